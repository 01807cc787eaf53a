// read_throughput FILE [RUNS]: how fast a file is read, parse to city model, beside the time that
// `xmllint --stream --noout --huge` needs for it where xmllint is installed, or for CityJSON the
// SAX pass of nlohmann-json. Medians.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/source/document.h"
#include "core/source/source.h"

namespace {

using namespace citymesh;

template <class Action>
double median_s(int runs, Action&& action) {
  std::vector<double> times;
  for (int i = 0; i < runs; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    if (!action()) return -1;
    times.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  std::nth_element(times.begin(), times.begin() + runs / 2, times.end());
  return times[static_cast<std::size_t>(runs / 2)];
}

/// Takes every event and does nothing.
struct Ignore : nlohmann::json_sax<nlohmann::json> {
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return true; }
  bool key(string_t&) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    return false;
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: read_throughput FILE [RUNS]\n");
    return 2;
  }
  const std::filesystem::path path = argv[1];
  const int runs = argc > 2 ? std::max(1, std::atoi(argv[2])) : 5;
  const double megabytes = static_cast<double>(std::filesystem::file_size(path)) / 1e6;

  auto source = open_files({path}, {});
  if (!source) {
    std::fprintf(stderr, "%s\n", source.error().message.c_str());
    return 2;
  }
  std::uint64_t buildings = 0, polygons = 0;
  Result<Selection> selection = Selection{};
  const double select_s = median_s(1, [&] {
    selection = (*source)->select({}, {});
    return selection.has_value();
  });
  if (!selection) {
    std::fprintf(stderr, "%s\n", selection.error().message.c_str());
    return 2;
  }
  const auto read_on = [&](unsigned threads) {
    RunContext context;
    context.threads = threads;
    return median_s(runs, [&] {
      buildings = polygons = 0;
      return (*source)
          ->read(
              {}, *selection,
              [&](Building&& building) -> Result<void> {
                ++buildings;
                for (const Geometry& geometry : building.geometries)
                  polygons += geometry.polygons.size();
                return {};
              },
              context)
          .has_value();
    });
  };
  const double read_s = read_on(1);
  const double on_two_s = read_on(2);
  std::printf("%-10s %8.3f s %8.1f MB/s  (first pass: ids, extents, CRS)\n", "select", select_s,
              megabytes / select_s);
  std::printf("%-10s %8.3f s %8.1f MB/s  %llu buildings, %llu polygons\n", "read", read_s,
              megabytes / read_s, static_cast<unsigned long long>(buildings),
              static_cast<unsigned long long>(polygons));
  std::printf("%-10s %8.3f s %8.1f MB/s  on two threads, %.2f times as fast\n", "read", on_two_s,
              megabytes / on_two_s, read_s / on_two_s);

  if (path.extension() == ".json") {
    const double sax_s = median_s(runs, [&] {
      std::ifstream file(path, std::ios::binary);
      const std::string text((std::istreambuf_iterator<char>(file)), {});
      Ignore ignore;
      return nlohmann::json::sax_parse(text, &ignore);
    });
    if (sax_s > 0)
      std::printf("%-10s %8.3f s %8.1f MB/s  read takes %.2f times as long\n", "nlohmann", sax_s,
                  megabytes / sax_s, read_s / sax_s);
    return 0;
  }
  const std::string command = "xmllint --stream --noout --huge '" + path.string() + "'";
  const double xmllint_s =
      median_s(runs, [&] { return std::system(command.c_str()) == 0; });  // NOLINT
  if (xmllint_s > 0)
    std::printf("%-10s %8.3f s %8.1f MB/s  read takes %.2f times as long\n", "xmllint", xmllint_s,
                megabytes / xmllint_s, read_s / xmllint_s);
  return 0;
}
