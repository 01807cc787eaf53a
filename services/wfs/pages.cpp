#include "services/wfs/pages.h"

#include <utility>

#include "core/source/scan.h"

namespace citymesh::wfs {

using namespace source;

Result<Pages::Added> Pages::add(const std::filesystem::path& path, const ReadLimits& limits,
                                const std::stop_token& stop) {
  FileRecord file = plain_file(path);
  file.stamp = FileStamp::of(path);
  auto scan = scan_file(std::move(file), limits, true, stop);
  if (!scan) return scan.error();
  if (!scan->facts.failure.empty())
    return fail(scan->facts.not_a_city_model ? ErrorCode::FailedPrecondition : ErrorCode::DataLoss,
                scan->facts.failure);
  Added added{.buildings = scan->records.size()};
  std::vector<BuildingRecord> fresh;
  for (auto& record : scan->records)
    if (!ids_.contains(record.gml_id)) fresh.push_back(std::move(record));
  for (const auto& record : fresh) {  // repetitions within a file are the data's own
    ids_.insert(record.gml_id);
    ids_.insert(record.part_ids.begin(), record.part_ids.end());
  }
  added.fresh = fresh.size();
  buildings_ += added.fresh;
  scan->buildings = added.fresh;
  scan->records = std::move(fresh);
  files_.push_back(std::make_shared<const FileScan>(std::move(*scan)));
  return added;
}

Result<std::vector<std::shared_ptr<const FileRecord>>> Pages::files(bool, const RunContext&) {
  return files_;
}

Result<void> Pages::buildings(const FileRecord& file, const RecordQuery& query,
                              const RecordSink& sink) {
  const auto& scan = static_cast<const FileScan&>(file);  // files() gives nothing else
  for (const auto& building : scan.records) {
    if (query.box && !query.box->meets(building.extent)) continue;
    if (auto taken = sink(building); !taken) return taken;
  }
  return {};
}

}  // namespace citymesh::wfs
