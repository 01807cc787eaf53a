#include "core/source/xml_reader.h"

#include <libxml/parser.h>
#include <libxml/parserInternals.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "core/base/text.h"

namespace citymesh::source {
namespace {

std::string_view view(const xmlChar* text) {
  return text ? std::string_view(reinterpret_cast<const char*>(text)) : std::string_view{};
}

XmlAttributes attributes_of(int count, const xmlChar** attributes) {
  XmlAttributes found;
  for (int i = 0; i < count; ++i, attributes += 5) {
    const std::string_view key = view(attributes[0]);
    const auto* begin = reinterpret_cast<const char*>(attributes[3]);
    const std::string_view value(
        begin, static_cast<std::size_t>(reinterpret_cast<const char*>(attributes[4]) - begin));
    if (key == "id")
      found.id = value;
    else if (key == "srsDimension")
      found.srs_dimension = trimmed(value);
    else if (key == "href")
      found.href = trimmed(value);
    else if (key == "srsName")
      found.srs_name = trimmed(value);
    else if (key == "orientation")
      found.orientation = trimmed(value);
    else if (key == "name")
      found.name = value;
    else if (key == "count")
      found.count = trimmed(value);
    else if (key == "decimal")
      found.decimal = value;
    else if (key == "cs")
      found.coordinate_separator = value;
    else if (key == "ts")
      found.tuple_separator = value;
  }
  return found;
}

}  // namespace

template <class Action>
void XmlReader::guarded(Action&& action) noexcept {
  // Nothing may be thrown through libxml2.
  if (stopped_) return;
  try {
    action();
  } catch (const std::exception& exception) {
    stop_with(fail(ErrorCode::ResourceExhausted,
                   std::string("reading the file failed: ") + exception.what()));
  }
}

struct XmlReader::Sax {
  static XmlReader& self(void* context) { return *static_cast<XmlReader*>(context); }

  static int read_bytes(void* context, char* buffer, int size) {
    XmlReader& reader = self(context);
    int count = -1;
    reader.guarded([&] {
      if (reader.options_.stop.stop_requested()) {
        reader.stop_with(fail(ErrorCode::Cancelled, "reading was stopped"));
        return;
      }
      // A comment, a name or an attribute that does not end would be held in memory as a whole.
      if (reader.bytes_.bytes_read() >
          reader.event_bytes_ + reader.options_.limits.max_building_bytes) {
        reader.fail_document("a single piece of markup has more than max_building_bytes = " +
                             std::to_string(reader.options_.limits.max_building_bytes) + " bytes");
        return;
      }
      const auto got = reader.bytes_.read(buffer, static_cast<std::size_t>(size));
      if (!got) {
        reader.fail_document(got.error().message);
        return;
      }
      count = static_cast<int>(*got);
    });
    return count;
  }

  static void start_element(void* context, const xmlChar* name, const xmlChar*, const xmlChar* uri,
                            int, const xmlChar**, int attribute_count, int,
                            const xmlChar** attributes) {
    XmlReader& reader = self(context);
    reader.event_bytes_ = reader.bytes_.bytes_read();
    if (++reader.depth_ > reader.options_.limits.max_depth) {
      reader.guarded([&] {
        reader.fail_document("elements are nested deeper than max_depth = " +
                             std::to_string(reader.options_.limits.max_depth));
      });
      return;
    }
    if (reader.skipped_ > 0) {
      ++reader.skipped_;
      return;
    }
    reader.guarded([&] {
      reader.handler_.on_start({view(name), view(uri)}, attributes_of(attribute_count, attributes));
    });
  }

  static void end_element(void* context, const xmlChar*, const xmlChar*, const xmlChar*) {
    XmlReader& reader = self(context);
    reader.event_bytes_ = reader.bytes_.bytes_read();
    --reader.depth_;
    if (reader.skipped_ > 0) {
      --reader.skipped_;
      return;
    }
    reader.guarded([&] { reader.handler_.on_end(); });
  }

  static void characters(void* context, const xmlChar* text, int size) {
    XmlReader& reader = self(context);
    reader.event_bytes_ = reader.bytes_.bytes_read();
    if (!reader.capturing_ || reader.skipped_ > 0) return;
    reader.guarded([&] {
      reader.text_.append(reinterpret_cast<const char*>(text), static_cast<std::size_t>(size));
      if (reader.text_.size() > reader.options_.limits.max_building_bytes)
        reader.fail_document("a text has more than max_building_bytes = " +
                             std::to_string(reader.options_.limits.max_building_bytes) + " bytes");
    });
  }

