#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace citymesh {

/// File-safe, unique body names (contract, Results): characters outside [A-Za-z0-9_] become `_`,
/// `b_` in front unless it starts with a letter, clashes numbered in gml_id order. All ids are
/// known beforehand, so a name depends neither on the order of the buildings nor on what is
/// dropped.
class Names {
 public:
  explicit Names(std::vector<std::string> gml_ids);

  /// The name of an id; an id that comes again gets a number of its own.
  std::string take(const std::string& gml_id);

 private:
  std::unordered_map<std::string, std::string>
      renamed_;                            ///< only ids whose plain name is taken by another one
  std::unordered_set<std::string> used_;   ///< names promised to ids
  std::unordered_set<std::string> taken_;  ///< ids that have been here
};

std::string plain_name(std::string_view gml_id);

}  // namespace citymesh
