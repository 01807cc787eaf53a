#include "core/source/plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <unordered_set>
#include <utility>

namespace citymesh::source {
namespace {

Point3 floored(const Point3& point) {
  return {std::floor(point.x), std::floor(point.y), std::floor(point.z)};
}

std::string spelt(const Crs& crs) { return crs.id.empty() ? "none stated" : crs.id; }

template <class Texts>
std::string joined(const Texts& texts) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : ", ") + text;
  return all;
}

// " (+NoiseBuilding 2, Bridge 1)"
std::string listed_types(const std::map<std::string, std::uint64_t>& types) {
  constexpr std::size_t kMaxTypes = 20;
  std::vector<std::string> entries;
  for (const auto& [name, count] : types) {
    if (entries.size() == kMaxTypes) break;
    entries.push_back(name + " " + std::to_string(count));
  }
  return entries.empty() ? "" : " (" + joined(entries) + ")";
}

bool overlap(const Box3& a, const Box3& b) {
  return a.min.x <= b.max.x && a.max.x >= b.min.x && a.min.y <= b.max.y && a.max.y >= b.min.y;
}

// Source text per triangle of the outer shells: the median of real files of LoD1 and LoD2. What
// CityGML spells out with element names and a point per line, JSON says with an index.
constexpr double kXmlBytesPerTriangle = 400, kOtherBytesPerTriangle = 60;
constexpr double kPackedTimes = 10;  // as much text as bytes in a .gz

/// Triangles that the selected buildings of a file will have, by the size of their text; none: that
/// is not known.
std::optional<double> expected_triangles(const Plan::File& file) {
  const FileRecord& record = *file.record;
  double bytes = 0;
  for (const BuildingRecord& building : file.selected) {
    if (building.bytes.known())
      bytes += static_cast<double>(building.bytes.end - building.bytes.begin);
    else if (record.stamp)
      bytes += static_cast<double>(record.stamp->bytes) / static_cast<double>(record.buildings) *
               (record.name.ends_with(".gz") ? kPackedTimes : 1);
    else
      return std::nullopt;
  }
  return bytes / (record.format == Format::CityGml ? kXmlBytesPerTriangle : kOtherBytesPerTriangle);
}

// Beyond any rounding of coordinates, in the unit of the file's axes.
constexpr double kBoxMargin = 1e-6;

class Planner {
 public:
  Planner(Catalogue& catalogue, const BuildingQuery& query, const Crs& assumed,
          const RunContext& context)
      : catalogue_(catalogue), query_(query), assumed_(assumed), context_(context) {}

  Result<Plan> make() {
    if (auto checked = check_query(); !checked) return checked.error();
    if (auto listed = list_files(); !listed) return listed.error();
    if (auto found = find_working_crs(); !found) return found.error();
    if (auto chosen = choose(); !chosen) return chosen.error();
    if (auto agreed = agree_on_crs(); !agreed) return agreed.error();
    if (auto placed = place_origin(); !placed) return placed.error();
    describe();
    return std::move(plan_);
  }

 private:
  /// Where buildings of one source CRS are worked on.
  struct Workplace {
    Crs crs{};
    std::optional<Error> problem{};
  };

  Result<void> list_files() {
    auto files = catalogue_.files(query_.bbox.has_value(), context_);
    if (!files) return files.error();
    for (auto& record : *files) {
      if (record->found_in_folder && record->facts.not_a_city_model) {
        passed_over_.push_back(record->name + " is no city model, passed over");
        continue;
      }
      auto srs = interpret_srs(*record, query_.source_crs.known() ? query_.source_crs : assumed_,
                               query_.axis_order, book_);
      plan_.files.push_back({std::move(record), std::move(srs), {}});
    }
    return {};
  }

  Result<void> check_query() {
    if (query_.crs.known()) {
      const auto& facts = book_.facts(query_.crs);
      if (!facts) return facts.error();
      if (facts->geographic || facts->horizontal_unit_m != 1.0)
        return fail(ErrorCode::InvalidArgument,
                    "crs '" + query_.crs.id + "' (" + facts->name +
                        ") is no projected CRS in metres, which the working CRS must be");
    }
    if (!query_.bbox) return {};
    const RequestBox& box = *query_.bbox;
    for (const double value : {box.min_x, box.min_y, box.max_x, box.max_y})
      if (!std::isfinite(value))
        return fail(ErrorCode::InvalidArgument,
                    "bbox has the value " + std::to_string(value) + ", expected finite numbers");
    if (box.min_x > box.max_x || box.min_y > box.max_y)
      return fail(ErrorCode::InvalidArgument, "bbox is empty: min_x " + std::to_string(box.min_x) +
                                                  ", max_x " + std::to_string(box.max_x) +
                                                  ", min_y " + std::to_string(box.min_y) +
                                                  ", max_y " + std::to_string(box.max_y) +
                                                  ", expected the minimum before the maximum");
    if (box.z_range_m && !((*box.z_range_m)[0] <= (*box.z_range_m)[1]))
      return fail(ErrorCode::InvalidArgument, "bbox is empty: its lowest z is above its highest");
    if (box.crs.known() && !book_.facts(box.crs)) return book_.facts(box.crs).error();
    return {};
  }

