#include "services/citydb/citydb.h"

#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <optional>
#include <utility>
#include <vector>

#include "core/source/build.h"
#include "core/source/plan.h"
#include "services/citydb/candidates.h"
#include "services/citydb/pool.h"
#include "services/citydb/schema.h"

namespace citymesh {
namespace {

using namespace citydb;
using postgres::Pool;

constexpr std::uint32_t kSrs = 1;

/// What a selection leaves for its reading.
struct Session {
  std::optional<Pool::Lease> lease{};  ///< within the transaction of the selection
  std::unique_ptr<const Schema> schema{};
  Instance instance{};
  source::DocumentFacts facts{};
  std::vector<std::int64_t> ids{};
  std::vector<source::SrsUse> srs{};
};

class CityDbSource final : public CitySource {
 public:
  CityDbSource(std::shared_ptr<Pool> pool, CityDbOptions options, std::string name)
      : pool_(std::move(pool)), options_(std::move(options)), name_(std::move(name)) {}

  Result<Selection> select(const BuildingQuery& query, const RunContext& context) override {
    auto selection = select_once(query, context);
    if (selection || selection.error().code != ErrorCode::Unavailable) return selection;
    // A database that was restarted leaves connections behind that only look alive.
    pool_->drop_idle();
    return select_once(query, context);
  }

  Result<void> read(const BuildingQuery& query, const Selection& selection,
                    const BuildingSink& sink, const RunContext& context) override {
    const auto session = std::const_pointer_cast<Session>(
        std::static_pointer_cast<const Session>(selection.details));
    if (!session || !session->lease)
      return fail(ErrorCode::FailedPrecondition,
                  "the selection was not made by this source or has been read already: select the "
                  "buildings again");
    auto done = read_chunks(*session, query, selection, sink, context);
    session->lease.reset();
    if (!done && done.error().code == ErrorCode::Unavailable)
      return fail(
          ErrorCode::Unavailable,
          done.error().message + "; what was selected is gone with it: submit the job again");
    return done;
  }

 private:
  Result<Selection> select_once(const BuildingQuery& query, const RunContext& context) {
    auto lease = pool_->lease(context.stop);
    if (!lease) return lease.error();
    auto session = std::make_shared<Session>();
    session->lease = *std::move(lease);
    auto& connection = **session->lease;
    const std::vector<postgres::Statement> begin{
        {"BEGIN TRANSACTION ISOLATION LEVEL REPEATABLE READ READ ONLY"}};
    if (auto begun = connection.run(begin, context.stop); !begun) return begun.error();
    auto instance = look_at(connection, options_.schema, context.stop);
    if (!instance) return instance.error();
    session->instance = *std::move(instance);
    session->schema = schema_of(session->instance);

    auto asked = query;  // PostGIS has x for east, whatever a CRS says
    if (asked.axis_order == AxisOrder::Auto) asked.axis_order = AxisOrder::EastNorth;
    DatabaseCatalogue catalogue(connection, *session->schema, session->instance, name_,
                                options_.chunk, asked, options_.limits);
    auto plan = source::make_plan(catalogue, asked, {}, context);
    if (!plan) return plan.error();
    auto selection = std::move(plan->selection);
    if (query.bbox)
      if (auto warned = warn_of_unfindable(*session, selection, context); !warned)
        return warned.error();
    session->facts = catalogue.facts();
    for (auto& file : plan->files) {
      session->srs = std::move(file.srs);
      for (const auto& record : file.selected)
        session->ids.push_back(static_cast<std::int64_t>(record.number));
    }
    selection.details = std::move(session);
    return selection;
  }

  Result<void> warn_of_unfindable(const Session& session, Selection& selection,
                                  const RunContext& context) const {
    const auto counted =
        (*session.lease)->run(session.schema->without_envelope(session.instance), context.stop);
    if (!counted) return counted.error();
    if (const auto buildings = counted->integer(0, 0); buildings > 0)
      selection.warnings.push_back(fmt::format(
          "buildings of the database without an envelope, which no box finds: {}; have 3DCityDB "
          "compute what is missing ({})",
          buildings, session.schema->sql_for_envelopes(options_.schema)));
    return {};
  }

  Result<void> read_chunks(Session& session, const BuildingQuery& query, const Selection& selection,
                           const BuildingSink& sink, const RunContext& context) {
    auto placements = placements_of(session, query, selection.crs);
    if (!placements) return placements.error();
    source::BuildingMaker maker(*std::move(placements), selection.origin);
    FeatureBuilder builder(session.facts, kSrs, options_.limits);
    const auto take = [&](source::Feature& feature) -> Result<void> {
      if (context.stopped()) return fail(ErrorCode::Cancelled, "reading was stopped");
      return sink(maker.make(feature));
    };

    const std::size_t chunk = std::clamp<std::size_t>(options_.chunk, 1, 1000);
    const auto fetch = [&](std::size_t first) {
      const auto begin = session.ids.begin() + static_cast<std::ptrdiff_t>(first);
      const auto count = std::min(chunk, session.ids.size() - first);
      return session.schema->fetch(**session.lease, session.instance,
                                   {begin, begin + static_cast<std::ptrdiff_t>(count)},
                                   context.stop);
    };
    // The database works on the next chunk while the buildings of this one are worked on.
    std::future<Result<Tables>> next;
    for (std::size_t first = 0; first < session.ids.size(); first += chunk) {
      auto tables = next.valid() ? next.get() : fetch(first);
      if (!tables) return tables.error();
      if (first + chunk < session.ids.size())
        next = std::async(std::launch::async, fetch, first + chunk);
      auto built = session.schema->build(*tables, session.instance, builder, take);
      if (!built) {
        if (next.valid()) next.wait();
        return built;
      }
    }
    return {};
  }

  static Result<std::vector<source::SrsPlacement>> placements_of(const Session& session,
                                                                 const BuildingQuery& query,
                                                                 const Crs& working) {
    std::vector<source::SrsPlacement> placements;
    for (const auto& use : session.srs) {
      auto& placement = placements.emplace_back();
      placement.swap_axes = use.swap_axes;
      placement.problem = use.problem;
      if (!use.problem.empty()) continue;
      auto transformer = Transformer::create(source::source_crs(use, query), working);
      if (transformer)
        placement.transformer = *std::move(transformer);
      else
        placement.problem = transformer.error().message;
    }
    return placements;
  }

  std::shared_ptr<Pool> pool_;
  const CityDbOptions options_;
  const std::string name_;
};

}  // namespace

Result<CityDbFactory> open_citydb(const CityDbOptions& options) {
  auto name = shown_citydb_url(options.url);
  if (!name) return name.error();
  const auto pool = std::make_shared<Pool>(
      postgres::ConnectionOptions{.url = options.url,
                                  .connect_timeout_s = options.connect_timeout_s,
                                  .statement_timeout_s = options.statement_timeout_s},
      options.schema, options.max_connections);
  {
    const auto lease = pool->lease({});
    if (!lease) return lease.error();
    if (const auto instance = look_at(**lease, options.schema, {}); !instance)
      return instance.error();
  }
  return CityDbFactory([pool, options, name = *std::move(name)] {
    return Result<std::unique_ptr<CitySource>>(std::make_unique<CityDbSource>(pool, options, name));
  });
}

Result<std::string> shown_citydb_url(const std::string& url) { return postgres::shown_url(url); }

}  // namespace citymesh
