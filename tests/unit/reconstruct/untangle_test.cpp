#include "core/reconstruct/untangle.h"

#include <gtest/gtest.h>

#include "core/citymodel/grid.h"
#include "tests/support/shapes.h"

namespace citymesh {
namespace {

using testing::block;
using testing::Draw;
using testing::rectangle;

Shell shell_of(const Building& building) {
  return std::get<Gridded>(grid(building, building.geometries[0])).shell;
}

TEST(Untangle, GivesABowTieTheOrderOfItsNeighbours) {
  const Shell sound = shell_of(block(0, 0, 10, 8, 6).done());
  for (std::size_t f = 0; f < sound.faces.size(); ++f)
    for (std::size_t i = 0; i < 4; ++i) {
      Shell shell = sound;
      Ring& ring = shell.faces[f].rings[0];
      std::swap(ring[i], ring[(i + 1) % 4]);
      untangle(shell);
      Ring turned = ring, expected = sound.faces[f].rings[0];
      std::reverse(expected.begin(), expected.end());
      for (Ring* r : {&turned, &expected})
        std::rotate(r->begin(), std::min_element(r->begin(), r->end()), r->end());
      const bool same_way = [&] {
        Ring forward = sound.faces[f].rings[0];
        std::rotate(forward.begin(), std::min_element(forward.begin(), forward.end()),
                    forward.end());
        return turned == forward;
      }();
      EXPECT_TRUE(same_way || turned == expected) << "face " << f << " corner " << i;
    }
}

TEST(Untangle, LeavesSoundRingsAlone) {
  const Shell sound = shell_of(block(0, 0, 10, 8, 6).done());
  Shell shell = sound;
  untangle(shell);
  for (std::size_t f = 0; f < sound.faces.size(); ++f)
    EXPECT_EQ(shell.faces[f].rings, sound.faces[f].rings);
}

TEST(Untangle, LeavesABowTieThatHasNoNeighbours) {
  Draw draw;
  draw.face(SurfaceType::RoofSurface, {{{0, 0, 3}, {10, 8, 3}, {10, 0, 3}, {0, 8, 3}}});
  const Shell lonely = shell_of(draw.done());
  Shell shell = lonely;
  untangle(shell);
  EXPECT_EQ(shell.faces[0].rings, lonely.faces[0].rings);
}

}  // namespace
}  // namespace citymesh
