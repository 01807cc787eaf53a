#include "services/rest/pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/version.h"
#include "services/offer/offer.h"
#include "services/rest/documents.h"
#include "services/rest/processes.h"

namespace citymesh {
namespace {

constexpr std::string_view kStyle = R"(
body{font:16px/1.5 system-ui,sans-serif;color:#1d2733;background:#f5f6f8;margin:0}
header{background:#1d3a5f;color:#fff;padding:.8rem 1.5rem}
header a{color:#fff;text-decoration:none;margin-right:1.2rem}
header a:first-child{font-weight:700}
main{max-width:62rem;margin:1.5rem auto;padding:0 1.5rem}
h1{font-size:1.5rem;margin:.2rem 0 .6rem}h2{font-size:1.1rem;margin:1.6rem 0 .4rem}
table{border-collapse:collapse;width:100%;background:#fff}
th,td{text-align:left;padding:.4rem .7rem;border-bottom:1px solid #e2e6eb;vertical-align:top}
th{color:#55606e;font-weight:600}code,pre{font:14px/1.45 ui-monospace,monospace}
pre{background:#fff;border:1px solid #e2e6eb;padding:.8rem;overflow:auto}
a{color:#1b5fa8}details{margin-top:1.6rem}summary{cursor:pointer;color:#55606e}progress{width:100%;height:1.1rem}
.muted{color:#55606e}.badge{padding:.1rem .6rem;border-radius:1rem;color:#fff;background:#6b7683}
.running{background:#1b5fa8}.successful{background:#257a45}.failed{background:#b3261e}
img.picture{width:100%;background:#fff;border:1px solid #e2e6eb}
)";

std::string page(std::string_view base, std::string_view title, std::string_view body,
                 std::string_view head = {}) {
  const auto navigation = fmt::format(
      "<a href=\"{0}/\">citymesh</a><a href=\"{0}/processes\">Processes</a>"
      "<a href=\"{0}/jobs\">Jobs</a><a href=\"{0}/api?f=html\">API</a>",
      escape_html(base));
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
      "<title>{} - citymesh</title>{}<style>{}</style></head>\n"
      "<body><header>{}</header>\n<main>{}</main></body></html>\n",
      escape_html(title), head, kStyle, navigation, body);
}

std::string badge(JobState state) {
  return fmt::format("<span class=\"badge {0}\">{0}</span>", to_string(state));
}

std::string size_text(std::uint64_t bytes) {
  const auto value = static_cast<double>(bytes);
  if (bytes < 1'000) return fmt::format("{} B", bytes);
  if (bytes < 1'000'000) return fmt::format("{:.1f} kB", value / 1e3);
  return fmt::format("{:.1f} MB", value / 1e6);
}

std::string row(std::string_view name, std::string_view html) {
  return fmt::format("<tr><th>{}</th><td>{}</td></tr>", escape_html(name), html);
}

std::string values_text(const OptionSpec& option) {
  if (!option.choices.empty()) return fmt::format("{}", fmt::join(option.choices, ", "));
  if (option.minimum < option.maximum)
    return fmt::format("{} to {}", option.minimum, option.maximum);
  return {};
}

std::string curl_example(std::string_view base, const ProcessSpec& process) {
  auto request = nlohmann::ordered_json::parse(example_request_json(process)).dump();
  return fmt::format(
      "curl -i {}/processes/{}/execution \\\n  -H 'Content-Type: application/json' \\\n  -d '{}'",
      base, process.id, request);
}

std::string results_section(std::string_view base, const Job& job) {
  std::string html =
      "<h2>Results</h2><table><tr><th>File</th><th>Output</th><th>Type</th>"
      "<th>Size</th></tr>";
  std::string picture;
  for (const auto& file : job.results) {
    const auto url = escape_html(result_url(base, job, file));
    html += fmt::format("<tr><td><a href=\"{}\">{}</a></td><td>{}</td><td>{}</td><td>{}</td></tr>",
                        url, escape_html(file.file_name), escape_html(file.output),
                        escape_html(file.media_type), size_text(file.bytes));
    if (file.media_type == "image/svg+xml")
      picture =
          fmt::format("<p><img class=\"picture\" src=\"{}\" alt=\"The delivered scene\"></p>", url);
  }
  return html + "</table>" + picture;
}

std::string html_of(const nlohmann::ordered_json& value, std::string_view name = {}) {
  if (value.is_string()) {
    const auto text = escape_html(value.get<std::string>());
    return name == "href" ? fmt::format("<a href=\"{0}\">{0}</a>", text) : text;
  }
  if (!value.is_structured()) return escape_html(value.dump());
  std::string html = value.is_array() ? "<ol>" : "<table>";
  for (const auto& [key, member] : value.items())
    html += value.is_array() ? fmt::format("<li>{}</li>", html_of(member))
                             : row(key, html_of(member, key));
  return html + (value.is_array() ? "</ol>" : "</table>");
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  return escaped;
}

Response page_response(int status, std::string page, std::string_view document_json) {
  if (!document_json.empty())
    page.insert(page.rfind("</main>"),
                fmt::format("<details><summary>Everything that the JSON says</summary>{}</details>",
                            html_of(nlohmann::ordered_json::parse(document_json))));
  auto response = text_response(status, "text/html; charset=utf-8", std::move(page));
  response.headers.set("Content-Security-Policy",
                       "default-src 'none'; style-src 'unsafe-inline'; img-src *; base-uri 'none'; "
                       "form-action 'none'; frame-ancestors 'none'");
  return response;
}

std::string landing_page(std::string_view base) {
  const auto html = fmt::format(
      "<h1>citymesh {1}</h1><p>Turns 3D city models into closed, 2-manifold, simulation-ready "
      "meshes.</p><table>{2}{3}{4}{5}{6}</table>",
      escape_html(base), version(),
      row("Processes", fmt::format("<a href=\"{0}/processes\">{0}/processes</a>", base)),
      row("Jobs", fmt::format("<a href=\"{0}/jobs\">{0}/jobs</a>", base)),
      row("API definition",
          fmt::format("<a href=\"{0}/api?f=json\">OpenAPI 3.0</a>, <a href=\"{0}/api?f=html\">as a "
                      "page</a>",
                      base)),
      row("Conformance", fmt::format("<a href=\"{0}/conformance\">{0}/conformance</a>", base)),
      row("Metrics", fmt::format("<a href=\"{0}/metrics\">{0}/metrics</a>", base)));
  return page(base, "Welcome", html);
}

std::string conformance_page(std::string_view base, std::string_view conformance_json) {
  std::string html = "<h1>Conformance classes</h1><ul>";
  const auto document = nlohmann::json::parse(conformance_json);
  for (const auto& uri : document["conformsTo"])
    html += fmt::format("<li><code>{}</code></li>", escape_html(uri.get<std::string>()));
  return page(base, "Conformance", html + "</ul>");
}

std::string process_list_page(std::string_view base) {
  std::string html = "<h1>Processes</h1><table><tr><th>Process</th><th>What it does</th></tr>";
  for (const auto& process : offered_processes())
    html += fmt::format("<tr><td><a href=\"{}/processes/{}\">{}</a></td><td>{}</td></tr>", base,
                        process.id, process.id, escape_html(process.description));
  return page(base, "Processes", html + "</table>");
}

std::string process_page(std::string_view base, const ProcessSpec& process) {
  std::string html =
      fmt::format("<h1>{}</h1><p>{}</p><h2>Request</h2><pre>{}</pre>", escape_html(process.title),
                  escape_html(process.description), escape_html(curl_example(base, process)));
  html +=
      "<h2>Inputs</h2><table><tr><th>Name</th><th>Type</th><th>Default</th><th>Values</th>"
      "<th>Meaning</th></tr>";
  for (const auto& option : process.inputs)
    html += fmt::format(
        "<tr><td><code>{}</code></td><td>{}</td><td><code>{}</code></td><td>{}</td><td>{}</td></"
        "tr>",
        option.name, to_string(option.kind),
        option.default_json == "null" ? "" : escape_html(option.default_json),
        escape_html(values_text(option)), escape_html(option.description));
  html += "</table><h2>Outputs</h2><table><tr><th>Name</th><th>Type</th><th>Meaning</th></tr>";
  for (const auto& output : process.outputs)
    html += fmt::format("<tr><td><code>{}</code></td><td>{}</td><td>{}</td></tr>", output.id,
                        output.media_type, escape_html(output.title));
  return page(base, process.title, html + "</table>");
}

std::string job_list_page(std::string_view base, const std::vector<Job>& jobs,
                          std::string_view next) {
  std::string html =
      "<h1>Jobs</h1><table><tr><th>Job</th><th>Process</th><th>Status</th><th>Created</th>"
      "<th>Message</th></tr>";
  for (const auto& job : jobs)
    html += fmt::format(
        "<tr><td><a href=\"{}\"><code>{}</code></a></td><td>{}</td><td>{}</td><td>{}</td>"
        "<td>{}</td></tr>",
        job_url(base, job), job.id.substr(0, 8), escape_html(job.spec.process), badge(job.state),
        rfc3339(job.created), escape_html(job.message));
  html += "</table>";
  if (jobs.empty()) html += "<p class=\"muted\">No jobs.</p>";
  if (!next.empty()) html += fmt::format("<p><a href=\"{}\">Older jobs</a></p>", escape_html(next));
  return page(base, "Jobs", html);
}

std::string job_page(std::string_view base, const Job& job) {
  std::string rows = row("Job", fmt::format("<code>{}</code>", escape_html(job.id)));
  rows += row("Status", badge(job.state));
  rows += row("Message", escape_html(job.message));
  if (!job.progress.stage.empty() && job.state != JobState::Successful)
    rows += row("Stage", escape_html(job.progress.stage));
  if (job.progress.total > 0)
    rows += row("Done", fmt::format("{} of {}", job.progress.done, job.progress.total));
  rows += row("Created", rfc3339(job.created));
  if (job.started) rows += row("Started", rfc3339(*job.started));
  if (job.finished) rows += row("Finished", rfc3339(*job.finished));
  if (job.error)
    rows += row("Error",
                fmt::format("{}: {}", to_string(job.error->code), escape_html(job.error->message)));

  std::string html = fmt::format(
      "<h1>{}</h1><p><progress max=\"100\" value=\"{}\"></progress></p><table>{}</table>",
      escape_html(job.spec.process), job.percent, rows);
  if (!job.results.empty()) html += results_section(base, job);
  html += fmt::format("<h2>Inputs</h2><pre>{}</pre>", escape_html(job.spec.inputs_json));
  return page(base, job.spec.process, html,
              is_final(job.state) ? "" : "<meta http-equiv=\"refresh\" content=\"2\">");
}

std::string api_page(std::string_view base, std::string_view openapi_json) {
  std::string html = fmt::format(
      "<h1>API</h1><p>The full definition: <a href=\"{}/api?f=json\">OpenAPI 3.0</a>.</p>"
      "<table><tr><th>Request</th><th>What it does</th></tr>",
      base);
  const auto document = nlohmann::ordered_json::parse(openapi_json);
  for (const auto& [path, operations] : document["paths"].items())
    for (const auto& [method, operation] : operations.items()) {
      if (!operation.contains("summary")) continue;
      std::string verb = method;
      std::ranges::transform(verb, verb.begin(), [](char c) {
        return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
      });
      html += fmt::format("<tr><td><code>{} {}</code></td><td>{}</td></tr>", verb,
                          escape_html(path), escape_html(operation["summary"].get<std::string>()));
    }
  return page(base, "API", html + "</table>");
}

std::string problem_page(const ProblemKind& kind, std::string_view detail) {
  return page("", kind.title,
              fmt::format("<h1>{} {}</h1><p>{}</p>", kind.status, escape_html(kind.title),
                          escape_html(detail)));
}

}  // namespace citymesh
