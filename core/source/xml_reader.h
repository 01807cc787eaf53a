#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/source/byte_reader.h"
#include "core/source/feature.h"

namespace citymesh::source {

/// Name and namespace are interned: equal ones have the same address throughout a document.
struct XmlName {
  std::string_view local{}, uri{};
};

/// The values of the few attributes that matter, "" where they are missing; views live until the
/// event has been handled.
struct XmlAttributes {
  std::string_view id{}, href{}, srs_name{}, srs_dimension{}, orientation{}, name{};
  std::string_view count{};  ///< of positions in a gml:posList
  std::string_view decimal{}, coordinate_separator{}, tuple_separator{};  ///< of gml:coordinates
};

class XmlHandler {
 public:
  virtual ~XmlHandler() = default;
  virtual void on_start(const XmlName& name, const XmlAttributes& attributes) = 0;
  virtual void on_end() = 0;
};

/// Reads XML from front to back within our own limits: no entities, no network, no document type
/// declaration. Exceptions of the handler end the reading; none comes out.
class XmlReader {
 public:
  XmlReader(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts,
            XmlHandler& handler)
      : bytes_(bytes), options_(options), facts_(facts), handler_(handler) {}

  /// What is wrong with the document goes to `facts.failure`. Errors: what stop_with() was given,
  /// Cancelled.
  Result<void> parse();

  // For the handler, while it handles an event.
  void skip() { skipped_ = 1; }    ///< no events from this element on to its end, which is left out
  void capture();                  ///< collects the text of the element that starts
  std::string_view end_capture();  ///< the text so far
  void stop_with(Error error);
  void fail_document(const std::string& reason);
  int line() const;
  std::uint64_t bytes_read() const { return bytes_.bytes_read(); }
  /// The tag whose start is being reported, without its '>'; "" where it cannot be told.
  std::string_view start_tag() const;
  /// Bytes of the document before the parser's place; not what it has read ahead.
  std::uint64_t position() const;
  /// Whether places are those of the bytes of the file.
  bool can_be_read_in_pieces() const;
  std::string_view encoding() const;  ///< as the document declares it, else ""

 private:
  struct Sax;  // libxml2's view
  friend struct Sax;

  template <class Action>
  void guarded(Action&& action) noexcept;

  ByteReader& bytes_;
  const DocumentOptions& options_;
  DocumentFacts& facts_;
  XmlHandler& handler_;
  void* context_ = nullptr;
  bool stopped_ = false;
  std::optional<Error> error_{};
  unsigned depth_ = 0;
  unsigned skipped_ = 0;  ///< open elements of a skipped subtree
  bool capturing_ = false;
  std::string text_{};
  std::uint64_t event_bytes_ = 0;
};

}  // namespace citymesh::source
