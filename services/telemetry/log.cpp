#include "services/telemetry/log.h"

#include <fmt/chrono.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/ostream_sink.h>

#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>
#include <ostream>

namespace citymesh {
namespace {

using nlohmann::ordered_json;

spdlog::level::level_enum spdlog_level(LogLevel level) {
  switch (level) {
    case LogLevel::Debug:
      return spdlog::level::debug;
    case LogLevel::Info:
      return spdlog::level::info;
    case LogLevel::Warning:
      return spdlog::level::warn;
    case LogLevel::Error:
      return spdlog::level::err;
  }
  return spdlog::level::info;
}

std::string_view name(LogLevel level) {
  switch (level) {
    case LogLevel::Debug:
      return "debug";
    case LogLevel::Info:
      return "info";
    case LogLevel::Warning:
      return "warning";
    case LogLevel::Error:
      return "error";
  }
  return "info";
}

std::string timestamp() {
  using namespace std::chrono;
  const auto now = system_clock::now();
  const auto ms = duration_cast<milliseconds>(now.time_since_epoch()).count() % 1000;
  const auto time = system_clock::to_time_t(now);
  std::tm utc{};
  gmtime_r(&time, &utc);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", utc, ms);
}

}  // namespace

struct Log::Impl {
  explicit Impl(std::ostream& out)
      : logger("citymesh", std::make_shared<spdlog::sinks::ostream_sink_mt>(out, true)) {}
  spdlog::logger logger;
};

Log::Log(std::ostream& out, LogLevel least) : impl_(std::make_unique<Impl>(out)) {
  impl_->logger.set_level(spdlog_level(least));
  impl_->logger.set_pattern("%v");
}

Log::~Log() = default;

void Log::write(LogLevel level, std::string_view event, LogFields fields) noexcept {
  try {
    const auto wanted = spdlog_level(level);
    if (!impl_->logger.should_log(wanted)) return;
    ordered_json line{{"ts", timestamp()}, {"level", name(level)}, {"event", event}};
    for (const auto& field : fields)
      std::visit([&](const auto& value) { line[std::string(field.key)] = value; }, field.value);
    const auto text = line.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    impl_->logger.log(wanted, spdlog::string_view_t(text));
  } catch (...) {
    // A line that cannot be written must not end the work it tells of.
  }
}

}  // namespace citymesh
