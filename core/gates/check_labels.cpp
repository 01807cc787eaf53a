#include <algorithm>

#include "core/gates/gates.h"

namespace citymesh {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool is_solver_name(std::string_view name) {
  return !name.empty() && is_letter(name[0]) && std::all_of(name.begin(), name.end(), [](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '_';
  });
}

}  // namespace

std::vector<GateFailure> check_labels(const ParsedBody& body, bool named) {
  std::vector<GateFailure> failures;
  if (named && !is_solver_name(body.name))
    failures.push_back({"G14", 1, "name `" + body.name + "`"});
  const auto without = static_cast<std::uint64_t>(
      std::count_if(body.patches.begin(), body.patches.end(),
                    [](const std::string& patch) { return patch.empty(); }));
  const std::uint64_t unlabelled = without + (body.triangles.size() > body.patches.size()
                                                  ? body.triangles.size() - body.patches.size()
                                                  : 0);
  if (unlabelled > 0)
    failures.push_back({"G14", unlabelled, "triangles of `" + body.name + "` without a patch"});
  return failures;
}

}  // namespace citymesh
