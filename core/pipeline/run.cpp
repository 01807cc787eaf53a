#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <unordered_set>

#include "core/base/parallel.h"
#include "core/base/version.h"
#include "core/pipeline/body_sink.h"
#include "core/pipeline/manifest.h"
#include "core/pipeline/names.h"
#include "core/pipeline/pipeline.h"
#include "core/pipeline/process_building.h"
#include "core/pipeline/source_bodies.h"
#include "core/pipeline/totals.h"
#include "core/pipeline/validate_building.h"
#include "core/processes/inputs.h"
#include "core/processes/processes.h"
#include "core/write/write.h"

namespace citymesh {
namespace {

constexpr std::size_t kBatchPerThread = 32;  ///< buildings in memory at a time

Error cancelled() { return fail(ErrorCode::Cancelled, "stopped before the end"); }

/// One run, from the selection to the finished files.
class Run {
 public:
  Run(std::string_view process, CitySource& source, const std::filesystem::path& folder,
      const RunContext& context, BodySink* write_back)
      : process_(process),
        exporting_(process != "validate"),
        shows_errors_(process == "validate" || process == "heal"),
        source_(source),
        folder_(folder),
        context_(context),
        write_back_(write_back) {}

  Result<RunOutcome> execute(CanonicalInputs inputs) {
    const double start = context_.now();
    inputs_ = std::move(inputs.values);
    if (inputs_.only_estimate)
      return fail(ErrorCode::InvalidArgument,
                  "input `mode` is \"estimate\", which makes no files; expected \"run\"");
    if (!inputs_.write_back) {
      write_back_ = nullptr;
    } else if (write_back_ == nullptr) {
      return fail(ErrorCode::InvalidArgument,
                  "input `write_back` is true, but there is no database to write to: it needs "
                  "`citymesh serve` with --write_back_schema");
    }
    if (inputs_.keep_installations) totals_.keep_installations();
    if (!exporting_) validation_.emplace(inputs_);

    auto selection = source_.select(inputs_.query, context_);
    if (!selection) return selection.error();
    if (context_.stopped()) return cancelled();
    time("select", start);

    RunReport& head = totals_.report();
    head.process = process_;
    head.version = version();
    head.options_json = std::move(inputs.json);
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
    if (write_back_)
      if (auto begun = write_back_->begin(scene); !begun) return begun;
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
    if (validation_) {
      std::vector<BuildingReport> reports = validation_->validate(batch, context_);
      for (std::size_t i = 0; i < batch.size(); ++i) processed[i].report = std::move(reports[i]);
    } else {
      parallel_for(batch.size(), context_.threads, [&](std::size_t i) {
        if (context_.stopped()) return;
        processed[i] = process_building(batch[i], inputs_, formats_, context_);
      });
    }
    parallel_for(batch.size(), context_.threads, [&](std::size_t i) {
      if (!context_.stopped() && (shows_errors_ || processed[i].report.rung != "as_is"))
        processed[i].sources = source_bodies(batch[i], inputs_, processed[i].report);
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
        manifest_.add(*bodies, building.fingerprints);
        for (const OpenFormat& open : formats_)
          if (auto added = open.writer->add(*bodies); !added) return added.error();
        if (write_back_)
          if (auto added = write_back_->add(*bodies); !added) return added;
      }
      if (!exporting_ && has_defects(building.report)) ++invalid_;
      if (auto added = report_->add(building.report, bodies, building.sources); !added)
        return added.error();
    }
    time("write", write_start);
    done_ += batch.size();
    context_.report({"heal", done_, std::max(total_, done_)});
    return {};
  }

  static bool has_defects(const BuildingReport& report) {
    const auto any = [](const std::vector<Issue>& issues) {
      return std::any_of(issues.begin(), issues.end(),
                         [](const Issue& issue) { return is_defect(issue.code); });
    };
    return any(report.issues_before) ||
           std::any_of(report.parts.begin(), report.parts.end(),
                       [&](const PartReport& part) { return any(part.issues_before); });
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
    if (!write_back_) return {};
    start = context_.now();
    auto warnings = write_back_->finish();
    if (!warnings) return warnings.error();
    write_back_warnings_ = *std::move(warnings);
    time("write_back", start);
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
    outcome.report.warnings.insert(outcome.report.warnings.end(), write_back_warnings_.begin(),
                                   write_back_warnings_.end());
    for (const std::string& id : selection.missing_ids)
      outcome.report.warnings.push_back(fmt::format("object `{}` is in none of the inputs", id));
    if (outcome.report.counts.requested == 0)
      outcome.report.warnings.push_back("no building was selected: the result is empty");
    if (validation_ && !validation_->compared_all())
      outcome.report.warnings.push_back(
          "too many buildings to compare each with its neighbours: those at the end were not");
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
    if (shows_errors_) outcome.files.push_back({"errors_glb", "errors.glb", "model/gltf-binary"});
    outcome.files.push_back({"run.json", "run.json", "application/json"});
    return outcome;
  }

  void time(const std::string& stage, double since) { stages_s_[stage] += context_.now() - since; }

  std::string process_;
  bool exporting_;     ///< writes bodies; `validate` only looks
  bool shows_errors_;  ///< writes errors.glb
  CitySource& source_;
  const std::filesystem::path& folder_;
  const RunContext& context_;
  BodySink* write_back_;  ///< none: not asked for
  Inputs inputs_;
  std::vector<OpenFormat> formats_;
  std::optional<Validation> validation_;  ///< instead of healing
  std::unique_ptr<ReportWriter> report_;
  std::optional<Names> names_;
  std::unordered_set<std::string> seen_;
  Manifest manifest_;
  std::vector<std::string> write_back_warnings_{};
  Totals totals_;
  std::map<std::string, double> stages_s_;
  std::uint64_t total_ = 0, done_ = 0, invalid_ = 0;
};

}  // namespace

Result<RunOutcome> run(std::string_view process, std::string_view inputs_json, CitySource& source,
                       const std::filesystem::path& folder, const RunContext& context,
                       BodySink* write_back) {
  auto inputs = canonical_inputs(process, inputs_json);
  if (!inputs) return inputs.error();
  return Run(process, source, folder, context, write_back).execute(*std::move(inputs));
}

}  // namespace citymesh
