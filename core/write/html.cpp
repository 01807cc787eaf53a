#include "core/write/html.h"

#include <array>
#include <cmath>

#include "core/write/drawing.h"
#include "core/write/text.h"

namespace citymesh {

std::string escaped(std::string_view text) {
  std::string out;
  append_markup(out, text);
  return out;
}

/// 1234567 as "1 234 567" with narrow spaces.
std::string grouped(std::uint64_t value) {
  std::string text = std::to_string(value);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, "\u202f");
  return text;
}

std::string rounded(double value, int decimals) {
  if (std::abs(value) >= 10'000 && std::abs(value) < 1e15)
    return (value < 0 ? "−" : "") +
           grouped(static_cast<std::uint64_t>(std::llround(std::abs(value))));
  std::string out;
  append_number(out, value, decimals);
  return out;
}

std::string plural(std::uint64_t count, std::string_view one, std::string_view many) {
  return grouped(count) + ' ' + std::string(count == 1 ? one : many);
}

/// "SHELL_NOT_CLOSED" as "shell not closed".
std::string spoken(std::string_view name) {
  std::string out(name);
  for (char& c : out) c = c == '_' ? ' ' : c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return out;
}

std::string css_colour(std::string_view rung) {
  const auto& c = kStyles[rung_style(rung)].colour;
  return "rgb(" + std::to_string(c[0]) + ',' + std::to_string(c[1]) + ',' + std::to_string(c[2]) +
         ')';
}

std::string chip(std::string_view label, const Style& style) {
  std::string html = "<span class=\"rung\" style=\"background:";
  append_colour(html, style.colour);
  return html + "\" title=\"" + escaped(style.meaning) + "\">" + escaped(label) + "</span>";
}

std::string rung_chip(std::string_view rung, std::string_view outcome) {
  if (outcome == "delivered") return chip(rung.empty() ? outcome : rung, kStyles[rung_style(rung)]);
  return "<span class=\"rung " + std::string(outcome == "merged" ? "merged" : "dropped") + "\">" +
         escaped(outcome) + "</span>";
}

}  // namespace citymesh
