#include "services/access/issuer_keys.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "services/access/networks.h"
#include "services/http/http.h"

namespace citymesh {
namespace {

constexpr std::size_t kMostFetchedBytes = 1 << 20;

bool is_url(std::string_view source) {
  return source.starts_with("https://") || source.starts_with("http://");
}

Result<std::string> fetch(const std::string& url, double timeout_s) {
  HttpRequest request{.url = url,
                      .body = {},
                      .headers = {{"Accept", "application/json"}},
                      .timeout_s = timeout_s,
                      .max_answer_bytes = kMostFetchedBytes,
                      .may_connect = {}};
  // What comes in plain text over a network is no proof of anything.
  const bool plain = url.starts_with("http://");
  if (plain) request.may_connect = is_loopback_address;
  auto answer = ask(request);
  if (!answer && plain && answer.error().code == ErrorCode::PermissionDenied)
    return fail(ErrorCode::InvalidArgument, "expected https:// for another machine than this one");
  if (!answer) return answer.error();
  if (answer->status != 200)
    return fail(ErrorCode::Unavailable,
                fmt::format("the answer was {}, expected 200", answer->status));
  if (!answer->is_whole)
    return fail(ErrorCode::InvalidArgument,
                fmt::format("the answer is longer than {} bytes", kMostFetchedBytes));
  return std::move(answer->body);
}

}  // namespace

IssuerKeys::IssuerKeys(IssuerKeyOptions options)
    : options_(std::move(options)), is_fetched_(is_url(options_.source)) {}

Result<std::unique_ptr<IssuerKeys>> IssuerKeys::open(IssuerKeyOptions options) {
  auto keys = std::unique_ptr<IssuerKeys>(new IssuerKeys(std::move(options)));
  if (keys->options_.source.empty()) return keys;
  if (auto read = keys->read(); !read) return read.error();
  return keys;
}

IssuerKeys::Keys IssuerKeys::current() const {
  const std::scoped_lock lock(mutex_);
  return keys_;
}

Result<void> IssuerKeys::read() {
  auto done = try_to_read();
  last_try_ = Clock::now();
  has_failed_ = !done;
  return done;
}

Result<void> IssuerKeys::try_to_read() {
  const auto state = is_fetched_ ? FileState{} : state_of(options_.source);
  const auto text =
      is_fetched_ ? fetch(options_.source, options_.timeout_s) : read_key_file(options_.source);
  if (!text) return is_fetched_ ? named(options_.source, text.error()) : text.error();
  auto parsed = parse_jwks(*text);
  if (!parsed) return named(options_.source, parsed.error());
  file_ = state;
  const std::scoped_lock lock(mutex_);
  keys_ = std::make_shared<const std::vector<VerificationKey>>(*std::move(parsed));
  return {};
}

Result<bool> IssuerKeys::reload() {
  if (options_.source.empty()) return false;
  const std::scoped_lock lock(reading_);
  const auto longest_age = has_failed_ ? options_.pause : options_.longest_age;
  const bool is_due =
      is_fetched_ ? Clock::now() - last_try_ >= longest_age : state_of(options_.source) != file_;
  if (!is_due) return false;
  if (auto done = read(); !done) return done.error();
  return true;
}

IssuerKeys::Keys IssuerKeys::look_again() {
  if (!is_fetched_) return current();
  const std::unique_lock lock(reading_, std::chrono::duration<double>(options_.timeout_s));
  if (lock && Clock::now() - last_try_ >= options_.pause)
    (void)read();  // what goes wrong `reload` tells of
  return current();
}

}  // namespace citymesh
