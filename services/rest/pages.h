#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/processes/processes.h"
#include "services/jobs/job.h"
#include "services/rest/message.h"
#include "services/rest/problem.h"

namespace citymesh {

// Pages for people. Self-contained, without scripts; every text from outside is escaped. `base` is
// the URL that all links begin with, without a slash at its end.

std::string landing_page(std::string_view base);
std::string conformance_page(std::string_view base, std::string_view conformance_json);
std::string process_list_page(std::string_view base);
std::string process_page(std::string_view base, const ProcessSpec& process);
std::string job_list_page(std::string_view base, const std::vector<Job>& jobs,
                          std::string_view next);
/// Reloads itself until the job has ended, then shows the picture and the files.
std::string job_page(std::string_view base, const Job& job);
std::string api_page(std::string_view base, std::string_view openapi_json);
std::string problem_page(const ProblemKind& kind, std::string_view detail);

/// A page with the headers that keep it harmless. What the JSON document says is added to it, so
/// that the page never says less.
Response page_response(int status, std::string page, std::string_view document_json = {});

std::string escape_html(std::string_view text);

}  // namespace citymesh
