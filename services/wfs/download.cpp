#include "services/wfs/download.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/source/frame.h"

namespace citymesh::wfs {
namespace {

constexpr std::size_t kMostPages = 100'000;
constexpr std::size_t kIdsAtOnce = 50;
// The box grows by this part of itself: its sides are bent in another CRS.
constexpr double kBoxGrowth = 0.01;
constexpr double kBoxMargin = 1e-6;  // beyond any rounding

// "minx,miny,maxx,maxy,crs"
Result<std::string> box_of(const Server& server, const BuildingQuery& query) {
  const RequestBox& box = *query.bbox;
  auto ring = source::densified_ring(box.min_x, box.min_y, box.max_x, box.max_y);
  const Crs from = box.crs.known() ? box.crs : query.crs.known() ? query.crs : server.crs;
  const auto transformer = Transformer::create(from, server.crs);
  if (!transformer) return transformer.error();
  if (auto moved = transformer->apply(ring); !moved)
    return fail(ErrorCode::InvalidArgument, "bbox: " + moved.error().message);
  Box3 there;
  for (const Point3& point : ring) there.add(point);
  const double margin =
      kBoxGrowth * std::max(there.max.x - there.min.x, there.max.y - there.min.y) + kBoxMargin;
  there.add(Point3{there.min.x - margin, there.min.y - margin, 0});
  there.add(Point3{there.max.x + margin, there.max.y + margin, 0});
  if (server.north_first) there = source::with_axes_swapped(there);
  return fmt::format("{:.9f},{:.9f},{:.9f},{:.9f},{}", there.min.x, there.min.y, there.max.x,
                     there.max.y, server.srs_name);
}

Parameters request(const Server& server, const Parameters& filter) {
  Parameters all{{"SERVICE", "WFS"},
                 {"VERSION", server.version},
                 {"REQUEST", "GetFeature"},
                 {"TYPENAMES", server.types}};
  if (!server.namespaces.empty()) all.emplace_back("NAMESPACES", server.namespaces);
  if (!server.options.output_format.empty())
    all.emplace_back("OUTPUTFORMAT", server.options.output_format);
  if (!server.is_default_crs) all.emplace_back("SRSNAME", server.srs_name);
  all.insert(all.end(), filter.begin(), filter.end());
  return all;
}

std::optional<Error> over_limit(const Server& server, std::uint64_t features) {
  const auto most = server.options.max_features;
  if (most == 0 || features <= most) return std::nullopt;
  return server.error(ErrorCode::ResourceExhausted,
                      fmt::format("{} features are asked for, at most {} may be; choose a smaller "
                                  "`bbox`, or `object_ids`",
                                  features, most));
}

class Download {
 public:
  Download(const Server& server, const std::filesystem::path& folder, const RunContext& context)
      : server_(server), folder_(folder), context_(context) {}

  Result<Content> run(const BuildingQuery& query) {
    if (query.bbox) {
      auto box = box_of(server_, query);
      if (!box) return box.error();
      if (auto done = get_pages({{"BBOX", *box}}); !done) return done.error();
    } else if (query.object_ids.empty()) {
      if (auto done = get_pages({}); !done) return done.error();
    }
    std::set<std::string> missing(query.object_ids.begin(), query.object_ids.end());
    std::erase_if(missing, [&](const std::string& id) { return pages_->ids().contains(id); });
    const std::vector<std::string> ids(missing.begin(), missing.end());
    const std::size_t at_once =
        std::min<std::uint64_t>(kIdsAtOnce, server_.count_default.value_or(kIdsAtOnce));
    for (std::size_t i = 0; i < ids.size(); i += at_once)
      if (auto done = get_ids(std::span(ids).subspan(i, std::min(at_once, ids.size() - i))); !done)
        return done.error();
    return Content{std::move(pages_), std::move(warnings_)};
  }

 private:
  struct Page {
    AnswerHead head{};
    Pages::Added added{};
    std::uint64_t returned() const { return head.returned.value_or(added.buildings); }
  };

  Result<Page> get(const std::string& url) {
    if (pages_->count() >= kMostPages)
      return server_.error(ErrorCode::ResourceExhausted,
                           fmt::format("there are more than {} pages", kMostPages));
    auto answer = get_features(server_, url, context_.stop);
    if (!answer) return answer.error();
    Page page{.head = std::move(answer->head)};
    const auto& options = server_.options;
    bytes_ += answer->body.size();
    if (bytes_ > options.max_download_bytes)
      return server_.error(ErrorCode::ResourceExhausted,
                           fmt::format("the answers have more than {} bytes "
                                       "(max_download_bytes); choose a smaller `bbox`",
                                       options.max_download_bytes));
    const auto path = folder_ / fmt::format("page_{:06}.{}", pages_->count() + 1,
                                            page.head.json ? "json" : "gml");
    if (std::ofstream file(path, std::ios::binary);
        !file.write(answer->body.data(), static_cast<std::streamsize>(answer->body.size())) ||
        !file.flush())
      return fail(ErrorCode::Unavailable,
                  "an answer of a WFS cannot be written to the folder for temporary files; is the "
                  "disk full?");
    answer->body = {};
    auto added = pages_->add(path, options.limits, context_.stop);
    if (!added && added.error().code == ErrorCode::Cancelled) return added.error();
    if (!added)
      return server_.error(added.error().code,
                           "an answer cannot be read: " + added.error().message);
    page.added = *added;
    if (auto error =
            over_limit(server_, std::max(page.head.matched.value_or(0), pages_->buildings())))
      return *std::move(error);
    return page;
  }

