#include "core/citymodel/crs.h"

#include <proj.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/text.h"

namespace citymesh {
namespace {

// ---- spelling ----------------------------------------------------------------------------------

struct NamedCode {
  std::string_view name;
  int epsg;
};

// AdV GeoInfoDok names of the German surveys, horizontal part.
constexpr std::array kAdvHorizontal{
    NamedCode{"ETRS89_UTM31", 25831},          NamedCode{"ETRS89_UTM32", 25832},
    NamedCode{"ETRS89_UTM33", 25833},          NamedCode{"ETRS89_Lat-Lon", 4258},
    NamedCode{"ETRS89_Lat-Lon-h", 4937},       NamedCode{"DE_DHDN_3GK2", 31466},
    NamedCode{"DE_DHDN_3GK3", 31467},          NamedCode{"DE_DHDN_3GK4", 31468},
    NamedCode{"DE_DHDN_3GK5", 31469},          NamedCode{"DE_DHDN_Lat-Lon", 4314},
    NamedCode{"DE_PD-83_3GK3", 3396},          NamedCode{"DE_PD-83_3GK4", 3397},
    NamedCode{"DE_RD-83_3GK4", 3398},          NamedCode{"DE_RD-83_3GK5", 3399},
    NamedCode{"DE_42-83_3GK3", 2397},          NamedCode{"DE_42-83_3GK4", 2398},
    NamedCode{"DE_42-83_3GK5", 2399},          NamedCode{"DE_DHDN_Soldner-Berlin", 3068},
    NamedCode{"DE_DHDN_SOLDNER-BERLIN", 3068}, NamedCode{"DE_Soldner-Berlin", 3068},
};

// AdV names, vertical part. Both DE_DHHN92_NH and DE_DHN92_NH occur in files.
constexpr std::array kAdvVertical{
    NamedCode{"DE_DHHN12_NN", 7699},    NamedCode{"DE_DHHN12_NOH", 7699},
    NamedCode{"DE_DHHN85_NN", 5784},    NamedCode{"DE_DHHN85_NOH", 5784},
    NamedCode{"DE_DHHN92_NH", 5783},    NamedCode{"DE_DHHN92_NHN", 5783},
    NamedCode{"DE_DHN92_NH", 5783},     NamedCode{"DE_DHHN2016_NH", 7837},
    NamedCode{"DE_DHHN2016_NHN", 7837}, NamedCode{"DE_SNN76_NH", 5785},
    NamedCode{"DE_SNN76_NHN", 5785},
};

// Names without a code that occur as srsName.
constexpr std::array kPlainNames{
    NamedCode{"CH1903", 21781},
    NamedCode{"CH1903_LV03", 21781},
    NamedCode{"CH1903+", 2056},
    NamedCode{"CH1903+_LV95", 2056},
    NamedCode{"DHDN_Soldner_Berlin", 3068},
};

template <std::size_t N>
std::optional<int> code_of(const std::array<NamedCode, N>& table, std::string_view name) {
  for (const auto& entry : table)
    if (entry.name == name) return entry.epsg;
  return std::nullopt;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

bool is_code(std::string_view text) {
  return !text.empty() && text.size() <= 9 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

std::string_view after_last(std::string_view text, char separator) {
  const auto at = text.rfind(separator);
  return at == std::string_view::npos ? text : text.substr(at + 1);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

// "EPSG:6.12:3068", "epsg::3068", "EPSG/0/3068" -> "3068"; "" when the authority is another one.
std::string_view epsg_code(std::string_view text, char separator) {
  const auto parts = split(text, separator);
  if (parts.size() < 2 || lower(parts.front()) != "epsg" || !is_code(parts.back())) return {};
  return parts.back();
}

std::string compound(std::string_view horizontal, std::string_view vertical) {
  std::string id = "EPSG:" + std::string(horizontal);
  if (!vertical.empty()) id += "+" + std::string(vertical);
  return id;
}

// What follows "…/def/crs/" in an OGC URI, or "" when it is none.
std::string_view uri_path(std::string_view uri) {
  constexpr std::string_view kMark = "/def/crs/";
  const auto at = uri.find(kMark);
  return at == std::string_view::npos ? std::string_view{} : uri.substr(at + kMark.size());
}

std::string id_of(std::string_view name) {
  const std::string small = lower(name);
  const auto starts = [&](std::string_view prefix) { return small.rfind(prefix, 0) == 0; };

  if (const auto code = code_of(kPlainNames, name)) return "EPSG:" + std::to_string(*code);
  if (is_code(name)) return "EPSG:" + std::string(name);
  if (name.front() == '#' || small.find("engineering") != std::string::npos || starts("local") ||
      starts("urn:ogc:def:crs:local"))
    return "LOCAL";
  if (small == "crs84" || small == "ogc:crs84" || small == "crs:84" || small == "crs84h" ||
      small == "ogc:crs84h")
    return "OGC:CRS84";

  if (starts("epsg:")) {
    const auto parts = split(name, '+');
    const auto horizontal = epsg_code(parts[0], ':');
    if (horizontal.empty() || parts.size() > 2) return {};
    if (parts.size() == 1) return compound(horizontal, {});
    const auto vertical = is_code(parts[1]) ? parts[1] : epsg_code(parts[1], ':');
    return vertical.empty() ? std::string{} : compound(horizontal, vertical);
  }

  for (const std::string_view prefix : {"urn:ogc:def:crs:", "urn:x-ogc:def:crs:"}) {
    if (!starts(prefix)) continue;
    const auto rest = name.substr(prefix.size());
    if (const auto code = epsg_code(rest, ':'); !code.empty()) return compound(code, {});
    if (starts(std::string(prefix) + "ogc:") && lower(after_last(rest, ':')).rfind("crs84", 0) == 0)
      return "OGC:CRS84";
    return {};
  }

  if (starts("urn:ogc:def:crs,") || starts("urn:x-ogc:def:crs,")) {
    const auto parts = split(name, ',');  // urn:ogc:def:crs , crs:EPSG::h , crs:EPSG::v
    if (parts.size() < 2 || parts.size() > 3) return {};
    std::array<std::string_view, 2> codes{};
    for (std::size_t i = 1; i < parts.size(); ++i) {
      if (lower(parts[i].substr(0, 4)) != "crs:") return {};
      codes[i - 1] = epsg_code(parts[i].substr(4), ':');
      if (codes[i - 1].empty()) return {};
    }
    return compound(codes[0], codes[1]);
  }

  if (starts("urn:adv:crs:")) {
    const auto parts = split(name.substr(std::string_view("urn:adv:crs:").size()), '*');
    const auto horizontal = code_of(kAdvHorizontal, parts[0]);
    if (!horizontal) return {};
    if (parts.size() == 1) return compound(std::to_string(*horizontal), {});
    const auto vertical = code_of(kAdvVertical, parts[1]);  // a third part names the geoid model
    return vertical ? compound(std::to_string(*horizontal), std::to_string(*vertical))
                    : std::string{};
  }

  if (starts("http://") || starts("https://")) {
    if (const auto query = small.find("/def/crs-compound?"); query != std::string::npos) {
      std::array<std::string_view, 2> codes{};
      for (const auto part : split(name.substr(name.find('?') + 1), '&')) {
        const auto path = uri_path(part);
        const auto code = epsg_code(path, '/');
        if (code.empty()) return {};
        if (part.rfind("1=", 0) == 0) codes[0] = code;
        if (part.rfind("2=", 0) == 0) codes[1] = code;
      }
      return codes[0].empty() ? std::string{} : compound(codes[0], codes[1]);
    }
    if (const auto path = uri_path(name); !path.empty()) {
      if (const auto code = epsg_code(path, '/'); !code.empty()) return compound(code, {});
      if (lower(after_last(path, '/')).rfind("crs84", 0) == 0) return "OGC:CRS84";
      return {};
    }
    if (small.find("/gml/srs/epsg.xml#") != std::string::npos)
      if (const auto code = after_last(name, '#'); is_code(code)) return compound(code, {});
  }
  return {};
}

// ---- PROJ --------------------------------------------------------------------------------------

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

CrsFacts facts_of(PJ_CONTEXT* context, PJ* crs) {
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
    UtmSeries{"JGD2011", 6688 - 51, 51, 55, false}, UtmSeries{"JGD2000", 3097 - 51, 51, 55, false},
    UtmSeries{"ETRS89", 25800, 28, 38, false},      UtmSeries{"WGS 84", 32600, 1, 60, false},
    UtmSeries{"WGS 84", 32700, 1, 60, true},        UtmSeries{"NAD83", 26900, 1, 23, false},
    UtmSeries{"GDA2020", 7846 - 46, 46, 59, true},  UtmSeries{"GDA94", 28300, 46, 59, true},
};

}  // namespace

Result<Crs> parse_crs(std::string_view srs_name) {
  const auto name = trimmed(srs_name);
  if (name.empty()) return Crs{};
  std::string id = id_of(name);
  if (id.empty())
    return fail(ErrorCode::InvalidArgument,
                "CRS name '" + std::string(name.substr(0, 200)) +
                    "' is not understood, expected for example EPSG:25833, "
                    "urn:ogc:def:crs:EPSG::25833 or urn:adv:crs:ETRS89_UTM33*DE_DHHN2016_NH");
  return Crs{std::move(id)};
}

Result<CrsFacts> describe_crs(const Crs& crs) {
  const Context context = new_context();
  const Pj object = create_horizontal(context.get(), crs);
  if (!object) return unknown_crs(crs);
  return facts_of(context.get(), object.get());
}

Result<Crs> working_crs(const Crs& crs, const Point3& centre_deg) {
  if (!crs.known()) return crs;
  const Context context = new_context();
  const Pj object = create_horizontal(context.get(), crs);
  if (!object) return unknown_crs(crs);
  const CrsFacts facts = facts_of(context.get(), object.get());
  if (!facts.geographic) {
    if (facts.horizontal_unit_m == 1.0) return crs;
    return fail(ErrorCode::InvalidArgument,
                "CRS '" + crs.id + "' (" + facts.name + ") has axes in units of " +
                    std::to_string(facts.horizontal_unit_m) +
                    " m, expected a projected CRS in metres: name one with `crs`");
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
    if (facts.name.rfind(series.datum, 0) != 0 || series.south != south) continue;
    if (zone < series.first_zone || zone > series.last_zone) continue;
    return Crs{"EPSG:" + std::to_string(series.base + zone)};
  }
  return fail(ErrorCode::InvalidArgument,
              "no UTM zone of the datum of '" + crs.id + "' (" + facts.name + ") at longitude " +
                  std::to_string(centre_deg.x) + ", latitude " + std::to_string(centre_deg.y) +
                  " is known here: name a projected CRS in metres with `crs`");
}

struct Transformer::Impl {
  Context context{};
  Pj operation{};  ///< none: identity
  std::string from{}, to{};
};

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
  if (proj_is_equivalent_to_with_ctx(context, source.get(), target.get(),
                                     PJ_COMP_EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS))
    return Transformer(std::move(impl));

  const Pj raw(
      proj_create_crs_to_crs_from_pj(context, source.get(), target.get(), nullptr, nullptr));
  if (raw) impl->operation.reset(proj_normalize_for_visualization(context, raw.get()));
  if (!impl->operation)
    return fail(ErrorCode::InvalidArgument,
                "PROJ knows no transformation from '" + from.id + "' to '" + to.id + "'");
  return Transformer(std::move(impl));
}

bool Transformer::is_identity() const { return !impl_->operation; }

Result<void> Transformer::apply(std::span<Point3> points) const {
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
