#pragma once

#include <string>
#include <string_view>

namespace citymesh::test {

/// CityJSON of one building, 4 x 3 x 2 m, with ids, semantics, attributes and an address, whose
/// east wall is missing.
inline std::string open_box_cityjson() {
  return R"({"type":"CityJSON","version":"2.0",
"transform":{"scale":[0.001,0.001,0.001],"translate":[391000,5820000,30]},
"metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/25833"},
"CityObjects":{"open_box":{"type":"Building","attributes":{"owner":"A & B","floors":2},
"address":[{"ThoroughfareName":"Main Street","ThoroughfareNumber":"7"}],
"geometry":[{"type":"MultiSurface","lod":"2",
"boundaries":[[[0,3,2,1]],[[0,1,5,4]],[[2,3,7,6]],[[3,0,4,7]],[[4,5,6,7]]],
"semantics":{"surfaces":[{"type":"GroundSurface","id":"ground"},{"type":"WallSurface","id":"south"},
{"type":"WallSurface","id":"north"},{"type":"WallSurface","id":"west"},
{"type":"RoofSurface","id":"roof"}],"values":[0,1,2,3,4]}}]}},
"vertices":[[0,0,0],[4000,0,0],[4000,3000,0],[0,3000,0],[0,0,2000],[4000,0,2000],
[4000,3000,2000],[0,3000,2000]]})";
}

/// The same surfaces stated as a solid, which is not closed then.
inline std::string open_solid_cityjson() {
  std::string text = open_box_cityjson();
  const auto replace = [&](std::string_view from, std::string_view by) {
    text.replace(text.find(from), from.size(), by);
  };
  replace("MultiSurface", "Solid");
  replace("[[[0,3,2,1]]", "[[[[0,3,2,1]]");
  replace("[[4,5,6,7]]]", "[[4,5,6,7]]]]");
  replace("[0,1,2,3,4]", "[[0,1,2,3,4]]");
  return text;
}

}  // namespace citymesh::test
