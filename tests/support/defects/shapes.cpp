#include "tests/support/defects/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/support/defects/plan.h"

namespace citymesh::testing {
namespace {

using Corners = Plan::Corners;

auto flat(double height_m) {
  return [height_m](double, double) { return height_m; };
}

/// Corners of a rectangle, counter-clockwise.
Corners rectangle(Plan& plan, double x0, double y0, double x1, double y1) {
  return {plan.corner(x0, y0), plan.corner(x1, y0), plan.corner(x1, y1), plan.corner(x0, y1)};
}

Corners turned(Corners ring) {
  std::reverse(ring.begin(), ring.end());
  return ring;
}

/// Cells between two rings of equally many corners.
template <class Height>
void band(Plan& plan, const Corners& outer, const Corners& inner, Height&& height) {
  for (std::size_t i = 0; i < outer.size(); ++i) {
    const std::size_t j = (i + 1) % outer.size();
    plan.cell({outer[i], outer[j], inner[j], inner[i]}, height);
  }
}

House flat_house(Random& random) {
  Plan plan;
  plan.cell(rectangle(plan, 0, 0, random.between(6, 30), random.between(6, 20)),
            flat(random.between(3, 25)));
  return plan.raise();
}

House shed(Random& random) {
  Plan plan;
  const double depth = random.between(5, 15), eaves = random.between(3, 8),
               slope = random.between(0.1, 0.5);
  plan.cell(rectangle(plan, 0, 0, random.between(6, 20), depth),
            [&](double, double y) { return eaves + slope * y; });
  return plan.raise();
}

/// Several sheds in a row: a works hall.
House sawtooth(Random& random) {
  Plan plan;
  const std::size_t bays = 3 + random.below(4);
  const double width = random.between(4, 8), depth = random.between(10, 30),
               low = random.between(4, 7), rise = random.between(1, 3);
  Corners near, far;
  for (std::size_t i = 0; i <= bays; ++i) {
    near.push_back(plan.corner(width * static_cast<double>(i), 0));
    far.push_back(plan.corner(width * static_cast<double>(i), depth));
  }
  for (std::size_t i = 0; i < bays; ++i)
    plan.cell({near[i], near[i + 1], far[i + 1], far[i]},
              [&](double x, double) { return low + rise * (x / width - static_cast<double>(i)); });
  return plan.raise();
}

House gabled(Random& random) {
  Plan plan;
  const double length = random.between(7, 25), depth = random.between(6, 14),
               eaves = random.between(3, 12), slope = random.between(0.3, 1.2);
  const Corners base = rectangle(plan, 0, 0, length, depth);
  const int west = plan.corner(0, depth / 2), east = plan.corner(length, depth / 2);
  const auto height = [&](double, double y) { return eaves + slope * std::min(y, depth - y); };
  plan.cell({base[0], base[1], east, west}, height);
  plan.cell({west, east, base[2], base[3]}, height);
  return plan.raise();
}

House hipped(Random& random) {
  Plan plan;
  const double depth = random.between(6, 14), length = depth + random.between(2, 15),
               eaves = random.between(3, 12), slope = random.between(0.3, 1.0);
  const Corners base = rectangle(plan, 0, 0, length, depth);
  const int west = plan.corner(depth / 2, depth / 2),
            east = plan.corner(length - depth / 2, depth / 2);
  const auto height = [&](double x, double y) {
    return eaves + slope * std::min({x, y, length - x, depth - y});
  };
  plan.cell({base[0], base[1], east, west}, height);
  plan.cell({base[1], base[2], east}, height);
  plan.cell({base[2], base[3], west, east}, height);
  plan.cell({base[3], base[0], west}, height);
  return plan.raise();
}

/// A drum with a cone.
House round_tower(Random& random) {
  Plan plan;
  const std::size_t sides = 12 + random.below(13);
  const double radius = random.between(3, 8), eaves = random.between(6, 25),
               rise = random.between(1, 8);
  Corners rim;
  for (std::size_t i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(sides);
    rim.push_back(
        plan.corner(radius + radius * std::cos(angle), radius + radius * std::sin(angle)));
  }
  const int tip = plan.corner(radius, radius);
  const auto height = [&](double x, double y) {
    return std::hypot(x - radius, y - radius) < radius / 2 ? eaves + rise : eaves;
  };
  for (std::size_t i = 0; i < sides; ++i) plan.cell({rim[i], rim[(i + 1) % sides], tip}, height);
  return plan.raise();
}

/// Two wings of one width that meet at a corner, with valley and hip.
House l_shaped(Random& random) {
  Plan plan;
  const double w = random.between(6, 12), a = w + random.between(5, 15),
               b = w + random.between(5, 15), eaves = random.between(3, 10),
               slope = random.between(0.4, 1.0);
  const int origin = plan.corner(0, 0), south_east = plan.corner(a, 0),
            east_ridge = plan.corner(a, w / 2), east = plan.corner(a, w), inner = plan.corner(w, w),
            north_east = plan.corner(w, b), north_ridge = plan.corner(w / 2, b),
            north = plan.corner(0, b), crossing = plan.corner(w / 2, w / 2);
  const auto along_x = [&](double, double y) { return eaves + slope * std::min(y, w - y); };
  const auto along_y = [&](double x, double) { return eaves + slope * std::min(x, w - x); };
  plan.cell({origin, south_east, east_ridge, crossing}, along_x);
  plan.cell({crossing, east_ridge, east, inner}, along_x);
  plan.cell({origin, crossing, north_ridge, north}, along_y);
  plan.cell({crossing, inner, north_east, north_ridge}, along_y);
  return plan.raise();
}

/// A lower gabled wing that runs into the roof of the main house.
House crossing_gables(Random& random) {
  Plan plan;
  const double depth = random.between(8, 14), length = random.between(16, 30),
               eaves = random.between(3, 10), slope = random.between(0.5, 1.0),
               width = depth * random.between(0.4, 0.7), reach = random.between(3, 8),
               centre = length * random.between(0.4, 0.6), west = centre - width / 2,
               east = centre + width / 2;
  const Corners base = rectangle(plan, 0, 0, length, depth);
  const int ridge_west = plan.corner(0, depth / 2), ridge_east = plan.corner(length, depth / 2),
            eaves_west = plan.corner(west, 0), eaves_east = plan.corner(east, 0),
            front_west = plan.corner(west, -reach), front = plan.corner(centre, -reach),
            front_east = plan.corner(east, -reach), meeting = plan.corner(centre, width / 2);
  const auto main_roof = [&](double, double y) { return eaves + slope * std::min(y, depth - y); };
  const auto wing_roof = [&](double x, double) {
    return eaves + slope * std::min(x - west, east - x);
  };
  plan.cell({base[0], eaves_west, meeting, eaves_east, base[1], ridge_east, ridge_west}, main_roof);
  plan.cell({ridge_west, ridge_east, base[2], base[3]}, main_roof);
  plan.cell({front_west, front, meeting, eaves_west}, wing_roof);
  plan.cell({front, front_east, eaves_east, meeting}, wing_roof);
  return plan.raise();
}

House mansard(Random& random) {
  Plan plan;
  const double depth = random.between(10, 16), length = depth + random.between(2, 10),
               eaves = random.between(6, 15), inset = random.between(0.8, 1.5),
               steep = random.between(2, 4), shallow = random.between(0.2, 0.5);
  const auto height = [&](double x, double y) {
    const double in = std::min({x, y, length - x, depth - y});
    return eaves + steep * std::min(in, inset) + shallow * std::max(in - inset, 0.0);
  };
  const Corners base = rectangle(plan, 0, 0, length, depth),
                knee = rectangle(plan, inset, inset, length - inset, depth - inset);
  band(plan, base, knee, height);
  const int west = plan.corner(depth / 2, depth / 2),
            east = plan.corner(length - depth / 2, depth / 2);
  plan.cell({knee[0], knee[1], east, west}, height);
  plan.cell({knee[1], knee[2], east}, height);
  plan.cell({knee[2], knee[3], west, east}, height);
  plan.cell({knee[3], knee[0], west}, height);
  return plan.raise();
}

/// A box out of a pitched roof.
House dormer(Random& random) {
  Plan plan;
  const double length = random.between(9, 18), depth = random.between(9, 14),
               eaves = random.between(3, 8), slope = random.between(0.6, 1.1),
               x0 = length * random.between(0.2, 0.35), x1 = length * random.between(0.6, 0.8),
               y0 = depth * random.between(0.08, 0.15), y1 = depth * random.between(0.3, 0.4);
  const Corners base = rectangle(plan, 0, 0, length, depth);
  const int west = plan.corner(0, depth / 2), east = plan.corner(length, depth / 2);
  const auto height = [&](double, double y) { return eaves + slope * std::min(y, depth - y); };
  const Corners box = rectangle(plan, x0, y0, x1, y1);
  plan.cell({base[0], base[1], east, west}, height);
  plan.hole(turned(box), height);
  plan.cell({west, east, base[2], base[3]}, height);
  plan.cell(box, flat(eaves + slope * y1));
  return plan.raise();
}

/// Flat wings around an inner ring.
House courtyard(Random& random) {
  Plan plan;
  const double a = random.between(18, 40), b = random.between(18, 40), wing = random.between(4, 7),
               height = random.between(6, 20);
  const Corners base = rectangle(plan, 0, 0, a, b),
                yard = rectangle(plan, wing, wing, a - wing, b - wing);
  plan.cell(base, flat(height));
  plan.hole(turned(yard), flat(height));
  return plan.raise();
}

/// Pitched wings around an inner ring.
House cloister(Random& random) {
  Plan plan;
  const double a = random.between(22, 40), b = random.between(22, 40), wing = random.between(5, 9),
               eaves = random.between(4, 12), slope = random.between(0.3, 0.9);
  const auto height = [&](double x, double y) {
    const double in = std::min({x, y, a - x, b - y});
    return eaves + slope * std::min(in, wing - in);
  };
  const Corners base = rectangle(plan, 0, 0, a, b),
                ridge = rectangle(plan, wing / 2, wing / 2, a - wing / 2, b - wing / 2),
                yard = rectangle(plan, wing, wing, a - wing, b - wing);
  band(plan, base, ridge, height);
  band(plan, ridge, yard, height);
  return plan.raise();
}

/// Blocks on blocks, each on the middle of the lower one.
House stepped_tower(Random& random) {
  Plan plan;
  const double a = random.between(16, 30), b = random.between(16, 30);
  double height = random.between(4, 12), in = 0;
  Corners outer = rectangle(plan, 0, 0, a, b);
  const std::size_t steps = 1 + random.below(2);
  for (std::size_t i = 0; i < steps; ++i) {
    in += random.between(1.5, 3);
    const Corners inner = rectangle(plan, in, in, a - in, b - in);
    plan.cell(outer, flat(height));
    plan.hole(turned(inner), flat(height));
    height += random.between(3, 10);
    outer = inner;
  }
  plan.cell(outer, flat(height));
  return plan.raise();
}

/// Blocks of different height side by side behind one front.
House terrace(Random& random) {
  Plan plan;
  const double depth = random.between(8, 14);
  const std::size_t blocks = 2 + random.below(3);
  double x = 0, height = random.between(5, 9);
  int near = plan.corner(0, 0), far = plan.corner(0, depth);
  for (std::size_t i = 0; i < blocks; ++i) {
    x += random.between(5, 9);
    const int next_near = plan.corner(x, 0), next_far = plan.corner(x, depth);
    plan.cell({near, next_near, next_far, far}, flat(height));
    height = std::max(3.0, height + (random.coin() ? 1 : -1) * random.between(0.8, 3));
    near = next_near, far = next_far;
  }
  return plan.raise();
}

/// A street runs through the house: a roof with an outer ceiling under it.
House passage(Random& random) {
  Plan plan;
  const double depth = random.between(8, 14), p = random.between(4, 9),
               q = p + random.between(3, 5), length = q + random.between(4, 9),
               clear = random.between(3, 4.5), height = clear + random.between(3, 10);
  const double x[4] = {0, p, q, length};
  Corners near, far;
  for (const double at : x) {
    near.push_back(plan.corner(at, 0));
    far.push_back(plan.corner(at, depth));
  }
  for (std::size_t i = 0; i < 3; ++i)
    plan.cell({near[i], near[i + 1], far[i + 1], far[i]}, flat(height), i == 1 ? clear : 0);
  return plan.raise();
}

}  // namespace

std::span<const HouseShape> house_shapes() {
  static constexpr std::array kShapes{
      HouseShape{"flat", flat_house},
      HouseShape{"shed", shed},
      HouseShape{"sawtooth", sawtooth},
      HouseShape{"gabled", gabled},
      HouseShape{"hipped", hipped},
      HouseShape{"round_tower", round_tower},
      HouseShape{"l_shaped", l_shaped},
      HouseShape{"crossing_gables", crossing_gables},
      HouseShape{"mansard", mansard},
      HouseShape{"dormer", dormer},
      HouseShape{"courtyard", courtyard},
      HouseShape{"cloister", cloister},
      HouseShape{"stepped_tower", stepped_tower},
      HouseShape{"terrace", terrace},
      HouseShape{"passage", passage},
  };
  return kShapes;
}

}  // namespace citymesh::testing
