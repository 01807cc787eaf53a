#include "services/wfs/server.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string_view>
#include <utility>

#include "core/base/text.h"
#include "services/http/http.h"

namespace citymesh::wfs {
namespace {

constexpr int kTries = 3;

bool may_pass(int status) {
  constexpr std::array kPassing{429, 502, 503, 504};
  return std::ranges::find(kPassing, status) != kPassing.end();
}

ErrorCode code_of(int status) {
  if (status == 401 || status == 403) return ErrorCode::PermissionDenied;
  if (status == 404 || status == 410) return ErrorCode::NotFound;
  if (status == 408 || status == 504) return ErrorCode::DeadlineExceeded;
  if (status == 429 || status >= 500) return ErrorCode::Unavailable;
  return ErrorCode::FailedPrecondition;
}

void pause(double seconds, const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  wake.wait_for(lock, stop, std::chrono::duration<double>(seconds), [] { return false; });
}

/// A whole answer of any status; network errors and busy servers are tried again.
Result<HttpAnswer> fetch(const Server& server, const std::string& url,
                         const std::stop_token& stop) {
  const HttpRequest request{.url = url,
                            .body = {},
                            .headers = {},
                            .timeout_s = server.options.timeout_s,
                            .max_answer_bytes = server.options.max_answer_bytes,
                            .may_connect = {}};
  for (int tried = 1;; ++tried) {
    auto answer = ask(request, stop);
    const bool again =
        answer ? may_pass(answer->status) : answer.error().code == ErrorCode::Unavailable;
    if (again && tried < kTries) {
      pause(server.options.retry_pause_s * tried, stop);
      if (stop.stop_requested()) return fail(ErrorCode::Cancelled, "stopped");
      continue;
    }
    if (!answer && answer.error().code == ErrorCode::Cancelled) return answer.error();
    if (!answer) return server.error(answer.error().code, answer.error().message);
    if (!answer->is_whole)
      return server.error(
          ErrorCode::ResourceExhausted,
          fmt::format("an answer has more than {} bytes (max_answer_bytes); smaller pages help",
                      server.options.max_answer_bytes));
    return answer;
  }
}

Error refused(const Server& server, int status, const ServerError& error) {
  const std::string words =
      error.text.empty() ? "without a reason" : fmt::format("'{}'", error.text);
  if (status >= 300 && status < 400)
    return server.error(ErrorCode::FailedPrecondition,
                        fmt::format("the answer is a redirect ({}), which is not followed: name "
                                    "the address that it leads to",
                                    status));
  if (!error.code.empty()) {
    const ErrorCode code = error.code == "NotFound" ? ErrorCode::NotFound
                           : status == 200          ? ErrorCode::FailedPrecondition
                                                    : code_of(status);
    return server.error(code, fmt::format("the server refuses: {} {}", error.code, words));
  }
  if (status != 200)
    return server.error(code_of(status), fmt::format("the answer is {}, {}", status, words));
  return server.error(ErrorCode::FailedPrecondition,
                      fmt::format("the answer is no city model: {}", words));
}

Result<FeatureType> type_named(const Server& server, const Capabilities& capabilities,
                               std::string_view name) {
  const auto local = [](std::string_view full) { return full.substr(full.find(':') + 1); };
  for (const auto& type : capabilities.types)
    if (type.name == name) return type;
  std::string known;
  for (const auto& type : capabilities.types) {
    if (local(type.name) == local(name)) return type;
    if (known.size() < 500) known += (known.empty() ? "" : ", ") + type.name;
  }
  return server.error(ErrorCode::FailedPrecondition,
                      fmt::format("there is no type '{}', expected one of {}", name, known));
}

/// Chooses the CRS of boxes: the default one, or the first projected one where that is in degrees.
Result<void> choose_crs(Server& server, const std::vector<std::string>& spelt) {
  std::string problem = "none is named";
  for (std::size_t i = 0; i < spelt.size(); ++i) {
    const auto crs = parse_crs(spelt[i]);
    const auto facts = crs && crs->known() ? describe_crs(*crs) : Result<CrsFacts>(CrsFacts{});
    if (!crs || !crs->known() || !facts) {
      problem = fmt::format("'{}' is not understood", spelt[i]);
      continue;
    }
    if (facts->geographic && server.crs.known()) continue;
    server.crs = *crs;
    server.is_default_crs = i == 0;
    server.north_first = facts->geographic && facts->north_first;
    server.srs_name = spelt[i];
    // A compound one has a comma, which is what separates the values of a box.
    if (spelt[i].find(',') != std::string::npos) {
      const auto horizontal = crs->id.substr(0, crs->id.find('+'));
      const auto colon = horizontal.find(':');
      server.srs_name = fmt::format("urn:ogc:def:crs:{}::{}", horizontal.substr(0, colon),
                                    horizontal.substr(colon + 1));
    }
    if (!facts->geographic) return {};
  }
  if (server.crs.known()) return {};
  return server.error(ErrorCode::FailedPrecondition,
                      fmt::format("the CRS of {} cannot be told: {}", server.types, problem));
}

Result<void> choose_types(Server& server, const Capabilities& capabilities) {
  std::vector<std::string> crs;
  for (std::string_view rest = server.options.type_names; !rest.empty();) {
    const auto name = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), name.size() + 1));
    const auto type = type_named(server, capabilities, trimmed(name));
    if (!type) return type.error();
    if (crs.empty()) crs = type->crs;
    server.types += (server.types.empty() ? "" : ",") + type->name;
    if (type->uri.empty()) continue;
    const auto space =
        fmt::format("xmlns({},{})", type->name.substr(0, type->name.find(':')), type->uri);
    if (server.namespaces.find(space) == std::string::npos)
      server.namespaces += (server.namespaces.empty() ? "" : ",") + space;
  }
  return choose_crs(server, crs);
}

}  // namespace

