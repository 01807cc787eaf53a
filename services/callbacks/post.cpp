#include "services/callbacks/post.h"

#include <curl/curl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <string_view>

#include "core/base/version.h"
#include "services/callbacks/address_guard.h"

namespace citymesh {
namespace {

constexpr std::size_t kMostAnswerBytes = 64 * 1024;
constexpr double kConnectTimeout_s = 5;

struct Exchange {
  bool allow_private = false;
  bool refused = false;
  std::size_t answer_bytes = 0;
  const std::stop_token* stop = nullptr;
};

bool is_public_socket(const curl_sockaddr& address) {
  if (address.family == AF_INET && address.addrlen >= sizeof(sockaddr_in)) {
    sockaddr_in v4{};
    std::memcpy(&v4, &address.addr, sizeof v4);
    return is_public(std::bit_cast<Ipv4>(v4.sin_addr));
  }
  if (address.family == AF_INET6 && address.addrlen >= sizeof(sockaddr_in6)) {
    sockaddr_in6 v6{};
    std::memcpy(&v6, &address.addr, sizeof v6);
    return is_public(std::bit_cast<Ipv6>(v6.sin6_addr));
  }
  return false;
}

/// Called with the address that is about to be connected to.
curl_socket_t open_socket(void* data, curlsocktype, curl_sockaddr* address) {
  auto& exchange = *static_cast<Exchange*>(data);
  if (!exchange.allow_private && !is_public_socket(*address)) {
    exchange.refused = true;
    return CURL_SOCKET_BAD;
  }
  return ::socket(address->family, address->socktype | SOCK_CLOEXEC, address->protocol);
}

std::size_t take_answer(char*, std::size_t size, std::size_t count, void* data) {
  auto& exchange = *static_cast<Exchange*>(data);
  exchange.answer_bytes += size * count;
  return exchange.answer_bytes > kMostAnswerBytes ? 0 : size * count;
}

int go_on(void* data, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  return static_cast<Exchange*>(data)->stop->stop_requested() ? 1 : 0;
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

Result<int> post(const Message& message, const PostOptions& options, const std::stop_token& stop) {
  if (auto checked = check_callback_uri(message.uri, options.allow_private); !checked)
    return checked.error();
  const std::unique_ptr<CURL, FreeHandle> handle(is_ready() ? curl_easy_init() : nullptr);
  if (!handle) return fail(ErrorCode::Unavailable, "libcurl cannot be used");

  Exchange exchange{.allow_private = options.allow_private, .stop = &stop};
  std::array<char, CURL_ERROR_SIZE> reason{};
  HeaderList headers;
  append(headers, "Content-Type: application/json");
  append(headers, "Expect:");
  for (const auto& [name, value] : message.headers)
    append(headers, fmt::format("{}: {}", name, value));

  CURL* curl = handle.get();
  const auto set = [curl](CURLoption option, auto value) {
    return curl_easy_setopt(curl, option, value) == CURLE_OK;
  };
  const auto agent = fmt::format("citymesh/{}", version());
  const bool prepared =
      set(CURLOPT_URL, message.uri.c_str()) && set(CURLOPT_PROTOCOLS_STR, "http,https") &&
      set(CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(message.body.size())) &&
      set(CURLOPT_POSTFIELDS, message.body.c_str()) && set(CURLOPT_HTTPHEADER, headers.get()) &&
      set(CURLOPT_USERAGENT, agent.c_str()) && set(CURLOPT_FOLLOWLOCATION, 0L) &&
      set(CURLOPT_PROXY, "") && set(CURLOPT_SSL_VERIFYPEER, 1L) &&
      set(CURLOPT_SSL_VERIFYHOST, 2L) && set(CURLOPT_NOSIGNAL, 1L) &&
      set(CURLOPT_TIMEOUT_MS, milliseconds_of(options.timeout_s)) &&
      set(CURLOPT_CONNECTTIMEOUT_MS,
          milliseconds_of(std::min(options.timeout_s, kConnectTimeout_s))) &&
      set(CURLOPT_OPENSOCKETFUNCTION, &open_socket) && set(CURLOPT_OPENSOCKETDATA, &exchange) &&
      set(CURLOPT_WRITEFUNCTION, &take_answer) && set(CURLOPT_WRITEDATA, &exchange) &&
      set(CURLOPT_XFERINFOFUNCTION, &go_on) && set(CURLOPT_XFERINFODATA, &exchange) &&
      set(CURLOPT_NOPROGRESS, 0L) && set(CURLOPT_ERRORBUFFER, reason.data());
  if (!prepared) return fail(ErrorCode::Unavailable, "libcurl does not know an option");

  const auto code = curl_easy_perform(curl);
  long status = 0;
  curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
  if (code == CURLE_ABORTED_BY_CALLBACK) return fail(ErrorCode::Cancelled, "stopped");
  if (exchange.refused && status == 0)
    return fail(ErrorCode::PermissionDenied,
                fmt::format("{} is no public address", shown_uri(message.uri)));
  // An answer that is too long has been received all the same.
  if (code != CURLE_OK && !(code == CURLE_WRITE_ERROR && status != 0))
    return fail(ErrorCode::Unavailable,
                reason[0] != '\0' ? reason.data() : curl_easy_strerror(code));
  return static_cast<int>(status);
}

}  // namespace citymesh
