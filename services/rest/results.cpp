#include "services/rest/results.h"
#include "services/offer/offer.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "services/rest/documents.h"
#include "services/rest/links.h"
#include "services/rest/problem.h"

namespace citymesh {
namespace {

using Json = nlohmann::ordered_json;

/// Results hold text from input files: a page of them gets an origin of its own, from which it
/// reaches nothing. The report's table is sorted and searched by a script inside the page.
constexpr std::string_view kPagePolicy =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:; "
    "sandbox allow-scripts allow-downloads";
constexpr std::string_view kFilePolicy =
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; sandbox";

FilePiece piece_of(JobManager& jobs, const Job& job, const ResultFile& file) {
  return {file.bytes, [&jobs, id = job.id, name = file.file_name](std::uint64_t offset,
                                                                  std::uint64_t max_bytes) {
            return jobs.read_result(id, name, offset, max_bytes);
          }};
}

bool is_json(std::string_view media_type) {
  return media_type == "application/json" || media_type.ends_with("+json");
}

bool is_text(const ResultFile& file) {
  return file.media_type.starts_with("text/") || file.media_type == "image/svg+xml" ||
         ((file.media_type.starts_with("model/")) && file.output != "stl_binary");
}

std::string content_disposition(const ResultFile& file) {
  const bool shown = file.media_type.starts_with("text/") ||
                     file.media_type.starts_with("image/") || file.media_type == "application/json";
  return fmt::format("{}; filename=\"{}\"", shown ? "inline" : "attachment",
                     encode_segment(file.file_name));
}

struct Wanted {
  std::string output;
  const ResultFile* file;
  Transmission transmission;
};

/// What was asked for, or every default output as a link. An output that wrote no file is
/// left out.
std::vector<Wanted> wanted_outputs(const Job& job) {
  auto outputs = job.spec.outputs;
  if (outputs.empty())
    if (const auto* process = find_offered(job.spec.process))
      for (const auto& output : process->outputs)
        if (is_default_output(*process, output))
          outputs[std::string(output.id)] = Transmission::Reference;
  std::vector<Wanted> wanted;
  for (const auto& [output, transmission] : outputs)
    if (const auto* file = find_result(job, output)) wanted.push_back({output, file, transmission});
  return wanted;
}

Json link_to(std::string_view base, const Job& job, const ResultFile& file) {
  return {{"href", result_url(base, job, file)},
          {"type", file.media_type},
          {"title", file.file_name},
          {"length", file.bytes}};
}

/// Adds `"output": value` to a document that is sent piece by piece. JSON files go in as they are,
/// so that their size does not matter.
Result<void> add_value(Response& document, JobManager& jobs, const Job& job, const Wanted& wanted) {
  const auto& file = *wanted.file;
  const auto media_type = Json(file.media_type).dump();
  auto piece = piece_of(jobs, job, file);
  if (is_json(file.media_type)) {
    document.body.emplace_back(fmt::format("{{\"mediaType\": {}, \"value\": ", media_type));
    document.body.emplace_back(std::move(piece));
    document.body.emplace_back("}");
    return {};
  }
  Response whole;
  whole.body.emplace_back(std::move(piece));
  auto content = body_text(whole);
  if (!content) return content.error();
  const bool text = is_text(file);
  document.body.emplace_back(
      text ? Json(*content).dump(-1, ' ', false, Json::error_handler_t::replace)
           : fmt::format("{{\"mediaType\": {}, \"encoding\": \"base64\", \"value\": \"{}\"}}",
                         media_type, encode_base64(*content)));
  return {};
}

Response document_response(JobManager& jobs, const Job& job, std::string_view base,
                           const std::vector<Wanted>& outputs, bool links_only,
                           std::uint64_t max_inline_bytes) {
  Response document = text_response(200, "application/json", "{");
  std::string_view separator = "\n  ";
  for (const auto& wanted : outputs) {
    document.body.emplace_back(fmt::format("{}{}: ", separator, Json(wanted.output).dump()));
    separator = ",\n  ";
    const bool linked =
        links_only || wanted.transmission == Transmission::Reference ||
        (!is_json(wanted.file->media_type) && wanted.file->bytes > max_inline_bytes);
    if (linked)
      document.body.emplace_back(link_to(base, job, *wanted.file).dump());
    else if (auto added = add_value(document, jobs, job, wanted); !added)
      return problem_response(problem_kind(added.error().code), added.error().message, {});
  }
  document.body.emplace_back("\n}\n");
  return document;
}

Response links_response(const Job& job, std::string_view base, const std::vector<Wanted>& outputs) {
  Response response;
  response.status = 204;
  for (const auto& wanted : outputs)
    response.headers.add("Link", fmt::format("<{}>; rel=\"{}\"; type=\"{}\"; title=\"{}\"",
                                             result_url(base, job, *wanted.file), rel::kResults,
                                             wanted.file->media_type, wanted.output));
  return response;
}

Response multipart_response(JobManager& jobs, const Job& job, std::string_view base,
                            const std::vector<Wanted>& outputs) {
  const auto boundary = fmt::format("citymesh-{}", job.id);
  Response response;
  response.headers.set("Content-Type",
                       fmt::format("multipart/related; boundary=\"{}\"; type=\"{}\"", boundary,
                                   outputs.front().file->media_type));
  for (const auto& wanted : outputs) {
    const auto& file = *wanted.file;
    const bool linked = wanted.transmission == Transmission::Reference;
    response.body.emplace_back(
        fmt::format("--{}\r\nContent-ID: <{}>\r\nContent-Type: {}\r\n{}\r\n", boundary,
                    wanted.output, file.media_type,
                    linked ? fmt::format("Content-Location: {}\r\n", result_url(base, job, file))
                           : fmt::format("Content-Disposition: {}\r\nContent-Length: {}\r\n",
                                         content_disposition(file), file.bytes)));
    if (!linked) response.body.emplace_back(piece_of(jobs, job, file));
    response.body.emplace_back("\r\n");
  }
  response.body.emplace_back(fmt::format("--{}--\r\n", boundary));
  return response;
}

}  // namespace

std::string result_links_json(std::string_view base, const Job& job) {
  Json links = Json::object();
  for (const auto& wanted : wanted_outputs(job))
    links[wanted.output] = link_to(base, job, *wanted.file);
  return links.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string callback_json(const Job& job) {
  const auto& base = job.spec.subscriber.base;
  return job.state == JobState::Successful ? result_links_json(base, job) : status_json(base, job);
}

const ResultFile* find_result(const Job& job, std::string_view name) {
  const auto by_name = std::ranges::find(job.results, name, &ResultFile::file_name);
  if (by_name != job.results.end()) return &*by_name;

  // Beside its main file an output may have companions (report.html, patches.json): the main file
  // is the first one with the media type that the process declares.
  const auto* process = find_offered(job.spec.process);
  std::string_view media_type;
  if (process != nullptr)
    for (const auto& output : process->outputs)
      if (output.id == name) media_type = output.media_type;
  const ResultFile* first = nullptr;
  for (const auto& file : job.results) {
    if (file.output != name) continue;
    if (file.media_type == media_type) return &file;
    if (first == nullptr) first = &file;
  }
  return first;
}

Response file_response(JobManager& jobs, const Job& job, const ResultFile& file) {
  Response response;
  response.headers.set("Content-Type", file.media_type);
  // Results never change: the attempt that made them names them.
  response.headers.set("ETag", fmt::format("\"{}-{}\"", job.id, job.attempt));
  response.headers.set("Cache-Control", "private, no-cache");
  response.headers.set("Content-Disposition", content_disposition(file));
  response.headers.set("Content-Security-Policy",
                       std::string(file.media_type == "text/html" ? kPagePolicy : kFilePolicy));
  response.body.emplace_back(piece_of(jobs, job, file));
  return response;
}

Response values_response(JobManager& jobs, Job job, std::string_view base, std::string_view accept,
                         std::uint64_t max_inline_bytes) {
  if (job.spec.outputs.empty()) {
    for (const auto& wanted : wanted_outputs(job))
      job.spec.outputs[wanted.output] = Transmission::Value;
    job.spec.response_document = job.spec.outputs.size() != 1;
  }
  return results_response(jobs, job, base, accept, max_inline_bytes);
}

Response results_response(JobManager& jobs, const Job& job, std::string_view base,
                          std::string_view accept, std::uint64_t max_inline_bytes) {
  const auto outputs = wanted_outputs(job);
  if (job.spec.outputs.empty() || job.spec.response_document || outputs.empty())
    return document_response(jobs, job, base, outputs, job.spec.outputs.empty(), max_inline_bytes);

  const bool linked_only = std::ranges::all_of(
      outputs, [](const Wanted& wanted) { return wanted.transmission == Transmission::Reference; });
  if (linked_only) return links_response(job, base, outputs);
  if (outputs.size() == 1) return file_response(jobs, job, *outputs.front().file);
  if (accept_quality(accept, "multipart/related") == 0 &&
      accept_quality(accept, "application/json") > 0)
    return document_response(jobs, job, base, outputs, true, max_inline_bytes);
  return multipart_response(jobs, job, base, outputs);
}

}  // namespace citymesh
