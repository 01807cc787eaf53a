#include "core/write/json_values.h"

#include <array>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "core/write/text.h"

namespace citymesh {

void append_attributes(std::string& json, const Attributes& attributes) {
  std::unordered_set<std::string_view> written;  // a repeated name keeps the first value
  bool leading = true;
  for (const auto& [name, value] : attributes) {
    if (!written.insert(name).second) continue;
    if (!leading) json += ',';
    leading = false;
    append_json_string(json, name);
    json += ':';
    if (const auto* flag = std::get_if<bool>(&value)) {
      json += *flag ? "true" : "false";
    } else if (const auto* integer = std::get_if<std::int64_t>(&value)) {
      append_integer(json, *integer);
    } else if (const auto* number = std::get_if<double>(&value)) {
      append_exact(json, *number);
    } else {
      append_json_string(json, std::get<std::string>(value));
    }
  }
}

void append_addresses(std::string& json, const std::vector<Address>& addresses) {
  for (std::size_t i = 0; i < addresses.size(); ++i) {
    const Address& address = addresses[i];
    json += i == 0 ? "{" : ",{";
    bool leading = true;
    const std::array<std::pair<std::string_view, const std::string*>, 7> members{
        {{"Country", &address.country},
         {"AdministrativeArea", &address.state},
         {"Locality", &address.city},
         {"Postcode", &address.zip_code},
         {"ThoroughfareName", &address.street},
         {"ThoroughfareNumber", &address.house_number},
         {"PostBox", &address.po_box}}};
    for (const auto& [name, value] : members) {
      if (value->empty()) continue;
      if (!std::exchange(leading, false)) json += ',';
      append_json_string(json, name);
      json += ':';
      append_json_string(json, *value);
    }
    json += '}';
  }
}

}  // namespace citymesh
