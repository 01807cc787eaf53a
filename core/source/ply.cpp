#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/base/text.h"
#include "core/source/soup.h"
#include "core/source/soup_readers.h"

namespace citymesh::source {
namespace {

enum class Scalar : std::uint8_t { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

struct ScalarName {
  std::string_view name;
  Scalar type;
};
constexpr std::array<ScalarName, 16> kScalarNames{{{"char", Scalar::Int8},
                                                   {"int8", Scalar::Int8},
                                                   {"uchar", Scalar::Uint8},
                                                   {"uint8", Scalar::Uint8},
                                                   {"short", Scalar::Int16},
                                                   {"int16", Scalar::Int16},
                                                   {"ushort", Scalar::Uint16},
                                                   {"uint16", Scalar::Uint16},
                                                   {"int", Scalar::Int32},
                                                   {"int32", Scalar::Int32},
                                                   {"uint", Scalar::Uint32},
                                                   {"uint32", Scalar::Uint32},
                                                   {"float", Scalar::Float32},
                                                   {"float32", Scalar::Float32},
                                                   {"double", Scalar::Float64},
                                                   {"float64", Scalar::Float64}}};

std::optional<Scalar> scalar_from(std::string_view name) {
  for (const ScalarName& known : kScalarNames)
    if (known.name == name) return known.type;
  return std::nullopt;
}

std::size_t size_of(Scalar type) {
  switch (type) {
    case Scalar::Int8:
    case Scalar::Uint8:
      return 1;
    case Scalar::Int16:
    case Scalar::Uint16:
      return 2;
    case Scalar::Int32:
    case Scalar::Uint32:
    case Scalar::Float32:
      return 4;
    case Scalar::Float64:
      return 8;
  }
  return 0;
}

/// Every value of the format is exact in a double.
double value_of(Scalar type, std::uint64_t bits) {
  switch (type) {
    case Scalar::Int8:
      return static_cast<std::int8_t>(bits);
    case Scalar::Int16:
      return static_cast<std::int16_t>(bits);
    case Scalar::Int32:
      return static_cast<std::int32_t>(bits);
    case Scalar::Float32:
      return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    case Scalar::Float64:
      return std::bit_cast<double>(bits);
    default:
      return static_cast<double>(bits);
  }
}

/// What becomes of the values of a property.
enum class Role : std::uint8_t { Unused, X, Y, Z, Corners, Body, Surface };

struct Property {
  Scalar type = Scalar::Int32;
  std::optional<Scalar> count_type{};  ///< of a list
  Role role = Role::Unused;
};

enum class ElementKind : std::uint8_t { Other, Vertex, Face };

struct Element {
  std::string name{};
  std::uint64_t count = 0;
  ElementKind kind = ElementKind::Other;
  std::vector<Property> properties{};
};

class PlyReader {
 public:
  PlyReader(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts)
      : input_(bytes, options.limits.max_building_bytes),
        options_(options),
        facts_(facts),
        soup_(options) {}

  Result<void> read(const FeatureSink& sink) {
    facts_.format = "PLY";
    if (!read_header()) return {};
    facts_.format = text_ ? "PLY (text)" : "PLY (binary)";
    for (const Element& element : elements_) {
      if (element.properties.empty()) continue;
      for (std::uint64_t i = 0; i < element.count; ++i) {
        if (options_.stop.stop_requested()) return reading_stopped();
        if (!read_one(element)) {
          fail_here("in " + element.name + " " + std::to_string(i) + " of " +
                    std::to_string(element.count) + ": " + problem_);
          return {};
        }
        if (soup_.point_count() > options_.limits.max_points_per_building)
          return soup_.deliver_too_large(sink);
      }
    }
    return soup_.deliver(GeometryType::MultiSurface, sink);
  }

 private:
  bool fail_here(const std::string& what) {
    if (text_)
      fail_at_line(facts_, input_.line(), what);
    else
      fail_reading(facts_, "byte " + std::to_string(input_.offset()) + ": " + what);
    return false;
  }

  // ---- header ----------------------------------------------------------------------------------

