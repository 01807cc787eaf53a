#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "core/source/build.h"
#include "core/source/scan.h"

namespace citymesh::source {

/// Bytes that can be opened as a file without touching a disk.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : descriptor_(memfd_create("fuzz", 0)) {
    if (descriptor_ < 0 || ::write(descriptor_, data, size) != static_cast<ssize_t>(size)) abort();
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { ::close(descriptor_); }

  std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

/// Reads the bytes in both passes, as a source does, and demands what every reader promises:
/// indices that are in range, and two passes that agree. `name` helps to recognise the format.
inline void read_bytes(const std::uint8_t* data, std::size_t size,
                       const std::string& name = "fuzz") {
  const MemoryFile file(data, size);
  ReadLimits limits;
  limits.max_depth = 64;
  limits.max_file_bytes = 1u << 22;
  limits.max_building_bytes = 1u << 20;
  limits.max_points_per_building = 20'000;

  FileRecord record = plain_file(file.path());
  record.name = name;
  const auto scan = scan_file(record, limits, true, {});
  if (!scan || !scan->format) return;
  std::vector<SrsPlacement> placements(scan->facts.srs_names.size());
  for (SrsPlacement& placement : placements) {
    auto identity = Transformer::create({}, {});
    if (!identity) abort();
    placement.transformer = std::move(*identity);
  }
  BuildingMaker maker(std::move(placements), {});
  const DocumentOptions options{
      .limits = limits, .stem = file_stem(name), .shared = scan->shared.get()};
  DocumentFacts facts;
  facts.srs_names = scan->facts.srs_names;
  std::size_t count = 0;

  const std::function<void(const Building&)> check = [&](const Building& building) {
    for (const Surface& surface : building.surfaces)
      if (surface.parent >= static_cast<std::int32_t>(building.surfaces.size())) abort();
    for (const Geometry& geometry : building.geometries) {
      for (const Polygon& polygon : geometry.polygons) {
        if (polygon.surface >= static_cast<std::int32_t>(building.surfaces.size())) abort();
        for (const Ring& ring : polygon.rings)
          for (const std::uint32_t point : ring)
            if (point >= geometry.points.size()) abort();
      }
      for (const Solid& solid : geometry.solids) {
        for (const std::uint32_t polygon : solid.exterior)
          if (polygon >= geometry.polygons.size()) abort();
        for (const auto& shell : solid.interiors)
          for (const std::uint32_t polygon : shell)
            if (polygon >= geometry.polygons.size()) abort();
      }
    }
    for (const Building& part : building.parts) check(part);
  };
  const auto read = read_document(file.path(), *scan->format, options, facts,
                                  [&](Feature& feature) -> Result<void> {
                                    ++count;
                                    check(maker.make(feature));
                                    return {};
                                  });
  if (!read || count != scan->records.size()) abort();
}

}  // namespace citymesh::source
