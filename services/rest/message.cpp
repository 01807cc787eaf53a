#include "services/rest/message.h"

#include <algorithm>
#include <charconv>
#include <limits>

#include <fmt/format.h>

namespace citymesh {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::string_view trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// Calls `visit` with each trimmed piece between separators outside double quotes.
template <class Visit>
void for_each_piece(std::string_view text, char separator, Visit visit) {
  bool quoted = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (i < text.size() && text[i] == '"') quoted = !quoted;
    if (i < text.size() && (quoted || text[i] != separator)) continue;
    visit(trim(text.substr(begin, i - begin)));
    begin = i + 1;
  }
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  c = lower(c);
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/// Empty when the encoding is bad or the text holds control characters.
std::optional<std::string> percent_decode(std::string_view text, bool plus_is_space) {
  std::string decoded;
  decoded.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (c == '+' && plus_is_space) c = ' ';
    if (c == '%') {
      if (i + 2 >= text.size()) return std::nullopt;
      const int high = hex_digit(text[i + 1]);
      const int low = hex_digit(text[i + 2]);
      if (high < 0 || low < 0) return std::nullopt;
      c = static_cast<char>(high * 16 + low);
      i += 2;
    }
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) return std::nullopt;
    decoded += c;
  }
  return decoded;
}

struct MediaRange {
  std::string_view type;
  double quality = 1;
};

MediaRange parse_range(std::string_view text) {
  MediaRange range;
  bool first = true;
  for_each_piece(text, ';', [&](std::string_view piece) {
    if (first) {
      range.type = piece;
      first = false;
    } else if (piece.size() > 2 && lower(piece[0]) == 'q' && piece[1] == '=') {
      double quality = 0;
      const auto digits = piece.substr(2);
      const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), quality);
      range.quality = parsed.ec == std::errc{} && quality >= 0 && quality <= 1 ? quality : 0;
    }
  });
  return range;
}

/// 3: the type itself, 2: `application/*`, 1: `*/*`, 0: no match.
int specificity(std::string_view range, std::string_view media_type) {
  if (equal_without_case(range, media_type)) return 3;
  if (range == "*/*") return 1;
  if (!range.ends_with("/*")) return 0;
  const auto prefix = range.substr(0, range.size() - 1);
  return equal_without_case(media_type.substr(0, prefix.size()), prefix) ? 2 : 0;
}

}  // namespace

bool equal_without_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, {}, lower, lower);
}

void Headers::set(std::string_view name, std::string value) {
  std::erase_if(fields_, [&](const auto& field) { return equal_without_case(field.first, name); });
  add(name, std::move(value));
}

void Headers::add(std::string_view name, std::string value) {
  fields_.emplace_back(std::string(name), std::move(value));
}

std::string Headers::get(std::string_view name) const {
  std::string joined;
  for (const auto& [key, value] : fields_) {
    if (!equal_without_case(key, name)) continue;
    if (!joined.empty()) joined += ", ";
    joined += value;
  }
  return joined;
}

bool Headers::has(std::string_view name) const {
  return std::ranges::any_of(
      fields_, [&](const auto& field) { return equal_without_case(field.first, name); });
}

std::uint64_t body_bytes(const Response& response) {
  std::uint64_t bytes = 0;
  for (const auto& piece : response.body)
    bytes += std::holds_alternative<FilePiece>(piece) ? std::get<FilePiece>(piece).bytes
                                                      : std::get<std::string>(piece).size();
  return bytes;
}

Result<std::string> body_text(const Response& response) {
  std::string text;
  for (const auto& piece : response.body) {
    if (const auto* inline_text = std::get_if<std::string>(&piece)) {
      text += *inline_text;
      continue;
    }
    const auto& file = std::get<FilePiece>(piece);
    for (std::uint64_t offset = 0; offset < file.bytes;) {
      auto chunk = file.read(offset, file.bytes - offset);
      if (!chunk) return chunk.error();
      if (chunk->empty())
        return fail(ErrorCode::DataLoss,
                    fmt::format("the file ends after {} of {} bytes", offset, file.bytes));
      offset += chunk->size();
      text += *chunk;
    }
  }
  return text;
}

Response text_response(int status, std::string_view media_type, std::string body) {
  Response response;
  response.status = status;
  response.headers.set("Content-Type", std::string(media_type));
  response.body.emplace_back(std::move(body));
  return response;
}

