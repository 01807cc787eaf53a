#include "services/catalogue/records.h"

#include <cstring>
#include <nlohmann/json.hpp>

namespace citymesh::catalogue {
namespace {

using nlohmann::json;
using namespace source;

Error damaged(const std::string& what) {
  return fail(ErrorCode::DataLoss,
              "the catalogue is damaged (" + what + "): index the folder again");
}

std::string dumped(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

json box_json(const Box3& box) {
  if (box.is_empty()) return nullptr;
  return {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
}

Box3 box_from(const json& value) {
  Box3 box;
  if (value.is_null()) return box;
  const auto numbers = value.get<std::array<double, 6>>();
  box.add(Point3{numbers[0], numbers[1], numbers[2]});
  box.add(Point3{numbers[3], numbers[4], numbers[5]});
  return box;
}

template <class Value>
void append(std::string& bytes, const Value& value) {
  static_assert(std::is_trivially_copyable_v<Value>);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class Value>
bool take(std::string_view& bytes, Value& value) {
  if (bytes.size() < sizeof value) return false;
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes.remove_prefix(sizeof value);
  return true;
}

}  // namespace

std::string facts_text(const FileRecord& file) {
  const DocumentFacts& facts = file.facts;
  json envelopes = json::array(), srs = json::array();
  for (const Envelope& envelope : facts.envelopes)
    envelopes.push_back({envelope.before, envelope.after, envelope.srs, envelope.dimension});
  for (const SrsExtent& extent : file.srs)
    srs.push_back({extent.buildings, box_json(extent.all), box_json(extent.near_m),
                   box_json(extent.near_deg)});
  return dumped({{"format", facts.format},
                 {"failure", facts.failure},
                 {"not_a_city_model", facts.not_a_city_model},
                 {"srs_names", facts.srs_names},
                 {"declared_extent", box_json(facts.declared_extent)},
                 {"declared_srs", facts.declared_srs},
                 {"unresolved", facts.unresolved},
                 {"envelopes", envelopes},
                 {"skipped_objects", facts.skipped_objects},
                 {"skipped_types", facts.skipped_types},
                 {"srs", srs}});
}

Result<void> read_facts(std::string_view text, FileRecord& file) {
  try {
    const json stored = json::parse(text);
    DocumentFacts& facts = file.facts;
    facts.format = stored.at("format");
    facts.failure = stored.at("failure");
    facts.not_a_city_model = stored.at("not_a_city_model");
    facts.srs_names = stored.at("srs_names").get<std::vector<std::string>>();
    facts.declared_extent = box_from(stored.at("declared_extent"));
    facts.declared_srs = stored.at("declared_srs");
    for (const json& id : stored.at("unresolved")) facts.unresolved.insert(id.get<std::string>());
    for (const json& envelope : stored.at("envelopes"))
      facts.envelopes.push_back({.before = envelope.at(0),
                                 .after = envelope.at(1),
                                 .srs = envelope.at(2),
                                 .dimension = envelope.at(3)});
    facts.skipped_objects = stored.at("skipped_objects");
    facts.skipped_types = stored.value("skipped_types", facts.skipped_types);
    for (const json& extent : stored.at("srs"))
      file.srs.push_back({.buildings = extent.at(0),
                          .all = box_from(extent.at(1)),
                          .near_m = box_from(extent.at(2)),
                          .near_deg = box_from(extent.at(3))});
    if (file.srs.size() != facts.srs_names.size()) return damaged("extents of " + file.name);
    return {};
  } catch (const json::exception& error) {
    return damaged(error.what());
  }
}

std::string footprint_bytes(const Footprints& footprint) {
  std::string bytes;
  append(bytes, static_cast<std::uint32_t>(footprint.rings.size()));
  for (const Footprints::Ring& ring : footprint.rings) {
    append(bytes, ring.count);
    append(bytes, static_cast<std::uint8_t>(ring.exterior));
    for (std::uint32_t i = 0; i < ring.count; ++i) append(bytes, footprint.points[ring.first + i]);
  }
  return bytes;
}

Result<Footprints> read_footprint(std::string_view bytes) {
  Footprints footprint;
  std::uint32_t rings = 0;
  bool whole = take(bytes, rings);
  for (std::uint32_t r = 0; whole && r < rings; ++r) {
    std::uint32_t count = 0;
    std::uint8_t exterior = 0;
    whole = take(bytes, count) && take(bytes, exterior) && count <= bytes.size() / sizeof(Point2);
    if (!whole) break;
    const auto first = static_cast<std::uint32_t>(footprint.points.size());
    footprint.points.resize(first + count);
    std::memcpy(footprint.points.data() + first, bytes.data(), count * sizeof(Point2));
    bytes.remove_prefix(count * sizeof(Point2));
    footprint.rings.push_back({first, count, exterior != 0});
  }
  if (!whole || !bytes.empty()) return damaged("a footprint");
  return footprint;
}

std::string list_text(const std::vector<std::string>& texts) {
  return texts.empty() ? std::string() : dumped(texts);
}

Result<std::vector<std::string>> read_list(std::string_view text) {
  if (text.empty()) return std::vector<std::string>{};
  try {
    return json::parse(text).get<std::vector<std::string>>();
  } catch (const json::exception& error) {
    return damaged(error.what());
  }
}

}  // namespace citymesh::catalogue
