#pragma once

#include <functional>
#include <vector>

#include "core/source/build.h"
#include "core/source/catalogue.h"

namespace citymesh::source {

/// Makes what turns features of one file into buildings; each thread has its own.
using MakerFactory = std::function<BuildingMaker()>;

/// Delivers the chosen buildings of a file, which are given in the order of their numbers. Only
/// they are parsed where the file can be read in pieces, on several threads; else all before the
/// last of them. Errors: FailedPrecondition when the file is not what was looked at; Cancelled;
/// those of the sink.
Result<void> read_buildings(const FileRecord& file, const std::vector<BuildingRecord>& chosen,
                            const MakerFactory& new_maker, const ReadLimits& limits,
                            const BuildingSink& sink, const RunContext& context);

}  // namespace citymesh::source
