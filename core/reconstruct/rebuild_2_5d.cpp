#include "core/reconstruct/rebuild_2_5d.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/base/union_find.h"
#include "core/geometry/box_tree.h"
#include "core/geometry/triangulation.h"
#include "core/reconstruct/columns.h"
#include "core/reconstruct/fidelity.h"
#include "core/reconstruct/level.h"
#include "core/reconstruct/partition.h"
#include "core/reconstruct/roles.h"
#include "core/reconstruct/tidy.h"

namespace citymesh {
namespace {

constexpr std::size_t kMaxEdges = 40000;  ///< work limit
constexpr std::int64_t kClearance = 20;   ///< twice what the gates take for touching
constexpr double kSliver_m = 0.02;        ///< narrower cells join a neighbour
constexpr std::int64_t kHalfNotch = 100;  ///< of the square cut out where columns meet in a line
constexpr int kRounds = 8;
constexpr std::int64_t kSameLayer = 500;  ///< faces closer above each other are one layer
constexpr double kMaxAir_m2 = 0.5;        ///< of space between faces above each other
constexpr double kMostOf = 0.6;           ///< of what a continued plane has to meet

class Rebuild {
 public:
  Rebuild(const Shell& input, const ReconstructOptions& options, const RunContext& context)
      : input_(with_clean_rings(input)),
        context_(context),
        tolerance_(std::max(kClearance, static_cast<std::int64_t>(std::llround(
                                            options.tolerance_m * kGridStepsPerMetre)))) {}

  std::optional<Shell> run() {
    read_faces();
    if (lines_.empty() || lines_.size() > kMaxEdges) return {};
    bool cut_crossings = true;
    for (int round = 0; round < kRounds; ++round) {
      if (context_.stopped()) return {};
      auto divided = divide(lines_, tolerance_, kMaxEdges);
      if (!divided || divided->cells.size() < 2) return {};
      partition_ = std::move(*divided);
      stack();
      if (cut_crossings && add_crossings()) {
        cut_crossings = false;  // what is left of them lies within the tolerance
        continue;
      }
      if (!choose()) return {};
      if (!walls_drawn_ && has_gaps()) {
        walls_drawn_ = true;
        draw_walls();
        continue;
      }
      fill_gaps();
      fill_bottoms();
      absorb_slivers();
      cut_notches();
      Shell shell = boundary_of(
          partition_, columns_, looks_,
          [this](std::uint32_t level, std::uint32_t vertex) { return height(level, vertex); },
          std::max(tolerance_, kClearance));
      if (shell.faces.empty()) return {};
      if (const auto places = pinches(shell); !places.empty()) {
        for (const GridPoint2& p : places) add_notch(p, kHalfNotch * (1 + round));
        continue;
      }
      shell.surface_ids = input_.surface_ids;
      name_walls(shell, input_, vertical_);
      tidy(shell);
      if (!is_faithful(shell, input_, roles_)) return {};
      return shell;
    }
    return {};
  }

 private:
  struct Layer {
    std::uint32_t level = 0;
    std::int64_t z = 0;
  };

  /// Faces of the input are the levels of the same number.
  void read_faces() {
    for (std::uint32_t f = 0; f < input_.faces.size(); ++f) {
      const Face& face = input_.faces[f];
      const FaceRole role = role_of(input_, face, tolerance_);
      roles_.push_back(role);
      up_.push_back(face.rings.empty() ? 0.0 : ring_normal(input_.points, face.rings[0]).z);
      looks_.push_back({face.type, face.source, face.added});
      levels_.push_back(role == FaceRole::Ignored || role == FaceRole::Vertical
                            ? Level(Slope{})
                            : Level(input_, face));
      if (role == FaceRole::Vertical) vertical_.push_back(f);
      if (role == FaceRole::Ignored || role == FaceRole::Vertical) continue;
      for (const Ring& ring : face.rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
          const GridPoint2 a = project(input_.points[ring[i]], Axis::Z),
                           b = project(input_.points[ring[(i + 1) % ring.size()]], Axis::Z);
          if (a != b) lines_.push_back({a, b, f});
        }
    }
  }

  std::int64_t z_at(std::uint32_t level, const GridPoint2& p) const {
    return levels_[level].z(p, static_cast<double>(2 * tolerance_));
  }

