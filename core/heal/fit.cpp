#include <algorithm>
#include <utility>

#include "core/heal/heal.h"
#include "core/heal/steps.h"
#include "core/validate/validate.h"

namespace citymesh {

std::vector<Issue> make_fit(Shell& shell, double planarity_tolerance_m, const DeliveryGate& gate,
                            std::vector<GridPoint>& cuts) {
  type_faces(shell);
  group_solids(shell);
  std::vector<Issue> refused = gate(shell);
  if (!refused.empty()) return refused;
  const auto sound_of = [&](const Shell& s) { return sound_faces(s, {0, planarity_tolerance_m}); };
  const std::vector<bool> sound = sound_of(shell);
  if (std::find(sound.begin(), sound.end(), false) == sound.end()) return {};
  Shell cut = shell;
  cuts = split_uneven_faces(cut, sound, planarity_tolerance_m, false);
  // Pieces may be uneven in turn, and the cuts of neighbours may not go together: then triangles,
  // of which nothing else can be found.
  split_uneven_faces(cut, sound_of(cut), planarity_tolerance_m, true);
  if (!gate(cut).empty()) {
    cut = shell;
    split_uneven_faces(cut, sound, planarity_tolerance_m, true);
    refused = gate(cut);
  }
  if (refused.empty()) shell = std::move(cut);
  return refused;
}

}  // namespace citymesh