  // The declared extent of a file in its own CRS, x east; empty when it says nothing or something
  // that the buildings contradict.
  Box3 declared_extent(const Plan::File& file, std::uint32_t srs) const {
    const DocumentFacts& facts = file.record->facts;
    const bool about_it = facts.declared_srs == srs || facts.declared_srs == 0;
    if (!about_it || facts.declared_extent.is_empty()) return {};
    const Box3 box =
        file.srs[srs].swap_axes ? with_axes_swapped(facts.declared_extent) : facts.declared_extent;
    return overlap(box, file.srs[srs].extent) ? box : Box3{};
  }

  // A CRS with the heights of all sources, nothing where they differ.
  Crs common_heights(const std::map<std::string, Box3>& extents) {
    std::map<std::string, Crs> heights;  // by name
    for (const auto& [id, extent] : extents)
      if (const auto& facts = book_.facts(Crs{id})) heights.emplace(facts->vertical_name, Crs{id});
    return heights.size() == 1 ? heights.begin()->second : Crs{};
  }

  Result<void> find_working_crs() {
    std::map<std::string, Box3> extents;  // by source CRS
    for (const Plan::File& file : plan_.files)
      for (std::uint32_t s = 0; s < file.srs.size(); ++s) {
        const SrsUse& use = file.srs[s];
        if (!use.problem.empty() || use.extent.is_empty()) continue;
        const Box3 declared = declared_extent(file, s);
        extents[source_crs(use, query_).id].add(declared.is_empty() ? use.extent : declared);
      }
    for (const auto& [id, extent] : extents) {
      const Crs source{id};
      if (query_.crs.known()) {
        workplaces_[id].crs = with_vertical(query_.crs, common_heights(extents));
        continue;
      }
      const Point3 centre{(extent.min.x + extent.max.x) / 2, (extent.min.y + extent.max.y) / 2, 0};
      auto working = working_crs(source, centre);
      if (working)
        workplaces_[id].crs = *working;
      else
        workplaces_[id].problem = working.error();
    }
    return {};
  }

  // What the request wants in a working CRS.
  Result<const Area*> area_in(const Crs& working) {
    const auto known = areas_.find(working.id);
    if (known != areas_.end()) return &known->second;
    const RequestBox& box = *query_.bbox;
    const Transformer* transformer = nullptr;
    if (!box.crs.id.empty()) {
      const auto& found = book_.transformer(box.crs, working);
      if (!found) return found.error();
      transformer = &*found;
    }
    auto rings = rings_of(box, transformer);
    if (!rings) return rings.error();
    return &areas_.emplace(working.id, Area(*std::move(rings))).first->second;
  }

  Result<void> choose() {
    const std::unordered_set<std::string> wanted(query_.object_ids.begin(),
                                                 query_.object_ids.end());
    for (Plan::File& file : plan_.files) {
      RecordQuery records;
      records.with_footprints = query_.bbox.has_value();
      if (query_.bbox) {
        auto box = box_in(file);
        if (!box) return box.error();
        if (!*box && wanted.empty()) continue;
        records.box = *box;
      }
      if (!wanted.empty()) {  // also those outside of the box, to tell them from those that are not
                              // there
        records.ids = &wanted;
        records.box.reset();
      }
      auto chosen = catalogue_.buildings(
          *file.record, records,
          [&](const BuildingRecord& building) { return choose(file, building, wanted); });
      if (!chosen) return chosen;
    }
    if (!unplaced_.empty()) {
      const std::string text = joined(unplaced_) + (unplaced_.size() == 1 ? " states" : " state") +
                               " no CRS that a bbox in " + query_.bbox->crs.id +
                               " can be compared with";
      if (!placed_any_)
        return fail(ErrorCode::InvalidArgument,
                    text + ": name the CRS of the data with `crs`, for example crs=EPSG:25833");
      plan_.selection.warnings.push_back(text + "; left out, name their CRS with `crs`");
    }
    for (const std::string& id : query_.object_ids)
      if (!found_ids_.contains(id)) plan_.selection.missing_ids.push_back(id);
    return {};
  }

