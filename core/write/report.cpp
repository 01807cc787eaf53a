#include <utility>

#include "core/write/errors_glb.h"
#include "core/write/gallery.h"
#include "core/write/output.h"
#include "core/write/picture.h"
#include "core/write/report_html.h"
#include "core/write/report_json.h"
#include "core/write/write.h"

namespace citymesh {
namespace {

/// Buildings grow in two nameless files; the totals, known last, stand before them in the results.
class FileReportWriter final : public ReportWriter {
 public:
  FileReportWriter(std::filesystem::path folder, Spool lines, Spool rows,
                   std::unique_ptr<ErrorsGlb> errors, bool only_checked)
      : folder_(std::move(folder)),
        lines_(std::move(lines)),
        rows_(std::move(rows)),
        errors_(std::move(errors)),
        only_checked_(only_checked) {}

  Result<void> add(const BuildingReport& report, const BuildingBodies* bodies,
                   std::span<const SourceBody> sources) override {
    buffer_.clear();
    buffer_ += findings_.buildings == 0 ? "\n    " : ",\n    ";
    append_building_json(buffer_, report);
    if (auto written = lines_.write(buffer_); !written) return written;
    if (findings_.buildings < kMaxHtmlRows) {
      buffer_.clear();
      append_row(buffer_, report, only_checked_);
      if (auto written = rows_.write(buffer_); !written) return written;
    }
    findings_.add(report);
    if (errors_)
      if (auto written = errors_->add(report, sources); !written) return written;
    if (only_checked_) {
      picture_.add(report, sources);
    } else {
      if (bodies != nullptr) picture_.add(*bodies);
      gallery_.add(report, bodies, sources);
    }
    return {};
  }

  Result<void> finish(const RunReport& report) override {
    if (errors_)
      if (auto r = errors_->finish(); !r) return r;
    const std::string svg = picture_.svg(report);
    if (auto r = write_file("picture.svg", svg, nullptr, ""); !r) return r;

    std::string head, tail;
    append_report_head(head, report);
    tail = findings_.buildings == 0 ? "" : "\n  ";
    append_report_tail(tail, report);
    if (auto r = write_file("report.json", head, &lines_, tail); !r) return r;

    head.clear();
    tail.clear();
    append_page_head(head, report, findings_, svg, gallery_.section());
    append_page_tail(tail);
    return write_file("report.html", head, &rows_, tail);
  }

 private:
  Result<void> write_file(std::string_view name, std::string_view head, Spool* middle,
                          std::string_view tail) {
    auto file = AtomicFile::create(folder_ / name);
    if (!file) return file.error();
    if (auto r = file->write(head); !r) return r;
    if (middle != nullptr)
      if (auto r = file->append(*middle); !r) return r;
    if (auto r = file->write(tail); !r) return r;
    return file->commit();
  }

  std::filesystem::path folder_;
  Spool lines_;
  Spool rows_;
  std::unique_ptr<ErrorsGlb> errors_;  // nullptr: not wanted
  bool only_checked_;
  ReportFindings findings_{};
  Picture picture_{};
  Gallery gallery_{};
  std::string buffer_{};
};

}  // namespace

Result<std::unique_ptr<ReportWriter>> ReportWriter::create(const std::filesystem::path& folder,
                                                           const Scene& scene) {
  auto lines = Spool::create(folder, "report.json (buildings)");
  if (!lines) return lines.error();
  auto rows = Spool::create(folder, "report.html (buildings)");
  if (!rows) return rows.error();
  std::unique_ptr<ErrorsGlb> errors;
  if (scene.process == "validate" || scene.process == "heal") {
    auto file = ErrorsGlb::create(folder, scene);
    if (!file) return file.error();
    errors = std::move(*file);
  }
  return std::unique_ptr<ReportWriter>(std::make_unique<FileReportWriter>(
      folder, std::move(*lines), std::move(*rows), std::move(errors), scene.process == "validate"));
}

}  // namespace citymesh
