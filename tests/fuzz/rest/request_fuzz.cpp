// A request as text: method and target in the first line, then header fields, an empty line, the
// body. What reads single parts of it must take anything.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "services/rest/conditional.h"
#include "services/rest/job_query.h"
#include "services/rest/message.h"
#include "services/rest/problem.h"

namespace {

using namespace citymesh;

void demand(bool promise) {
  if (!promise) abort();
}

std::string_view cut(std::string_view& text, std::string_view end) {
  const auto at = text.find(end);
  const auto piece = text.substr(0, at);
  text.remove_prefix(at == std::string_view::npos ? text.size() : at + end.size());
  return piece;
}

Request request_of(std::string_view text) {
  Request request;
  auto line = cut(text, "\n");
  request.method = cut(line, " ");
  request.target = line;
  for (auto field = cut(text, "\n"); !field.empty(); field = cut(text, "\n")) {
    const auto name = cut(field, ":");
    request.headers.add(name, std::string(field));
  }
  request.body = text;
  return request;
}

void check_target(const Request& request) {
  const auto target = parse_target(request.target);
  if (!target) return;
  std::string again = "/";
  for (const std::string& segment : target->segments) again += encode_segment(segment) + "/";
  const auto parsed = parse_target(again);
  demand(parsed && parsed->segments == target->segments);
  if (const auto query = parse_job_query(target->query)) demand(query->filter.limit > 0);
}

void check_headers(const Request& request) {
  const std::string accept = request.headers.get("Accept");
  for (const std::string_view type : {"application/json", "text/html", "model/obj"}) {
    const double quality = accept_quality(accept, type);
    demand(quality >= 0 && quality <= 1);
    accept_names(accept, type);
  }
  const std::string prefer = request.headers.get("Prefer");
  prefers(prefer, "respond-async");
  preference_value(prefer, "wait");
  media_type_of(request.headers.get("Content-Type"));
  is_valid_host(request.headers.get("Host"));
  const Response problem = problem_response(problems::kInvalidQuery, request.body, accept);
  demand(problem.status == 400 && body_text(problem));
}

/// A file of ten bytes, asked for under the request's conditions.
void check_conditions(const Request& request) {
  const std::string file = "0123456789";
  Response whole = text_response(200, "text/plain", {});
  whole.headers.set("ETag", "\"1-10\"");
  whole.body = {FilePiece{file.size(), [&](std::uint64_t offset, std::uint64_t max_bytes) {
                            demand(offset <= file.size());
                            return Result<std::string>(file.substr(offset, max_bytes));
                          }}};
  const Response answer = conditional(request, std::move(whole), "*/*");
  switch (answer.status) {
    case 200:
      return demand(body_text(answer).value() == file);
    case 206: {
      const auto part = body_text(answer);
      return demand(part && !part->empty() && file.find(*part) != std::string_view::npos);
    }
    case 304:
      return demand(body_bytes(answer) == 0);
    default:
      demand(answer.status == 412 || answer.status == 416);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Request request = request_of({reinterpret_cast<const char*>(data), size});
  check_target(request);
  check_headers(request);
  check_conditions(request);
  return 0;
}
