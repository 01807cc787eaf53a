#pragma once

#include <string>
#include <vector>

#include "core/citymodel/building.h"

namespace citymesh {

/// `"name":value,…` without the braces; a repeated name keeps the first value.
void append_attributes(std::string& json, const Attributes& attributes);

/// `{"Locality":…,"ThoroughfareName":…},…` without the brackets, by the names of CityJSON's
/// examples, which are those of xAL.
void append_addresses(std::string& json, const std::vector<Address>& addresses);

}  // namespace citymesh
