#include "core/write/gml_ids.h"

#include <functional>

namespace citymesh {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Latin letters beyond ASCII, as two bytes of UTF-8: U+00C0 to U+0131 without × and ÷. Every XML
/// processor takes them for letters.
bool is_latin_letter(std::string_view text, std::size_t at) {
  if (at + 1 >= text.size()) return false;
  const auto first = static_cast<unsigned char>(text[at]);
  const auto second = static_cast<unsigned char>(text[at + 1]);
  if ((second & 0xC0u) != 0x80u) return false;
  const unsigned code = ((first & 0x1Fu) << 6) | (second & 0x3Fu);
  return (first & 0xE0u) == 0xC0u && code >= 0xC0 && code <= 0x131 && code != 0xD7 && code != 0xF7;
}

}  // namespace

std::string to_ncname(std::string_view id) {
  std::string name;
  for (std::size_t i = 0; i < id.size(); ++i) {
    const char c = id[i];
    if (is_latin_letter(id, i)) {
      name += id.substr(i++, 2);
    } else {
      name += is_letter(c) || is_digit(c) || c == '_' || c == '-' || c == '.' ? c : '_';
    }
  }
  const bool starts_well =
      !name.empty() && (is_letter(name[0]) || name[0] == '_' || is_latin_letter(name, 0));
  return starts_well ? name : "b_" + name;
}

bool GmlIds::is_new(std::string_view id) {
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a: the same on every machine
  for (const char c : id) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return taken_.insert(hash).second;
}

std::string GmlIds::take(std::string_view id, std::string_view otherwise) {
  const std::string wanted = to_ncname(id.empty() ? otherwise : id);
  std::string unused = wanted;
  for (int n = 2; !is_new(unused); ++n) unused = wanted + '_' + std::to_string(n);
  return unused;
}

std::string BodyIds::take(std::string_view id, char kind, std::size_t number) {
  if (id.empty()) return generated(kind, number);
  const bool looks_generated = id.starts_with("cm.") && !id.starts_with(prefix_);
  std::string taken = ids_.take(looks_generated ? '_' + std::string(id) : std::string(id), "");
  if (taken.starts_with(prefix_)) own_.insert(taken);
  return taken;
}

std::string BodyIds::generated(char kind, std::size_t number) {
  std::string id = prefix_ + kind + std::to_string(number);
  while (own_.contains(id)) id += '_';
  return id;
}

}  // namespace citymesh
