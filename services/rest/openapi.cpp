#include "services/rest/openapi.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/base/version.h"
#include "services/offer/offer.h"
#include "services/rest/links.h"
#include "services/rest/processes.h"

namespace citymesh {
namespace {

using Json = nlohmann::ordered_json;

Json ref(std::string_view kind, std::string_view name) {
  return {{"$ref", fmt::format("#/components/{}/{}", kind, name)}};
}

Json schema_ref(std::string_view name) { return ref("schemas", name); }

Json content(std::string_view media_type, Json schema) {
  return {{std::string(media_type), {{"schema", std::move(schema)}}}};
}

/// A success answer in JSON and, for browsers, as a page.
Json json_or_page(std::string_view description, std::string_view schema) {
  auto media = content("application/json", schema_ref(schema));
  media["text/html"] = {{"schema", {{"type", "string"}}}};
  return {{"description", description}, {"content", std::move(media)}};
}

Json operation(std::string_view id, std::string_view tag, std::string_view summary,
               std::string_view description, Json parameters, Json responses) {
  Json described = {{"operationId", id},
                    {"tags", Json::array({tag})},
                    {"summary", summary},
                    {"description", description}};
  if (!parameters.empty()) described["parameters"] = std::move(parameters);
  for (const auto* wrong : {"4XX", "5XX"}) responses[wrong] = ref("responses", "Problem");
  described["responses"] = std::move(responses);
  return described;
}

Json parameter(std::string_view name, std::string_view in, std::string_view description,
               Json schema) {
  return {{"name", name},
          {"in", in},
          {"required", in == "path"},
          {"description", description},
          {"schema", std::move(schema)}};
}

Json text() { return {{"type", "string"}}; }
Json url() { return {{"type", "string"}, {"format", "uri"}}; }
Json whole_number(int minimum) { return {{"type", "integer"}, {"minimum", minimum}}; }
Json date_time() { return {{"type", "string"}, {"format", "date-time"}}; }
Json boolean() { return {{"type", "boolean"}}; }
Json list_of(Json items) { return {{"type", "array"}, {"items", std::move(items)}}; }

Json object(Json properties, std::initializer_list<const char*> required) {
  Json schema = {{"type", "object"}};
  if (required.size() > 0) schema["required"] = required;
  schema["properties"] = std::move(properties);
  return schema;
}

Json one_of(std::initializer_list<const char*> values) {
  return {{"type", "string"}, {"enum", values}};
}

std::string execute_schema_name(const ProcessSpec& process) {
  return fmt::format("execute-{}", process.id);
}

Json execute_schema(const ProcessSpec& process) {
  Json outputs = Json::object();
  for (const auto& output : process.outputs) outputs[std::string(output.id)] = schema_ref("output");
  Json outputs_schema = object(std::move(outputs), {});
  outputs_schema["additionalProperties"] = false;
  auto schema = object({{"inputs", Json::parse(inputs_schema_json(process))},
                        {"outputs", std::move(outputs_schema)},
                        {"response", one_of({"raw", "document"})},
                        {"subscriber", schema_ref("subscriber")}},
                       {});
  schema["additionalProperties"] = false;
  schema["example"] = Json::parse(example_request_json(process));
  return schema;
}

Json schemas() {
  Json all = {
      {"link", object({{"href", text()},
                       {"rel", text()},
                       {"type", text()},
                       {"title", text()},
                       {"length", whole_number(0)}},
                      {"href"})},
      {"landingPage", object({{"title", text()},
                              {"description", text()},
                              {"version", text()},
                              {"links", list_of(schema_ref("link"))}},
                             {"links"})},
      {"conformance", object({{"conformsTo", list_of(text())}}, {"conformsTo"})},
      {"processSummary", object({{"id", text()},
                                 {"version", text()},
                                 {"title", text()},
                                 {"description", text()},
                                 {"jobControlOptions", list_of(text())},
                                 {"outputTransmission", list_of(one_of({"value", "reference"}))},
                                 {"links", list_of(schema_ref("link"))}},
                                {"id", "version"})},
      {"processList", object({{"processes", list_of(schema_ref("processSummary"))},
                              {"links", list_of(schema_ref("link"))}},
                             {"processes", "links"})},
      {"process",
       {{"allOf",
         Json::array({schema_ref("processSummary"),
                      object({{"inputs", {{"type", "object"}}}, {"outputs", {{"type", "object"}}}},
                             {})})}}},
      {"output", object({{"transmissionMode", one_of({"value", "reference"})},
                         {"format", object({{"mediaType", text()}}, {})}},
                        {})},
      {"subscriber",
       object({{"successUri", url()}, {"inProgressUri", url()}, {"failedUri", url()}}, {})},
      {"qualifiedValue", object({{"value", Json::object()},
                                 {"mediaType", text()},
                                 {"encoding", text()},
                                 {"schema", Json::object()}},
                                {"value"})},
      {"statusInfo",
       object({{"processID", text()},
               {"type", one_of({"process"})},
               {"jobID", text()},
               {"status", one_of({"accepted", "running", "successful", "failed", "dismissed"})},
               {"message", text()},
               {"created", date_time()},
               {"started", date_time()},
               {"finished", date_time()},
               {"updated", date_time()},
               {"progress", {{"type", "integer"}, {"minimum", 0}, {"maximum", 100}}},
               {"stage", text()},
               {"done", whole_number(0)},
               {"total", whole_number(0)},
               {"cached", boolean()},
               {"exception", schema_ref("problem")},
               {"links", list_of(schema_ref("link"))}},
              {"jobID", "status", "type"})},
      {"jobList",
       object({{"jobs", list_of(schema_ref("statusInfo"))}, {"links", list_of(schema_ref("link"))}},
              {"jobs", "links"})},
      {"results",
       {{"type", "object"},
        {"description", "Output id to value, qualified value or link."},
        {"additionalProperties", true}}},
      {"estimate",
       object(
           {{"process", text()},
            {"buildings", whole_number(0)},
            {"expected",
             object({{"triangles", whole_number(0)},
                     {"bytes", whole_number(0)},
                     {"outputs", {{"type", "object"}, {"additionalProperties", whole_number(0)}}}},
                    {"triangles", "bytes", "outputs"})},
            {"crs", text()},
            {"problems", list_of(text())}},
           {"process", "buildings", "expected", "crs", "problems"})},
      {"problem", object({{"type", text()},
                          {"title", text()},
                          {"status", {{"type", "integer"}}},
                          {"detail", text()},
                          {"instance", text()}},
                         {"type"})}};
  for (const auto& process : offered_processes())
    all[execute_schema_name(process)] = execute_schema(process);
  return all;
}

Json header(std::string_view description, Json schema) {
  return {{"description", description}, {"schema", std::move(schema)}};
}

Json binary() { return {{"type", "string"}, {"format", "binary"}}; }

/// A file of any output: JSON of any form, or bytes.
Json file_content() {
  Json forms = Json::object();
  for (const auto& process : offered_processes())
    for (const auto& output : process.outputs)
      if (is_json(output)) forms[std::string(output.media_type)]["schema"] = Json::object();
  forms["*/*"]["schema"] = binary();
  return forms;
}

/// Results in every form that a request can ask for.
Json result_answers() {
  auto forms = file_content();
  forms["application/json"]["schema"] = schema_ref("results");
  forms["multipart/related"]["schema"] = text();
  return {{"200",
           {{"description", "A document of values and links, or raw values"},
            {"content", std::move(forms)}}},
          {"204",
           {{"description", "Raw results by reference, in `Link` headers"},
            {"headers", {{"Link", header("One per output", text())}}}}}};
}

/// What a subscriber is sent, by POST to its address.
Json callbacks() {
  const auto told = [](std::string_view what, std::string_view schema) {
    Json post = {
        {"summary", what},
        {"parameters",
         Json::array({parameter("Citymesh-Signature", "header", "`t=SECONDS,v1=HMAC`", text()),
                      parameter("Idempotency-Key", "header",
                                "The same for every attempt to say the same", text())})},
        {"requestBody",
         {{"required", true}, {"content", content("application/json", schema_ref(schema))}}},
        {"responses", {{"2XX", {{"description", "Received; anything else is tried again"}}}}}};
    return Json{{"post", std::move(post)}};
  };
  return {{"successful",
           {{"{$request.body#/subscriber/successUri}",
             told("The job was successful: links to its results", "results")}}},
          {"inProgress",
           {{"{$request.body#/subscriber/inProgressUri}", told("The job gets on", "statusInfo")}}},
          {"failed",
           {{"{$request.body#/subscriber/failedUri}",
             told("The job failed or was dismissed", "statusInfo")}}}};
}

Json execution_path(const ProcessSpec& process) {
  const auto applied = header("The preferences that were honoured", text());
  auto created = json_or_page("The job is accepted; `Location` is its address.", "statusInfo");
  created["content"].erase("text/html");
  created["headers"] = {{"Location", header("Absolute URL of the job", url())},
                        {"Preference-Applied", applied}};
  Json answers = Json::object();
  if (!process.async_only) {
    answers = result_answers();
    for (auto& answer : answers) {
      answer["headers"]["Content-Location"] = header("Where the results stay", url());
      answer["headers"]["Preference-Applied"] = applied;
    }
    created["description"] =
        "The job is accepted or not yet done; `Location` is its address, and it goes on.";
  }
  if (find_process(process.id) != nullptr) {
    auto& answer = answers["200"];
    auto& schema = answer["content"]["application/json"]["schema"];
    schema = schema.is_null() ? schema_ref("estimate")
                              : Json{{"anyOf", Json::array({schema_ref("estimate"), schema})}};
    answer["description"] = answer.value("description", "") +
                            (answer.contains("description") ? "; with `mode` " : "With `mode` ") +
                            "`estimate`: what would be processed. No job is made.";
  }
  answers["201"] = std::move(created);
  const auto* prefer =
      process.async_only ? "Always executed as a job; `respond-async` is confirmed."
                         : "`respond-async`: a job at once; `wait=10`: a job when the results are "
                           "not there after 10 seconds; without it the results.";
  auto post = operation(
      fmt::format("execute-{}", process.id), "Processes", fmt::format("Execute {}", process.id),
      process.description,
      Json::array({parameter("Prefer", "header", prefer, text()),
                   parameter("Idempotency-Key", "header",
                             "A text of the client's own, for instance a UUID: the same request "
                             "with the same key again gets the same job.",
                             text())}),
      std::move(answers));
  post["requestBody"] = {
      {"required", true},
      {"content", content("application/json", schema_ref(execute_schema_name(process)))}};
  post["callbacks"] = callbacks();
  return {{"post", std::move(post)}};
}

Json result_operation(const Json& job_id) {
  const auto etag = header("Names this file; it never changes", text());
  Json whole = {{"description", "The file"},
                {"headers", {{"ETag", etag}, {"Accept-Ranges", header("`bytes`", text())}}},
                {"content", file_content()}};
  Json part = whole;
  part["content"] = content("*/*", binary());
  part["description"] = "The range asked for";
  part["headers"]["Content-Range"] = header("`bytes first-last/size`", text());
  return operation(
      "result", "Jobs", "One result file",
      "It never changes. Ranges and ETags spare what the client has already.",
      Json::array({job_id,
                   parameter("output", "path", "An output (`obj`) or a result file (`picture.svg`)",
                             text()),
                   parameter("Range", "header", "One range of bytes, as `bytes=0-499`", text()),
                   parameter("If-Range", "header", "The ETag of which the range is wanted", text()),
                   parameter("If-None-Match", "header", "ETags of what the client has", text())}),
      {{"200", std::move(whole)},
       {"206", std::move(part)},
       {"304", {{"description", "The client has it"}, {"headers", {{"ETag", etag}}}}}});
}

Json paths() {
  const auto f = ref("parameters", "f");
  const auto limit = ref("parameters", "limit");
  const auto offset = ref("parameters", "offset");
  const auto process_id = ref("parameters", "processID");
  const auto job_id = ref("parameters", "jobID");
  const auto get = [](Json described) { return Json{{"get", std::move(described)}}; };
  const auto plain = [](std::string_view description) {
    return Json{
        {"200", {{"description", description}, {"content", content("text/plain", text())}}}};
  };

  Json api_answer = {{"description", "This description"},
                     {"content", content(kOpenApiMediaType, {{"type", "object"}})}};
  api_answer["content"]["text/html"] = {{"schema", text()}};

  Json all = Json::object();
  all["/"] = get(operation("landing", "Service", "Landing page",
                           "Title and links to everything else.", Json::array({f}),
                           {{"200", json_or_page("Where everything is", "landingPage")}}));
  all["/api"] = get(operation("api", "Service", "This API definition",
                              "OpenAPI 3.0, made from the tables that the program itself uses.",
                              Json::array({f}), {{"200", api_answer}}));
  all["/openapi.json"] =
      get(operation("openapi", "Service", "The same under its usual name", "What `/api` answers.",
                    Json::array({f}), {{"200", std::move(api_answer)}}));
  all["/conformance"] =
      get(operation("conformance", "Service", "Conformance classes",
                    "What of OGC API - Processes 1.0 is supported.", Json::array({f}),
                    {{"200", json_or_page("Conformance classes", "conformance")}}));
  all["/processes"] = get(operation("processes", "Processes", "List of processes",
                                    "With their ids, and links to what they take and make.",
                                    Json::array({limit, offset, f}),
                                    {{"200", json_or_page("Processes", "processList")}}));
  all["/processes/{processID}"] = get(operation(
      "process", "Processes", "Inputs and outputs of a process",
      "The JSON Schema of every input, and the media types of every output.",
      Json::array({process_id, f}), {{"200", json_or_page("Process description", "process")}}));
  for (const auto& process : offered_processes())
    all[fmt::format("/processes/{}/execution", process.id)] = execution_path(process);

  all["/jobs"] = get(operation(
      "jobs", "Jobs", "List of jobs, newest first",
      "Those of the client that asks. The link `next` leads to the next page.",
      Json::array(
          {limit, offset,
           parameter("type", "query", "Only jobs of processes exist", list_of(one_of({"process"}))),
           parameter("processID", "query", "Jobs of these processes", list_of(text())),
           parameter("status", "query", "Jobs in these states",
                     list_of(one_of({"accepted", "running", "successful", "failed", "dismissed"}))),
           parameter("datetime", "query", "Created at an instant or in an interval `from/to`",
                     text()),
           parameter("minDuration", "query", "Seconds of running, at least", whole_number(0)),
           parameter("maxDuration", "query", "Seconds of running, at most", whole_number(0)), f}),
      {{"200", json_or_page("Jobs", "jobList")}}));
  for (const auto* name : {"type", "processID", "status"})
    for (auto& described : all["/jobs"]["get"]["parameters"])
      if (described.value("name", "") == name) {
        described["style"] = "form";
        described["explode"] = false;
      }

  Json job =
      get(operation("job", "Jobs", "Status of a job",
                    "State and progress; when it has ended, its results or why it failed.",
                    Json::array({job_id, f}), {{"200", json_or_page("Status", "statusInfo")}}));
  job["delete"] =
      operation("dismiss", "Jobs", "Dismiss a job",
                "It ends as dismissed, whether it waits or runs. One that has ended stays.",
                Json::array({job_id}),
                {{"200",
                  {{"description", "The dismissed job"},
                   {"content", content("application/json", schema_ref("statusInfo"))}}}});
  all["/jobs/{jobID}"] = std::move(job);

  all["/jobs/{jobID}/events"] = get(operation(
      "events", "Jobs", "Changes of a job as server-sent events",
      "One event per change until the job has ended. A client that comes back gets what is newer.",
      Json::array({job_id, parameter("Last-Event-ID", "header",
                                     "The last event seen; only what is newer is sent", text())}),
      {{"200",
        {{"description", "Events `status`, their data as JSON"},
         {"content", content("text/event-stream", text())}}},
       {"204", {{"description", "The job has ended and the client has seen it"}}}}));
  all["/jobs/{jobID}/results"] = get(operation("results", "Jobs", "Results of a job",
                                               "In the form that its request asked for.",
                                               Json::array({job_id, f}), result_answers()));
  all["/jobs/{jobID}/results/{output}"] = get(result_operation(job_id));

  all["/healthz"] = get(operation("healthz", "Operations", "Whether the server runs",
                                  "For supervisors.", Json::array(), plain("It does")));
  all["/readyz"] =
      get(operation("readyz", "Operations", "Whether jobs can be taken",
                    "The stores answer. For load balancers.", Json::array(), plain("They can")));
  all["/metrics"] = get(operation("metrics", "Operations", "Metrics",
                                  "What docs/operations.md lists, in Prometheus's text format.",
                                  Json::array(), plain("Metrics")));
  return all;
}

/// The two ways to show who one is, and where nobody has to.
void add_security(Json& document, bool (*is_open)(std::string_view method, std::string_view path)) {
  document["components"]["securitySchemes"] = {
      {"bearer",
       {{"type", "http"},
        {"scheme", "bearer"},
        {"description", "An API key, or a token of the identity provider"}}},
      {"apiKey",
       {{"type", "apiKey"},
        {"in", "header"},
        {"name", "X-API-Key"},
        {"description", "An API key"}}}};
  document["security"] = Json::array({{{"bearer", Json::array()}}, {{"apiKey", Json::array()}}});
  for (auto& [path, operations] : document["paths"].items())
    for (auto& [method, described] : operations.items())
      if (is_open(method, path)) described["security"] = Json::array();
}

}  // namespace

std::string openapi_json(std::string_view server_url,
                         bool (*is_open)(std::string_view method, std::string_view path)) {
  Json problem = {{"description", "What is wrong"},
                  {"content", content("application/problem+json", schema_ref("problem"))}};
  problem["content"]["application/json"] = {{"schema", schema_ref("problem")}};
  problem["content"]["text/html"] = {{"schema", text()}};

  Json document = {
      {"openapi", "3.0.3"},
      {"info",
       {{"title", "citymesh"},
        {"version", version()},
        {"description",
         "3D city models in, closed, 2-manifold, simulation-ready meshes out: OGC API - Processes "
         "1.0."},
        {"license",
         {{"name", "GPL-3.0-or-later"}, {"url", "https://www.gnu.org/licenses/gpl-3.0.html"}}}}},
      {"servers", Json::array({Json{{"url", server_url}}})},
      {"security", Json::array()},
      {"tags", Json::array({Json{{"name", "Service"}, {"description", "What is here"}},
                            Json{{"name", "Processes"}, {"description", "What can be done"}},
                            Json{{"name", "Jobs"}, {"description", "What is being done"}},
                            Json{{"name", "Operations"}, {"description", "For operators"}}})},
      {"paths", paths()},
      {"components",
       {{"schemas", schemas()},
        {"responses", {{"Problem", std::move(problem)}}},
        {"parameters",
         {{"f", parameter("f", "query", "Overrides the Accept header", one_of({"json", "html"}))},
          {"limit", parameter("limit", "query", "Largest number of entries", whole_number(1))},
          {"offset", parameter("offset", "query", "Entries to skip", whole_number(0))},
          {"processID", parameter("processID", "path", "Id of a process", text())},
          {"jobID", parameter("jobID", "path", "Id of a job", text())}}}}}};
  if (is_open != nullptr) add_security(document, is_open);
  return dump(document);
}

}  // namespace citymesh
