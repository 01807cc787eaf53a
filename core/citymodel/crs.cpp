#include "core/citymodel/crs.h"

#include <proj.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace citymesh {
namespace {

struct ContextDeleter {
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
};
struct PjDeleter {
  void operator()(PJ* object) const { proj_destroy(object); }
};
using Context = std::unique_ptr<PJ_CONTEXT, ContextDeleter>;
using Pj = std::unique_ptr<PJ, PjDeleter>;

// No network: the same answer everywhere. No log: the core is silent.
Context new_context() {
  Context context(proj_context_create());
  proj_context_set_enable_network(context.get(), 0);
  proj_log_level(context.get(), PJ_LOG_NONE);
  return context;
}

Error unknown_crs(const Crs& crs) {
  return fail(ErrorCode::InvalidArgument,
              "CRS '" + crs.id + "' is not known to PROJ, expected for example EPSG:25833");
}

// The horizontal part: heights are never transformed.
Pj create_horizontal(PJ_CONTEXT* context, const Crs& crs) {
  if (!crs.known()) return nullptr;
  Pj whole(proj_create(context, crs.id.c_str()));
  if (!whole || !proj_is_crs(whole.get())) return nullptr;
  if (proj_get_type(whole.get()) != PJ_TYPE_COMPOUND_CRS) return whole;
  return Pj(proj_crs_get_sub_crs(context, whole.get(), 0));
}

// The heights of a compound CRS; none where none are stated.
Pj create_vertical(PJ_CONTEXT* context, const Crs& crs) {
  if (!crs.known()) return nullptr;
  const Pj whole(proj_create(context, crs.id.c_str()));
  if (!whole || proj_get_type(whole.get()) != PJ_TYPE_COMPOUND_CRS) return nullptr;
  return Pj(proj_crs_get_sub_crs(context, whole.get(), 1));
}

// "5703" of a CRS of EPSG, "" of another one.
std::string epsg_code_of(const PJ* crs) {
  const char* authority = crs ? proj_get_id_auth_name(crs, 0) : nullptr;
  if (!authority || std::string_view(authority) != "EPSG") return {};
  return proj_get_id_code(crs, 0);
}

// Metres in a unit of the axis; 1 where PROJ does not tell.
double unit_of_axis(PJ_CONTEXT* context, const PJ* crs, int axis) {
  const Pj axes(proj_crs_get_coordinate_system(context, crs));
  double unit = 1.0;
  if (!axes || axis >= proj_cs_get_axis_count(context, axes.get()) ||
      !proj_cs_get_axis_info(context, axes.get(), axis, nullptr, nullptr, nullptr, &unit, nullptr,
                             nullptr, nullptr))
    return 1.0;
  return unit;
}

// Below a bound CRS ("+towgs84") lies the CRS that has the axes.
bool is_geographic(PJ_CONTEXT* context, const PJ* crs) {
  switch (proj_get_type(crs)) {
    case PJ_TYPE_GEOGRAPHIC_2D_CRS:
    case PJ_TYPE_GEOGRAPHIC_3D_CRS:
      return true;
    case PJ_TYPE_BOUND_CRS: {
      const Pj source(proj_get_source_crs(context, crs));
      return source && is_geographic(context, source.get());
    }
    default:
      return false;
  }
}

CrsFacts facts_of(PJ_CONTEXT* context, PJ* crs, const PJ* vertical) {
  CrsFacts facts;
  facts.name = proj_get_name(crs);
  facts.geographic = is_geographic(context, crs);

  const Pj axes(proj_crs_get_coordinate_system(context, crs));
  const char* direction = nullptr;
  double unit_factor = 1.0;
  if (axes && proj_cs_get_axis_info(context, axes.get(), 0, nullptr, nullptr, &direction,
                                    &unit_factor, nullptr, nullptr, nullptr)) {
    facts.north_first = direction && std::string_view(direction) == "north";
    if (!facts.geographic) facts.horizontal_unit_m = unit_factor;
  }

  constexpr int kHeightAxis = 2;
  if (vertical) {
    facts.vertical_name = proj_get_name(vertical);
    facts.vertical_unit_m = unit_of_axis(context, vertical, 0);
  } else if (axes && proj_cs_get_axis_count(context, axes.get()) > kHeightAxis) {
    facts.vertical_name = "ellipsoidal height";
    facts.vertical_unit_m = unit_of_axis(context, crs, kHeightAxis);
  } else {
    facts.vertical_unit_m = facts.horizontal_unit_m;
  }

  double west = 0, south = 0, east = 0, north = 0;
  constexpr double kUnknown = -1000;
  if (proj_get_area_of_use(context, crs, &west, &south, &east, &north, nullptr) &&
      west != kUnknown) {
    if (east < west) east += 360.0;  // across the date line
    facts.area_of_use_deg.add(Point3{west, south, 0});
    facts.area_of_use_deg.add(Point3{east, north, 0});
  }
  return facts;
}

// UTM zones by datum: EPSG code of zone z is base + z.
struct UtmSeries {
  std::string_view datum;  ///< how the name of the geographic CRS starts
  int base;
  int first_zone, last_zone;
  bool south;
};

constexpr std::array kUtmSeries{
    UtmSeries{"JGD2011", 6688 - 51, 51, 55, false},
    UtmSeries{"JGD2000", 3097 - 51, 51, 55, false},
    UtmSeries{"ETRS89", 25800, 28, 38, false},
    UtmSeries{"WGS 84", 32600, 1, 60, false},
    UtmSeries{"WGS 84", 32700, 1, 60, true},
    UtmSeries{"NAD83", 26900, 1, 23, false},
    UtmSeries{"NAD83(2011)", 6329, 1, 19, false},
    UtmSeries{"NAD83(NSRS2007)", 3707, 1, 19, false},
    UtmSeries{"NAD83(HARN)", 3730, 10, 19, false},
    UtmSeries{"NAD27", 26700, 1, 22, false},
    UtmSeries{"GDA2020", 7846 - 46, 46, 59, true},
    UtmSeries{"GDA94", 28300, 46, 59, true},
    UtmSeries{"SIRGAS 2000", 31954, 11, 22, false},
    UtmSeries{"SIRGAS 2000", 31960, 17, 25, true},
};

// "WGS 84 (G1762)" is WGS 84, "NAD83(2011)" is another datum than NAD83.
bool is_of_datum(std::string_view name, std::string_view datum) {
  return name.starts_with(datum) && (name.size() == datum.size() || name[datum.size()] != '(');
}

// Heights in feet have a twin in metres; the others are not named any more.
constexpr std::array kHeightsInMetres{
    std::pair<std::string_view, std::string_view>{"6360", "5703"},  // NAVD88 (ftUS)
    std::pair<std::string_view, std::string_view>{"8228", "5703"},  // NAVD88 (ft)
};

// The working CRS as an id: heights keep their CRS as they are not shifted.
std::string with_heights_of(const std::string& horizontal, PJ_CONTEXT* context,
                            const PJ* vertical) {
  std::string code = epsg_code_of(vertical);
  if (code.empty()) return horizontal;
  if (unit_of_axis(context, vertical, 0) != 1.0) {
    const auto twin = std::find_if(kHeightsInMetres.begin(), kHeightsInMetres.end(),
                                   [&](const auto& entry) { return entry.first == code; });
    if (twin == kHeightsInMetres.end()) return horizontal;
    code = twin->second;
  }
  return horizontal + "+" + code;
}

}  // namespace

