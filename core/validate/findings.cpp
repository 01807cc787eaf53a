#include "core/validate/findings.h"

#include <fmt/format.h>

namespace citymesh {

std::size_t Findings::count() const {
  std::size_t all = 0;
  for (const auto& [code, count] : counts_) all += count;
  return all;
}

std::vector<Issue> Findings::take() {
  for (const auto& [code, count] : counts_)
    if (count > kMaxPlaces)
      issues_.push_back({code, fmt::format("and {} more places", count - kMaxPlaces),
                         static_cast<double>(count - kMaxPlaces)});
  counts_.clear();
  return std::move(issues_);
}

}  // namespace citymesh