  Result<void> choose(Plan::File& file, const BuildingRecord& building,
                      const std::unordered_set<std::string>& wanted) {
    if (context_.stopped()) return fail(ErrorCode::Cancelled, "selecting was stopped");
    if (!wanted.empty()) {
      bool any = wanted.contains(building.gml_id);
      if (any) found_ids_.insert(building.gml_id);
      for (const std::string& part : building.part_ids)
        if (wanted.contains(part)) {
          found_ids_.insert(part);
          any = true;
        }
      if (!any) return {};
    }
    if (query_.bbox) {
      const SrsUse& use = file.srs[building.srs];
      const Workplace* place = workplace_of(use);
      if (building.extent.is_empty() || !place) return {};
      if (query_.bbox->crs.known() && !place->crs.known()) return {};
      placed_any_ = true;
      auto inside = is_inside(building, use, place->crs);
      if (!inside) return inside.error();
      if (!*inside) return {};
    }
    file.selected.push_back(building);
    file.selected.back().footprint = {};
    return {};
  }

  // Where buildings with this CRS name are worked on; null where they cannot be.
  const Workplace* workplace_of(const SrsUse& use) const {
    if (!use.problem.empty()) return nullptr;
    const auto place = workplaces_.find(source_crs(use, query_).id);
    return place == workplaces_.end() || place->second.problem ? nullptr : &place->second;
  }

  // The request's box as the coordinates of a file may meet it, a little too large rather than too
  // small; none: no building of the file can meet it.
  Result<std::optional<FlatBox>> box_in(const Plan::File& file) {
    Box3 whole;
    for (std::size_t s = 0; s < file.srs.size(); ++s) {
      const SrsUse& use = file.srs[s];
      const SrsExtent& extent = file.record->srs[s];
      const Workplace* place = workplace_of(use);
      if (!place || extent.buildings == 0) continue;
      if (query_.bbox->crs.known() && !place->crs.known()) {
        unplaced_.insert(file.record->name);
        continue;
      }
      placed_any_ = true;
      const auto area = area_in(place->crs);
      if (!area) return area.error();
      const Point2 &low = (*area)->min(), &high = (*area)->max();
      auto ring = densified_ring(low.x, low.y, high.x, high.y);
      const auto& back = book_.transformer(place->crs, source_crs(use, query_));
      Box3 box;
      if (back && back->apply(ring)) {
        for (const Point3& point : ring) box.add(point);
        const double margin =
            0.02 * std::max(box.max.x - box.min.x, box.max.y - box.min.y) + kBoxMargin;
        box.add(Point3{box.min.x - margin, box.min.y - margin, 0});
        box.add(Point3{box.max.x + margin, box.max.y + margin, 0});
        if (use.swap_axes) box = with_axes_swapped(box);
        if (!overlap(box, extent.all)) continue;
      } else {
        box = extent.all;
      }
      whole.add(box);
    }
    if (whole.is_empty()) return std::optional<FlatBox>{};
    return std::optional(FlatBox{{whole.min.x, whole.min.y}, {whole.max.x, whole.max.y}});
  }

  bool z_fits(Box3 extent, double unit_m) const {
    if (!query_.bbox->z_range_m) return true;
    const auto [low, high] = *query_.bbox->z_range_m;
    extent.min.z *= unit_m;
    extent.max.z *= unit_m;
    const double middle = (extent.min.z + extent.max.z) / 2;
    switch (query_.bbox_rule) {
      case BboxRule::Intersects:
        return extent.min.z <= high && extent.max.z >= low;
      case BboxRule::Centre:
        return middle >= low && middle <= high;
      case BboxRule::Within:
        return extent.min.z >= low && extent.max.z <= high;
    }
    return false;
  }

