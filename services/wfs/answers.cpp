#include "services/wfs/answers.h"

#include <fmt/format.h>
#include <libxml/parser.h>
#include <libxml/tree.h>
#include <libxml/xmlreader.h>

#include <algorithm>
#include <memory>
#include <string_view>

#include "core/base/text.h"

namespace citymesh::wfs {
namespace {

constexpr int kOptions = XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING;
constexpr std::size_t kLongestText = 300;

struct FreeDocument {
  void operator()(xmlDoc* document) const { xmlFreeDoc(document); }
};
using Document = std::unique_ptr<xmlDoc, FreeDocument>;
struct FreeReader {
  void operator()(xmlTextReader* reader) const { xmlFreeTextReader(reader); }
};
using Reader = std::unique_ptr<xmlTextReader, FreeReader>;

std::string_view view(const xmlChar* text) {
  return text ? std::string_view(reinterpret_cast<const char*>(text)) : std::string_view{};
}

std::string taken(xmlChar* text) {
  std::string copy(trimmed(view(text)));
  xmlFree(text);
  return copy;
}

const xmlChar* xml(const char* text) { return reinterpret_cast<const xmlChar*>(text); }

/// None for what is not well-formed, has a document type, or is too large to be one of ours.
Document parse(const std::string& text) {
  constexpr std::size_t kMostBytes = 64 << 20;
  if (text.size() > kMostBytes) return nullptr;
  xmlInitParser();
  Document document(
      xmlReadMemory(text.data(), static_cast<int>(text.size()), nullptr, nullptr, kOptions));
  if (document && xmlGetIntSubset(document.get())) document.reset();
  return document;
}

bool is_named(const xmlNode* node, std::string_view name) {
  return node->type == XML_ELEMENT_NODE && view(node->name) == name;
}

/// Calls with every element of that name below a node, in the order of the document.
template <class Action>
void for_each(xmlNode* node, std::string_view name, const Action& action) {
  for (xmlNode* child = node ? node->children : nullptr; child; child = child->next) {
    if (is_named(child, name)) action(child);
    for_each(child, name, action);
  }
}

std::string text_of(xmlNode* node) { return taken(xmlNodeGetContent(node)); }
std::string attribute_of(xmlNode* node, const char* name) {
  return taken(xmlGetNoNsProp(node, xml(name)));
}

// One line without control characters, cut.
std::string tidied(std::string_view text) {
  std::string line;
  for (const char c : text) {
    const bool blank = (c >= 0 && c <= ' ') || c == '\x7f';
    if (!blank)
      line += c;
    else if (!line.empty() && line.back() != ' ')
      line += ' ';
    if (line.size() == kLongestText) {
      while (!line.empty() && (line.back() & 0xC0) == 0x80) line.pop_back();
      if (!line.empty() && (line.back() & 0xC0) == 0xC0) line.pop_back();  // no half characters
      return line + " …";
    }
  }
  return std::string(trimmed(line));
}

FeatureType type_of(xmlNode* node) {
  FeatureType type;
  for (xmlNode* child = node->children; child; child = child->next) {
    if (is_named(child, "Name")) {
      type.name = text_of(child);
      const auto colon = type.name.find(':');
      const std::string prefix =
          colon == std::string::npos ? std::string{} : type.name.substr(0, colon);
      const xmlNs* space =
          prefix.empty() ? nullptr : xmlSearchNs(child->doc, child, xml(prefix.c_str()));
      if (space) type.uri = view(space->href);
    } else if (is_named(child, "DefaultCRS")) {
      type.crs.insert(type.crs.begin(), text_of(child));
    } else if (is_named(child, "OtherCRS")) {
      type.crs.push_back(text_of(child));
    }
  }
  return type;
}

void read_constraint(xmlNode* node, Capabilities& capabilities) {
  const std::string name = attribute_of(node, "name");
  std::string value;
  for_each(node, "DefaultValue", [&](xmlNode* found) { value = text_of(found); });
  if (name == "ImplementsResultPaging") capabilities.pages = value == "TRUE" || value == "true";
  if (name == "CountDefault") {
    capabilities.count_default = number_from<std::uint64_t>(value);
    if (capabilities.count_default == 0u) capabilities.count_default.reset();
  }
}

void read_formats(xmlNode* operation, Capabilities& capabilities) {
  for_each(operation, "Parameter", [&](xmlNode* parameter) {
    if (attribute_of(parameter, "name") != "outputFormat") return;
    for_each(parameter, "Value",
             [&](xmlNode* value) { capabilities.formats.push_back(text_of(value)); });
  });
}

ServerError exception_of(const std::string& text) {
  ServerError error{.code = "NoApplicableCode"};
  const auto document = parse(text);
  if (!document) return error;
  std::string all;
  for_each(xmlDocGetRootElement(document.get()), "Exception", [&](xmlNode* exception) {
    if (all.empty()) {
      error.code = tidied(attribute_of(exception, "exceptionCode"));
      if (const auto where = attribute_of(exception, "locator"); !where.empty())
        all = fmt::format("({}) ", where);
    }
    for_each(exception, "ExceptionText", [&](xmlNode* line) { all += text_of(line) + " "; });
  });
  error.text = tidied(all);
  return error;
}

// The title of a web page, else the text; in ASCII, for the encoding is anybody's guess.
ServerError other_text(std::string_view text) {
  text = text.substr(0, 64 * 1024);
  std::string bare;
  for (const std::string_view tag : {"<title>", "<TITLE>"})
    if (const auto begin = text.find(tag); begin != text.npos && bare.empty()) {
      const auto title = text.substr(begin + tag.size());
      bare = title.substr(0, title.find('<'));
    }
  if (bare.empty()) {
    bool in_tag = false;
    for (const char c : text) {
      if (c == '<') in_tag = true;
      if (!in_tag) bare += c;
      if (c == '>') in_tag = false;
    }
  }
  std::ranges::replace_if(
      bare, [](char c) { return (c & 0x80) != 0; }, '?');
  return {.text = tidied(bare)};
}

std::string attribute_of(xmlTextReader* reader, const char* name) {
  return taken(xmlTextReaderGetAttribute(reader, xml(name)));
}

}  // namespace

Result<Capabilities> read_capabilities(const std::string& text) {
  const auto document = parse(text);
  xmlNode* root = document ? xmlDocGetRootElement(document.get()) : nullptr;
  if (!root || !is_named(root, "WFS_Capabilities"))
    return fail(ErrorCode::FailedPrecondition,
                fmt::format("GetCapabilities is not answered with WFS_Capabilities but with '{}'",
                            other_text(text).text));
  Capabilities capabilities;
  capabilities.version = attribute_of(root, "version");
  for_each(root, "FeatureType",
           [&](xmlNode* node) { capabilities.types.push_back(type_of(node)); });
  for_each(root, "Constraint", [&](xmlNode* node) { read_constraint(node, capabilities); });
  for_each(root, "Operation", [&](xmlNode* node) {
    if (attribute_of(node, "name") == "GetFeature") read_formats(node, capabilities);
  });
  return capabilities;
}

AnswerHead read_head(const std::string& text) {
  AnswerHead head;
  if (trimmed(std::string_view(text).substr(0, 1024)).starts_with('{')) {
    head.json = true;
    return head;
  }
  constexpr std::size_t kMostBytes = 2'000'000'000;
  xmlInitParser();
  const Reader reader(xmlReaderForMemory(text.data(),
                                         static_cast<int>(std::min(text.size(), kMostBytes)),
                                         nullptr, nullptr, kOptions));
  while (reader && xmlTextReaderRead(reader.get()) == 1) {
    const int type = xmlTextReaderNodeType(reader.get());
    if (type == XML_READER_TYPE_DOCUMENT_TYPE) break;
    if (type != XML_READER_TYPE_ELEMENT) continue;
    const auto name = view(xmlTextReaderConstLocalName(reader.get()));
    if (name == "ExceptionReport") {
      head.error = exception_of(text);
      return head;
    }
    if (name != "FeatureCollection" && name != "CityModel" && name != "Building") break;
    head.matched = number_from<std::uint64_t>(attribute_of(reader.get(), "numberMatched"));
    head.returned = number_from<std::uint64_t>(attribute_of(reader.get(), "numberReturned"));
    head.next = attribute_of(reader.get(), "next");
    return head;
  }
  head.error = other_text(text);
  return head;
}

}  // namespace citymesh::wfs
