#include "core/write/citygml_features.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "core/write/text.h"

namespace citymesh {
namespace {

/// What an element of the schema takes.
enum class Content { Text, Codes, Code, Date, DateTime, Terrain, Water, Year, Count, Height };

/// Where the schema has an attribute: before generic attributes, with those of buildings, with
/// those of constructions.
enum class Place { Feature, Construction, Building, BuildingOnly };

struct StandardAttribute {
  std::string_view name;
  std::string_view element;
  Content content;
  Place place;
};

// Both in the order of their schema.
constexpr std::array kAttributes2{
    StandardAttribute{"description", "gml:description", Content::Text, Place::Feature},
    StandardAttribute{"name", "gml:name", Content::Text, Place::Feature},
    StandardAttribute{"creationDate", "creationDate", Content::Date, Place::Feature},
    StandardAttribute{"terminationDate", "terminationDate", Content::Date, Place::Feature},
    StandardAttribute{"relativeToTerrain", "relativeToTerrain", Content::Terrain, Place::Feature},
    StandardAttribute{"relativeToWater", "relativeToWater", Content::Water, Place::Feature},
    StandardAttribute{"class", "bldg:class", Content::Code, Place::Building},
    StandardAttribute{"function", "bldg:function", Content::Codes, Place::Building},
    StandardAttribute{"usage", "bldg:usage", Content::Codes, Place::Building},
    StandardAttribute{"yearOfConstruction", "bldg:yearOfConstruction", Content::Year,
                      Place::BuildingOnly},
    StandardAttribute{"yearOfDemolition", "bldg:yearOfDemolition", Content::Year,
                      Place::BuildingOnly},
    StandardAttribute{"roofType", "bldg:roofType", Content::Code, Place::BuildingOnly},
    StandardAttribute{"measuredHeight", "bldg:measuredHeight", Content::Height,
                      Place::BuildingOnly},
    StandardAttribute{"storeysAboveGround", "bldg:storeysAboveGround", Content::Count,
                      Place::BuildingOnly},
    StandardAttribute{"storeysBelowGround", "bldg:storeysBelowGround", Content::Count,
                      Place::BuildingOnly},
};
constexpr std::array kAttributes3{
    StandardAttribute{"description", "gml:description", Content::Text, Place::Feature},
    StandardAttribute{"name", "gml:name", Content::Text, Place::Feature},
    StandardAttribute{"creationDate", "creationDate", Content::DateTime, Place::Feature},
    StandardAttribute{"terminationDate", "terminationDate", Content::DateTime, Place::Feature},
    StandardAttribute{"relativeToTerrain", "relativeToTerrain", Content::Terrain, Place::Feature},
    StandardAttribute{"relativeToWater", "relativeToWater", Content::Water, Place::Feature},
    StandardAttribute{"dateOfConstruction", "con:dateOfConstruction", Content::Date,
                      Place::Construction},
    StandardAttribute{"dateOfDemolition", "con:dateOfDemolition", Content::Date,
                      Place::Construction},
    StandardAttribute{"measuredHeight", "con:height", Content::Height, Place::Construction},
    StandardAttribute{"class", "bldg:class", Content::Code, Place::Building},
    StandardAttribute{"function", "bldg:function", Content::Codes, Place::Building},
    StandardAttribute{"usage", "bldg:usage", Content::Codes, Place::Building},
    StandardAttribute{"roofType", "bldg:roofType", Content::Code, Place::BuildingOnly},
    StandardAttribute{"storeysAboveGround", "bldg:storeysAboveGround", Content::Count,
                      Place::BuildingOnly},
    StandardAttribute{"storeysBelowGround", "bldg:storeysBelowGround", Content::Count,
                      Place::BuildingOnly},
};

std::span<const StandardAttribute> standard_attributes(CityGml version) {
  if (version == CityGml::V2) return kAttributes2;
  return kAttributes3;
}

std::string text_of(const AttributeValue& value) {
  std::string text;
  if (const auto* flag = std::get_if<bool>(&value)) {
    text = *flag ? "true" : "false";
  } else if (const auto* integer = std::get_if<std::int64_t>(&value)) {
    append_integer(text, *integer);
  } else if (const auto* number = std::get_if<double>(&value)) {
    if (std::isfinite(*number)) {
      append_exact(text, *number);
    } else {
      text = std::isnan(*number) ? "NaN" : *number > 0 ? "INF" : "-INF";
    }
  } else {
    text = std::get<std::string>(value);
  }
  return text;
}

/// '9' stands for a digit.
bool has_form(std::string_view text, std::string_view form) {
  return text.size() == form.size() &&
         std::equal(text.begin(), text.end(), form.begin(),
                    [](char c, char f) { return f == '9' ? c >= '0' && c <= '9' : c == f; });
}

bool is_date(std::string_view text) {
  if (!has_form(text, "9999-99-99")) return false;
  const auto two = [&](std::size_t at) { return (text[at] - '0') * 10 + text[at + 1] - '0'; };
  const std::chrono::year_month_day date(std::chrono::year(two(0) * 100 + two(2)),
                                         std::chrono::month(static_cast<unsigned>(two(5))),
                                         std::chrono::day(static_cast<unsigned>(two(8))));
  return date.ok() && date.year() != std::chrono::year(0);
}

/// "entirelyAboveTerrain" and so on.
bool is_relation_to(std::string_view what, std::string_view text) {
  if (!text.ends_with(what)) return false;
  text.remove_suffix(what.size());
  for (const std::string_view known :
       {"entirelyAbove", "substantiallyAbove", "substantiallyAboveAndBelow", "substantiallyBelow",
        "entirelyBelow"})
    if (text == known) return true;
  return what == "WaterSurface" && text == "temporarilyAboveAndBelow";
}

/// The number that a text is, as XML Schema and we spell it.
std::optional<double> finite_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size() ||
      !std::isfinite(value))
    return std::nullopt;
  return value;
}

