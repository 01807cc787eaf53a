#include "services/http/http.h"

#include <arpa/inet.h>
#include <curl/curl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>

#include "core/base/version.h"

namespace citymesh {
namespace {

constexpr double kConnectTimeout_s = 5;

struct Exchange {
  const HttpRequest& request;
  const std::stop_token& stop;
  bool refused = false;
  HttpAnswer answer{};
};

/// Empty for what is no address of the internet.
std::string text_of(const curl_sockaddr& address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  const void* bytes = nullptr;
  sockaddr_in v4{};
  sockaddr_in6 v6{};
  if (address.family == AF_INET && address.addrlen >= sizeof v4) {
    std::memcpy(&v4, &address.addr, sizeof v4);
    bytes = &v4.sin_addr;
  } else if (address.family == AF_INET6 && address.addrlen >= sizeof v6) {
    std::memcpy(&v6, &address.addr, sizeof v6);
    bytes = &v6.sin6_addr;
  } else {
    return {};
  }
  return ::inet_ntop(address.family, bytes, text.data(), text.size()) != nullptr ? text.data() : "";
}

/// Called with the address that is about to be connected to.
curl_socket_t open_socket(void* data, curlsocktype, curl_sockaddr* address) {
  auto& exchange = *static_cast<Exchange*>(data);
  const auto& may_connect = exchange.request.may_connect;
  if (may_connect && !may_connect(text_of(*address))) {
    exchange.refused = true;
    return CURL_SOCKET_BAD;
  }
  return ::socket(address->family, address->socktype | SOCK_CLOEXEC, address->protocol);
}

std::size_t take_answer(char* bytes, std::size_t size, std::size_t count, void* data) {
  auto& exchange = *static_cast<Exchange*>(data);
  auto& answer = exchange.answer;
  if (size * count > exchange.request.max_answer_bytes - answer.body.size()) {
    answer.is_whole = false;
    return 0;
  }
  answer.body.append(bytes, size * count);
  return size * count;
}

int go_on(void* data, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  return static_cast<Exchange*>(data)->stop.stop_requested() ? 1 : 0;
}

struct FreeHandle {
  void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
};
struct FreeList {
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};
using HeaderList = std::unique_ptr<curl_slist, FreeList>;

void append(HeaderList& list, const std::string& line) {
  auto* longer = curl_slist_append(list.get(), line.c_str());
  if (longer == nullptr) return;
  (void)list.release();
  list.reset(longer);
}

long milliseconds_of(double seconds) { return std::lround(seconds * 1000); }

/// Initialises libcurl once, before any thread needs it.
bool is_ready() {
  static const bool kReady = curl_global_init(CURL_GLOBAL_DEFAULT) == CURLE_OK;
  return kReady;
}

}  // namespace

Result<HttpAnswer> ask(const HttpRequest& request, const std::stop_token& stop) {
  const std::unique_ptr<CURL, FreeHandle> handle(is_ready() ? curl_easy_init() : nullptr);
  if (!handle) return fail(ErrorCode::Unavailable, "libcurl cannot be used");

  Exchange exchange{.request = request, .stop = stop};
  std::array<char, CURL_ERROR_SIZE> reason{};
  HeaderList headers;
  append(headers, "Expect:");
  for (const auto& [name, value] : request.headers)
    append(headers, fmt::format("{}: {}", name, value));

  CURL* curl = handle.get();
  const auto set = [curl](CURLoption option, auto value) {
    return curl_easy_setopt(curl, option, value) == CURLE_OK;
  };
  const auto agent = fmt::format("citymesh/{}", version());
  const bool prepared =
      set(CURLOPT_URL, request.url.c_str()) && set(CURLOPT_PROTOCOLS_STR, "http,https") &&
      set(CURLOPT_HTTPHEADER, headers.get()) && set(CURLOPT_USERAGENT, agent.c_str()) &&
      set(CURLOPT_FOLLOWLOCATION, 0L) && set(CURLOPT_SSL_VERIFYPEER, 1L) &&
      set(CURLOPT_SSL_VERIFYHOST, 2L) && set(CURLOPT_NOSIGNAL, 1L) &&
      set(CURLOPT_TIMEOUT_MS, milliseconds_of(request.timeout_s)) &&
      set(CURLOPT_CONNECTTIMEOUT_MS,
          milliseconds_of(std::min(request.timeout_s, kConnectTimeout_s))) &&
      set(CURLOPT_OPENSOCKETFUNCTION, &open_socket) && set(CURLOPT_OPENSOCKETDATA, &exchange) &&
      set(CURLOPT_WRITEFUNCTION, &take_answer) && set(CURLOPT_WRITEDATA, &exchange) &&
      set(CURLOPT_XFERINFOFUNCTION, &go_on) && set(CURLOPT_XFERINFODATA, &exchange) &&
      set(CURLOPT_NOPROGRESS, 0L) && set(CURLOPT_ERRORBUFFER, reason.data()) &&
      (!request.may_connect || set(CURLOPT_PROXY, "")) &&
      (!request.body ||
       (set(CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(request.body->size())) &&
        set(CURLOPT_POSTFIELDS, request.body->c_str())));
  if (!prepared) return fail(ErrorCode::Unavailable, "libcurl does not know an option");

  const auto code = curl_easy_perform(curl);
  long status = 0;
  curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
  if (code == CURLE_ABORTED_BY_CALLBACK) return fail(ErrorCode::Cancelled, "stopped");
  if (exchange.refused && status == 0)
    return fail(ErrorCode::PermissionDenied, "the address may not be connected to");
  if (code != CURLE_OK && exchange.answer.is_whole)
    return fail(
        code == CURLE_OPERATION_TIMEDOUT ? ErrorCode::DeadlineExceeded : ErrorCode::Unavailable,
        reason[0] != '\0' ? reason.data() : curl_easy_strerror(code));
  exchange.answer.status = static_cast<int>(status);
  return std::move(exchange.answer);
}

}  // namespace citymesh
