#pragma once

#include <string>
#include <string_view>

#include "services/jobs/job_manager.h"
#include "services/rest/message.h"

namespace citymesh {

/// The answer to GET /jobs/{id}/results for a successful job, in the form its request asked for:
/// a document of values and links, the one value itself, 204 with Link headers, or
/// multipart/related. A raw answer of several outputs becomes a document of links for a client that
/// accepts JSON only.
Response results_response(JobManager& jobs, const Job& job, std::string_view base,
                          std::string_view accept, std::uint64_t max_inline_bytes);

/// The same as the answer to a synchronous execution, where a request without `outputs` gets values
/// instead of links: the one output itself, or a document of them.
Response values_response(JobManager& jobs, Job job, std::string_view base, std::string_view accept,
                         std::uint64_t max_inline_bytes);

/// A document of links to what the request asked for.
std::string result_links_json(std::string_view base, const Job& job);

/// What the subscriber of a job is told: links to the results of a successful one, else its status.
std::string callback_json(const Job& job);

/// The file that `name` stands for: a file name, or an output whose main file it is. nullptr: none.
const ResultFile* find_result(const Job& job, std::string_view name);

/// One result file, streamed, with an ETag.
Response file_response(JobManager& jobs, const Job& job, const ResultFile& file);

}  // namespace citymesh
