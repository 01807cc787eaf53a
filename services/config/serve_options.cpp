#include "services/config/serve_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <regex>
#include <system_error>
#include <utility>

namespace citymesh {
namespace {

constexpr double kLongestLease_s = 3600;
constexpr double kLongestSyncWait_s = 3600;
constexpr double kLongestTimeout_s = 3600;
constexpr unsigned kMostThreads = 256;
constexpr std::array<std::string_view, 4> kLogLevels{"debug", "info", "warning", "error"};

template <class Value>
Error wrong(std::string_view name, const Value& value, std::string_view expected) {
  return fail(ErrorCode::InvalidArgument,
              fmt::format("{} is {}, expected {}", name, value, expected));
}

bool knows_clients(const ServeOptions& options) {
  return !options.api_keys.empty() || !options.oidc_jwks.empty();
}

/// As browsers send it: no path and no slash at the end, small letters, no port that goes without
/// saying.
bool is_web_origin(std::string_view text) {
  const bool secure = text.starts_with("https://");
  if (!secure && !text.starts_with("http://")) return false;
  const auto host = text.substr(text.find("://") + 3);
  return !host.empty() && !host.ends_with(secure ? ":443" : ":80") &&
         std::ranges::all_of(host, [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
                  std::string_view("-._:[]").find(c) != std::string_view::npos;
         });
}

Result<void> check_web_origins(std::string_view list) {
  if (list == "*") return {};
  while (!list.empty()) {
    const auto comma = std::min(list.find(','), list.size());
    auto origin = list.substr(0, comma);
    list.remove_prefix(std::min(comma + 1, list.size()));
    while (origin.starts_with(' ')) origin.remove_prefix(1);
    while (origin.ends_with(' ')) origin.remove_suffix(1);
    if (!is_web_origin(origin))
      return wrong("--cors_allow_origin", fmt::format("'{}'", origin),
                   "* or origins by comma as browsers send them, for example "
                   "https://portal.example or http://localhost:3000");
  }
  return {};
}

bool is_database(const std::string& url) {
  return url.starts_with("postgresql://") || url.starts_with("postgres://");
}

Result<void> check_access(const ServeOptions& options) {
  const bool tokens = !options.oidc_jwks.empty();
  for (const auto& [name, value] : {std::pair("--oidc_issuer", options.oidc_issuer),
                                    std::pair("--oidc_audience", options.oidc_audience)}) {
    if (tokens && value.empty())
      return fail(ErrorCode::InvalidArgument,
                  fmt::format("{} is missing; expected with --oidc_jwks, so that tokens for "
                              "others are refused",
                              name));
    if (!tokens && !value.empty())
      return wrong(name, value, "public keys in --oidc_jwks beside it");
  }
  if (tokens && options.oidc_role_claim.empty())
    return wrong("--oidc_role_claim", "empty", "the name of a claim, for example roles");
  if (options.tls_certificate.empty() != options.tls_key.empty())
    return fail(ErrorCode::InvalidArgument,
                "one of --tls_certificate and --tls_key is missing; expected both or none");
  if (knows_clients(options) && options.insecure)
    return fail(ErrorCode::InvalidArgument,
                "--insecure is given, expected not together with --api_keys or --oidc_jwks");
  if (knows_clients(options) || options.insecure) return {};
  for (const auto& [name, endpoint] :
       {std::pair("--listen", options.listen), std::pair("--grpc", options.grpc)})
    if (!is_loopback(endpoint))
      return wrong(name, to_string(endpoint),
                   "a loopback address, or --api_keys or --oidc_jwks: whoever reaches it "
                   "could submit, read and dismiss jobs (--insecure if that is meant)");
  return {};
}

}  // namespace

Result<Endpoint> parse_endpoint(std::string_view text) {
  const auto refuse = [&] {
    return fail(ErrorCode::InvalidArgument,
                fmt::format("'{}' is no address to listen on; expected HOST:PORT, for example "
                            "127.0.0.1:8080 or [::1]:8080",
                            text));
  };
  Endpoint endpoint{"127.0.0.1", 0};
  auto port = text;
  if (const auto colon = text.rfind(':'); colon != std::string_view::npos) {
    auto host = text.substr(0, colon);
    port = text.substr(colon + 1);
    if (host.starts_with('[') && host.ends_with(']'))
      host = host.substr(1, host.size() - 2);
    else if (host.find(':') != std::string_view::npos)
      return refuse();
    if (host.empty()) return refuse();
    endpoint.host = host == "localhost" ? "127.0.0.1" : host;
  }
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), endpoint.port);
  if (port.empty() || error != std::errc{} || end != port.data() + port.size()) return refuse();
  return endpoint;
}

std::string to_string(const Endpoint& endpoint) {
  const auto ipv6 = endpoint.host.find(':') != std::string::npos;
  return fmt::format("{}{}{}:{}", ipv6 ? "[" : "", endpoint.host, ipv6 ? "]" : "", endpoint.port);
}

bool is_loopback(const Endpoint& endpoint) {
  return endpoint.host.starts_with("127.") || endpoint.host == "::1";
}

std::string without_passwords(const std::string& text) {
  static const std::regex kUrl(R"((://[^:/@\s"]*):[^/\s"]*@)"), kWord(R"((password=)[^&\s"]*)");
  return std::regex_replace(std::regex_replace(text, kUrl, "$1:***@"), kWord, "$1***");
}

