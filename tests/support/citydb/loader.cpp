#include "tests/support/citydb/loader.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/source/citygml_shapes.h"
#include "core/source/document.h"
#include "core/source/frame.h"
#include "core/source/scan.h"
#include "tests/support/citydb/database.h"
#include "tests/support/citydb/store.h"

namespace citymesh::citydb_support {
namespace {

namespace fs = std::filesystem;
using source::Feature;

/// A file that was looked through once: its CRSs, and what its buildings borrow from each other.
struct Document {
  source::FileScan scan{};
  std::vector<source::SrsUse> srs{};
};

Result<Document> look_through(const fs::path& file) {
  auto scan = source::scan_file(source::plain_file(file), {}, false, {});
  if (!scan) return scan.error();
  if (!scan->format || !scan->facts.failure.empty())
    return fail(ErrorCode::InvalidArgument, file.string() + ": " + scan->facts.failure);
  source::CrsBook book;
  auto srs = source::interpret_srs(*scan, {}, AxisOrder::Auto, book);
  return Document{std::move(*scan), std::move(srs)};
}

Box3 extent_of(const std::vector<Feature>& features, const StoredFeature::Place& place) {
  Box3 box;
  LoadReport ignored;
  for (const Feature& feature : features) {
    const StoredFeature stored(feature, place, ignored);
    for (const source::RawObject& object : feature.objects)
      for (const source::RawShape& shape : object.shapes)
        for (const source::PolygonUse& use : shape.uses)
          static_cast<void>(stored.rings(use, box).has_value());
  }
  return box;
}

/// Copies of the file on a square grid.
class Grid {
 public:
  Grid(std::uint32_t copies, const Box3& extent)
      : side_(static_cast<std::uint32_t>(std::ceil(std::sqrt(copies)))) {
    constexpr double kGap = 1.05;
    if (extent.is_empty()) return;
    width_ = std::ceil((extent.max.x - extent.min.x) * kGap);
    height_ = std::ceil((extent.max.y - extent.min.y) * kGap);
  }

  void put(std::uint32_t copy, StoredFeature::Place& place) const {
    if (copy == 0) return;
    place.dx = copy % side_ * width_;
    place.dy = copy / side_ * height_;
    place.suffix = "_c" + std::to_string(copy);
  }

 private:
  std::uint32_t side_;
  double width_ = 0, height_ = 0;
};

class Loading {
 public:
  Loading(Store& store, LoadReport& report) : store_(store), report_(report) {}

  Result<void> add(const Feature& feature, const StoredFeature::Place& place) {
    constexpr std::size_t kChunk_bytes = 32u << 20;
    store_.add(StoredFeature(feature, place, report_));
    ++report_.buildings;
    return store_.bytes() < kChunk_bytes ? Result<void>() : store_.flush();
  }

 private:
  Store& store_;
  LoadReport& report_;
};

Result<void> read_into(Store& store, const Document& document, const LoadOptions& options,
                       LoadReport& report) {
  StoredFeature::Place place;
  for (const source::SrsUse& use : document.srs) place.swap_axes.push_back(use.swap_axes);
  place.citygml3 = document.scan.facts.format == "CityGML 3.0";

  Loading loading(store, report);
  std::vector<Feature> kept;
  source::DocumentFacts facts;
  const source::DocumentOptions reading{.stem = source::file_stem(document.scan.path),
                                        .shared = document.scan.shared.get()};
  const auto read = source::read_document(document.scan.text, *document.scan.format, reading, facts,
                                          [&](Feature& feature) -> Result<void> {
                                            if (options.copies == 1)
                                              return loading.add(feature, place);
                                            kept.push_back(std::move(feature));
                                            return {};
                                          });
  if (!read) return read;
  if (facts.srs_names.size() > place.swap_axes.size())
    return fail(ErrorCode::Internal, "CRS names differ between two readings of the file");
  const Grid grid(options.copies, extent_of(kept, place));
  for (std::uint32_t copy = 0; copy < options.copies; ++copy) {
    grid.put(copy, place);
    for (const Feature& feature : kept)
      if (auto added = loading.add(feature, place); !added) return added;
  }
  return store.flush();
}

/// The ids were not drawn from the sequences, which go on behind them.
Result<void> advance_sequences(Database& database, const Schema& schema) {
  const auto tables = schema.major == 4
                          ? std::vector<std::string>{"cityobject", "surface_geometry"}
                          : std::vector<std::string>{"feature", "geometry_data", "property"};
  for (const auto& table : tables) {
    const auto name = identifier(schema.name) + "." + table;
    const auto set =
        database.value("SELECT setval(" + literal(name + "_seq") + ", max(id)) FROM " + name);
    if (!set) return set.error();
  }
  return {};
}

}  // namespace

Result<LoadReport> load(const std::string& url, const LoadOptions& options, const fs::path& file) {
  const auto document = look_through(file);
  if (!document) return document.error();
  auto database = Database::open(url);
  if (!database) return database.error();
  if (auto begun = database->run("BEGIN"); !begun) return begun.error();
  LoadReport report;
  const auto store = options.schema.major == 4 ? open_store_v4(*database, options, report)
                                               : open_store_v5(*database, options, report);
  if (!store) return store.error();
  if (auto stored = read_into(**store, *document, options, report); !stored) return stored.error();
  if (auto advanced = advance_sequences(*database, options.schema); !advanced)
    return advanced.error();
  if (auto ended = database->run("COMMIT"); !ended) return ended.error();
  return report;
}

Result<int> srid_of(const fs::path& file) {
  const auto document = look_through(file);
  if (!document) return document.error();
  for (const source::SrsUse& use : document->srs) {
    constexpr std::string_view kAuthority = "EPSG:";
    const std::string_view id = use.crs.id;
    if (id.substr(0, kAuthority.size()) != kAuthority) continue;
    const auto code = id.substr(kAuthority.size(), id.find('+') - kAuthority.size());
    if (const auto number = number_from<int>(code)) return *number;
  }
  return 0;
}

}  // namespace citymesh::citydb_support
