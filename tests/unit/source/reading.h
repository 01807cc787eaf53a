#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/citymodel/issue.h"
#include "core/source/source.h"
#include "tests/support/temp_folder.h"

namespace citymesh {

/// What came of selecting and reading a set of small documents.
struct Reading {
  std::optional<Error> error{};
  Selection selection{};
  std::vector<Building> buildings{};

  const InputReport& input(std::size_t i = 0) const { return selection.inputs.at(i); }
  std::vector<std::string> ids() const {
    std::vector<std::string> ids;
    for (const Building& building : buildings) ids.push_back(building.gml_id);
    return ids;
  }
};

inline Reading read_from(CitySource& source, const BuildingQuery& query = {}) {
  Reading reading;
  auto selection = source.select(query, {});
  if (!selection) {
    reading.error = selection.error();
    return reading;
  }
  reading.selection = *selection;
  const auto done = source.read(query, *selection,
                                [&](Building&& building) -> Result<void> {
                                  reading.buildings.push_back(std::move(building));
                                  return {};
                                },
                                {});
  if (!done) reading.error = done.error();
  return reading;
}

/// Documents in a folder of their own.
class Documents {
 public:
  std::filesystem::path add(const std::string& name, const std::string& text) {
    const auto path = folder_ / name;
    if (path.extension() == ".gz") {
      gzFile file = gzopen(path.c_str(), "wb");
      gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
      gzclose(file);
    } else {
      std::ofstream(path, std::ios::binary) << text;
    }
    paths_.push_back(path);
    return path;
  }
  const std::filesystem::path& folder() const { return folder_.path(); }

  Reading read(const BuildingQuery& query = {}, const FileSourceOptions& options = {}) const {
    auto source = open_files(paths_, options);
    if (!source) return {.error = source.error()};
    return read_from(**source, query);
  }

 private:
  TempFolder folder_{};
  std::vector<std::filesystem::path> paths_{};
};

inline Reading read_text(const std::string& name, const std::string& text,
                         const BuildingQuery& query = {}, const FileSourceOptions& options = {}) {
  Documents documents;
  documents.add(name, text);
  return documents.read(query, options);
}

// ---- CityGML in few words ----------------------------------------------------------------------

inline std::string city_model(const std::string& content, const std::string& version = "2.0") {
  const std::string base = "http://www.opengis.net/citygml/";
  const std::string gml = version == "3.0" ? "/3.2" : "";
  return "<?xml version=\"1.0\"?>\n<CityModel xmlns=\"" + base + version + "\" xmlns:bldg=\"" +
         base + "building/" + version + "\" xmlns:gen=\"" + base + "generics/" + version +
         "\" xmlns:con=\"" + base + "construction/" + version + "\" xmlns:app=\"" + base +
         "appearance/" + version + "\" xmlns:gml=\"http://www.opengis.net/gml" + gml +
         "\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" xmlns:ade=\"http://example.org/ade\">\n" +
         content + "</CityModel>\n";
}

inline std::string building(const std::string& id, const std::string& content) {
  return "<cityObjectMember><bldg:Building" + (id.empty() ? "" : " gml:id=\"" + id + "\"") + ">" +
         content + "</bldg:Building></cityObjectMember>\n";
}

inline std::string ring(const std::string& positions) {
  return "<gml:LinearRing><gml:posList>" + positions + "</gml:posList></gml:LinearRing>";
}

inline std::string polygon(const std::string& id, const std::string& positions) {
  return "<gml:Polygon gml:id=\"" + id + "\"><gml:exterior>" + ring(positions) +
         "</gml:exterior></gml:Polygon>";
}

inline std::string member(const std::string& geometry) {
  return "<gml:surfaceMember>" + geometry + "</gml:surfaceMember>";
}

inline std::string member_by(const std::string& href) {
  return "<gml:surfaceMember xlink:href=\"" + href + "\"/>";
}

inline std::string multi_surface(const std::string& members) {
  return "<bldg:lod2MultiSurface><gml:MultiSurface>" + members +
         "</gml:MultiSurface></bldg:lod2MultiSurface>";
}

inline std::string solid(const std::string& members) {
  return "<bldg:lod2Solid><gml:Solid><gml:exterior><gml:CompositeSurface>" + members +
         "</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod2Solid>";
}

inline std::string surface(const std::string& type, const std::string& id,
                           const std::string& content) {
  return "<bldg:boundedBy><bldg:" + type + " gml:id=\"" + id + "\">" + content + "</bldg:" + type +
         "></bldg:boundedBy>";
}

/// Positions of a level square, closed, counter-clockwise from above.
inline std::string square(double x, double y, double z = 0, double size = 10) {
  const auto corner = [&](double dx, double dy) {
    return std::to_string(x + dx) + " " + std::to_string(y + dy) + " " + std::to_string(z) + " ";
  };
  return corner(0, 0) + corner(size, 0) + corner(size, size) + corner(0, size) + corner(0, 0);
}

/// A building of one ground surface.
inline std::string simple_building(const std::string& id, double x, double y, double z = 0) {
  return building(id, surface("GroundSurface", id + "_g",
                              multi_surface(member(polygon(id + "_p", square(x, y, z))))));
}

inline std::string envelope(const std::string& srs, const std::string& lower,
                            const std::string& upper) {
  return "<gml:boundedBy><gml:Envelope srsName=\"" + srs +
         "\" srsDimension=\"3\"><gml:lowerCorner>" + lower + "</gml:lowerCorner><gml:upperCorner>" +
         upper + "</gml:upperCorner></gml:Envelope></gml:boundedBy>\n";
}

MATCHER_P(HasIssue, code, "has issue " + std::string(issue_name(code))) {
  for (const Issue& issue : arg.source_issues)
    if (issue.code == code) return true;
  return false;
}

}  // namespace citymesh
