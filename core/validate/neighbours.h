#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/citymodel/issue.h"
#include "core/validate/body.h"

namespace citymesh {

struct NeighbourOptions {
  double gap_threshold_m = 0.10;   ///< narrower gaps are reported; 0: none are
  double wall_tolerance_m = 0.01;  ///< walls that are closer are meant to be one
};

/// Compares buildings with those that came before: overlaps (C116), walls that are nearly one
/// (C117), narrow gaps (C118). Of each pair of buildings one issue of a code, with the other's id,
/// the place and what was measured. Keeps the solids of all buildings, found again by squares in
/// plan; beyond kMaxTriangles it lets them go and compares no more.
class Neighbours {
 public:
  static constexpr std::uint64_t kMaxTriangles = 4'000'000;

  explicit Neighbours(const NeighbourOptions& options) : options_(options) {}

  void add(std::string gml_id, std::vector<SolidBody> solids);
  std::size_t size() const { return buildings_.size(); }
  bool complete() const { return triangles_ <= kMaxTriangles; }

  /// Between a building and those with a lower number. May be called from several threads as long
  /// as nothing is added.
  std::vector<Issue> issues_of(std::size_t number) const;

 private:
  struct Kept {
    std::string gml_id{};
    std::vector<SolidBody> solids{};
    GridBox box{};
  };
  std::vector<std::uint32_t> near(std::size_t number) const;
  void compare(const Kept& building, const Kept& other, std::vector<Issue>& issues) const;

  NeighbourOptions options_;
  std::vector<Kept> buildings_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> squares_;
  std::vector<std::uint32_t> wide_;  ///< buildings over too many squares
  std::uint64_t triangles_ = 0;
};

}  // namespace citymesh