  static void doctype(void* context, const xmlChar* name, const xmlChar*, const xmlChar*) {
    XmlReader& reader = self(context);
    reader.guarded([&] {
      reader.fail_document("a document type declaration (<!DOCTYPE " + std::string(view(name)) +
                           ">) is refused: CityGML needs none, and entities are not expanded");
    });
  }

  static void ignore_error(void*, xmlErrorPtr) {}
};

void XmlReader::capture() {
  text_.clear();
  capturing_ = true;
}

std::string_view XmlReader::end_capture() {
  capturing_ = false;
  return text_;
}

// When stopped, events are ignored and reading fails, so libxml2 ends by itself at the end of its
// buffer. xmlStopParser from inside a callback leaves libxml2 2.9 without an input and crashes it.
void XmlReader::stop_with(Error error) {
  if (!error_) error_ = std::move(error);
  stopped_ = true;
}

void XmlReader::fail_document(const std::string& reason) {
  if (facts_.failure.empty()) facts_.failure = "line " + std::to_string(line()) + ": " + reason;
  stopped_ = true;
}

int XmlReader::line() const {
  const auto* context = static_cast<xmlParserCtxtPtr>(context_);
  return context && context->input ? context->input->line : 0;
}

// Markup holds no '<', so the tag is what follows the last one; the parser keeps a tag together in
// its buffer.
std::string_view XmlReader::start_tag() const {
  const auto* context = static_cast<xmlParserCtxtPtr>(context_);
  const xmlParserInput* input = context ? context->input : nullptr;
  if (!input || !input->cur || !input->base) return {};
  const auto* end = reinterpret_cast<const char*>(input->cur);
  const auto* begin = end;
  while (begin > reinterpret_cast<const char*>(input->base) && *begin != '<') --begin;
  if (*begin != '<') return {};
  return {begin, static_cast<std::size_t>(end - begin)};
}

std::uint64_t XmlReader::position() const {
  const long place = context_ ? xmlByteConsumed(static_cast<xmlParserCtxtPtr>(context_)) : -1;
  return place < 0 ? 0 : static_cast<std::uint64_t>(place);
}

// Where characters have more than a byte each, a piece cannot stand behind an envelope of ours;
// where they are transcoded, the length of a start tag is that of the file only in ASCII.
bool XmlReader::can_be_read_in_pieces() const {
  const auto* context = static_cast<xmlParserCtxtPtr>(context_);
  if (!context->input->buf || !context->input->buf->encoder) return true;
  const std::string_view name = encoding();
  const std::string_view tag = start_tag();
  return !name.empty() && name.substr(0, 3) != "UTF" && name.substr(0, 3) != "UCS" &&
         name.substr(0, 9) != "ISO-10646" &&
         std::all_of(tag.begin(), tag.end(), [](char c) { return c > 0; });
}

std::string_view XmlReader::encoding() const {
  return view(static_cast<xmlParserCtxtPtr>(context_)->encoding);
}

Result<void> XmlReader::parse() {
  xmlSAXHandler handler{};
  handler.initialized = XML_SAX2_MAGIC;
  handler.startElementNs = &Sax::start_element;
  handler.endElementNs = &Sax::end_element;
  handler.characters = &Sax::characters;
  handler.ignorableWhitespace = &Sax::characters;
  handler.cdataBlock = &Sax::characters;
  handler.internalSubset = &Sax::doctype;
  handler.serror = &Sax::ignore_error;

  xmlInitParser();
  const xmlParserCtxtPtr context = xmlCreateIOParserCtxt(&handler, this, &Sax::read_bytes, nullptr,
                                                         this, XML_CHAR_ENCODING_NONE);
  if (!context) {
    if (error_) return *error_;
    if (facts_.failure.empty()) facts_.failure = "the file cannot be read as XML";
    return {};
  }
  context_ = context;
  // Depth, size and text length are our own counters: libxml2's would refuse real city models.
  xmlCtxtUseOptions(context, XML_PARSE_NONET | XML_PARSE_HUGE);
  xmlParseDocument(context);

  if (!error_ && facts_.failure.empty() && !context->wellFormed) {
    const xmlError* problem = xmlCtxtGetLastError(context);
    facts_.failure =
        "line " + std::to_string(problem ? problem->line : line()) + ": " +
        (problem && problem->message ? std::string(trimmed(problem->message)) : "not well-formed");
  }
  if (context->myDoc) xmlFreeDoc(context->myDoc);
  xmlFreeParserCtxt(context);
  context_ = nullptr;
  if (error_) return *error_;
  return {};
}

}  // namespace citymesh::source