Result<CrsFacts> describe_crs(const Crs& crs) {
  const Context context = new_context();
  const Pj object = create_horizontal(context.get(), crs);
  if (!object) return unknown_crs(crs);
  const Pj vertical = create_vertical(context.get(), crs);
  return facts_of(context.get(), object.get(), vertical.get());
}

Result<Crs> working_crs(const Crs& crs, const Point3& centre) {
  if (!crs.known()) return crs;
  const Context context = new_context();
  const Pj object = create_horizontal(context.get(), crs);
  if (!object) return unknown_crs(crs);
  const Pj vertical = create_vertical(context.get(), crs);
  const CrsFacts facts = facts_of(context.get(), object.get(), vertical.get());
  Point3 centre_deg = centre;
  std::string datum = facts.name;
  if (!facts.geographic) {
    if (facts.horizontal_unit_m == 1.0) {
      if (facts.vertical_unit_m == 1.0) return crs;
      return Crs{
          with_heights_of("EPSG:" + epsg_code_of(object.get()), context.get(), vertical.get())};
    }
    const Pj geographic(proj_crs_get_geodetic_crs(context.get(), object.get()));
    if (geographic) datum = proj_get_name(geographic.get());
    auto to_degrees = Transformer::create(crs, Crs{"OGC:CRS84"});
    if (!to_degrees) return to_degrees.error();
    if (auto moved = to_degrees->apply(std::span(&centre_deg, 1)); !moved) return moved.error();
  }

  if (!std::isfinite(centre_deg.x) || !std::isfinite(centre_deg.y) ||
      std::abs(centre_deg.x) > 360 || std::abs(centre_deg.y) > 90)
    return fail(ErrorCode::InvalidArgument,
                "no UTM zone for longitude " + std::to_string(centre_deg.x) + ", latitude " +
                    std::to_string(centre_deg.y) + ", expected degrees");
  const double turned = std::fmod(centre_deg.x + 180.0 + 720.0, 360.0);
  const int zone = std::min(60, static_cast<int>(turned / 6.0) + 1);
  const bool south = centre_deg.y < 0;
  for (const UtmSeries& series : kUtmSeries) {
    if (!is_of_datum(datum, series.datum) || series.south != south) continue;
    if (zone < series.first_zone || zone > series.last_zone) continue;
    return Crs{with_heights_of("EPSG:" + std::to_string(series.base + zone), context.get(),
                               vertical.get())};
  }
  return fail(ErrorCode::InvalidArgument,
              "no UTM zone of the datum of '" + crs.id + "' (" + facts.name + ") at longitude " +
                  std::to_string(centre_deg.x) + ", latitude " + std::to_string(centre_deg.y) +
                  " is known here: name a projected CRS in metres with `crs`");
}