  /// Height of a level over a vertex: of its own corner there, if it has one.
  std::int64_t height(std::uint32_t level, std::uint32_t vertex) const {
    const auto known = corner_z_.find({level, vertex});
    return known != corner_z_.end() ? known->second : z_at(level, partition_.vertices[vertex]);
  }

  /// The faces over every cell, from below.
  void stack() {
    corner_z_.clear();
    for (std::uint32_t f = 0; f < input_.faces.size(); ++f) {
      if (roles_[f] == FaceRole::Ignored || roles_[f] == FaceRole::Vertical) continue;
      for (const Ring& ring : input_.faces[f].rings)
        for (const std::uint32_t corner : ring) {
          const GridPoint& p = input_.points[corner];
          const auto at = partition_.vertex_of.find(project(p, Axis::Z));
          if (at != partition_.vertex_of.end()) corner_z_.emplace(std::pair(f, at->second), p.z);
        }
    }
    layers_.assign(partition_.cells.size(), {});
    for (std::uint32_t c = 1; c < partition_.cells.size(); ++c) {
      for (const std::uint32_t f : partition_.cells[c].areas)
        layers_[c].push_back({f, z_at(f, partition_.cells[c].inside)});
      std::stable_sort(layers_[c].begin(), layers_[c].end(),
                       [](const Layer& s, const Layer& t) { return s.z < t.z; });
    }
    // Inside out? Ask the highest faces where several lie above each other.
    double upwards = 0;
    for (std::uint32_t c = 1; c < layers_.size(); ++c)
      if (layers_[c].size() > 1)
        upwards += partition_.cells[c].area_m2 * (up_[layers_[c].back().level] > 0 ? 1 : -1);
    inside_out_ = upwards < 0;
  }

  /// Where faces over one cell cross, a line that divides it; whether there are any.
  bool add_crossings() {
    std::vector<std::vector<std::uint32_t>> corners(partition_.cells.size());
    for (const Partition::Edge& edge : partition_.edges)
      for (const std::uint32_t cell : {edge.left, edge.right})
        if (layers_[cell].size() > 1)
          corners[cell].insert(corners[cell].end(), {edge.from, edge.to});
    const std::size_t before = lines_.size();
    constexpr std::size_t kManyLayers = 12;
    for (std::uint32_t c = 1; c < partition_.cells.size(); ++c) {
      const auto& layers = layers_[c];
      if (layers.size() < 2 || layers.size() > kManyLayers) continue;
      for (std::size_t i = 0; i < layers.size(); ++i)
        for (std::size_t j = i + 1; j < layers.size(); ++j) {
          // Points of the outline where the difference of the two is nothing.
          std::vector<GridPoint2> ends;
          std::int64_t lowest = 0, highest = 0;
          for (std::size_t k = 0; k + 1 < corners[c].size(); k += 2) {
            const std::uint32_t u = corners[c][k], v = corners[c][k + 1];
            const std::int64_t at_u = height(layers[i].level, u) - height(layers[j].level, u);
            const std::int64_t at_v = height(layers[i].level, v) - height(layers[j].level, v);
            lowest = std::min({lowest, at_u, at_v});
            highest = std::max({highest, at_u, at_v});
            const GridPoint2 &a = partition_.vertices[u], &b = partition_.vertices[v];
            if (at_u == 0) ends.push_back(a);
            if (at_v == 0) ends.push_back(b);
            if (at_u == 0 || at_v == 0 || (at_u > 0) == (at_v > 0)) continue;
            const double t = static_cast<double>(at_u) / static_cast<double>(at_u - at_v);
            ends.push_back({a.x + std::llround(t * static_cast<double>(b.x - a.x)),
                            a.y + std::llround(t * static_cast<double>(b.y - a.y))});
          }
          if (-lowest <= kSameLayer || highest <= kSameLayer || ends.size() < 2) continue;
          const auto [first, last] = std::minmax_element(ends.begin(), ends.end());
          if (*first != *last) lines_.push_back({*first, *last});
        }
    }
    return lines_.size() > before;
  }

  bool faces_up(std::uint32_t level) const { return (up_[level] > 0) != inside_out_; }

