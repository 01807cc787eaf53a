#include "core/pipeline/names.h"

#include <algorithm>

namespace citymesh {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_plain(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; }

std::string first_free(const std::string& name, const std::unordered_set<std::string>& used) {
  for (std::size_t n = 2;; ++n) {
    std::string numbered = name + "_" + std::to_string(n);
    if (!used.contains(numbered)) return numbered;
  }
}

}  // namespace

std::string plain_name(std::string_view gml_id) {
  std::string name;
  name.reserve(gml_id.size() + 2);
  if (gml_id.empty() || !is_letter(gml_id[0])) name = "b_";
  for (const char c : gml_id) name += is_plain(c) ? c : '_';
  return name;
}

Names::Names(std::vector<std::string> gml_ids) {
  std::sort(gml_ids.begin(), gml_ids.end());
  gml_ids.erase(std::unique(gml_ids.begin(), gml_ids.end()), gml_ids.end());
  used_.reserve(gml_ids.size());
  for (std::string& id : gml_ids) {
    std::string name = plain_name(id);
    if (used_.insert(name).second) continue;
    name = first_free(name, used_);
    used_.insert(name);
    renamed_.emplace(std::move(id), std::move(name));
  }
}

std::string Names::take(const std::string& gml_id) {
  const auto renamed = renamed_.find(gml_id);
  std::string name = renamed == renamed_.end() ? plain_name(gml_id) : renamed->second;
  if (taken_.insert(gml_id).second) {
    used_.insert(name);
    return name;
  }
  name = first_free(name, used_);
  used_.insert(name);
  return name;
}

}  // namespace citymesh