  Result<bool> is_inside(const BuildingRecord& building, const SrsUse& use, const Crs& working) {
    const Crs source = source_crs(use, query_);
    const auto& facts = book_.facts(source);
    if (!z_fits(building.extent, source.known() && facts ? facts->vertical_unit_m : 1.0))
      return false;
    const auto area = area_in(working);
    if (!area) return area.error();
    const auto& transformer = book_.transformer(source_crs(use, query_), working);
    if (!transformer) return transformer.error();

    // The envelope first: it decides most buildings.
    const Box3 box = use.swap_axes ? with_axes_swapped(building.extent) : building.extent;
    std::array<Point3, 4> corners{{{box.min.x, box.min.y, 0},
                                   {box.max.x, box.min.y, 0},
                                   {box.max.x, box.max.y, 0},
                                   {box.min.x, box.max.y, 0}}};
    if (!transformer->apply(corners)) return false;
    Box3 envelope;
    for (const Point3& corner : corners) envelope.add(corner);
    if (query_.bbox_rule == BboxRule::Centre)
      return (*area)->contains(
          {(envelope.min.x + envelope.max.x) / 2, (envelope.min.y + envelope.max.y) / 2});
    // A transformed side bends by far less than this.
    const double margin =
        0.01 * std::max(envelope.max.x - envelope.min.x, envelope.max.y - envelope.min.y);
    if (!(*area)->box_touches({envelope.min.x - margin, envelope.min.y - margin},
                              {envelope.max.x + margin, envelope.max.y + margin}))
      return false;
    return footprint_inside(building.footprint, use, *transformer, **area);
  }

  bool footprint_inside(const Footprints& footprint, const SrsUse& use,
                        const Transformer& transformer, const Area& area) {
    const std::span rings(footprint.rings);
    const bool within = query_.bbox_rule == BboxRule::Within;
    bool any = false;
    for (std::size_t r = 0; r < rings.size();) {
      std::size_t end = r + 1;
      while (end < rings.size() && !rings[end].exterior) ++end;
      std::vector<Footprints::Ring> polygon;
      points_.clear();
      for (std::size_t i = r; i < end; ++i) {
        polygon.push_back(
            {static_cast<std::uint32_t>(points_.size()), rings[i].count, rings[i].exterior});
        for (std::uint32_t p = 0; p < rings[i].count; ++p) {
          const Point2& point = footprint.points[rings[i].first + p];
          points_.push_back(use.swap_axes ? Point3{point.y, point.x, 0}
                                          : Point3{point.x, point.y, 0});
        }
      }
      r = end;
      if (!transformer.apply(points_)) continue;
      std::vector<Point2> flat;
      flat.reserve(points_.size());
      for (const Point3& point : points_) flat.push_back({point.x, point.y});
      if (within) {
        for (const Footprints::Ring& ring : polygon)
          if (!area.contains_sides(std::span(flat).subspan(ring.first, ring.count))) return false;
        any = true;
      } else if (area.touches(flat, polygon)) {
        return true;
      }
    }
    return within && any;
  }

  Result<void> agree_on_crs() {
    std::map<std::string, std::string> found;  // working CRS -> source CRS
    std::optional<Error> problem;
    for (const Plan::File& file : plan_.files)
      for (const BuildingRecord& building : file.selected) {
        const SrsUse& use = file.srs[building.srs];
        if (building.extent.is_empty() || !use.problem.empty()) continue;
        const auto place = workplaces_.find(source_crs(use, query_).id);
        if (place == workplaces_.end()) continue;
        if (place->second.problem && !problem) problem = place->second.problem;
        found.emplace(place->second.crs.id, spelt(use.crs));
      }
    if (problem) return *problem;
    if (found.size() > 1) {
      std::vector<std::string> names;
      names.reserve(found.size());
      for (const auto& [working, source] : found) names.push_back(source);
      return fail(ErrorCode::FailedPrecondition, "the selected buildings are in different CRSs (" +
                                                     joined(names) +
                                                     "): name the one to work in with `crs`");
    }
    if (found.size() == 1)
      plan_.selection.crs = Crs{found.begin()->first};
    else if (query_.crs.known())
      plan_.selection.crs = query_.crs;
    else if (!workplaces_.empty())
      plan_.selection.crs = workplaces_.begin()->second.crs;
    return {};
  }

