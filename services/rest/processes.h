#pragma once

#include <string>
#include <string_view>

#include "core/processes/processes.h"

namespace citymesh {

// JSON documents about processes, generated from the tables of core/pipeline. `base` is the URL
// that all links begin with, without a slash at its end.

/// The processes [offset, offset + limit), with links to the neighbouring pages.
std::string process_list_json(std::string_view base, std::size_t limit, std::size_t offset);
std::string process_description_json(std::string_view base, const ProcessSpec& process);

/// Whether an output is JSON of some kind.
bool is_json(const OutputSpec& output);

/// The schema of a process's `inputs` object in OpenAPI. Every input may also be qualified, for
/// which it refers to the schema `qualifiedValue`.
std::string inputs_schema_json(const ProcessSpec& process);
/// An execute request that works as it stands.
std::string example_request_json(const ProcessSpec& process);

}  // namespace citymesh
