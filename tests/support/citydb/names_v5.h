#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/source/feature.h"

namespace citymesh::citydb_support {

/// What version 5 calls what a city model has.

enum Namespace : std::int64_t { kCore = 1, kGen = 3, kCon = 8, kBldg = 10, kDepr = 18 };
enum DataType : std::int64_t {
  kInteger = 3,
  kDouble = 4,
  kString = 5,
  kTimestamp = 7,
  kAddress = 8,
  kFeature = 10,
  kGeometry = 11,
  kCode = 14,
  kMeasure = 17,
  kMeasureList = 18,
  kStringOrRef = 22,
  kGenericSet = 200,
  kHeight = 702,
};

int class_v5(ObjectKind kind);
/// 0: there is no class for it.
int class_v5(SurfaceType type);

struct PropertyName {
  std::string_view name{};
  Namespace space = kCore;
};

/// Attributes that are properties of the standard.
struct KnownAttribute {
  std::string_view name;
  PropertyName property;
  DataType type;
};

/// Null: it becomes a generic attribute.
const KnownAttribute* known_attribute(std::string_view name);

/// Of a stated geometry; no name when there is no property for it.
PropertyName geometry_name(const source::RawObject& object, const source::RawShape& shape,
                           bool citygml3);
/// Of the geometry of a boundary surface or an opening.
PropertyName surface_geometry_name(int lod);

/// "2.5 3" as a JSON list; texts that are no numbers stay texts.
std::string json_list(const std::string& text);

}  // namespace citymesh::citydb_support