  /// What bounds every cell from above and below, as far as faces tell. False: there is air between
  /// faces above each other.
  bool choose() {
    bottoms_.assign(partition_.cells.size(), {});
    tops_.assign(partition_.cells.size(), {});
    double air_m2 = 0;
    for (std::uint32_t c = 1; c < partition_.cells.size(); ++c) {
      const std::vector<Layer>& layers = layers_[c];
      if (layers.empty()) continue;
      // Of faces within a layer, the first of the input stands for all.
      const auto first_in_layer = [&](std::int64_t from, std::int64_t to, auto&& fits) {
        std::optional<std::uint32_t> first;
        for (const Layer& layer : layers)
          if (layer.z >= from && layer.z <= to && fits(roles_[layer.level]) &&
              (!first || layer.level < *first))
            first = layer.level;
        return first;
      };
      const std::int64_t high = layers.back().z, low = layers.front().z;
      const auto is_top = [](FaceRole role) {
        return role == FaceRole::Up || role == FaceRole::Either;
      };
      const auto is_bottom = [](FaceRole role) {
        return role == FaceRole::Down || role == FaceRole::Either;
      };
      if (high - low <= kSameLayer) {
        // One layer: a roof, a ground, or what its face looks like.
        if (const auto up = first_in_layer(low, high, [](FaceRole r) { return r == FaceRole::Up; }))
          tops_[c] = up;
        else if (const auto down =
                     first_in_layer(low, high, [](FaceRole r) { return r == FaceRole::Down; }))
          bottoms_[c] = down;
        else
          (faces_up(layers[0].level) ? tops_ : bottoms_)[c] = layers[0].level;
        continue;
      }
      tops_[c] = first_in_layer(high - kSameLayer, high, is_top);
      if (!tops_[c]) tops_[c] = layers.back().level;
      bottoms_[c] = first_in_layer(low, low + kSameLayer, is_bottom);
      if (!bottoms_[c] && !faces_up(layers.front().level)) bottoms_[c] = layers.front().level;
      // Air: a face that looks up and above it, below the roof, one that looks down.
      std::optional<std::int64_t> floor;
      for (const Layer& layer : layers) {
        if (layer.z <= low + kSameLayer || layer.z >= high - kSameLayer) continue;
        const bool down = roles_[layer.level] == FaceRole::Down || !faces_up(layer.level);
        if (down &&
            (floor ? layer.z - *floor > kSameLayer : roles_[layer.level] == FaceRole::Down)) {
          air_m2 += partition_.cells[c].area_m2;
          break;
        }
        if (!down) floor = layer.z;
      }
    }
    return air_m2 <= kMaxAir_m2;
  }

  bool has_gaps() const {
    double gap_m2 = 0;
    for (std::uint32_t c = 1; c < partition_.cells.size(); ++c)
      if (bottoms_[c] && !tops_[c]) gap_m2 += partition_.cells[c].area_m2;
    return gap_m2 > kMaxAir_m2;
  }

  void draw_walls() {
    for (const std::uint32_t f : vertical_) {
      const PartitionLine line = seen_from_above(input_, input_.faces[f]);
      if (line.a != line.b) lines_.push_back(line);
    }
  }

  std::uint32_t add_level(const Slope& plane, SurfaceType type) {
    levels_.emplace_back(plane);
    looks_.push_back({type, 0, true});
    up_.push_back(type == SurfaceType::RoofSurface ? 1.0 : -1.0);
    return static_cast<std::uint32_t>(levels_.size() - 1);
  }

  static Slope flat(std::int64_t z) { return {{}, static_cast<double>(z), 0, 0}; }

