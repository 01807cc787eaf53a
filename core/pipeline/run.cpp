#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>
#include <unordered_set>

#include "core/base/parallel.h"
#include "core/base/version.h"
#include "core/gates/gates.h"
#include "core/geometry/measure.h"
#include "core/pipeline/contacts.h"
#include "core/pipeline/inputs.h"
#include "core/pipeline/names.h"
#include "core/pipeline/pipeline.h"
#include "core/pipeline/process_building.h"
#include "core/pipeline/signature.h"
#include "core/write/write.h"

namespace citymesh {
namespace {

constexpr std::size_t kBatchPerThread = 32;  ///< buildings in memory at a time

Error cancelled() { return fail(ErrorCode::Cancelled, "stopped before the end"); }

/// Adds up what report.json says of the whole run.
class Totals {
 public:
  void add(const BuildingReport& building, const BuildingBodies* bodies) {
    count(report_.counts, building.outcome);
    for (const PartReport& part : building.parts)
      if (part.kind == ObjectKind::BuildingPart) count(report_.part_counts, part.outcome);
    if (building.outcome == "delivered") {
      if (!building.rung.empty()) ++rungs_[building.rung];
    } else {
      ++reasons_[building.reason];
    }
    if (!bodies) return;
    for (const Body& body : bodies->bodies) add(body.mesh);
  }

  /// What was left out of a building by choice.
  void add_skipped(const Building& building) {
    if (!keep_installations_) installations_ += building.installations.size();
    for (const auto& [name, count] : building.skipped_ade_elements) ade_elements_[name] += count;
    for (const Building& part : building.parts) add_skipped(part);
    for (const Building& installation : building.installations) add_skipped(installation);
  }

  void add(const TriangleMesh& mesh) {
    contacts_.add(mesh);
    ++report_.bodies;
    report_.points += mesh.points.size();
    report_.triangles += mesh.triangles.size();
    report_.volume_m3 += volume_m3(mesh.points, mesh.triangles);
    report_.area_m2 += area_m2(mesh.points, mesh.triangles);
    for (const GridPoint& p : mesh.points) report_.extent.add(to_metres(p));
    for (const Triangle& t : mesh.triangles) {
      const double a = distance_m(mesh.points[t[1]], mesh.points[t[2]]);
      const double b = distance_m(mesh.points[t[2]], mesh.points[t[0]]);
      const double c = distance_m(mesh.points[t[0]], mesh.points[t[1]]);
      const double shortest = std::min({a, b, c}), longest = std::max({a, b, c});
      const double middle = a + b + c - shortest - longest;
      min_edge_m_ = std::min(min_edge_m_, shortest);
      // The smallest angle lies opposite the shortest edge (law of cosines).
      const double cosine =
          (middle * middle + longest * longest - shortest * shortest) / (2 * middle * longest);
      max_cosine_ = std::max(max_cosine_, std::min(cosine, 1.0));
    }
  }

  RunReport finish() {
    report_.contacts = contacts_.count();
    if (installations_ > 0)
      report_.warnings.push_back(
          fmt::format("{} building installations were left out", installations_));
    if (!ade_elements_.empty()) {
      std::uint64_t elements = 0;
      std::string names;
      for (const auto& [name, count] : ade_elements_) {
        elements += count;
        names += fmt::format("{}{} {}", names.empty() ? "" : ", ", name, count);
      }
      report_.warnings.push_back(
          fmt::format("{} elements of extensions (ADE) were skipped: {}", elements, names));
    }
    report_.rungs.assign(rungs_.begin(), rungs_.end());
    report_.drop_reasons.assign(reasons_.begin(), reasons_.end());
    if (report_.triangles > 0) {
      report_.min_edge_m = min_edge_m_;
      report_.min_angle_deg = std::acos(max_cosine_) * 180.0 / 3.14159265358979323846;
    }
    return std::move(report_);
  }

  RunReport& report() { return report_; }
  void keep_installations() { keep_installations_ = true; }

 private:
  static void count(Counts& counts, const std::string& outcome) {
    ++counts.requested;
    ++(outcome == "delivered" ? counts.delivered
       : outcome == "merged"  ? counts.merged
                              : counts.dropped);
  }

  RunReport report_;
  Contacts contacts_;
  std::uint64_t installations_ = 0;
  std::map<std::string, std::uint64_t> ade_elements_;
  bool keep_installations_ = false;
  std::map<std::string, std::uint64_t> rungs_, reasons_;
  double min_edge_m_ = std::numeric_limits<double>::infinity();
  double max_cosine_ = -1;
};

/// What the finished files must hold, body by body.
class Manifest {
 public:
  void add(const BuildingBodies& building) {
    for (const Body& body : building.bodies) {
      const std::uint64_t fingerprint = signature(body.mesh.points, body.mesh.triangles);
      bodies_.emplace(body.name, fingerprint);
      fingerprints_.insert(fingerprint);
      sum_ += fingerprint;
    }
  }

