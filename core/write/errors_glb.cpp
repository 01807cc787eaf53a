#include "core/write/errors_glb.h"

#include <cmath>
#include <set>
#include <utility>

#include "core/write/findings.h"
#include "core/write/report_json.h"
#include "core/write/shell_faces.h"
#include "core/write/styles.h"
#include "core/write/text.h"

namespace citymesh {
namespace {

constexpr std::uint64_t kMaxBytes = 1u << 30;
constexpr std::size_t kMaxIssues = 1000;    // of a body; report.json has all
constexpr std::int64_t kMarkRadius = 1500;  // in steps: 15 cm
constexpr std::size_t kMaterials = 1 + style::kLastFinding - style::kFirstFinding + 1;

std::size_t material_of(std::uint8_t face_style) {
  return face_style < style::kFirstFinding ? 0u : 1u + face_style - style::kFirstFinding;
}

std::vector<GlbMaterial> materials() {
  std::vector<GlbMaterial> all{
      {kStyles[style::kSound].meaning, kStyles[style::kOther].colour, true}};
  for (std::size_t i = style::kFirstFinding; i <= style::kLastFinding; ++i)
    all.push_back({kStyles[i].meaning, kStyles[i].colour, true});
  return all;
}

/// What a node shows.
struct Model {
  std::vector<GridPoint> points{};
  std::array<std::vector<Triangle>, kMaterials> triangles{};

  void add_mark(const GridPoint& at, std::size_t material) {
    const auto first = static_cast<std::uint32_t>(points.size());
    for (const std::int64_t r : {-kMarkRadius, kMarkRadius}) {
      points.push_back({at.x + r, at.y, at.z});
      points.push_back({at.x, at.y + r, at.z});
      points.push_back({at.x, at.y, at.z + r});
    }
    // Of the axes' low ends 0 1 2 and high ends 3 4 5, one triangle per octant.
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
      const std::uint32_t x = first + (octant & 1 ? 3 : 0), y = first + (octant & 2 ? 4 : 1),
                          z = first + (octant & 4 ? 5 : 2);
      const bool turned = ((octant & 1) + (octant >> 1 & 1) + (octant >> 2 & 1)) % 2 == 0;
      triangles[material].push_back(turned ? Triangle{x, z, y} : Triangle{x, y, z});
    }
  }
};

Model model_of(const SourceBody& source) {
  Model model;
  const Shell& shell = source.shell;
  model.points = shell.points;
  const auto styles = face_findings(shell, source.issues);
  for (std::size_t f = 0; f < shell.faces.size(); ++f) {
    auto& to = model.triangles[material_of(styles[f])];
    const auto triangles = pieces(shell.points, shell.faces[f]);
    to.insert(to.end(), triangles.begin(), triangles.end());
  }
  std::set<std::pair<GridPoint, std::size_t>> marked;
  for (const Issue& issue : source.issues) {
    if (!issue.at || marked.size() == kMaxIssues) continue;
    constexpr double kReach_m = static_cast<double>(kGridLimit) * kGridStep_m;
    const Point3& p = *issue.at;
    if (!(std::abs(p.x) < kReach_m && std::abs(p.y) < kReach_m && std::abs(p.z) < kReach_m))
      continue;
    const GridPoint at{std::llround(p.x * kGridStepsPerMetre),
                       std::llround(p.y * kGridStepsPerMetre),
                       std::llround(p.z * kGridStepsPerMetre)};
    const std::size_t material = material_of(finding_style(issue.code));
    if (marked.emplace(at, material).second) model.add_mark(at, material);
  }
  return model;
}

std::string extras_of(const BuildingReport& report, const SourceBody& source) {
  std::string json = "{\"gml_id\":";
  append_json_string(json, source.gml_id);
  json += ",\"building\":";
  append_json_string(json, report.gml_id);
  json += ",\"issues\":";
  append_issues(json, std::span(source.issues).first(std::min(kMaxIssues, source.issues.size())));
  return json + '}';
}

}  // namespace

Result<std::unique_ptr<ErrorsGlb>> ErrorsGlb::create(const std::filesystem::path& folder,
                                                     const Scene& scene) {
  auto file = File::create(folder, "errors.glb");
  if (!file) return file.error();
  return std::unique_ptr<ErrorsGlb>(new ErrorsGlb(std::move(*file), scene));
}

ErrorsGlb::ErrorsGlb(File file, const Scene& scene)
    : file_(std::move(file)), parts_(scene, materials()) {}

Result<void> ErrorsGlb::add(const BuildingReport& report, std::span<const SourceBody> sources) {
  for (const SourceBody& source : sources) {
    if (parts_.bytes() > kMaxBytes) return {};
    const Model model = model_of(source);
    const std::string extras = extras_of(report, source);
    File::Texts texts;
    if (!parts_.append({source.name, extras, model.points, model.triangles}, texts)) continue;
    if (auto written = file_.write(texts); !written) return written;
  }
  return {};
}

Result<void> ErrorsGlb::finish() { return file_.finish(parts_); }

}  // namespace citymesh