  /// Heights of all corners of the input and of roofs over vertices of the partition, ascending.
  void sound() {
    soundings_.assign(partition_.vertices.size(), {});
    std::vector<GridBox> boxes;
    boxes.reserve(partition_.vertices.size());
    for (const GridPoint2& p : partition_.vertices) boxes.push_back(GridBox::of({p.x, p.y, 0}));
    const BoxTree tree(boxes);
    std::set<std::uint32_t> used;
    for (std::uint32_t f = 0; f < input_.faces.size(); ++f)
      if (roles_[f] != FaceRole::Ignored)
        for (const Ring& ring : input_.faces[f].rings) used.insert(ring.begin(), ring.end());
    for (const std::uint32_t i : used) {
      const GridPoint& p = input_.points[i];
      tree.for_each_meeting(GridBox::of({p.x, p.y, 0}).grown(2 * tolerance_),
                            [&](std::uint32_t v) { soundings_[v].push_back(p.z); });
    }
    for (const Partition::Edge& edge : partition_.edges)
      for (const std::uint32_t cell : {edge.left, edge.right})
        if (tops_[cell])
          for (const std::uint32_t v : {edge.from, edge.to})
            soundings_[v].push_back(height(*tops_[cell], v));
    for (auto& z : soundings_) {
      std::sort(z.begin(), z.end());
      z.erase(std::unique(z.begin(), z.end()), z.end());
    }
  }

  /// Cells that `belongs` holds for, in groups that hang together across edges that `joins` holds
  /// for.
  template <class Belongs, class Joins>
  std::vector<std::vector<std::uint32_t>> groups(Belongs&& belongs, Joins&& joins) const {
    UnionFind sets(partition_.cells.size());
    for (const Partition::Edge& edge : partition_.edges)
      if (joins(edge)) sets.join(edge.left, edge.right);
    std::map<std::uint32_t, std::vector<std::uint32_t>> by_root;
    for (std::uint32_t c = 1; c < partition_.cells.size(); ++c)
      if (belongs(c)) by_root[sets.root(c)].push_back(c);
    std::vector<std::vector<std::uint32_t>> result;
    result.reserve(by_root.size());
    for (auto& [first, cells] : by_root) result.push_back(std::move(cells));
    return result;
  }

  /// Connected cells that `belongs` holds for.
  template <class Belongs>
  std::vector<std::vector<std::uint32_t>> groups(Belongs&& belongs) const {
    return groups(belongs, [&](const Partition::Edge& edge) {
      return belongs(edge.left) && belongs(edge.right);
    });
  }

  /// Vertices of the cells that satisfy `counts(neighbour)` on the other side of an edge.
  template <class Counts>
  std::set<std::uint32_t> outline(const std::vector<std::uint32_t>& cells, Counts&& counts) const {
    const std::set<std::uint32_t> own(cells.begin(), cells.end());
    std::set<std::uint32_t> vertices;
    for (const Partition::Edge& edge : partition_.edges) {
      const bool left = own.contains(edge.left), right = own.contains(edge.right);
      if (left == right || !counts(left ? edge.right : edge.left)) continue;
      vertices.insert({edge.from, edge.to});
    }
    return vertices;
  }

  /// Cells with a ground and no roof: the plane that most heights on their outline lie in, else
  /// that of the neighbour with the longest common edge, as long as it stays above the ground.
  void fill_gaps() {
    const auto is_gap = [this](std::uint32_t c) { return bottoms_[c] && !tops_[c]; };
    std::vector<std::vector<std::uint32_t>> gaps;
    if (walls_drawn_)  // what walls divide may have different heights
      for (std::uint32_t c = 1; c < partition_.cells.size(); ++c) {
        if (is_gap(c)) gaps.push_back({c});
      }
    else
      gaps = groups(is_gap);
    if (gaps.empty()) return;
    sound();
    for (const auto& cells : gaps) {
      std::vector<Sounding> soundings;
      std::int64_t highest = z_at(*bottoms_[cells[0]], partition_.cells[cells[0]].inside);
      const std::int64_t ground = highest;
      for (const std::uint32_t v : outline(cells, [](std::uint32_t) { return true; })) {
        Sounding sounding{partition_.vertices[v], {}};
        const std::int64_t bottom = height(*bottoms_[cells[0]], v);
        for (const std::int64_t z : soundings_[v])
          if (z > bottom + kSameLayer) sounding.z.push_back(z);
        if (sounding.z.empty()) continue;
        highest = std::max(highest, sounding.z.back());
        soundings.push_back(std::move(sounding));
      }
      if (const auto plane = consensus(soundings, static_cast<double>(2 * tolerance_), kMostOf)) {
        const std::uint32_t level = add_level(*plane, SurfaceType::RoofSurface);
        for (const std::uint32_t c : cells) tops_[c] = level;
      } else if (highest > ground + kSameLayer && !soundings.empty()) {
        std::vector<std::int64_t> tops;
        tops.reserve(soundings.size());
        for (const Sounding& sounding : soundings) tops.push_back(sounding.z.back());
        std::nth_element(tops.begin(), tops.begin() + static_cast<std::ptrdiff_t>(tops.size() / 2),
                         tops.end());
        const std::uint32_t level =
            add_level(flat(tops[tops.size() / 2]), SurfaceType::RoofSurface);
        for (const std::uint32_t c : cells) tops_[c] = level;
      }
    }
  }