Result<Target> parse_target(std::string_view target) {
  if (target.empty() || target.front() != '/')
    return fail(ErrorCode::InvalidArgument,
                "the request target is not a path: expected one that begins with '/'");
  const auto question = target.find('?');
  const auto path = target.substr(1, question == std::string_view::npos ? question : question - 1);

  Target parsed;
  bool valid = true;
  for_each_piece(path, '/', [&](std::string_view piece) {
    auto segment = percent_decode(piece, false);
    valid = valid && segment.has_value();
    if (segment) parsed.segments.push_back(*std::move(segment));
  });
  if (!parsed.segments.empty() && parsed.segments.back().empty()) parsed.segments.pop_back();

  if (question != std::string_view::npos)
    for_each_piece(target.substr(question + 1), '&', [&](std::string_view piece) {
      if (piece.empty()) return;
      const auto equals = std::min(piece.find('='), piece.size());
      auto name = percent_decode(piece.substr(0, equals), true);
      auto value = percent_decode(piece.substr(std::min(equals + 1, piece.size())), true);
      valid = valid && name && value;
      if (name && value) parsed.query[*std::move(name)] = *std::move(value);
    });
  if (!valid)
    return fail(ErrorCode::InvalidArgument,
                "the request target is badly percent-encoded or holds control characters");
  return parsed;
}

std::string encode_segment(std::string_view text) {
  std::string encoded;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("-._~").find(c) != std::string_view::npos;
    if (plain)
      encoded += c;
    else
      encoded += fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return encoded;
}

std::string encode_base64(std::string_view bytes) {
  constexpr std::string_view kAlphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string encoded;
  encoded.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t j = 0; j < 3; ++j)
      bits = bits << 8 | (j < count ? static_cast<unsigned char>(bytes[i + j]) : 0U);
    for (std::size_t j = 0; j < 4; ++j)
      encoded += j <= count ? kAlphabet[bits >> (18 - 6 * j) & 63U] : '=';
  }
  return encoded;
}

double accept_quality(std::string_view accept, std::string_view media_type) {
  if (trim(accept).empty()) return 1;
  double quality = 0;
  int best = 0;
  for_each_piece(accept, ',', [&](std::string_view piece) {
    const auto range = parse_range(piece);
    const int match = specificity(range.type, media_type);
    if (match > best) {
      best = match;
      quality = range.quality;
    }
  });
  return quality;
}

bool accept_names(std::string_view accept, std::string_view media_type) {
  bool named = false;
  for_each_piece(accept, ',', [&](std::string_view piece) {
    const auto range = parse_range(piece);
    named = named || (specificity(range.type, media_type) == 3 && range.quality > 0);
  });
  return named;
}

std::vector<std::string_view> list_items(std::string_view list) {
  std::vector<std::string_view> items;
  for_each_piece(list, ',', [&](std::string_view item) {
    if (!item.empty()) items.push_back(item);
  });
  return items;
}

std::string media_type_of(std::string_view content_type) {
  std::string type(trim(content_type.substr(0, content_type.find(';'))));
  std::ranges::transform(type, type.begin(), lower);
  return type;
}

std::optional<std::string> preference_value(std::string_view prefer, std::string_view preference) {
  std::optional<std::string> value;
  for_each_piece(prefer, ',', [&](std::string_view piece) {
    const auto item = trim(piece.substr(0, piece.find(';')));
    const auto equals = std::min(item.find('='), item.size());
    if (value || !equal_without_case(trim(item.substr(0, equals)), preference)) return;
    auto text = trim(item.substr(std::min(equals + 1, item.size())));
    if (text.size() > 1 && text.starts_with('"') && text.ends_with('"'))
      text = text.substr(1, text.size() - 2);
    value = std::string(text);
  });
  return value;
}

bool prefers(std::string_view prefer, std::string_view preference) {
  return preference_value(prefer, preference).has_value();
}

bool is_valid_host(std::string_view host) {
  const auto all_of = [](std::string_view text, std::string_view more) {
    return !text.empty() && std::ranges::all_of(text, [&](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
             more.find(c) != std::string_view::npos;
    });
  };
  std::string_view port = "0";
  if (host.starts_with('[')) {
    const auto close = host.find(']');
    if (close == std::string_view::npos || !all_of(host.substr(1, close - 1), ":.")) return false;
    const auto rest = host.substr(close + 1);
    if (!rest.empty() && rest.front() != ':') return false;
    if (!rest.empty()) port = rest.substr(1);
  } else {
    const auto colon = host.find(':');
    if (!all_of(host.substr(0, colon), "-._")) return false;
    if (colon != std::string_view::npos) port = host.substr(colon + 1);
  }
  std::uint16_t number = 0;
  const auto parsed = std::from_chars(port.data(), port.data() + port.size(), number);
  return parsed.ec == std::errc{} && parsed.ptr == port.data() + port.size() && host.size() < 262;
}

}  // namespace citymesh