  Error incomplete(std::uint64_t received, const AnswerHead& head, const std::string& why) const {
    const auto all = head.matched ? fmt::format("of {} features", *head.matched)
                                  : std::string("features of more");
    return server_.error(
        ErrorCode::ResourceExhausted,
        fmt::format("the server gives {} {}: {}; choose a smaller `bbox`", received, all, why));
  }

  // Links to the next page lead on, else STARTINDEX. A server may state how many features there
  // are, or not; may give fewer at once than asked for; may not know pages at all.
  Result<void> get_pages(const Parameters& filter) {
    const auto base = request(server_, filter);
    if (!server_.pages.value_or(true)) return get_all_at_once(base);
    const std::uint64_t count =
        std::min<std::uint64_t>(server_.options.page, server_.count_default.value_or(UINT64_MAX));
    std::uint64_t received = 0, repeated = 0;
    auto url = page_url(base, 0, count);
    for (bool first = true;; first = false) {
      const auto page = get(url);
      if (!page) return page.error();
      const std::uint64_t returned = page->returned();
      const bool repeats = !first && page->added.buildings > 0 && page->added.fresh == 0;
      if (repeats) {
        if (!page->head.matched && page->head.next.empty() && returned != count) return {};
        return incomplete(received, page->head, "it repeats a page instead of going on");
      }
      received += returned;
      repeated += page->added.buildings - page->added.fresh;
      if (returned == 0 && page->head.matched.value_or(0) > received)
        return incomplete(received, page->head, "a page is empty");
      if (returned == 0) return {};
      const auto& matched = page->head.matched;
      if (matched && received - repeated >= *matched) return {};
      const auto next =
          page->head.next.empty() ? std::nullopt : next_page(server_.url, page->head.next);
      if (matched && received >= *matched && !next) {
        warn_of_repeated(repeated, received);
        return {};
      }
      // More than asked for: it does not count, this is all. Fewer, where no limit of its own makes
      // them fewer: the end.
      if (page->head.next.empty() && !matched &&
          (returned > count || (server_.count_default && returned < count)))
        return {};
      url = next ? *next : page_url(base, received, count);
    }
  }

  void warn_of_repeated(std::uint64_t repeated, std::uint64_t received) {
    warnings_.push_back(
        fmt::format("WFS {}: {} of {} features came on two pages; where the server changes their "
                    "order from page to page, others have not come at all",
                    server_.shown, repeated, received));
  }

  std::string page_url(Parameters parameters, std::uint64_t start, std::uint64_t count) const {
    parameters.emplace_back("STARTINDEX", std::to_string(start));
    parameters.emplace_back("COUNT", std::to_string(count));
    return with_parameters(server_.url, parameters);
  }

  Result<void> get_all_at_once(const Parameters& base) {
    const auto page = get(with_parameters(server_.url, base));
    if (!page) return page.error();
    const bool may_lack =
        !page->head.matched && server_.count_default && page->returned() >= *server_.count_default;
    if (page->head.matched.value_or(0) > page->returned() || may_lack)
      return incomplete(page->returned(), page->head, "it has no pages");
    return {};
  }

  // An id that is not there may be an error to a server: then each is asked for by itself.
  Result<void> get_ids(std::span<const std::string> ids) {
    std::string list;
    for (const auto& id : ids) list += (list.empty() ? "" : ",") + id;
    const auto page = get(with_parameters(server_.url, request(server_, {{"RESOURCEID", list}})));
    if (page) return {};
    if (page.error().code != ErrorCode::NotFound) return page.error();
    if (ids.size() == 1) return {};
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (auto done = get_ids(ids.subspan(i, 1)); !done) return done;
    return {};
  }

  const Server& server_;
  const std::filesystem::path& folder_;
  const RunContext& context_;
  std::shared_ptr<Pages> pages_ = std::make_shared<Pages>();
  std::uint64_t bytes_ = 0;
  std::vector<std::string> warnings_{};
};

}  // namespace

Result<Content> download(const Server& server, const BuildingQuery& query,
                         const std::filesystem::path& folder, const RunContext& context) {
  return Download(server, folder, context).run(query);
}

Result<std::optional<std::uint64_t>> count(const Server& server, const BuildingQuery& query,
                                           const RunContext& context) {
  Parameters filter{{"RESULTTYPE", "hits"}};
  if (query.bbox) {
    auto box = box_of(server, query);
    if (!box) return box.error();
    filter.emplace_back("BBOX", *std::move(box));
  }
  const auto answer =
      get_features(server, with_parameters(server.url, request(server, filter)), context.stop);
  if (!answer && answer.error().code == ErrorCode::FailedPrecondition)
    return std::optional<std::uint64_t>{};
  if (!answer) return answer.error();
  const auto& matched = answer->head.matched;
  if (auto error = over_limit(server, matched.value_or(0))) return *std::move(error);
  return matched;
}

}  // namespace citymesh::wfs