  Result<void> place_origin() {
    const Crs& working = plan_.selection.crs;
    if (query_.bbox) {
      const RequestBox& box = *query_.bbox;
      std::array<Point3, 1> centre{{{(box.min_x + box.max_x) / 2, (box.min_y + box.max_y) / 2, 0}}};
      if (!box.crs.id.empty() && working.known()) {
        const auto& transformer = book_.transformer(box.crs, working);
        if (!transformer) return transformer.error();
        if (auto moved = transformer->apply(centre); !moved)
          return fail(ErrorCode::InvalidArgument, "bbox: " + moved.error().message);
      }
      plan_.selection.origin = floored({centre[0].x, centre[0].y, 0});
      return {};
    }

    Box3 whole;
    for (const Plan::File& file : plan_.files)
      for (std::uint32_t s = 0; s < file.srs.size(); ++s) {
        const SrsUse& use = file.srs[s];
        if (!use.problem.empty() || use.extent.is_empty()) continue;
        const auto place = workplaces_.find(source_crs(use, query_).id);
        if (place == workplaces_.end() || place->second.crs != working) continue;
        const Box3 declared = declared_extent(file, s);
        const Box3& box = declared.is_empty() ? use.extent : declared;
        const auto& transformer = book_.transformer(source_crs(use, query_), working);
        if (!transformer) return transformer.error();
        auto ring = densified_ring(box.min.x, box.min.y, box.max.x, box.max.y);
        for (Point3& point : ring) point.z = box.min.z;
        if (!transformer->apply(ring)) continue;
        for (const Point3& point : ring) whole.add(point);
      }
    if (!whole.is_empty()) plan_.selection.origin = floored(whole.min);
    return {};
  }

  void describe() {
    Selection& selection = plan_.selection;
    std::set<std::string> unstated, assumed, used;
    std::optional<double> triangles = 0.0;
    for (const Plan::File& file : plan_.files) {
      const auto of_file = expected_triangles(file);
      triangles = triangles && of_file ? std::optional(*triangles + *of_file) : std::nullopt;
      const FileRecord& record = *file.record;
      InputReport report{.file = record.name,
                         .format = record.facts.format,
                         .state = record.facts.failure.empty() ? "read" : "failed",
                         .message = record.facts.failure};
      report.buildings = record.buildings;
      std::set<std::string> crs_names, problems;
      for (std::size_t s = 0; s < file.srs.size(); ++s) {
        if (record.srs[s].buildings == 0) continue;
        const SrsUse& use = file.srs[s];
        if (!use.problem.empty()) {
          problems.insert(use.problem);
          continue;
        }
        if (!use.crs.id.empty()) crs_names.insert(use.crs.id);
        if (!use.crs.id.empty()) used.insert(use.crs.id);
        if (!use.crs.known()) (query_.crs.known() ? assumed : unstated).insert(record.name);
      }
      report.crs = joined(crs_names);
      for (const std::string& problem : problems)
        selection.warnings.push_back(record.name + ": " + problem);
      std::map<std::string, std::uint64_t> types = record.facts.skipped_types;
      if (const auto shared = types.extract(std::string(kSharedAddress)))
        selection.warnings.push_back(record.name + ": " + std::to_string(shared.mapped()) +
                                     " addresses by xlink:href were not read");
      if (record.facts.skipped_objects > 0)
        selection.warnings.push_back(
            record.name + ": " + std::to_string(record.facts.skipped_objects) +
            " objects of extension types were not read" + listed_types(types));
      selection.inputs.push_back(std::move(report));

      selection.buildings += file.selected.size();
      for (const BuildingRecord& building : file.selected) {
        selection.object_ids.push_back(building.gml_id);
        selection.object_ids.insert(selection.object_ids.end(), building.part_ids.begin(),
                                    building.part_ids.end());
      }
    }
    if (triangles) selection.expected_triangles = static_cast<std::uint64_t>(std::ceil(*triangles));
    selection.source_crs.assign(used.begin(), used.end());
    selection.warnings.insert(selection.warnings.end(), passed_over_.begin(), passed_over_.end());
    if (!unstated.empty())
      selection.warnings.push_back(joined(unstated) + ": no CRS stated, metres assumed");
    if (!assumed.empty())
      selection.warnings.push_back(joined(assumed) + ": no CRS stated, taken as " + query_.crs.id);
  }

  Catalogue& catalogue_;
  const BuildingQuery& query_;
  const Crs& assumed_;
  const RunContext& context_;
  CrsBook book_{};
  Plan plan_{};
  std::map<std::string, Workplace> workplaces_{};  ///< by source CRS
  std::map<std::string, Area> areas_{};            ///< by working CRS
  std::vector<Point3> points_{};
  std::vector<std::string> passed_over_{};
  std::set<std::string> unplaced_{};  ///< files whose buildings a box cannot be compared with
  std::unordered_set<std::string> found_ids_{};
  bool placed_any_ = false;
};

}  // namespace

Crs source_crs(const SrsUse& use, const BuildingQuery& query) {
  return use.crs.known() || !query.crs.known() ? use.crs : query.crs;
}

Result<Plan> make_plan(Catalogue& catalogue, const BuildingQuery& query, const Crs& assumed_crs,
                       const RunContext& context) {
  return Planner(catalogue, query, assumed_crs, context).make();
}

}  // namespace citymesh::source
