#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <vector>

#include "core/base/text.h"
#include "core/citymodel/crs.h"

namespace citymesh {
namespace {

struct NamedCode {
  std::string_view name;
  int epsg;
};

// AdV GeoInfoDok names of the German surveys, horizontal part. Names of the Gauss-Krüger nets end
// in the net of a state ("_NW101"), which is left out here.
constexpr std::array kAdvHorizontal{
    NamedCode{"ETRS89_UTM31-zE", 5649},        NamedCode{"ETRS89_UTM32-zE", 4647},
    NamedCode{"DE_42-83_6GK2", 3834},          NamedCode{"DE_42-83_6GK3", 3835},
    NamedCode{"ETRS89_UTM33-zE", 5650},        NamedCode{"DE_PD-83_Lat-Lon", 4746},
    NamedCode{"DE_RD-83_Lat-Lon", 4745},       NamedCode{"DE_42-83_Lat-Lon", 4178},
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
    NamedCode{"DE_SNN76_NHN", 5785},    NamedCode{"DE_DHHN12_NHN", 7699},
    NamedCode{"DE_AMST_NH", 5709},      NamedCode{"DE_AMST_NOH", 5709},
};

// Names without a code that occur as srsName.
constexpr std::array kPlainNames{
    NamedCode{"CH1903", 21781},
    NamedCode{"CH1903_LV03", 21781},
    NamedCode{"CH1903+", 2056},
    NamedCode{"CH1903+_LV95", 2056},
    NamedCode{"DHDN_Soldner_Berlin", 3068},
};

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

template <std::size_t N>
std::optional<int> code_of(const std::array<NamedCode, N>& table, std::string_view name) {
  for (const auto& entry : table)
    if (lower(entry.name) == lower(name)) return entry.epsg;
  return std::nullopt;
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

// "DE_DHDN_3GK2" of "DE_DHDN_3GK2_NW101" or "DE_DHDN_3GK2_RDN".
std::string_view without_state_net(std::string_view name) {
  const auto net = after_last(name, '_');
  if (net.size() == name.size()) return name;
  const bool state = net.size() == 5 && std::isupper(static_cast<unsigned char>(net[0])) &&
                     std::isupper(static_cast<unsigned char>(net[1])) && is_code(net.substr(2));
  return state || net == "RDN" ? name.substr(0, name.size() - net.size() - 1) : name;
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

  // "urn:EPSG:geographicCRS:4326"
  if (starts("urn:epsg:") && small.find("crs:") != std::string::npos) {
    const auto code = after_last(name, ':');
    return is_code(code) ? compound(code, {}) : std::string{};
  }

  for (const std::string_view prefix :
       {"urn:ogc:def:crs:", "urn:x-ogc:def:crs:", "urn:opengis:def:crs:"}) {
    if (!starts(prefix)) continue;
    const auto rest = name.substr(prefix.size());
    if (const auto plus = rest.find('+'); plus != std::string_view::npos) {
      const auto horizontal = epsg_code(rest.substr(0, plus), ':');
      const auto below = rest.substr(plus + 1);
      const auto vertical = is_code(below) ? below : epsg_code(below, ':');
      return horizontal.empty() || vertical.empty() ? std::string{}
                                                    : compound(horizontal, vertical);
    }
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
    const auto horizontal = code_of(kAdvHorizontal, without_state_net(parts[0]));
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
    if (auto path = uri_path(name); !path.empty()) {
      while (path.ends_with('/')) path.remove_suffix(1);
      if (const auto code = epsg_code(path, '/'); !code.empty()) return compound(code, {});
      if (lower(after_last(path, '/')).rfind("crs84", 0) == 0) return "OGC:CRS84";
      return {};
    }
    if (small.find("/gml/srs/epsg.xml#") != std::string::npos)
      if (const auto code = after_last(name, '#'); is_code(code)) return compound(code, {});
  }
  return {};
}

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

}  // namespace citymesh