  /// Re-reads a finished file once. A body is fit when the file holds exactly the triangles that
  /// passed the gates.
  Result<void> check(const Format& format, const std::filesystem::path& file, bool by_type,
                     const RunContext& context) const {
    const bool named = !by_type && !format.gml_ids;
    std::uint64_t sum = 0, count = 0;
    auto read = parse_file(format.key, file, [&](ParsedBody&& parsed) -> Result<void> {
      if (context.stopped()) return cancelled();
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
      return fail(ErrorCode::DataLoss,
                  fmt::format("{}: holds {} bodies, {} were delivered", file.filename().string(),
                              count, bodies_.size()));
    return {};
  }

 private:
  static std::string first_failure(const WeldedBody& body) {
    const auto failures = check_shell(body.points, body.triangles, {});
    return failures.empty() ? "G16" : std::string(failures[0].gate);
  }

  std::unordered_map<std::string, std::uint64_t> bodies_;
  std::unordered_set<std::uint64_t> fingerprints_;
  std::uint64_t sum_ = 0;
};

/// One run, from the selection to the finished files.
class Run {
 public:
  Run(std::string_view process, CitySource& source, const std::filesystem::path& folder,
      const RunContext& context)
      : process_(process),
        exporting_(process == "export-for-simulation"),
        source_(source),
        folder_(folder),
        context_(context) {}

  Result<RunOutcome> execute(const std::string& canonical) {
    const double start = context_.now();
    auto inputs = read_inputs(canonical);
    if (!inputs) return inputs.error();
    inputs_ = std::move(*inputs);
    if (inputs_.keep_installations) totals_.keep_installations();

    auto selection = source_.select(inputs_.query, context_);
    if (!selection) return selection.error();
    if (context_.stopped()) return cancelled();
    time("select", start);

    RunReport& head = totals_.report();
    head.process = process_;
    head.version = version();
    head.options_json = canonical;
    head.crs = selection->crs;
    head.origin = selection->origin;
    head.source_crs = selection->source_crs;
    if (const auto facts = describe_crs(selection->crs); facts)
      head.vertical_crs = facts->vertical_name;
    if (auto opened = open(*selection); !opened) return opened.error();
    if (auto streamed = stream(*selection); !streamed) return streamed.error();
    if (auto finished = finish_files(); !finished) return finished.error();
    return conclude(*selection, start);
  }

 private:
  Result<void> open(const Selection& selection) {
    const Scene scene{selection.crs, selection.origin, process_, inputs_.patches};
    if (exporting_)
      for (const std::string& key : inputs_.formats) {
        const Format* format = find_format(key);
        if (!format)
          return fail(ErrorCode::InvalidArgument,
                      fmt::format("format `{}` is not built; available: {}", key, format_keys()));
        auto writer = open_writer(*format, folder_, scene);
        if (!writer) return writer.error();
        formats_.push_back({format, std::move(*writer)});
      }
    auto report = ReportWriter::create(folder_, scene);
    if (!report) return report.error();
    report_ = std::move(*report);
    names_.emplace(selection.object_ids);
    return {};
  }

  Result<void> stream(const Selection& selection) {
    total_ = selection.buildings;
    const std::size_t batch_size = kBatchPerThread * std::max(1u, context_.threads);
    std::vector<NamedBuilding> batch;
    double mark = context_.now();
    const auto flush = [&]() -> Result<void> {
      time("source", mark);
      auto done = process(batch);
      batch.clear();
      mark = context_.now();
      return done;
    };
    context_.report({"heal", 0, total_});
    auto read = source_.read(
        inputs_.query, selection,
        [&](Building&& building) -> Result<void> {
          if (context_.stopped()) return cancelled();
          batch.push_back(name(std::move(building)));
          return batch.size() < batch_size ? Result<void>{} : flush();
        },
        context_);
    if (!read) return read.error();
    return flush();
  }

  NamedBuilding name(Building&& building) {
    NamedBuilding named;
    named.duplicate = !seen_.insert(building.gml_id).second;
    named.name = names_->take(building.gml_id);
    for (const Building* member : members_of(building, inputs_))
      named.part_names.push_back(names_->take(member->gml_id));
    named.building = std::move(building);
    return named;
  }

  Result<void> process(const std::vector<NamedBuilding>& batch) {
    const double start = context_.now();
    std::vector<ProcessedBuilding> processed(batch.size());
    parallel_for(batch.size(), context_.threads, [&](std::size_t i) {
      if (context_.stopped()) return;
      if (exporting_)
        processed[i] = process_building(batch[i], inputs_, formats_, context_);
      else
        processed[i].report = validate_building(batch[i], inputs_);
    });
    if (context_.stopped()) return cancelled();
    time("heal", start);
    for (const ProcessedBuilding& building : processed)
      if (building.refused) return *building.refused;

    const double write_start = context_.now();
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const ProcessedBuilding& building = processed[i];
      totals_.add_skipped(batch[i].building);
      const BuildingBodies* bodies = building.bodies ? &*building.bodies : nullptr;
      totals_.add(building.report, bodies);
      if (bodies) {
        manifest_.add(*bodies);
        for (const OpenFormat& open : formats_)
          if (auto added = open.writer->add(*bodies); !added) return added.error();
      }
      if (!exporting_ && has_defects(building.report)) ++invalid_;
      if (auto added = report_->add(building.report, bodies); !added) return added.error();
    }
    time("write", write_start);
    done_ += batch.size();
    context_.report({"heal", done_, std::max(total_, done_)});
    return {};
  }

  static bool has_defects(const BuildingReport& report) {
    return !report.issues_before.empty() ||
           std::any_of(report.parts.begin(), report.parts.end(),
                       [](const PartReport& part) { return !part.issues_before.empty(); });
  }

  Result<void> finish_files() {
    double start = context_.now();
    context_.report({"write", done_, done_});
    for (const OpenFormat& open : formats_)
      if (auto finished = open.writer->finish(); !finished) return finished.error();
    time("write", start);
    start = context_.now();
    context_.report({"gates", done_, done_});
    for (const OpenFormat& open : formats_) {
      const bool by_type =
          open.format->key.starts_with("stl") && inputs_.patches == Patches::ByType;
      auto checked =
          manifest_.check(*open.format, folder_ / open.format->file_name, by_type, context_);
      if (!checked) return checked.error();
    }
    time("gates", start);
    return {};
  }

  Result<RunOutcome> conclude(const Selection& selection, double start) {
    RunOutcome outcome;
    outcome.report = totals_.finish();
    const Counts& counts = outcome.report.counts;
    if (counts.requested != selection.buildings ||
        counts.requested != counts.delivered + counts.merged + counts.dropped)
      return fail(
          ErrorCode::DataLoss,
          fmt::format("gate G16: {} buildings selected, but {} delivered, {} merged and {} dropped",
                      selection.buildings, counts.delivered, counts.merged, counts.dropped));
    outcome.report.inputs = selection.inputs;
    outcome.report.warnings.insert(outcome.report.warnings.begin(), selection.warnings.begin(),
                                   selection.warnings.end());
    for (const std::string& id : selection.missing_ids)
      outcome.report.warnings.push_back(fmt::format("object `{}` is in none of the inputs", id));
    if (outcome.report.counts.requested == 0)
      outcome.report.warnings.push_back("no building was selected: the result is empty");
    outcome.invalid_buildings = invalid_;
    outcome.complete =
        outcome.report.counts.dropped == 0 && selection.missing_ids.empty() &&
        std::all_of(selection.inputs.begin(), selection.inputs.end(),
                    [](const InputReport& input) { return input.state != "failed"; });
    if (auto finished = report_->finish(outcome.report); !finished) return finished.error();

    RunTimings& timings = outcome.timings;
    timings.stages_s.assign(stages_s_.begin(), stages_s_.end());
    timings.total_s = context_.now() - start;
    timings.threads = context_.threads;
    if (auto written = write_run_json(folder_, timings); !written) return written.error();

    for (const OpenFormat& open : formats_) {
      const std::string key(open.format->key);
      outcome.files.push_back(
          {key, std::string(open.format->file_name), std::string(open.format->media_type)});
      if (!open.format->sidecar.empty())
        outcome.files.push_back({std::string(open.format->sidecar),
                                 std::string(open.format->sidecar), "application/json"});
    }
    outcome.files.push_back({"report", "report.json", "application/json"});
    outcome.files.push_back({"report.html", "report.html", "text/html"});
    outcome.files.push_back({"picture.svg", "picture.svg", "image/svg+xml"});
    outcome.files.push_back({"run.json", "run.json", "application/json"});
    return outcome;
  }

  void time(const std::string& stage, double since) { stages_s_[stage] += context_.now() - since; }

  std::string process_;
  bool exporting_;
  CitySource& source_;
  const std::filesystem::path& folder_;
  const RunContext& context_;
  Inputs inputs_;
  std::vector<OpenFormat> formats_;
  std::unique_ptr<ReportWriter> report_;
  std::optional<Names> names_;
  std::unordered_set<std::string> seen_;
  Manifest manifest_;
  Totals totals_;
  std::map<std::string, double> stages_s_;
  std::uint64_t total_ = 0, done_ = 0, invalid_ = 0;
};

}  // namespace

Result<RunOutcome> run(std::string_view process, std::string_view inputs_json, CitySource& source,
                       const std::filesystem::path& folder, const RunContext& context) {
  auto canonical = canonical_inputs(process, inputs_json);
  if (!canonical) return canonical.error();
  return Run(process, source, folder, context).execute(*canonical);
}

}  // namespace citymesh