Crs with_vertical(const Crs& crs, const Crs& heights) {
  if (!crs.known() || crs.id.find('+') != std::string::npos) return crs;
  const Context context = new_context();
  if (create_vertical(context.get(), crs)) return crs;  // a compound CRS with a code of its own
  const Pj vertical = create_vertical(context.get(), heights);
  return Crs{with_heights_of(crs.id, context.get(), vertical.get())};
}

struct Transformer::Impl {
  Context context{};
  Pj operation{};  ///< none: x and y stay
  double z_factor = 1.0;
  std::string from{}, to{};
};

namespace {

// x east and y north on both sides.
Pj create_operation(PJ_CONTEXT* context, const PJ* source, const PJ* target) {
  const Pj raw(proj_create_crs_to_crs_from_pj(context, source, target, nullptr, nullptr));
  return raw ? Pj(proj_normalize_for_visualization(context, raw.get())) : nullptr;
}

template <class Impl>
Error no_transformation(const Impl& impl) {
  return fail(ErrorCode::InvalidArgument,
              "PROJ knows no transformation from '" + impl.from + "' to '" + impl.to + "'");
}

}  // namespace

Transformer::Transformer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Transformer::Transformer(Transformer&&) noexcept = default;
Transformer& Transformer::operator=(Transformer&&) noexcept = default;
Transformer::~Transformer() = default;

Result<Transformer> Transformer::create(const Crs& from, const Crs& to) {
  auto impl = std::make_unique<Impl>();
  impl->from = from.id;
  impl->to = to.id;
  if (from == to) return Transformer(std::move(impl));

  impl->context = new_context();
  PJ_CONTEXT* context = impl->context.get();
  const Pj source = create_horizontal(context, from);
  if (!source) return unknown_crs(from);
  const Pj target = create_horizontal(context, to);
  if (!target) return unknown_crs(to);
  const auto height_unit_m = [&](const Crs& crs, PJ* horizontal) {
    const Pj vertical = create_vertical(context, crs);
    return facts_of(context, horizontal, vertical.get()).vertical_unit_m;
  };
  impl->z_factor = height_unit_m(from, source.get()) / height_unit_m(to, target.get());
  if (proj_is_equivalent_to_with_ctx(context, source.get(), target.get(),
                                     PJ_COMP_EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS))
    return Transformer(std::move(impl));

  impl->operation = create_operation(context, source.get(), target.get());
  if (!impl->operation) return no_transformation(*impl);
  return Transformer(std::move(impl));
}

Result<Transformer> Transformer::to_degrees(const Crs& from) {
  auto impl = std::make_unique<Impl>();
  impl->from = from.id;
  impl->to = "its geographic CRS";
  impl->context = new_context();
  PJ_CONTEXT* context = impl->context.get();
  const Pj source = create_horizontal(context, from);
  if (!source) return unknown_crs(from);
  const Pj target(proj_crs_get_geodetic_crs(context, source.get()));
  if (target) impl->operation = create_operation(context, source.get(), target.get());
  if (!impl->operation) return no_transformation(*impl);
  return Transformer(std::move(impl));
}

bool Transformer::is_identity() const { return !impl_->operation && impl_->z_factor == 1.0; }

Result<void> Transformer::apply(std::span<Point3> points) const {
  if (impl_->z_factor != 1.0)
    for (Point3& point : points) point.z *= impl_->z_factor;
  if (!impl_->operation) return {};
  for (Point3& point : points) {
    const PJ_COORD moved =
        proj_trans(impl_->operation.get(), PJ_FWD, proj_coord(point.x, point.y, 0.0, HUGE_VAL));
    if (!std::isfinite(moved.xy.x) || !std::isfinite(moved.xy.y))
      return fail(ErrorCode::InvalidArgument,
                  "coordinate " + std::to_string(point.x) + ", " + std::to_string(point.y) +
                      " cannot be transformed from '" + impl_->from + "' to '" + impl_->to + "'");
    point.x = moved.xy.x;
    point.y = moved.xy.y;
  }
  return {};
}

}  // namespace citymesh
