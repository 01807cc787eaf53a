#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/processes/inputs.h"
#include "core/processes/processes.h"

namespace citymesh {

/// `minx,miny[,minz],maxx,maxy[,maxz][@CRS]` as the OGC object of the input `bbox`.
/// Errors: InvalidArgument.
Result<std::string> bbox_json(std::string_view text);

/// What a command line says about the inputs of a process.
struct InputArguments {
  std::vector<std::string> formats{};
  std::string bbox{};
  std::vector<std::string> settings{};  ///< `name=value`
};

/// The inputs, checked and read. A value of `--set` is read by the kind of its input: lists by
/// comma, numbers, true or false; JSON is taken as it is. Errors: those of canonical_inputs().
Result<CanonicalInputs> inputs_of(const ProcessSpec& process, const InputArguments& arguments);

}  // namespace citymesh
