#include <array>
#include <utility>

#include "core/base/text.h"
#include "core/source/citygml_parser.h"

namespace citymesh::source {
namespace {

/// An element of an address with text, by its name and that of the element around it ("": any).
struct XalName {
  std::string_view parent, name;
  std::string Address::*field;
};

// xAL 2 of CityGML 1.0 and 2.0, then xAL 3 of CityGML 3.0.
constexpr std::array kXalNames{
    XalName{"", "CountryName", &Address::country},
    XalName{"", "AdministrativeAreaName", &Address::state},
    XalName{"Locality", "LocalityName", &Address::city},
    XalName{"Thoroughfare", "ThoroughfareName", &Address::street},
    XalName{"", "ThoroughfareNumber", &Address::house_number},
    XalName{"Premise", "PremiseNumber", &Address::house_number},
    XalName{"", "PostalCodeNumber", &Address::zip_code},
    XalName{"", "PostBoxNumber", &Address::po_box},
    XalName{"Country", "NameElement", &Address::country},
    XalName{"AdministrativeArea", "NameElement", &Address::state},
    XalName{"Locality", "NameElement", &Address::city},
    XalName{"Thoroughfare", "NameElement", &Address::street},
    XalName{"Thoroughfare", "Number", &Address::house_number},
    XalName{"Premises", "Number", &Address::house_number},
    XalName{"PostCode", "Identifier", &Address::zip_code},
    XalName{"PostOffice", "Identifier", &Address::po_box},
    XalName{"PostalDeliveryPoint", "Identifier", &Address::po_box},
};

}  // namespace

void CityGmlParser::start_in_address(const ElementName& element, std::string_view name) {
  Frame& top = frames_.back();
  switch (top.ctx) {
    case Ctx::AddressProperty:
      if (element.tag != Tag::Address) return skip();
      address_ = {};
      push(Ctx::Address, element);
      return;
    case Ctx::Address:
      if (element.tag != Tag::XalProperty) return skip();
      xal_.clear();
      break;
    default:
      top.complex = true;
  }
  push(Ctx::Xal, element);
  xal_.emplace_back(name);
  xml_.capture();
}

// Of parts that repeat the first counts.
void CityGmlParser::end_xal(const Frame& frame) {
  const std::string name = std::move(xal_.back());
  xal_.pop_back();
  const std::string_view text = trimmed(xml_.end_capture());
  if (frame.complex || text.empty() || xal_.empty()) return;
  for (const XalName& known : kXalNames)
    if (known.name == name && (known.parent.empty() || known.parent == xal_.back()))
      if (std::string& field = address_.*known.field; field.empty()) field = text;
}

}  // namespace citymesh::source
