#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/write/styles.h"

namespace citymesh {

// Texts and numbers for people, ready for HTML.

std::string escaped(std::string_view text);
std::string grouped(std::uint64_t value);         ///< 1234567 as "1 234 567", narrow spaces
std::string rounded(double value, int decimals);  ///< large numbers grouped, without decimals
std::string plural(std::uint64_t count, std::string_view one, std::string_view many);
std::string spoken(std::string_view name);  ///< "SHELL_NOT_CLOSED" as "shell not closed"
std::string css_colour(std::string_view rung);

/// A word in the colour of a style, whose meaning appears on pointing at it.
std::string chip(std::string_view label, const Style& style);

/// The chip of a rung, or of an outcome that is none.
std::string rung_chip(std::string_view rung, std::string_view outcome);

}  // namespace citymesh
