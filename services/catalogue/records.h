#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/source/catalogue.h"

namespace citymesh::catalogue {

/// What the catalogue keeps of a file besides its buildings, as JSON: doubles exactly.
std::string facts_text(const source::FileRecord& file);
/// Errors: DataLoss.
Result<void> read_facts(std::string_view text, source::FileRecord& file);

/// Rings as bytes of this machine: the catalogue does not travel.
std::string footprint_bytes(const source::Footprints& footprint);
/// Errors: DataLoss.
Result<source::Footprints> read_footprint(std::string_view bytes);

/// Texts as a JSON list.
std::string list_text(const std::vector<std::string>& texts);
/// Errors: DataLoss.
Result<std::vector<std::string>> read_list(std::string_view text);

}  // namespace citymesh::catalogue
