#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/write/city_objects.h"

namespace citymesh {

enum class CityGml { V2, V3 };

/// What an object says of itself before its geometry, in the order of the schema: lineage,
/// description, name, dates, generic attributes; in 2.0 also those of buildings.
void append_attributes_before_geometry(std::string& xml, CityGml version, const CityObject& object,
                                       std::string_view rung);

/// Only in 3.0: attributes of constructions and buildings.
void append_attributes_after_geometry(std::string& xml, CityGml version, const CityObject& object);

/// An attribute that the schema has no element for; flags become texts.
void append_generic_attribute(std::string& xml, CityGml version, std::string_view name,
                              const AttributeValue& value);

/// Addresses as xAL 2 (in CityGML 2.0) or xAL 3. The first has the id "<id>0".
void append_gml_addresses(std::string& xml, CityGml version, const std::vector<Address>& addresses,
                          const std::string& id);

}  // namespace citymesh
