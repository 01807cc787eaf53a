#include <algorithm>
#include <charconv>
#include <utility>

#include "core/base/text.h"
#include "core/source/citygml_parser.h"

namespace citymesh::source {

void CityGmlParser::start_in_generic(const ElementName& element, const XmlAttributes& attributes) {
  const Frame& top = frames_.back();
  switch (top.ctx) {
    case Ctx::GenericProperty:
      return start_generic(element, attributes);
    case Ctx::Generic:
      if (top.tag == Tag::GenericSet) return start_generic(element, attributes);
      if (element.tag != Tag::Value && element.tag != Tag::Name) return skip();
      push(element.tag == Tag::Value ? Ctx::GenericValue : Ctx::GenericName, element);
      return xml_.capture();
    case Ctx::HeightProperty:
      if (element.tag != Tag::Height) return skip();
      push(Ctx::Height, element);
      return;
    default:
      if (element.tag != Tag::Value) return skip();
      push(Ctx::HeightValue, element);
      xml_.capture();
  }
}

void CityGmlParser::end_attribute(const Frame& frame) {
  const std::string_view value = trimmed(xml_.end_capture());
  if (frame.complex || value.empty()) return;
  if (name_ == "measuredHeight") {
    if (const auto height = number_from<double>(value))
      return add_attribute(frame.object, name_, *height);
  } else if (name_ == "storeysAboveGround" || name_ == "storeysBelowGround" ||
             name_ == "yearOfConstruction" || name_ == "yearOfDemolition") {
    if (const auto whole = number_from<std::int64_t>(value))
      return add_attribute(frame.object, name_, *whole);
  }
  add_attribute(frame.object, name_, std::string(value));
}

void CityGmlParser::end_generic(const Frame& frame) {
  if (frame.tag == Tag::GenericSet) {
    generic_sets_.pop_back();
    return;
  }
  if (name_.empty()) return;
  const std::string name = generic_name();
  if (frame.surface >= 0) {  // of surfaces only our own mark is of use
    if (name == "citymesh_rung" && frame.object >= 0)
      feature_.objects[static_cast<std::size_t>(frame.object)]
          .surfaces[static_cast<std::size_t>(frame.surface)]
          .made_by = generic_value_;
    return;
  }
  if (frame.tag == Tag::GenericWhole) {
    if (const auto whole = number_from<std::int64_t>(generic_value_))
      return add_attribute(frame.object, name, *whole);
  } else if (frame.tag == Tag::GenericNumber) {
    if (const auto value = number_from<double>(generic_value_))
      return add_attribute(frame.object, name, *value);
  }
  add_attribute(frame.object, name, generic_value_);
}

void CityGmlParser::end_height(const Frame& frame) {
  const auto height = number_from<double>(trimmed(xml_.end_capture()));
  if (height &&
      !number_attribute(feature_.objects[static_cast<std::size_t>(frame.object)].attributes,
                        "measuredHeight"))
    add_attribute(frame.object, "measuredHeight", *height);
}

void CityGmlParser::start_generic(const ElementName& element, const XmlAttributes& attributes) {
  switch (element.tag) {
    case Tag::GenericText:
    case Tag::GenericWhole:
    case Tag::GenericNumber:
      name_ = attributes.name;
      generic_value_.clear();
      push(Ctx::Generic, element);
      return;
    case Tag::GenericSet:
      generic_sets_.emplace_back(attributes.name);
      push(Ctx::Generic, element);
      return;
    case Tag::GenericProperty:
      push(Ctx::GenericProperty, element);
      return;
    case Tag::Name:
      push(Ctx::GenericName, element);
      return xml_.capture();
    default:
      return skip();
  }
}

// Attributes of a set carry its name: "set.name".
std::string CityGmlParser::generic_name() const {
  std::string name;
  for (const std::string& set : generic_sets_)
    if (!set.empty()) name += set + ".";
  return name + name_;
}

void CityGmlParser::add_attribute(std::int32_t object, std::string_view key, AttributeValue value) {
  if (object < 0) return;
  Attributes& attributes = feature_.objects[static_cast<std::size_t>(object)].attributes;
  const auto found = std::find_if(attributes.begin(), attributes.end(),
                                  [&](const auto& entry) { return entry.first == key; });
  if (found == attributes.end()) {
    attributes.emplace_back(key, std::move(value));
    return;
  }
  // Names may repeat (function, usage): their texts are joined.
  auto* text = std::get_if<std::string>(&found->second);
  const auto* more = std::get_if<std::string>(&value);
  if (text && more) *text += ";" + *more;
}

}  // namespace citymesh::source