Result<void> check(const ServeOptions& options) {
  if (options.data.empty() == options.source.empty())
    return fail(ErrorCode::InvalidArgument,
                options.data.empty()
                    ? "--data is missing; expected a folder of CityGML or CityJSON files, or "
                      "--source with the URL of a 3DCityDB or a WFS"
                    : "--data and --source are both given; expected one of them");
  std::error_code error;
  constexpr std::array<std::string_view, 4> kSources{"postgresql://", "postgres://", "https://",
                                                     "http://"};
  if (!options.source.empty() && std::ranges::none_of(kSources, [&](std::string_view begin) {
        return options.source.starts_with(begin);
      }))
    return wrong("--source", fmt::format("'{}'", without_passwords(options.source)),
                 "postgresql://user@host:port/database of a 3DCityDB or the https URL of a WFS");
  if (options.source_schema.empty())
    return wrong("--source_schema", "empty", "the schema of the 3DCityDB, for example citydb");
  if (options.source_connections < 1 || options.source_connections > kMostThreads)
    return wrong("--source_connections", options.source_connections,
                 fmt::format("1 to {}", kMostThreads));
  if (options.write_back_schema.empty() && !options.write_back_url.empty())
    return fail(ErrorCode::InvalidArgument,
                "--write_back_url is given without --write_back_schema; expected both");
  if (!options.write_back_schema.empty()) {
    if (!is_database(options.source))
      return wrong("--write_back_schema", fmt::format("'{}'", options.write_back_schema),
                   "only with a 3DCityDB in --source");
    if (options.write_back_schema == options.source_schema)
      return wrong("--write_back_schema", fmt::format("'{}'", options.write_back_schema),
                   "another schema than --source_schema, which is never written to");
    if (!options.write_back_url.empty() && !is_database(options.write_back_url))
      return wrong("--write_back_url",
                   fmt::format("'{}'", without_passwords(options.write_back_url)),
                   "postgresql://user@host:port/database");
  }
  if (options.source_timeout_s < 0)
    return wrong("--source_timeout_s", options.source_timeout_s, "0 (no limit) or more");
  if (options.source.empty() && !std::filesystem::exists(options.data, error))
    return fail(ErrorCode::NotFound,
                fmt::format("--data '{}' does not exist; expected a folder of CityGML or CityJSON "
                            "files",
                            options.data.string()));
  if (options.workers < 1 || options.workers > kMostThreads)
    return wrong("--workers", options.workers, fmt::format("1 to {}", kMostThreads));
  if (options.threads > kMostThreads)
    return wrong("--threads", options.threads, fmt::format("0 to {}", kMostThreads));
  if (!(options.lease_s >= 0.1 && options.lease_s <= kLongestLease_s))
    return wrong("--lease_s", options.lease_s, fmt::format("0.1 to {}", kLongestLease_s));
  if (options.max_attempts < 1) return wrong("--max_attempts", options.max_attempts, "1 or more");
  if (!(options.job_timeout_s >= 0) || !std::isfinite(options.job_timeout_s))
    return wrong("--job_timeout_s", options.job_timeout_s, "0 (no limit) or more");
  if (!(options.max_job_area_km2 >= 0) || !std::isfinite(options.max_job_area_km2))
    return wrong("--max_job_area_km2", options.max_job_area_km2, "0 (no limit) or more");
  if (options.result_cache != "on" && options.result_cache != "off")
    return wrong("--result_cache", options.result_cache, "on or off");
  for (const auto& [name, kept_s] : {std::pair("--keep_results_s", options.keep_results_s),
                                     std::pair("--keep_jobs_s", options.keep_jobs_s)})
    if (!(kept_s >= 0) || !std::isfinite(kept_s))
      return wrong(name, kept_s, "0 (for ever) or more");
  if (options.max_open_jobs < 1)
    return wrong("--max_open_jobs", options.max_open_jobs, "1 or more");
  if (options.max_body_bytes < 1024 || options.max_body_bytes > (64u << 20))
    return wrong("--max_body_bytes", options.max_body_bytes, "1024 to 67108864");
  if (options.max_connections < 1)
    return wrong("--max_connections", options.max_connections, "1 or more");
  if (!(options.sync_wait_s >= 0 && options.sync_wait_s <= kLongestSyncWait_s))
    return wrong("--sync_wait_s", options.sync_wait_s,
                 fmt::format("0 (every execution is a job) to {}", kLongestSyncWait_s));
  for (const auto& [name, timeout_s] : {std::pair("--idle_timeout_s", options.idle_timeout_s),
                                        std::pair("--header_timeout_s", options.header_timeout_s),
                                        std::pair("--body_timeout_s", options.body_timeout_s)})
    if (!(timeout_s >= 0.1 && timeout_s <= kLongestTimeout_s))
      return wrong(name, timeout_s, fmt::format("0.1 to {}", kLongestTimeout_s));
  if (options.max_watches < 1 || options.max_watches > 4096)
    return wrong("--max_watches", options.max_watches, "1 to 4096");
  if (std::ranges::find(kLogLevels, options.log_level) == kLogLevels.end())
    return wrong("--log_level", options.log_level, "debug, info, warning or error");
  const auto& url = options.public_url;
  if (!url.empty() && !url.starts_with("http://") && !url.starts_with("https://"))
    return wrong("--public_url", url, "a URL that starts with http:// or https://");
  if (auto checked = check_web_origins(options.cors_allow_origin); !checked) return checked;
  return check_access(options);
}

}  // namespace citymesh
