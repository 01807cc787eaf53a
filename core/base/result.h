#pragma once

#include <cassert>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace citymesh {

/// Why an operation could not be done. A subset of gRPC's codes; the edge maps them to HTTP and
/// OGC.
enum class ErrorCode {
  InvalidArgument,     ///< the request is wrong whatever the state of the system
  FailedPrecondition,  ///< the request is right, the system or the data is not in the state it
                       ///< needs
  NotFound,
  AlreadyExists,
  PermissionDenied,
  ResourceExhausted,  ///< a limit (size, depth, count) was reached
  Cancelled,          ///< dismissed or shut down
  DeadlineExceeded,
  Unavailable,  ///< may succeed when tried again
  Unimplemented,
  DataLoss,  ///< what was written could not be read back as it was meant
  Internal,
};

std::string_view to_string(ErrorCode code);

/// The message names the thing, its value and what was expected.
struct Error {
  ErrorCode code = ErrorCode::Internal;
  std::string message;
};

/// A value, or the reason why there is none.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value)
      : state_(std::in_place_index<0>, std::move(value)) {}  // NOLINT(google-explicit-constructor)
  Result(Error error)
      : state_(std::in_place_index<1>, std::move(error)) {}  // NOLINT(google-explicit-constructor)

  bool has_value() const { return state_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  T& value() & { return assert(has_value()), std::get<0>(state_); }
  const T& value() const& { return assert(has_value()), std::get<0>(state_); }
  T&& value() && { return assert(has_value()), std::get<0>(std::move(state_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  const Error& error() const { return assert(!has_value()), std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
};

template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  bool has_value() const { return !error_; }
  explicit operator bool() const { return has_value(); }
  const Error& error() const { return assert(error_), *error_; }

 private:
  std::optional<Error> error_;
};

inline Error fail(ErrorCode code, std::string message) { return {code, std::move(message)}; }

}  // namespace citymesh
