// catalogue_latency DIR BUILDINGS [RUNS]: how fast a folder is indexed on one thread, how fast an
// unchanged one is looked through again, and how long a box of about BUILDINGS buildings takes from
// the request to the first and to the last building in memory. Medians.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "services/catalogue/catalogue.h"

namespace {

using namespace citymesh;
using Clock = std::chrono::steady_clock;

double since_ms(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

int failed(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return 2;
}

struct Request {
  double first_ms = -1, last_ms = 0;
  std::uint64_t buildings = 0;
};

Result<Request> request(const CatalogueOptions& options, const BuildingQuery& query) {
  Request done;
  const auto begin = Clock::now();
  auto source = open_catalogued(options);
  if (!source) return source.error();
  auto selection = (*source)->select(query, {});
  if (!selection) return selection.error();
  auto read = (*source)->read(query, *selection,
                              [&](Building&&) -> Result<void> {
                                if (done.buildings++ == 0) done.first_ms = since_ms(begin);
                                return {};
                              },
                              {});
  if (!read) return read.error();
  done.last_ms = since_ms(begin);
  return done;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: catalogue_latency DIR BUILDINGS [RUNS]\n");
    return 2;
  }
  const CatalogueOptions options{.data = argv[1],
                                 .state = std::filesystem::path(argv[1]) / ".citymesh"};
  const double wanted = std::atof(argv[2]);
  const int runs = argc > 3 ? std::max(1, std::atoi(argv[3])) : 5;

  std::vector<double> index_ms, again_ms;
  CatalogueReport report;
  for (int run = 0; run < runs; ++run) {
    std::filesystem::remove_all(options.state);
    auto begin = Clock::now();
    auto indexed = update_catalogue(options, {});
    if (!indexed) return failed(indexed.error());
    index_ms.push_back(since_ms(begin));
    report = *indexed;
    begin = Clock::now();
    if (auto again = update_catalogue(options, {}); !again) return failed(again.error());
    again_ms.push_back(since_ms(begin));
  }
  const double megabytes = static_cast<double>(report.bytes) / 1e6;
  std::printf("%-10s %9.1f ms %8.1f MB/s  %llu files, %llu buildings, %.1f MB\n", "index",
              median(index_ms), megabytes / median(index_ms) * 1e3,
              static_cast<unsigned long long>(report.files),
              static_cast<unsigned long long>(report.buildings), megabytes);
  std::printf("%-10s %9.1f ms\n", "unchanged", median(again_ms));

  // A box in the middle of the city, grown until it holds about as many as wanted.
  auto source = open_catalogued(options);
  if (!source) return failed(source.error());
  auto all = (*source)->select({}, {});
  if (!all) return failed(all.error());
  BuildingQuery query;
  query.bbox = RequestBox{.crs = all->crs};
  bool found = false;
  auto seek = (*source)->read({}, *all,
                              [&](Building&& building) -> Result<void> {
                                const Box3 box = extent(building);
                                if (box.is_empty()) return {};
                                query.bbox->min_x = query.bbox->max_x = box.min.x + all->origin.x;
                                query.bbox->min_y = query.bbox->max_y = box.min.y + all->origin.y;
                                found = true;
                                return fail(ErrorCode::Cancelled, "one is enough");
                              },
                              {});
  if (!found) return seek ? 2 : failed(seek.error());
  for (std::uint64_t count = 0; count < static_cast<std::uint64_t>(wanted);) {
    query.bbox->min_x -= 10;
    query.bbox->min_y -= 10;
    query.bbox->max_x += 10;
    query.bbox->max_y += 10;
    auto selection = (*source)->select(query, {});
    if (!selection) return failed(selection.error());
    count = selection->buildings;
  }

  std::vector<double> first_ms, last_ms;
  std::uint64_t buildings = 0;
  for (int run = 0; run < runs; ++run) {
    auto done = request(options, query);
    if (!done) return failed(done.error());
    first_ms.push_back(done->first_ms);
    last_ms.push_back(done->last_ms);
    buildings = done->buildings;
  }
  std::printf("%-10s %9.1f ms  to the first of %llu buildings\n", "box", median(first_ms),
              static_cast<unsigned long long>(buildings));
  std::printf("%-10s %9.1f ms  to the last\n", "box", median(last_ms));
  return 0;
}