/// Whether an element of the schema can hold the value so that a reader gets the same back.
bool fits(Content content, const AttributeValue& value, std::string_view text) {
  const bool is_text = std::holds_alternative<std::string>(value);
  constexpr std::string_view kBlanks = " \t\n\r";
  const bool is_trimmed = !text.empty() && kBlanks.find(text.front()) == std::string_view::npos &&
                          kBlanks.find(text.back()) == std::string_view::npos;
  switch (content) {
    case Content::Text:
    case Content::Code:
      return is_text && is_trimmed;
    case Content::Codes:
      return is_text && is_trimmed && text.front() != ';' && text.back() != ';' &&
             text.find(";;") == std::string_view::npos &&
             text.find("; ") == std::string_view::npos && text.find(" ;") == std::string_view::npos;
    case Content::Date:
      return is_text && is_date(text);
    case Content::DateTime:
      return is_text && text.size() == 19 && is_date(text.substr(0, 10)) &&
             has_form(text.substr(10), "T99:99:99") && text.substr(11, 2) < "24" &&
             text.substr(14, 2) < "60" && text.substr(17, 2) < "60";
    case Content::Terrain:
      return is_text && is_relation_to("Terrain", text);
    case Content::Water:
      return is_text && is_relation_to("WaterSurface", text);
    case Content::Year:
      return has_form(text, "9999") && text != "0000";
    case Content::Count: {
      const bool digits =
          !text.empty() && text.size() <= 9 &&
          std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
      return digits && !std::holds_alternative<double>(value);
    }
    case Content::Height:
      return !std::holds_alternative<bool>(value) && finite_number(text).has_value();
  }
  return false;
}

