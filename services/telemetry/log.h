#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <iosfwd>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

namespace citymesh {

enum class LogLevel { Debug, Info, Warning, Error };

/// One member of a log line. Refers to its text: for use in the call only.
struct LogField {
  using Value = std::variant<bool, std::int64_t, std::uint64_t, double, std::string_view>;

  LogField(std::string_view name, bool v) : key(name), value(v) {}
  LogField(std::string_view name, std::signed_integral auto v)
      : key(name), value(std::int64_t{v}) {}
  LogField(std::string_view name, std::unsigned_integral auto v)
      : key(name), value(std::uint64_t{v}) {}
  LogField(std::string_view name, double v) : key(name), value(v) {}
  LogField(std::string_view name, std::string_view v) : key(name), value(v) {}
  LogField(std::string_view name, const std::string& v) : key(name), value(std::string_view(v)) {}
  LogField(std::string_view name, const char* v) : key(name), value(std::string_view(v)) {}

  std::string_view key;
  Value value;
};

using LogFields = std::initializer_list<LogField>;

/// One JSON line per event: `ts`, `level`, `event` and the fields. Never holds inputs of users,
/// credentials or results. Thread-safe; never throws.
class Log {
 public:
  /// `out` must outlive the log.
  explicit Log(std::ostream& out, LogLevel least = LogLevel::Info);
  ~Log();
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  void debug(std::string_view event, LogFields fields) { write(LogLevel::Debug, event, fields); }
  void info(std::string_view event, LogFields fields) { write(LogLevel::Info, event, fields); }
  void warning(std::string_view event, LogFields fields) {
    write(LogLevel::Warning, event, fields);
  }
  void error(std::string_view event, LogFields fields) { write(LogLevel::Error, event, fields); }

 private:
  void write(LogLevel level, std::string_view event, LogFields fields) noexcept;

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace citymesh
