#include "core/source/cityjson_objects.h"

#include <simdjson.h>

#include <array>

#include "core/citymodel/issue.h"
#include "core/source/cityjson_geometry.h"
#include "core/source/json_features.h"

namespace citymesh::source {
namespace {

namespace dom = simdjson::dom;

std::string text_of(dom::element value) {
  if (value.is_string()) return std::string(std::string_view(value));
  if (value.is_number()) return simdjson::minify(value);
  return {};
}

// Of an address; the names of CityJSON 1.x and 2.0 and of what programs write, in small letters.
struct AddressName {
  std::string_view name;
  std::string Address::*field;
};
constexpr std::array kAddressNames{
    AddressName{"country", &Address::country},
    AddressName{"countryname", &Address::country},
    AddressName{"administrativearea", &Address::state},
    AddressName{"administrativeareaname", &Address::state},
    AddressName{"state", &Address::state},
    AddressName{"locality", &Address::city},
    AddressName{"localityname", &Address::city},
    AddressName{"city", &Address::city},
    AddressName{"thoroughfarename", &Address::street},
    AddressName{"street", &Address::street},
    AddressName{"thoroughfarenumber", &Address::house_number},
    AddressName{"housenumber", &Address::house_number},
    AddressName{"postalcode", &Address::zip_code},
    AddressName{"postcode", &Address::zip_code},
    AddressName{"zipcode", &Address::zip_code},
    AddressName{"postbox", &Address::po_box},
    AddressName{"pobox", &Address::po_box},
};

void add_address(dom::object object, std::vector<Address>& addresses) {
  Address address;
  for (const auto& [key, value] : object) {
    std::string name;
    for (const char c : key)
      if (c != '_') name += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    for (const AddressName& known : kAddressNames)
      if (known.name == name && (address.*known.field).empty())
        address.*known.field = text_of(value);
  }
  if (!(address == Address{})) addresses.push_back(std::move(address));
}

// An object in 1.x, a list of them in 2.0.
std::vector<Address> addresses_of(const dom::object& city_object) {
  std::vector<Address> addresses;
  dom::element element;
  if (city_object["address"].get(element) != simdjson::SUCCESS) return addresses;
  dom::object object;
  dom::array list;
  if (element.get(object) == simdjson::SUCCESS) {
    add_address(object, addresses);
  } else if (element.get(list) == simdjson::SUCCESS) {
    for (const dom::element entry : list)
      if (entry.get(object) == simdjson::SUCCESS) add_address(object, addresses);
  }
  return addresses;
}

}  // namespace

CityObjects::Type CityObjects::type_of(const dom::object& object) {
  const auto type = text_member(object, "type").value_or("");
  if (type == "Building") return Type::Building;
  if (type == "BuildingPart") return Type::Part;
  if (type == "BuildingInstallation") return Type::Installation;
  if (!type.empty() && type.front() == '+') return Type::Extension;
  return Type::Other;
}

void CityObjects::add(std::string id, const dom::object* object) {
  const auto index = static_cast<std::uint32_t>(entries_.size());
  by_id_.try_emplace(id, index);
  entries_.push_back({.id = std::move(id)});
  if (!object) return;
  Entry& entry = entries_.back();
  entry.type = type_of(*object);
  if (entry.type == Type::Extension) entry.extension = text_member(*object, "type").value_or("");
  if (entry.type == Type::Other) return;
  keep_ids(*object, "parents", index, parents_);
  keep_ids(*object, "children", index, children_);
}

void CityObjects::keep_ids(const dom::object& object, std::string_view key, std::uint32_t index,
                           Relations& relations) {
  dom::array ids;
  if (object[key].get(ids) != simdjson::SUCCESS) return;
  for (const dom::element element : ids)
    if (element.is_string()) relations.emplace_back(index, std::string_view(element));
}

void CityObjects::link() {
  for (const auto& [parent, id] : children_) join(parent, id, false);  // in their parents' order
  for (const auto& [child, id] : parents_) join(child, id, true);
  parents_ = {};
  children_ = {};
}

void CityObjects::join(std::uint32_t from, const std::string& id, bool upwards) {
  const auto found = by_id_.find(id);
  if (found == by_id_.end()) return;
  const std::uint32_t parent = upwards ? found->second : from;
  const std::uint32_t child = upwards ? from : found->second;
  const Type type = entries_[child].type;
  if (type != Type::Part && type != Type::Installation) return;
  if (linked_.insert({parent, child}).second) entries_[parent].children.push_back(child);
}

Result<void> CityJsonDelivery::deliver(CityObjects& objects, const std::vector<Point3>& vertices,
                                       const LoadObject& load, const ByteRange& bytes) {
  using Type = CityObjects::Type;
  const auto count = [&](std::string_view type) {
    ++facts_.skipped_objects;
    facts_.count_skipped(type);
  };
  for (const CityObjects::Entry& entry : objects.entries_)
    if (entry.type == Type::Extension) count(entry.extension);
  for (const Type type : {Type::Building, Type::Part})
    for (std::uint32_t i = 0; i < objects.entries_.size(); ++i) {
      if (objects.entries_[i].type != type || objects.entries_[i].delivered) continue;
      if (options_.stop.stop_requested()) return fail(ErrorCode::Cancelled, "reading was stopped");
      feature_.clear();
      feature_.bytes = bytes;
      if (auto taken = deliver_one(objects, i, vertices, load); !taken) return taken;
    }
  for (const CityObjects::Entry& entry : objects.entries_)
    if (entry.type == Type::Installation && !entry.delivered)
      count("BuildingInstallation without a building");
  return {};
}

Result<void> CityJsonDelivery::deliver_one(CityObjects& objects, std::uint32_t root,
                                           const std::vector<Point3>& vertices,
                                           const LoadObject& load) {
  using Type = CityObjects::Type;
  feature_.srs = header_.srs;
  ++ordinal_;
  bool fits = true;
  struct Due {
    std::uint32_t entry;
    std::int32_t parent;
  };
  std::vector<Due> due{{root, -1}};
  while (!due.empty()) {
    const Due next = due.back();
    due.pop_back();
    CityObjects::Entry& entry = objects.entries_[next.entry];
    if (std::exchange(entry.delivered, true)) continue;  // a part belongs to its first parent
    const dom::object* const object = load(next.entry);
    const std::size_t index = feature_.objects.size();
    RawObject& raw = feature_.objects.emplace_back();
    raw.gml_id = entry.id;
    raw.parent = next.parent;
    if (raw.gml_id.empty())
      raw.gml_id = index == 0 ? numbered_id(options_.stem, options_.buildings_before + ordinal_)
                              : numbered_id(feature_.objects.front().gml_id, index);
    raw.kind = entry.type == Type::Building ? ObjectKind::Building
               : entry.type == Type::Part   ? ObjectKind::BuildingPart
                                            : ObjectKind::BuildingInstallation;
    for (auto child = entry.children.rbegin(); child != entry.children.rend(); ++child)
      due.push_back({*child, static_cast<std::int32_t>(index)});
    if (!object) {
      raw.issues.push_back({issue_code::kUnreadableGeometry, "the object is not readable JSON"});
      continue;
    }
    if (dom::object attributes; (*object)["attributes"].get(attributes) == simdjson::SUCCESS)
      raw.attributes = attributes_from(attributes);
    raw.addresses = addresses_of(*object);
    fits = add_geometries(*object, header_, facts_.srs_names[header_.srs], vertices,
                          options_.limits.max_points_per_building, index, feature_) &&
           fits;
  }
  if (!fits) {
    for (RawObject& object : feature_.objects) object.shapes.clear();
    feature_.objects.front().issues.push_back(
        {issue_code::kReadLimitExceeded,
         "more than max_points_per_building = " +
             std::to_string(options_.limits.max_points_per_building) + " points"});
  }
  return sink_(feature_);
}

}  // namespace citymesh::source
