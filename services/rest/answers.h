#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "services/jobs/job.h"
#include "services/rest/message.h"

namespace citymesh {

/// Whether a client is to get a page rather than JSON; the query parameter `f` decides before the
/// Accept header.
bool wants_page(std::string_view accept, const std::map<std::string, std::string>& query);

Response json_response(std::string body, int status = 200);

/// Why a job cannot be had.
Response job_error(const Error& error, std::string_view accept);

/// Why a job has no results: not yet, failed, dismissed or expired. Nothing when it has some.
std::optional<Response> without_results(const Job& job, std::string_view base,
                                        std::string_view accept);

/// A problem that names the processes there are.
Response no_such_process(std::string_view id, std::string_view accept);

}  // namespace citymesh
