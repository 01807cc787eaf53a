// citymesh_mesh_checker model.obj|model.stl [--json]
// Exit code 0: every body is sound; 1: some are not; 2: the file could not be read.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/mesh_checker/check_body.h"
#include "tests/support/mesh_checker/read_mesh.h"

namespace {

std::string json_text(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
  }
  return result + '"';
}

std::string joined(const std::vector<std::string>& texts, const char* separator, bool quote) {
  std::string result;
  for (const auto& text : texts) {
    if (!result.empty()) result += separator;
    result += quote ? json_text(text) : text;
  }
  return result;
}

}  // namespace

int main(int count, char** arguments) {
  std::string path;
  bool json = false;
  for (int i = 1; i < count; ++i) {
    if (const std::string argument = arguments[i]; argument == "--json")
      json = true;
    else
      path = argument;
  }
  const auto kind = std::filesystem::path(path).extension();
  if (kind != ".obj" && kind != ".stl") {
    std::fprintf(stderr, "usage: citymesh_mesh_checker model.obj|model.stl [--json]\n");
    return 2;
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    std::fprintf(stderr, "%s: cannot be opened\n", path.c_str());
    return 2;
  }
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  try {
    const auto bodies =
        kind == ".obj" ? mesh_checker::read_obj(text) : mesh_checker::read_stl(text);
    std::size_t triangles = 0, unsound = 0;
    double volume_m3 = 0;
    std::string failures;
    for (const auto& body : bodies) {
      triangles += body.triangles.size();
      volume_m3 += mesh_checker::signed_volume_m3(body);
      const auto findings = mesh_checker::check(body);
      if (findings.empty()) continue;
      ++unsound;
      if (json) {
        failures += (failures.empty() ? "\n" : ",\n");
        failures += "  {\"body\": " + json_text(body.name) + ", \"findings\": [" +
                    joined(findings, ", ", true) + "]}";
      } else {
        std::printf("%s: %s\n", body.name.c_str(), joined(findings, "; ", false).c_str());
      }
    }
    if (json)
      std::printf(
          "{\"file\": %s, \"bodies\": %zu, \"triangles\": %zu, \"volume_m3\": %.3f, \"unsound\": "
          "%zu, \"failures\": [%s]}\n",
          json_text(path).c_str(), bodies.size(), triangles, volume_m3, unsound, failures.c_str());
    else
      std::printf("%zu bodies, %zu triangles, %.1f m3: %zu unsound\n", bodies.size(), triangles,
                  volume_m3, unsound);
    return unsound == 0 ? 0 : 1;
  } catch (const mesh_checker::ReadError& error) {
    std::fprintf(stderr, "%s: %s\n", path.c_str(), error.what());
    return 2;
  }
}
