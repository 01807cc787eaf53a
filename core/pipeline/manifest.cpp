#include "core/pipeline/manifest.h"

#include <fmt/format.h>

#include "core/gates/gates.h"
#include "core/pipeline/signature.h"

namespace citymesh {
namespace {

std::string first_failure(const WeldedBody& body) {
  const auto failures = check_shell(body.points, body.triangles, {});
  return failures.empty() ? "G16" : std::string(failures[0].gate);
}

}  // namespace

void Manifest::add(const BuildingBodies& building, std::span<const std::uint64_t> fingerprints) {
  for (std::size_t i = 0; i < building.bodies.size(); ++i) {
    bodies_.emplace(building.bodies[i].name, fingerprints[i]);
    fingerprints_.insert(fingerprints[i]);
    sum_ += fingerprints[i];
  }
}

Result<void> Manifest::check(const Format& format, const std::filesystem::path& file, bool by_type,
                             const RunContext& context) const {
  const bool named = !by_type && !format.gml_ids;
  std::uint64_t sum = 0, count = 0;
  auto read = parse_file(format.key, file, [&](ParsedBody&& parsed) -> Result<void> {
    if (context.stopped()) return fail(ErrorCode::Cancelled, "stopped before the end");
    if (const auto labels = check_labels(parsed, named); !labels.empty())
      return fail(ErrorCode::DataLoss,
                  fmt::format("{}: body `{}` fails gate {}: {}", file.filename().string(),
                              parsed.name, labels[0].gate, labels[0].where));
    auto body = weld(parsed);
    if (!body)
      return fail(ErrorCode::DataLoss, fmt::format("{}: body `{}`: {}", file.filename().string(),
                                                   parsed.name, body.error().message));
    const std::uint64_t fingerprint = signature(body->points, body->triangles);
    sum += fingerprint;
    ++count;
    const auto expected = bodies_.find(parsed.name);
    const bool fit = named ? expected != bodies_.end() && expected->second == fingerprint
                           : by_type || fingerprints_.contains(fingerprint);
    if (!fit)
      return fail(
          ErrorCode::DataLoss,
          fmt::format(
              "{}: body `{}` fails gate {}: its triangles are not those that were delivered",
              file.filename().string(), parsed.name, first_failure(*body)));
    return {};
  });
  if (!read) return read.error();
  if (sum != sum_ || (!by_type && count != bodies_.size()))
    return fail(ErrorCode::DataLoss, fmt::format("{}: holds {} bodies, {} were delivered",
                                                 file.filename().string(), count, bodies_.size()));
  return {};
}

}  // namespace citymesh