  bool read_header() {
    constexpr std::size_t kMaxElements = 1000;
    bool format_seen = false;
    while (elements_.size() <= kMaxElements) {
      const auto more = input_.next_line(line_);
      if (!more) return fail_here(more.error().message);
      if (!*more) return fail_here("the file ends in its header");
      std::string_view rest = line_;
      const auto word = next_word(rest);
      if (input_.line() == 1) {
        if (word != "ply") return fail_here("expected 'ply'");
      } else if (word == "format") {
        if (!read_format(next_word(rest))) return false;
        format_seen = true;
      } else if (word == "element") {
        const auto name = next_word(rest);
        const auto count = number_from<std::uint64_t>(next_word(rest));
        if (name.empty() || !count) return fail_here("an element needs a name and a number");
        elements_.push_back({std::string(name), *count, kind_of(name)});
      } else if (word == "property") {
        if (!read_property(rest)) return false;
      } else if (word == "end_header") {
        rest_of_line_ = {};
        line_.clear();
        return format_seen ? check_elements() : fail_here("the format is missing");
      } else if (word == "comment") {
        read_comment(rest);
      } else if (!word.empty() && word != "obj_info") {
        return fail_here("'" + std::string(word.substr(0, 60)) + "' is unknown in a header");
      }
    }
    return fail_here("the header has more than " + std::to_string(kMaxElements) + " elements");
  }

  // Our own files name bodies and surface types in comments:
  //   comment surface_type 0 Unknown 1 GroundSurface …
  //   comment body {"body":0,"name":"house", …
  void read_comment(std::string_view rest) {
    const auto about = next_word(rest);
    if (about == "surface_type") {
      for (auto number = next_word(rest); !number.empty(); number = next_word(rest)) {
        const auto value = number_from<std::int64_t>(number);
        const auto type = surface_type_from(next_word(rest));
        if (value && type) types_.emplace(*value, *type);
      }
    } else if (about == "body") {
      constexpr std::string_view kNumber = "{\"body\":", kName = ",\"name\":\"";
      rest = trimmed(rest);
      if (!rest.starts_with(kNumber)) return;
      rest.remove_prefix(kNumber.size());
      const auto value = number_from<std::int64_t>(rest.substr(0, rest.find(',')));
      const auto name = rest.find(kName);
      if (!value || name == rest.npos) return;
      rest.remove_prefix(name + kName.size());
      names_.emplace(*value, rest.substr(0, rest.find('"')));
    }
  }

  bool read_format(std::string_view name) {
    in_binary_ = name != "ascii";
    big_endian_ = name == "binary_big_endian";
    return name == "ascii" || name == "binary_little_endian" || big_endian_ ||
           fail_here("format '" + std::string(name.substr(0, 60)) + "' is unknown");
  }

  static ElementKind kind_of(std::string_view name) {
    return name == "vertex" ? ElementKind::Vertex
           : name == "face" ? ElementKind::Face
                            : ElementKind::Other;
  }

  bool read_property(std::string_view rest) {
    constexpr std::size_t kMaxProperties = 1000;
    if (elements_.empty()) return fail_here("a property before the first element");
    Element& element = elements_.back();
    if (element.properties.size() == kMaxProperties) return fail_here("too many properties");
    auto type_name = next_word(rest);
    Property property;
    if (type_name == "list") {
      property.count_type = scalar_from(next_word(rest));
      if (!property.count_type || size_of(*property.count_type) > 4 ||
          *property.count_type == Scalar::Float32)
        return fail_here("a list needs a type of whole numbers for its length");
      type_name = next_word(rest);
    }
    const auto type = scalar_from(type_name);
    if (!type) return fail_here("type '" + std::string(type_name.substr(0, 60)) + "' is unknown");
    property.type = *type;
    property.role = role_of(element.kind, next_word(rest), property.count_type.has_value());
    element.properties.push_back(property);
    return true;
  }

  static Role role_of(ElementKind kind, std::string_view name, bool list) {
    if (kind == ElementKind::Vertex && !list)
      return name == "x" ? Role::X : name == "y" ? Role::Y : name == "z" ? Role::Z : Role::Unused;
    if (kind != ElementKind::Face) return Role::Unused;
    if (list)
      return name == "vertex_indices" || name == "vertex_index" ? Role::Corners : Role::Unused;
    return name == "body" ? Role::Body : name == "surface_type" ? Role::Surface : Role::Unused;
  }

  bool check_elements() {
    const auto has = [&](ElementKind kind, Role role) {
      return std::any_of(elements_.begin(), elements_.end(), [&](const Element& element) {
        return element.kind == kind &&
               std::any_of(element.properties.begin(), element.properties.end(),
                           [&](const Property& property) { return property.role == role; });
      });
    };
    for (const Role role : {Role::X, Role::Y, Role::Z})
      if (!has(ElementKind::Vertex, role)) return fail_here("vertices have no x, y and z");
    for (const Element& element : elements_)
      if (element.kind == ElementKind::Face && element.count > 0 &&
          !has(ElementKind::Face, Role::Corners))
        return fail_here("faces have no list vertex_indices");
    text_ = !in_binary_;
    return true;
  }