/// Element text: line breaks and tabs stay as they are.
void append_text(std::string& xml, std::string_view text) {
  while (!text.empty()) {
    const auto end = std::min(text.find_first_of("\n\t\r"), text.size());
    append_markup(xml, text.substr(0, end));
    if (end < text.size()) {
      if (text[end] == '\r')
        xml += "&#13;";
      else
        xml += text[end];
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

void append_element(std::string& xml, std::string_view name, std::string_view text,
                    std::string_view attributes = "") {
  xml += '<';
  xml += name;
  xml += attributes;
  xml += '>';
  append_text(xml, text);
  xml += "</";
  xml += name;
  xml += ">\n";
}

void append_standard(std::string& xml, CityGml version, const StandardAttribute& attribute,
                     std::string_view text) {
  if (attribute.content == Content::Codes) {  // the reader joins repeated elements by ';'
    while (!text.empty()) {
      const auto end = std::min(text.find(';'), text.size());
      append_element(xml, attribute.element, text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
  } else if (attribute.content == Content::Height && version == CityGml::V3) {
    xml +=
        "<con:height>\n<con:Height>\n<con:highReference>highestRoofEdge</con:highReference>\n"
        "<con:lowReference>lowestGroundPoint</con:lowReference>\n<con:status>measured"
        "</con:status>\n";
    append_element(xml, "con:value", text, " uom=\"m\"");
    xml += "</con:Height>\n</con:height>\n";
  } else {
    append_element(xml, attribute.element, text,
                   attribute.content == Content::Height ? " uom=\"m\"" : "");
  }
}

/// The attributes of an object, each with the element that holds it; without one it is generic.
class Sorted {
 public:
  Sorted(CityGml version, const CityObject& object) : version_(version), object_(object) {
    std::set<std::string_view> names;  // a repeated name keeps the first value
    for (const auto& [name, value] : *object.attributes) {
      if (!names.insert(name).second) continue;
      const StandardAttribute* standard = find(name, value);
      if (!standard)
        generic_.push_back({name, &value});
      else
        standard_.push_back({standard, text_of(value)});
    }
    std::sort(standard_.begin(), standard_.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
  }

  void append(std::string& xml, Place from, Place to) const {
    for (const auto& [attribute, text] : standard_)
      if (attribute->place >= from && attribute->place <= to)
        append_standard(xml, version_, *attribute, text);
  }
  void append_generic_ones(std::string& xml) const {
    for (const auto& [name, value] : generic_)
      append_generic_attribute(xml, version_, name, *value);
  }

 private:
  const StandardAttribute* find(std::string_view name, const AttributeValue& value) const {
    const std::string text = text_of(value);
    for (const StandardAttribute& attribute : standard_attributes(version_))
      if (attribute.name == name && fits(attribute.content, value, text) &&
          (object_.kind != ObjectKind::BuildingInstallation || attribute.place == Place::Feature ||
           attribute.place == Place::Building))
        return &attribute;
    return nullptr;
  }

  CityGml version_;
  const CityObject& object_;
  std::vector<std::pair<const StandardAttribute*, std::string>> standard_{};
  std::vector<std::pair<std::string_view, const AttributeValue*>> generic_{};
};

void append_optional(std::string& xml, std::string_view before, std::string_view text,
                     std::string_view after) {
  if (text.empty()) return;
  xml += before;
  append_markup(xml, text);
  xml += after;
}

void append_xal2(std::string& xml, const Address& address) {
  xml += "<xAL:AddressDetails>\n<xAL:Country>\n";
  append_optional(xml, "<xAL:CountryName>", address.country, "</xAL:CountryName>\n");
  if (!address.state.empty()) xml += "<xAL:AdministrativeArea>\n";
  append_optional(xml, "<xAL:AdministrativeAreaName>", address.state,
                  "</xAL:AdministrativeAreaName>\n");
  xml += "<xAL:Locality Type=\"City\">\n";
  append_optional(xml, "<xAL:LocalityName>", address.city, "</xAL:LocalityName>\n");
  append_optional(xml, "<xAL:PostBox><xAL:PostBoxNumber>", address.po_box,
                  "</xAL:PostBoxNumber></xAL:PostBox>\n");
  if (!address.street.empty() || !address.house_number.empty()) {
    xml += "<xAL:Thoroughfare Type=\"Street\">\n";
    append_optional(xml, "<xAL:ThoroughfareNumber>", address.house_number,
                    "</xAL:ThoroughfareNumber>\n");
    append_optional(xml, "<xAL:ThoroughfareName>", address.street, "</xAL:ThoroughfareName>\n");
    xml += "</xAL:Thoroughfare>\n";
  }
  append_optional(xml, "<xAL:PostalCode><xAL:PostalCodeNumber>", address.zip_code,
                  "</xAL:PostalCodeNumber></xAL:PostalCode>\n");
  xml += "</xAL:Locality>\n";
  if (!address.state.empty()) xml += "</xAL:AdministrativeArea>\n";
  xml += "</xAL:Country>\n</xAL:AddressDetails>\n";
}

void append_xal3(std::string& xml, const Address& address) {
  xml += "<xAL:Address>\n";
  append_optional(xml, "<xAL:Country><xAL:NameElement>", address.country,
                  "</xAL:NameElement></xAL:Country>\n");
  append_optional(xml, "<xAL:AdministrativeArea><xAL:NameElement>", address.state,
                  "</xAL:NameElement></xAL:AdministrativeArea>\n");
  append_optional(xml, "<xAL:Locality><xAL:NameElement>", address.city,
                  "</xAL:NameElement></xAL:Locality>\n");
  if (!address.street.empty() || !address.house_number.empty()) {
    xml += "<xAL:Thoroughfare>\n";
    append_optional(xml, "<xAL:NameElement>", address.street, "</xAL:NameElement>\n");
    append_optional(xml, "<xAL:Number>", address.house_number, "</xAL:Number>\n");
    xml += "</xAL:Thoroughfare>\n";
  }
  append_optional(xml, "<xAL:PostCode><xAL:Identifier>", address.zip_code,
                  "</xAL:Identifier></xAL:PostCode>\n");
  append_optional(xml, "<xAL:PostOffice><xAL:Identifier>", address.po_box,
                  "</xAL:Identifier></xAL:PostOffice>\n");
  xml += "</xAL:Address>\n";
}

}  // namespace

void append_generic_attribute(std::string& xml, CityGml version, std::string_view name,
                              const AttributeValue& value) {
  const bool integer = std::holds_alternative<std::int64_t>(value);
  const bool number = std::holds_alternative<double>(value);
  const std::string text = text_of(value);
  if (version == CityGml::V2) {
    const std::string_view element = integer  ? "gen:intAttribute"
                                     : number ? "gen:doubleAttribute"
                                              : "gen:stringAttribute";
    xml += '<';
    xml += element;
    xml += " name=\"";
    append_markup(xml, name);
    xml += "\">\n";
    append_element(xml, "gen:value", text);
    xml += "</";
    xml += element;
    xml += ">\n";
    return;
  }
  const std::string_view element = integer  ? "gen:IntAttribute"
                                   : number ? "gen:DoubleAttribute"
                                            : "gen:StringAttribute";
  xml += "<genericAttribute>\n<";
  xml += element;
  xml += ">\n";
  append_element(xml, "gen:name", name);
  append_element(xml, "gen:value", text);
  xml += "</";
  xml += element;
  xml += ">\n</genericAttribute>\n";
}

void append_attributes_before_geometry(std::string& xml, CityGml version, const CityObject& object,
                                       std::string_view rung) {
  append_optional(xml, "<gml:metaDataProperty><gml:GenericMetaData>citymesh rung ", rung,
                  "</gml:GenericMetaData></gml:metaDataProperty>\n");
  const Sorted sorted(version, object);
  sorted.append(xml, Place::Feature, Place::Feature);
  sorted.append_generic_ones(xml);
  if (version == CityGml::V2) sorted.append(xml, Place::Construction, Place::BuildingOnly);
}

void append_attributes_after_geometry(std::string& xml, CityGml version, const CityObject& object) {
  if (version == CityGml::V3)
    Sorted(version, object).append(xml, Place::Construction, Place::BuildingOnly);
}

void append_gml_addresses(std::string& xml, CityGml version, const std::vector<Address>& addresses,
                          const std::string& id) {
  for (std::size_t i = 0; i < addresses.size(); ++i) {
    xml += "<bldg:address>\n<Address gml:id=\"" + id + std::to_string(i) + "\">\n";
    xml += "<xalAddress>\n";
    if (version == CityGml::V2)
      append_xal2(xml, addresses[i]);
    else
      append_xal3(xml, addresses[i]);
    xml += "</xalAddress>\n</Address>\n</bldg:address>\n";
  }
}

}  // namespace citymesh