  /// Cells with a roof and no ground take the ground beside them; where none is, the plane that
  /// the feet of most walls stand on, else the lowest height of all.
  void fill_bottoms() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> border;  // cell, level: length
    const auto is_open = [this](std::uint32_t c) { return tops_[c] && !bottoms_[c]; };
    for (bool grown = true; grown;) {
      border.clear();
      for (const Partition::Edge& edge : partition_.edges)
        for (const auto& [open, other] :
             {std::pair(edge.left, edge.right), std::pair(edge.right, edge.left)})
          if (is_open(open) && bottoms_[other] && is_ground(*bottoms_[other]))
            border[{open, *bottoms_[other]}] += length(edge);
      grown = !border.empty();
      std::map<std::uint32_t, std::pair<double, std::uint32_t>> longest;
      for (const auto& [key, along] : border) {
        auto& best = longest[key.first];
        if (along > best.first) best = {along, key.second};
      }
      for (const auto& [cell, best] : longest) bottoms_[cell] = best.second;
      grown = !longest.empty();
    }
    const auto open = groups(is_open);
    if (open.empty()) return;
    sound();
    std::int64_t lowest = kGridLimit;
    for (const auto& z : soundings_)
      if (!z.empty()) lowest = std::min(lowest, z.front());
    for (const Layer& layer : all_layers()) lowest = std::min(lowest, layer.z);
    const std::uint32_t base = add_level(flat(lowest), SurfaceType::GroundSurface);
    for (const auto& cells : open) {
      std::vector<Sounding> soundings;
      for (const std::uint32_t v : outline(cells, [this](std::uint32_t c) { return !tops_[c]; }))
        if (!soundings_[v].empty() && soundings_[v].back() - soundings_[v].front() > kSameLayer)
          soundings.push_back({partition_.vertices[v], {soundings_[v].front()}});
      std::uint32_t level = base;
      const auto plane = consensus(soundings, static_cast<double>(2 * tolerance_), kMostOf);
      if (plane && std::hypot(plane->gx, plane->gy) > 0)
        level = add_level(*plane, SurfaceType::GroundSurface);
      for (const std::uint32_t c : cells) bottoms_[c] = level;
    }
  }

  std::vector<Layer> all_layers() const {
    std::vector<Layer> all;
    for (const auto& layers : layers_) all.insert(all.end(), layers.begin(), layers.end());
    return all;
  }

  /// Whether a bottom stands on the ground, and is no underside.
  bool is_ground(std::uint32_t level) const {
    return looks_[level].type == SurfaceType::GroundSurface;
  }

  double length(const Partition::Edge& edge) const {
    const GridPoint2 &a = partition_.vertices[edge.from], &b = partition_.vertices[edge.to];
    return std::hypot(static_cast<double>(a.x - b.x), static_cast<double>(a.y - b.y));
  }