  // ---- elements --------------------------------------------------------------------------------

  std::optional<double> next_value(Scalar type) {
    if (!text_) {
      std::array<char, 8> bytes{};
      const std::size_t size = size_of(type);
      const auto taken = input_.take(bytes.data(), size);
      if (!taken || !*taken) {
        problem_ = taken ? "the file ends" : taken.error().message;
        return std::nullopt;
      }
      if (!big_endian_) std::reverse(bytes.begin(), bytes.begin() + static_cast<int>(size));
      std::uint64_t bits = 0;
      for (std::size_t i = 0; i < size; ++i)
        bits = bits << 8 | static_cast<unsigned char>(bytes[i]);
      return value_of(type, bits);
    }
    auto word = next_word(rest_of_line_);
    while (word.empty()) {
      const auto more = input_.next_line(line_);
      if (!more || !*more) {
        problem_ = more ? "the file ends" : more.error().message;
        return std::nullopt;
      }
      rest_of_line_ = line_;
      word = next_word(rest_of_line_);
    }
    const auto value = coordinate_from(word);
    if (!value) problem_ = "'" + std::string(word.substr(0, 60)) + "' is no number";
    return value;
  }

  /// Whole numbers come as whole numbers; anything else is no index.
  static std::int64_t whole(double value) {
    constexpr double kLimit = 4294967296.0;
    return std::abs(value) < kLimit && value == std::floor(value)
               ? static_cast<std::int64_t>(value)
               : std::numeric_limits<std::int64_t>::min();
  }

  bool read_one(const Element& element) {
    Point3 point{};
    corners_.clear();
    std::int64_t body = 0, surface = -1;
    for (const Property& property : element.properties) {
      std::uint64_t count = 1;
      if (property.count_type) {
        const auto length = next_value(*property.count_type);
        if (!length) return false;
        if (whole(*length) < 0) {
          problem_ = "a list has a length of " + std::to_string(*length);
          return false;
        }
        count = static_cast<std::uint64_t>(*length);
      }
      for (std::uint64_t i = 0; i < count; ++i) {
        const auto value = next_value(property.type);
        if (!value) return false;
        switch (property.role) {
          case Role::X:
            point.x = *value;
            break;
          case Role::Y:
            point.y = *value;
            break;
          case Role::Z:
            point.z = *value;
            break;
          case Role::Corners:
            // One more than the limit is enough to be refused.
            if (corners_.size() <= options_.limits.max_points_per_building)
              corners_.push_back(whole(*value));
            break;
          case Role::Body:
            body = whole(*value);
            break;
          case Role::Surface:
            surface = whole(*value);
            break;
          case Role::Unused:
            break;
        }
      }
    }
    if (element.kind == ElementKind::Vertex)
      soup_.add_point(point);
    else if (element.kind == ElementKind::Face)
      add_face(body, surface);
    return true;
  }

  void add_face(std::int64_t body, std::int64_t surface) {
    const auto known = buildings_.find(body);
    std::uint32_t building = 0;
    if (known != buildings_.end()) {
      building = known->second;
    } else {
      const auto name = names_.find(body);
      building = soup_.add_building(name == names_.end() ? std::string() : name->second);
      buildings_.emplace(body, building);
    }
    const auto type = types_.find(surface);
    soup_.begin_face(building, type == types_.end() ? std::nullopt : std::optional(type->second));
    for (const std::int64_t corner : corners_) soup_.add_corner(corner, corner);
  }

  Input input_;
  const DocumentOptions& options_;
  DocumentFacts& facts_;
  Soup soup_;
  bool text_ = true;  ///< what is read now; the header always is
  bool in_binary_ = false, big_endian_ = false;
  std::vector<Element> elements_{};
  std::string line_{};
  std::string_view rest_of_line_{};
  std::string problem_{};
  std::vector<std::int64_t> corners_{};
  std::unordered_map<std::int64_t, std::uint32_t> buildings_{};  ///< by body
  std::unordered_map<std::int64_t, std::string> names_{};        ///< by body
  std::unordered_map<std::int64_t, SurfaceType> types_{};
};

}  // namespace

Result<void> read_ply(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts,
                      const FeatureSink& sink) {
  return PlyReader(bytes, options, facts).read(sink);
}

}  // namespace citymesh::source
