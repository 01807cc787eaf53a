#include "services/apps/serve_flags.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <utility>

namespace citymesh {
namespace {

/// Of a flag or a name in the file.
std::string environment_name(std::string_view name) {
  std::string result = "CITYMESH_";
  for (const char c : name.substr(std::min(name.find_first_not_of('-'), name.size())))
    result += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return result;
}

/// Leaves out of the file what the environment says: CLI11 would let the file win.
class FileBelowEnvironment : public CLI::ConfigTOML {
 public:
  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override {
    auto settings = CLI::ConfigTOML::from_config(input);
    std::erase_if(settings, [](const CLI::ConfigItem& item) {
      return std::getenv(environment_name(item.name).c_str()) != nullptr;
    });
    return settings;
  }
};

CLI::Option* add_endpoint(CLI::App& command, const std::string& name, Endpoint& endpoint,
                          const std::string& what) {
  return command
      .add_option_function<std::string>(
          name,
          [&endpoint, name](const std::string& text) {
            const auto parsed = parse_endpoint(text);
            if (!parsed) throw CLI::ValidationError(name, parsed.error().message);
            endpoint = *parsed;
          },
          what + "; port 0: any free one")
      ->type_name("HOST:PORT")
      ->default_str(to_string(endpoint));
}

}  // namespace

void add_serve(CLI::App& program, ServeOptions& options, std::function<void()> run) {
  program.config_formatter(std::make_shared<FileBelowEnvironment>());
  // CLI11 looks for the file before it looks at the environment.
  const char* named = std::getenv("CITYMESH_CONFIG");
  program
      .set_config("--config", named ? named : "",
                  "TOML file with settings of `serve` in a section [serve], below environment and "
                  "flags; default: the one that CITYMESH_CONFIG names",
                  named != nullptr)
      ->type_name("FILE");
  program.allow_config_extras(CLI::config_extras_mode::error);

  auto& command = *program.add_subcommand(
      "serve", "the job service: REST, gRPC and workers in one process, until Ctrl-C");
  command.fallthrough();  // to --config
  command.allow_config_extras(CLI::config_extras_mode::error);
  command.add_option("--data", options.data, "folder of CityGML and CityJSON files that jobs read")
      ->type_name("DIR");
  command.add_option("--state", options.state, "folder for jobs and results")
      ->type_name("DIR")
      ->capture_default_str();
  add_endpoint(command, "--listen", options.listen, "address of the REST API");
  add_endpoint(command, "--grpc", options.grpc, "address of the gRPC API");
  command
      .add_option("--public_url", options.public_url,
                  "base of all links, for a service behind a proxy; default: from the request")
      ->type_name("URL");
  const auto add = [&command](const char* name, auto& value, const char* what) {
    return command.add_option(name, value, what)->capture_default_str();
  };
  add("--source", options.source,
      "3DCityDB or WFS 2.0 that jobs read instead: postgresql://user@host:port/database (the "
      "password best in PGPASSWORD or a PGPASSFILE), or its https URL")
      ->type_name("URL");
  add("--source_schema", options.source_schema, "schema of that database");
  add("--source_connections", options.source_connections,
      "to that database, at the same time; who needs one more waits");
  add("--source_timeout_s", options.source_timeout_s,
      "of one statement of that database; 0: no limit");
  add("--write_back_schema", options.write_back_schema,
      "another schema, a 3DCityDB too, that jobs with `write_back` may write to; empty: none may");
  add("--write_back_url", options.write_back_url,
      "of its database, with a user who may write; as --source when empty")
      ->type_name("URL");
  add("--api_keys", options.api_keys,
      "file of the API keys that are accepted, by lines of `citymesh make-key`")
      ->type_name("FILE");
  add("--oidc_jwks", options.oidc_jwks,
      "JSON Web Key Set of those who issue the tokens that are accepted: a file, or a https URL "
      "from which it is fetched")
      ->type_name("FILE|URL");
  add("--oidc_issuer", options.oidc_issuer, "issuer that tokens must name (`iss`)");
  add("--oidc_audience", options.oidc_audience, "audience that tokens must name (`aud`)");
  add("--oidc_role_claim", options.oidc_role_claim,
      "claim with the roles of a token, or the path to it, for example realm_access.roles");
  add("--oidc_role_prefix", options.oidc_role_prefix,
      "what the names of our roles begin with in that claim");
  add("--tls_certificate", options.tls_certificate,
      "PEM file with the certificate of REST and gRPC and those that issued it")
      ->type_name("FILE");
  add("--tls_key", options.tls_key, "PEM file with the key of the certificate")->type_name("FILE");
  add("--trusted_proxies", options.trusted_proxies,
      "networks by comma whose Forwarded and X-Forwarded headers are believed");
  add("--cors_allow_origin", options.cors_allow_origin,
      "web pages of other origins that may use the REST API in a browser: * for all, or origins by "
      "comma")
      ->type_name("LIST");
  command.add_flag("--insecure", options.insecure,
                   "listen on the network although everybody may do everything");
  add("--callback_secret", options.callback_secret,
      "file with the secret that signs messages to subscribers; without it they are not signed")
      ->type_name("FILE");
  command.add_flag(
      "--allow_private_callbacks", options.allow_private_callbacks,
      "subscribers may also be in networks that are not public, this machine included");
  add("--workers", options.workers, "jobs worked on at the same time");
  add("--threads", options.threads, "threads of all workers together; 0: one per core");
  add("--lease_s", options.lease_s, "a worker not heard of for so long counts as dead");
  add("--max_attempts", options.max_attempts, "deaths of a worker after which its job is failed");
  add("--job_timeout_s", options.job_timeout_s, "a job that runs longer is failed; 0: no limit");
  add("--max_job_area_km2", options.max_job_area_km2, "area of a job's box; 0: no limit");
  add("--max_job_buildings", options.max_job_buildings, "buildings of a job; 0: no limit");
  add("--max_job_points", options.max_job_points, "points of a job's buildings; 0: no limit");
  add("--max_job_bytes", options.max_job_bytes, "size of a job's results; 0: no limit");
  add("--result_cache", options.result_cache,
      "on: a job that asks for what an earlier one asked for, of the same data, gets its results; "
      "off: every job is worked on");
  add("--keep_results_s", options.keep_results_s,
      "results of an ended job are kept for so long; 0: for ever");
  add("--keep_jobs_s", options.keep_jobs_s, "an ended job is remembered for so long; 0: for ever");
  add("--max_result_bytes", options.max_result_bytes,
      "of all results together, above it the oldest go; 0: no limit");
  add("--max_open_jobs", options.max_open_jobs, "accepted and running jobs; more are refused");
  add("--max_client_jobs", options.max_client_jobs,
      "the same of each client; without authentication by address, those on this machine apart; "
      "0: no limit of its own");
  add("--max_body_bytes", options.max_body_bytes, "size of a request");
  add("--max_connections", options.max_connections, "REST connections at the same time");
  add("--max_client_connections", options.max_client_connections,
      "the same from one address; this machine and trusted proxies have no such limit; 0: none "
      "has");
  add("--idle_timeout_s", options.idle_timeout_s,
      "a REST connection without a request is closed after so long");
  add("--header_timeout_s", options.header_timeout_s, "for the header of a request to come");
  add("--body_timeout_s", options.body_timeout_s, "for the body of a request to come");
  add("--sync_wait_s", options.sync_wait_s,
      "longest wait of a synchronous REST execution, then a job is the answer");
  add("--max_watches", options.max_watches, "gRPC watch streams at the same time");
  add("--log_level", options.log_level, "debug, info, warning or error");
  for (CLI::Option* option : command.get_options())
    if (option->get_configurable() && !option->get_lnames().empty() &&
        option->get_lnames()[0] != "help")
      option->envname(environment_name(option->get_lnames()[0]));
  const auto print_config = std::make_shared<bool>(false);
  command
      .add_flag("--print_config", *print_config,
                "checks the settings, prints them as such a file, exits")
      ->configurable(false);
  command.footer(
      "Every setting can also stand in section [serve] of the file that --config names, or in the "
      "environment as CITYMESH_ and the name in capitals; flags win over the environment, that "
      "over the file. Logs are JSON lines on stdout. Exit codes: 0 stopped; 2 could not run.");
  command.callback([&options, &command, print_config, run = std::move(run)] {
    if (!*print_config) return run();
    if (const auto checked = check(options); !checked)
      throw CLI::ValidationError("serve", checked.error().message);
    std::cout << "[serve]\n" << without_passwords(command.config_to_str(true, false)) << '\n';
  });
}

}  // namespace citymesh
