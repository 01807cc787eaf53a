#include "core/pipeline/round_trip_gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/gates/gates.h"
#include "core/mesh/mesh.h"
#include "core/pipeline/signature.h"

namespace citymesh {
namespace {

/// The issue that a failed gate is to a reader of the report.
Issue issue_of(const GateFailure& failure, std::string_view format) {
  struct Row {
    std::string_view gate;
    int code;
  };
  constexpr std::array kRows{Row{"G1", 302},
                             Row{"G2", 303},
                             Row{"G3", issue_code::kEulerFormula},
                             Row{"G4", 306},
                             Row{"G5", issue_code::kDegenerateTriangle},
                             Row{"G6", issue_code::kTJunction},
                             Row{"G7", 307},
                             Row{"G8", issue_code::kDuplicateFace},
                             Row{"G13", issue_code::kCoordinateOutOfRange}};
  const auto row = std::find_if(kRows.begin(), kRows.end(),
                                [&](const Row& r) { return r.gate == failure.gate; });
  const int code = row == kRows.end() ? issue_code::kEncodingLoss : row->code;
  return {code, fmt::format("{} {} ({})", failure.gate, failure.where, format),
          static_cast<double>(failure.count)};
}

/// All that a reader of `text` finds, as one set of triangles.
Result<WeldedBody> read_back(std::string_view format, std::string_view text) {
  ParsedBody all;
  auto parsed = parse_text(format, text, [&](ParsedBody&& body) -> Result<void> {
    all.float32 = body.float32;
    all.centre = body.centre;  // where a file has several, it has one of them per body
    const auto first = static_cast<std::uint32_t>(all.points.size());
    all.points.insert(all.points.end(), body.points.begin(), body.points.end());
    for (const Triangle& t : body.triangles)
      all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    return {};
  });
  if (!parsed) return parsed.error();
  return weld(all);
}

}  // namespace

std::vector<Issue> RoundTripGate::operator()(const Shell& shell) {
  Meshed meshed = mesh(shell);
  if (const Issue* issue = std::get_if<Issue>(&meshed)) return {*issue};
  mesh_ = std::get<TriangleMesh>(std::move(meshed));
  fingerprint_ = signature(mesh_.points, mesh_.triangles);

  std::vector<Issue> issues;
  const auto judge = [&](const WeldedBody& body, std::string_view where) {
    for (const GateFailure& failure : check_shell(body.points, body.triangles, {}))
      issues.push_back(issue_of(failure, where));
  };
  BuildingBodies building;
  building.bodies.push_back({});
  building.bodies[0].name = name_;
  building.bodies[0].mesh = std::move(mesh_);
  bool judged = false;
  for (const OpenFormat& open : formats_) {
    auto text = open.writer->encode(building);
    if (!text && text.error().code == ErrorCode::FailedPrecondition) refused_ = text.error();
    auto body = text ? read_back(open.format->key, *text) : Result<WeldedBody>(text.error());
    if (!body) {
      issues.push_back({issue_code::kEncodingLoss, body.error().message, 0});
      continue;
    }
    if (signature(body->points, body->triangles) != fingerprint_) {
      issues.push_back(
          {issue_code::kEncodingLoss,
           fmt::format("{} holds {} triangles that differ from the {} meant", open.format->key,
                       body->triangles.size(), building.bodies[0].mesh.triangles.size()),
           0});
      continue;
    }
    // The same triangles need the same verdict only once.
    if (!std::exchange(judged, true)) judge(*body, open.format->key);
  }
  mesh_ = std::move(building.bodies[0].mesh);
  return issues;
}

}  // namespace citymesh
