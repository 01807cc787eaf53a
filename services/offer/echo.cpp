#include "services/offer/echo.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace citymesh {
namespace {

using nlohmann::json;

constexpr std::string_view kPause = "pause";
constexpr double kLongestPause_s = 60;
constexpr auto kProgressEvery = std::chrono::milliseconds(100);

constexpr std::string_view kText = "text/plain";
constexpr std::string_view kJson = "application/json";
constexpr std::string_view kBytes = "application/octet-stream";

constexpr std::string_view kListSchema = R"({"type":"array","items":{"type":"string"}})";
constexpr std::string_view kObjectSchema = R"({"type":"object"})";
constexpr std::string_view kMeasureSchema =
    R"({"type":"object","properties":{"measurement":{"type":"number"},"uom":{"type":"string"}}})";
constexpr std::string_view kBoxSchema =
    R"({"type":"object","format":"ogc-bbox","required":["bbox"],"properties":{)"
    R"("bbox":{"type":"array","items":{"type":"number"},"minItems":4,"maxItems":6},)"
    R"("crs":{"type":"string"}}})";
constexpr std::string_view kBinarySchema =
    R"({"type":"string","format":"byte","contentEncoding":"base64",)"
    R"("contentMediaType":"application/octet-stream"})";

/// An input and the output that it comes back as.
struct Echoed {
  std::string_view name;
  OptionKind kind;
  std::string_view description;
  std::string_view schema_json;
  std::string_view media_type;
  std::string_view file_name;
};

// The official suite takes the first one for its text and leaves out what it does not know.
constexpr std::array<Echoed, 9> kEchoed{{
    {"text", OptionKind::Text, "Any text.", R"({"type":"string"})", kText, "text.txt"},
    {"number", OptionKind::Number, "Any number.", R"({"type":"number"})", kJson, "number.json"},
    {"integer", OptionKind::Integer, "Any whole number.", R"({"type":"integer"})", kJson,
     "integer.json"},
    {"boolean", OptionKind::Boolean, "True or false.", R"({"type":"boolean"})", kJson,
     "boolean.json"},
    {"list", OptionKind::Json, "A list; a single text stands for a list of one.", kListSchema,
     kJson, "list.json"},
    {"object", OptionKind::Json, "Any JSON value, as {\"value\": {...}}.", kObjectSchema, kJson,
     "object.json"},
    {"measure", OptionKind::Json, "A number with its unit, as {\"value\": {...}}.", kMeasureSchema,
     kJson, "measure.json"},
    {"box", OptionKind::Json, "A bounding box, anywhere, in any CRS.", kBoxSchema, kJson,
     "box.json"},
    {"binary", OptionKind::Text, "Bytes in base64; the output is the bytes.", kBinarySchema, kBytes,
     "binary.bin"},
}};

struct Table {
  Table() {
    for (const auto& echoed : kEchoed) {
      inputs.push_back(
          {echoed.name, echoed.kind, "null", echoed.description, {}, 0, 0, echoed.schema_json});
      outputs.push_back({echoed.name, echoed.media_type, echoed.description,
                         echoed.media_type == kJson ? echoed.schema_json : std::string_view()});
    }
    inputs.push_back({kPause,
                      OptionKind::Number,
                      "0",
                      "Seconds to wait before the answer.",
                      {},
                      0,
                      kLongestPause_s});
    process = {kEcho,
               "Echo",
               "Gives every input back as the output of the same name, for those who write or test "
               "clients.",
               false,
               inputs,
               outputs};
  }
  Table(const Table&) = delete;  // it points into itself
  Table& operator=(const Table&) = delete;

  std::vector<OptionSpec> inputs{};
  std::vector<OutputSpec> outputs{};
  ProcessSpec process{};
};

Error wrong(std::string_view name, std::string_view expected) {
  return fail(ErrorCode::InvalidArgument, fmt::format("input `{}`: expected {}", name, expected));
}

std::optional<std::string> decode_base64(std::string_view text) {
  const auto content = text.find('=');
  const auto padding = content == std::string_view::npos ? 0 : text.size() - content;
  if (text.size() % 4 != 0 || padding > 2) return std::nullopt;
  std::string bytes(text.size() / 4 * 3, '\0');
  const int size = EVP_DecodeBlock(reinterpret_cast<unsigned char*>(bytes.data()),
                                   reinterpret_cast<const unsigned char*>(text.data()),
                                   static_cast<int>(text.size()));
  if (size < static_cast<int>(padding)) return std::nullopt;
  bytes.resize(static_cast<std::size_t>(size) - padding);  // EVP_DecodeBlock counts the padding
  return bytes;
}

bool is_box(const json& value) {
  if (!value.is_object() || !value.contains("bbox")) return false;
  const auto& numbers = value["bbox"];
  return numbers.is_array() && (numbers.size() == 4 || numbers.size() == 6) &&
         std::ranges::all_of(numbers, [](const json& number) { return number.is_number(); });
}

/// False when stopped meanwhile.
bool pause(double seconds, const RunContext& context) {
  using Clock = std::chrono::steady_clock;
  const auto total = static_cast<std::uint64_t>(std::llround(seconds));
  const auto start = Clock::now();
  const auto end =
      start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  while (!context.stopped() && Clock::now() < end) {
    const auto passed = std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - start);
    context.report({kPause, std::min(static_cast<std::uint64_t>(passed.count()), total), total});
    wake.wait_until(lock, context.stop, std::min(end, Clock::now() + kProgressEvery),
                    [] { return false; });
  }
  return !context.stopped();
}

std::string content_of(const Echoed& echoed, const json& value) {
  if (echoed.media_type == kText) return value.get<std::string>();
  if (echoed.media_type == kBytes)
    return decode_base64(value.get<std::string>()).value_or(std::string());
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

const ProcessSpec& echo_process() {
  static const Table kTable;
  return kTable.process;
}

Result<std::string> checked_echo_inputs(std::string_view inputs_json) {
  auto complete = complete_inputs(echo_process(), inputs_json);
  if (!complete) return complete;
  auto inputs = json::parse(*complete);
  auto& list = inputs["list"];
  if (list.is_string()) list = json::array({list});
  if (!list.is_null() && !list.is_array()) return wrong("list", "a list");
  if (!inputs["box"].is_null() && !is_box(inputs["box"]))
    return wrong("box",
                 "an object {\"bbox\": [minx, miny, maxx, maxy] or 6 numbers, \"crs\": uri}");
  if (inputs["binary"].is_string() && !decode_base64(inputs["binary"].get<std::string>()))
    return wrong("binary", "bytes in base64");
  return inputs.dump(-1, ' ', false, json::error_handler_t::replace);
}

Result<std::vector<EchoedFile>> run_echo(std::string_view inputs_json,
                                         const std::filesystem::path& folder,
                                         const RunContext& context) {
  const auto checked = checked_echo_inputs(inputs_json);
  if (!checked) return checked.error();
  const auto inputs = json::parse(*checked);
  if (!pause(inputs[kPause].get<double>(), context))
    return fail(ErrorCode::Cancelled, "stopped before the end");

  std::vector<EchoedFile> files;
  for (const auto& echoed : kEchoed) {
    const auto& value = inputs[echoed.name];
    if (value.is_null()) continue;
    std::ofstream file(folder / echoed.file_name, std::ios::binary);
    file << content_of(echoed, value);
    if (!file.flush())
      return fail(ErrorCode::Unavailable, fmt::format("cannot write '{}'", echoed.file_name));
    files.push_back({echoed.name, echoed.file_name, echoed.media_type});
  }
  return files;
}

}  // namespace citymesh
