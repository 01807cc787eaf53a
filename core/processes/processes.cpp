#include <array>
#include <vector>

#include "core/processes/processes.h"
#include "core/write/write.h"

namespace citymesh {
namespace {

constexpr std::array<std::string_view, 3> kBboxRules{"intersects", "centre", "within"};
constexpr std::array<std::string_view, 3> kAxisOrders{"auto", "east_north", "north_east"};
constexpr std::array<std::string_view, 2> kInstallations{"drop", "keep"};
constexpr std::array<std::string_view, 2> kOnFailure{"block", "drop"};
constexpr std::array<std::string_view, 2> kPatches{"by_object", "by_type"};
constexpr std::array<std::string_view, 2> kParts{"keep", "merge"};
constexpr std::array<std::string_view, 2> kModes{"run", "estimate"};

constexpr OptionSpec kBbox{
    "bbox", OptionKind::BoundingBox, "null",
    "Box to export: {\"bbox\": [minx, miny, maxx, maxy], \"crs\": uri}, axis order of the named "
    "CRS, CRS84 when none is named. Everything when absent."};
constexpr OptionSpec kPolygon{
    "polygon", OptionKind::Polygon, "null",
    "Region to export instead of a box: a GeoJSON Polygon or MultiPolygon, in CRS84 unless "
    "`coordRefSys` names another CRS, then in its axis order. `bbox_rule` applies."};
constexpr OptionSpec kBboxRule{
    "bbox_rule", OptionKind::Text, "\"intersects\"",
    "Which buildings belong to the box or polygon: the footprint touches it, the centre of the "
    "envelope lies in it, or the whole footprint lies in it.",
    kBboxRules};
constexpr OptionSpec kObjectIds{
    "object_ids", OptionKind::TextList, "[]",
    "gml_id of the buildings wanted; with a box, both must hold. Empty: all."};
constexpr OptionSpec kCrs{
    "crs", OptionKind::Text, "\"\"",
    "Working CRS of the result, for example EPSG:25833. Empty: that of the source; sources in "
    "degrees or feet go to the UTM zone of the same datum."};
constexpr OptionSpec kSourceCrs{
    "source_crs", OptionKind::Text, "\"\"",
    "CRS of inputs that state none, for example EPSG:28992; a stated one is never replaced."};
constexpr OptionSpec kAxisOrder{
    "axis_order", OptionKind::Text, "\"auto\"",
    "Order in which the inputs store coordinates. auto: latitude first for geographic CRSs, east "
    "first for projected ones, the other way round where only that lies in the area of use.",
    kAxisOrders};
constexpr OptionSpec kLod{
    "lod", OptionKind::TextList, "[\"2\",\"3\",\"1\",\"0\"]",
    "Levels of detail in order of preference; \"2\" means the highest 2.x there is."};
constexpr OptionSpec kInstallation{
    "installations", OptionKind::Text, "\"drop\"",
    "Building installations: left out and counted, or kept as bodies of their own.",
    kInstallations};
constexpr OptionSpec kFailure{
    "on_failure", OptionKind::Text, "\"block\"",
    "What becomes of a building that cannot be healed: its LoD1 block, or dropped with the "
    "reason.",
    kOnFailure};
constexpr OptionSpec kPart{
    "parts", OptionKind::Text, "\"keep\"",
    "Parts of a building that touch or overlap: kept as bodies of their own, or merged into one "
    "without the walls between them.",
    kParts};
constexpr OptionSpec kUnite{"unite_neighbours", OptionKind::Boolean, "false",
                            "Whether buildings in contact become one body."};
constexpr OptionSpec kPatch{
    "patches", OptionKind::Text, "\"by_object\"",
    "Solid names of ASCII STL: one per object and surface type, or one per surface type.",
    kPatches};
constexpr OptionSpec kSnap{"snap_tolerance_m",
                           OptionKind::Number,
                           "0.001",
                           "Points closer than this become one point.",
                           {},
                           0.0001,
                           1.0};
constexpr OptionSpec kPlanarity{"planarity_tolerance_m",
                                OptionKind::Number,
                                "0.01",
                                "Largest distance of a corner to the plane of its polygon.",
                                {},
                                0.0001,
                                10.0};
constexpr OptionSpec kDisplacement{
    "max_displacement_m",
    OptionKind::Number,
    "0.1",
    "Largest motion of a point on the rung `healed`; beyond it the next rung is tried.",
    {},
    0.0001,
    10.0};

constexpr OptionSpec kHole{
    "max_hole_area_m2",
    OptionKind::Number,
    "10000",
    "Largest hole that is closed on the rung `healed`; with a larger one the next rung is tried.",
    {},
    0,
    1'000'000};

constexpr OptionSpec kGap{"gap_threshold_m",
                          OptionKind::Number,
                          "0.1",
                          "Narrower gaps between buildings are reported; 0: none are.",
                          {},
                          0.0,
                          10.0};

constexpr OptionSpec kWriteBack{
    "write_back", OptionKind::Boolean, "false",
    "Whether the result also goes into the database, into a schema of its own beside the one that "
    "was read, with the same gml_id and the id of the job as lineage. Needs a service that was "
    "started for it and the right to write back."};

constexpr OptionSpec kMode{
    "mode", OptionKind::Text, "\"run\"",
    "run, or estimate: how many buildings that is, how large the results will "
    "be and what is wrong already, at once and without a job.",
    kModes};

constexpr std::array kValidateInputs{kBbox,      kPolygon, kBboxRule, kObjectIds, kCrs, kSourceCrs,
                                     kAxisOrder, kLod,     kSnap,     kPlanarity, kGap, kMode};

constexpr OutputSpec kReportOutput{"report", "application/json",
                                   "What became of every building, defects and repairs included"};
constexpr OutputSpec kErrorsOutput{"errors_glb", "model/gltf-binary",
                                   "The buildings as they came, places of defects coloured"};
constexpr std::array kValidateOutputs{kReportOutput, kErrorsOutput};

/// What depends on the formats that are built: core/write has the one table of them.
struct Table {
  Table() {
    for (const Format& format : formats()) {
      keys.push_back(format.key);
      model_outputs.push_back({format.key, format.media_type, format.title});
    }
    heal_outputs = model_outputs;
    heal_outputs.push_back(kErrorsOutput);
    const auto format = [this](std::string_view default_json) {
      return OptionSpec{"formats", OptionKind::TextList, default_json, "Formats to write.", keys};
    };
    heal_inputs = {kBbox,      kPolygon,   kBboxRule, kObjectIds,    kCrs,
                   kSourceCrs, kAxisOrder, kLod,      kInstallation, format("[\"cityjson\"]"),
                   kFailure,   kPart,      kSnap,     kPlanarity,    kDisplacement,
                   kHole,      kWriteBack, kMode};
    export_inputs = {kBbox,      kPolygon,      kBboxRule, kObjectIds,    kCrs,
                     kSourceCrs, kAxisOrder,    kLod,      kInstallation, format("[\"obj\"]"),
                     kFailure,   kPart,         kUnite,    kPatch,        kSnap,
                     kPlanarity, kDisplacement, kHole,     kWriteBack,    kMode};
    processes = {
        ProcessSpec{"export-for-simulation", "Export for simulation",
                    "Selects buildings by box or id, heals them, and delivers closed, 2-manifold "
                    "meshes free of self-intersections, with a report of what became of every "
                    "building.",
                    true, export_inputs, model_outputs},
        ProcessSpec{"heal", "Heal",
                    "Repairs buildings and gives the city model back, with ids, attributes, "
                    "addresses and surface types, and a report of every change.",
                    false, heal_inputs, heal_outputs},
        ProcessSpec{"validate", "Validate", "Finds the defects of buildings and changes nothing.",
                    false, kValidateInputs, kValidateOutputs}};
  }
  Table(const Table&) = delete;  // it points into itself
  Table& operator=(const Table&) = delete;

  std::vector<std::string_view> keys{};
  std::vector<OptionSpec> heal_inputs{}, export_inputs{};
  std::vector<OutputSpec> model_outputs{kReportOutput}, heal_outputs{};
  std::vector<ProcessSpec> processes{};
};

}  // namespace

std::string_view to_string(OptionKind kind) {
  switch (kind) {
    case OptionKind::Boolean:
      return "true or false";
    case OptionKind::Integer:
      return "whole number";
    case OptionKind::Number:
      return "number";
    case OptionKind::Text:
      return "text";
    case OptionKind::TextList:
      return "list of texts";
    case OptionKind::BoundingBox:
      return "bounding box";
    case OptionKind::Polygon:
      return "polygon";
    case OptionKind::Json:
      return "JSON value";
  }
  return "";
}

std::span<const ProcessSpec> processes() {
  static const Table table;
  return table.processes;
}

const ProcessSpec* find_process(std::string_view id) {
  for (const ProcessSpec& process : processes())
    if (process.id == id) return &process;
  return nullptr;
}

std::string process_ids() {
  std::string text;
  for (const ProcessSpec& process : processes()) {
    if (!text.empty()) text += ", ";
    text += process.id;
  }
  return text;
}

}  // namespace citymesh