  /// Cells narrower than a sliver become like the neighbour with the longest common edge.
  void absorb_slivers() {
    columns_.assign(partition_.cells.size(), {});
    for (std::uint32_t c = 1; c < partition_.cells.size(); ++c)
      if (bottoms_[c] && tops_[c]) columns_[c] = Column{*bottoms_[c], *tops_[c]};
    for (int round = 0; round < kRounds; ++round) {
      // Cells of one column count as one.
      std::vector<std::uint32_t> group(partition_.cells.size(), 0);
      std::uint32_t count = 1;
      for (const bool solid : {true, false})
        for (const auto& cells : same_groups(solid)) {
          for (const std::uint32_t c : cells) group[c] = count;
          ++count;
        }
      std::vector<double> area(count, 0), around(count, 0);
      std::map<std::uint32_t, std::map<std::uint32_t, double>> border;
      std::vector<std::uint32_t> some(count, 0);
      for (std::uint32_t c = 1; c < group.size(); ++c) {
        area[group[c]] += partition_.cells[c].area_m2;
        some[group[c]] = c;
      }
      for (const Partition::Edge& edge : partition_.edges) {
        const std::uint32_t s = group[edge.left], t = group[edge.right];
        if (s == t) continue;
        const double along = length(edge) / kGridStepsPerMetre;
        around[s] += along;
        around[t] += along;
        border[s][t] += along;
        border[t][s] += along;
      }
      bool changed = false;
      std::vector<char> fixed(count, 0);
      for (std::uint32_t g = 1; g < count; ++g) {
        if (fixed[g] || around[g] == 0 || 2 * area[g] / around[g] >= kSliver_m) continue;
        const auto longest =
            std::max_element(border[g].begin(), border[g].end(),
                             [](const auto& s, const auto& t) { return s.second < t.second; });
        const std::uint32_t to = longest->first;
        if (fixed[to]) continue;
        fixed[to] = fixed[g] = 1;
        const auto column = to == 0 ? std::nullopt : columns_[some[to]];
        for (std::uint32_t c = 1; c < group.size(); ++c)
          if (group[c] == g) columns_[c] = column;
        changed = true;
      }
      if (!changed) return;
    }
  }

  /// Connected cells with the same column, or (`solid` false) without one; the outside apart.
  std::vector<std::vector<std::uint32_t>> same_groups(bool solid) const {
    return groups([&](std::uint32_t c) { return columns_[c].has_value() == solid; },
                  [&](const Partition::Edge& edge) {
                    return edge.left != Partition::kOutside && edge.right != Partition::kOutside &&
                           columns_[edge.left] == columns_[edge.right];
                  });
  }

  void add_notch(const GridPoint2& p, std::int64_t half) {
    const GridPoint2 corner[4] = {{p.x - half, p.y - half},
                                  {p.x + half, p.y - half},
                                  {p.x + half, p.y + half},
                                  {p.x - half, p.y + half}};
    for (std::size_t i = 0; i < 4; ++i) lines_.push_back({corner[i], corner[(i + 1) % 4]});
    notches_.push_back({p, half});
  }

  /// Cells of a notch become like the lowest of them.
  void cut_notches() {
    for (const auto& [p, half] : notches_) {
      std::vector<std::uint32_t> cells;
      std::optional<std::uint32_t> lowest;
      std::int64_t lowest_z = 0;
      for (std::uint32_t c = 1; c < partition_.cells.size(); ++c) {
        const GridPoint2& inside = partition_.cells[c].inside;
        if (std::abs(inside.x - p.x) >= half || std::abs(inside.y - p.y) >= half) continue;
        cells.push_back(c);
        const std::int64_t z = columns_[c] ? z_at(columns_[c]->top, p) : -kGridLimit;
        if (lowest && z >= lowest_z) continue;
        lowest = c;
        lowest_z = z;
      }
      for (const std::uint32_t c : cells) columns_[c] = columns_[*lowest];
    }
  }

  const Shell input_;
  const RunContext& context_;
  std::int64_t tolerance_;

  std::vector<FaceRole> roles_;  ///< by face
  std::vector<double> up_;       ///< by level: z of the normal
  std::vector<Level> levels_;
  std::vector<LevelFace> looks_;  ///< by level
  std::vector<std::uint32_t> vertical_;
  std::vector<PartitionLine> lines_;
  bool walls_drawn_ = false;
  bool inside_out_ = false;

  Partition partition_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::int64_t> corner_z_;  ///< level, vertex
  std::vector<std::vector<Layer>> layers_;                                    ///< by cell
  std::vector<std::optional<std::uint32_t>> bottoms_, tops_;                  ///< by cell: level
  std::vector<std::vector<std::int64_t>> soundings_;                          ///< by vertex
  Columns columns_;
  struct Notch {
    GridPoint2 at{};
    std::int64_t half = 0;
  };
  std::vector<Notch> notches_;
};

}  // namespace

std::optional<Shell> rebuild_2_5d(const Shell& input, const ReconstructOptions& options,
                                  const RunContext& context) {
  return Rebuild(input, options, context).run();
}

}  // namespace citymesh
