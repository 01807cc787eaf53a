#include "services/rest/http_head.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/beast/http/status.hpp>
#include <ctime>
#include <string_view>

#include "core/base/version.h"

namespace citymesh {
namespace {

std::string http_date() {
  constexpr const char* kDays[] = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  constexpr const char* kMonths[] = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                     "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  return fmt::format("{}, {:02} {} {} {:02}:{:02}:{:02} GMT", kDays[utc.tm_wday], utc.tm_mday,
                     kMonths[utc.tm_mon], utc.tm_year + 1900, utc.tm_hour, utc.tm_min, utc.tm_sec);
}

/// A header value on one line, whatever went into it.
std::string one_line(std::string value) {
  std::ranges::replace_if(
      value, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
  return value;
}

std::string_view reason(int status) {
  namespace http = boost::beast::http;
  const auto text = http::obsolete_reason(static_cast<http::status>(status));
  return {text.data(), text.size()};
}

}  // namespace

bool may_have_body(int status) { return status != 204 && status != 304; }

std::string head_text(const Response& response, bool keep_alive) {
  std::string text = fmt::format(
      "HTTP/1.1 {} {}\r\nServer: citymesh/{}\r\nDate: {}\r\nConnection: {}\r\n", response.status,
      reason(response.status), version(), http_date(), keep_alive ? "keep-alive" : "close");
  if (may_have_body(response.status) && !response.follow)
    text += fmt::format("Content-Length: {}\r\n", body_bytes(response));
  for (const auto& [name, value] : response.headers.all())
    text += fmt::format("{}: {}\r\n", name, one_line(value));
  return text + "\r\n";
}

}  // namespace citymesh
