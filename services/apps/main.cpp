#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <memory>
#include <string>

#include "core/base/version.h"
#include "core/processes/processes.h"
#include "core/write/write.h"
#include "services/apps/commands.h"
#include "services/apps/serve_flags.h"

namespace citymesh {
namespace {

constexpr const char* kExitCodes =
    "Exit codes: 0 done; 1 done, but objects were dropped, inputs could not be read or (validate) "
    "defects were found; 2 could not run, the reason is on stderr.";

void add_selection(CLI::App& command, RunArguments& arguments) {
  command
      .add_option("--bbox", arguments.inputs.bbox,
                  "only buildings that meet this box: minx,miny[,minz],maxx,maxy[,maxz][@CRS]; "
                  "CRS84 when no CRS is named, else the axis order of the CRS")
      ->type_name("BOX");
  command
      .add_option("--set", arguments.inputs.settings,
                  "an input of the process, name=value; `citymesh processes` lists them")
      ->allow_extra_args(false)
      ->type_name("NAME=VALUE");
  command.add_option("--threads", arguments.threads, "threads to use; 0: one per core")
      ->check(CLI::Range(0u, 256u));
  command.add_flag("--overwrite", arguments.overwrite,
                   "replace the results of an earlier run in the output folder");
  command.footer(kExitCodes);
}

void add_format(CLI::App& command, RunArguments& arguments) {
  command
      .add_option("--format", arguments.inputs.formats,
                  "formats to write, by comma; available: " + format_keys())
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("FORMAT");
}

void add_output(CLI::App& command, RunArguments& arguments) {
  command
      .add_option("--output", arguments.output,
                  "folder for the results; created if needed. Not needed with `--set "
                  "mode=estimate`, which prints what would be processed")
      ->type_name("DIR");
}

void add_run(CLI::App& program, RunArguments& arguments, int& code) {
  auto& command = *program.add_subcommand("run", "runs a process on files, without a service");
  command.add_option("process", arguments.process, "one of: " + process_ids())
      ->required()
      ->type_name("PROCESS");
  command
      .add_option("--input", arguments.files,
                  "CityGML or CityJSON files (also .gz), or folders of them")
      ->required()
      ->type_name("FILE");
  add_output(command, arguments);
  add_format(command, arguments);
  add_selection(command, arguments);
  command.callback([&] { code = run_command(arguments); });
}

void add_validate(CLI::App& program, RunArguments& arguments, int& code) {
  auto& command = *program.add_subcommand("validate", "finds the defects of buildings in files");
  command.add_option("file", arguments.files, "CityGML or CityJSON files (also .gz), or folders")
      ->required()
      ->type_name("FILE");
  command
      .add_option("--output", arguments.output,
                  "folder for the results; without it the JSON report goes to stdout")
      ->type_name("DIR");
  add_selection(command, arguments);
  command.callback([&] {
    arguments.process = "validate";
    code = run_command(arguments);
  });
}

void add_heal(CLI::App& program, RunArguments& arguments, int& code) {
  auto& command = *program.add_subcommand(
      "heal", "repairs the buildings in files and writes the city model again");
  command.add_option("file", arguments.files, "CityGML or CityJSON files (also .gz), or folders")
      ->required()
      ->type_name("FILE");
  add_output(command, arguments);
  add_format(command, arguments);
  add_selection(command, arguments);
  command.callback([&] {
    arguments.process = "heal";
    code = run_command(arguments);
  });
}

void add_index(CLI::App& program, IndexArguments& arguments, int& code) {
  auto& command = *program.add_subcommand(
      "index", "builds or updates the catalogue of a folder: boxes and ids are then found at once");
  command.add_option("folder", arguments.data, "folder of city models")
      ->required()
      ->type_name("DIR");
  command
      .add_option("--state", arguments.state,
                  "folder for the catalogue and unpacked copies; default: DIR/.citymesh, which "
                  "`run --input DIR` and `serve --data DIR` then use")
      ->type_name("DIR");
  command.add_option("--threads", arguments.threads, "threads to use; 0: one per core")
      ->check(CLI::Range(0u, 256u));
  command.footer("Exit codes: 0 done; 1 done, but files could not be read; 2 could not run.");
  command.callback([&] { code = index_command(arguments); });
}

void add_make_key(CLI::App& program, int& code) {
  auto& command = *program.add_subcommand("make-key",
                                          "makes an API key for the service: `citymesh make-key "
                                          "map-portal submit >> keys`");
  const auto name = std::make_shared<std::string>();
  const auto role = std::make_shared<std::string>();
  command.add_option("name", *name, "the client; keys of one name stand for one client")
      ->required()
      ->type_name("NAME");
  command
      .add_option(
          "role", *role,
          "read-own (see its jobs), submit (and make and dismiss them), write-back (and let "
          "them write to the database) or admin (and see and dismiss those of all)")
      ->required()
      ->type_name("ROLE");
  command.footer(
      "The key goes to stderr and is kept nowhere; its line for the file that `serve --api_keys` "
      "reads goes to stdout.");
  command.callback([name, role, &code] { code = make_key_command(*name, *role); });
}

void add_openapi(CLI::App& program, int& code) {
  auto& command =
      *program.add_subcommand("openapi", "prints the OpenAPI description of the REST API");
  const auto server = std::make_shared<std::string>("http://127.0.0.1:8080");
  command.add_option("--server", *server, "URL of the server that the description names")
      ->type_name("URL")
      ->capture_default_str();
  command.callback([server, &code] { code = openapi_command(*server); });
}

int run_program(int argc, char** argv) {
  CLI::App program{
      "citymesh turns 3D city models into closed, 2-manifold, simulation-ready meshes.",
      "citymesh"};
  program.set_version_flag("--version", "citymesh " + std::string(version()));
  program.footer(kExitCodes);
  program.get_formatter()->column_width(34);

  int code = kDone;
  RunArguments run_arguments, validate_arguments, heal_arguments;
  IndexArguments index_arguments;
  ServeOptions serve_options;
  add_run(program, run_arguments, code);
  add_validate(program, validate_arguments, code);
  add_heal(program, heal_arguments, code);
  add_index(program, index_arguments, code);
  add_serve(program, serve_options, [&] { code = serve_command(serve_options); });
  program.add_subcommand("processes", "prints the processes with their inputs and outputs")
      ->callback([&] { code = processes_command(); });

  add_make_key(program, code);
  add_openapi(program, code);

  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // Help and version are no errors; whatever else the command line gets wrong is one kind.
    return program.exit(error, std::cout, std::cerr) == 0 ? kDone : kCouldNotRun;
  }
  if (program.get_subcommands().empty())
    return could_not_run(fail(ErrorCode::InvalidArgument,
                              "a subcommand is missing, expected one of run, validate, heal, "
                              "index, serve, make-key, processes, openapi; --help tells more"));
  return code;
}

}  // namespace
}  // namespace citymesh

int main(int argc, char** argv) {
  try {
    return citymesh::run_program(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "citymesh: unexpected error: " << error.what() << '\n';
  } catch (...) {
    std::cerr << "citymesh: unexpected error\n";
  }
  return citymesh::kCouldNotRun;
}