Error Server::error(ErrorCode code, const std::string& what) const {
  return fail(code, fmt::format("WFS {}: {}", shown, what));
}

Result<Server> look_at(const WfsOptions& options) {
  Server server{.options = options, .shown = shown_url(options.url)};
  auto url = service_url(options.url);
  if (!url) return url.error();
  server.url = std::move(*url);
  if (options.type_names.empty() || options.page == 0)
    return fail(ErrorCode::InvalidArgument,
                "a WFS is asked for at least one type and one feature at a time");
  const auto answer = fetch(server,
                            with_parameters(server.url, {{"SERVICE", "WFS"},
                                                         {"REQUEST", "GetCapabilities"},
                                                         {"ACCEPTVERSIONS", "2.0.2,2.0.0"}}),
                            {});
  if (!answer) return answer.error();
  const auto capabilities = read_capabilities(answer->body);
  if (answer->status != 200 || !capabilities) {
    const auto head = read_head(answer->body);
    if (answer->status != 200 || (head.error && !head.error->code.empty()))
      return refused(server, answer->status, head.error.value_or(ServerError{}));
    return server.error(capabilities.error().code, capabilities.error().message);
  }
  server.version = capabilities->version;
  if (!server.version.starts_with("2.0"))
    return server.error(ErrorCode::FailedPrecondition,
                        fmt::format("the server speaks WFS '{}', expected 2.0", server.version));
  server.pages = capabilities->pages;
  server.count_default = capabilities->count_default;
  const auto& formats = capabilities->formats;
  if (!options.output_format.empty() && !formats.empty() &&
      std::ranges::find(formats, options.output_format) == formats.end()) {
    std::string known;
    for (const auto& format : formats) known += (known.empty() ? "'" : ", '") + format + "'";
    return server.error(ErrorCode::FailedPrecondition,
                        fmt::format("there is no output format '{}', expected one of {}",
                                    options.output_format, known));
  }
  if (auto chosen = choose_types(server, *capabilities); !chosen) return chosen.error();
  return server;
}

Result<Answer> get_features(const Server& server, const std::string& url,
                            const std::stop_token& stop) {
  auto fetched = fetch(server, url, stop);
  if (!fetched) return fetched.error();
  Answer answer{.body = std::move(fetched->body)};
  answer.head = read_head(answer.body);
  if (fetched->status != 200 || answer.head.error)
    return refused(server, fetched->status, answer.head.error.value_or(ServerError{}));
  return answer;
}

}  // namespace citymesh::wfs
