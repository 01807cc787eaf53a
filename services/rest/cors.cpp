#include "services/rest/cors.h"

#include <algorithm>

namespace citymesh {
namespace {

constexpr std::string_view kSendableHeaders =
    "Accept, Authorization, Content-Type, Idempotency-Key, If-Match, If-None-Match, If-Range, "
    "Last-Event-ID, Prefer, Range, traceparent, X-API-Key";
constexpr std::string_view kReadableHeaders =
    "Location, Content-Location, Link, Preference-Applied, Content-Disposition, ETag, "
    "Content-Range, Accept-Ranges, Retry-After, WWW-Authenticate";

/// `host:port` of an origin or URL. The scheme is left out: behind a proxy that does not tell of it
/// the service takes its own for http.
std::string_view authority(std::string_view url) {
  const auto scheme_end = url.find("://");
  if (scheme_end == std::string_view::npos) return {};
  url.remove_prefix(scheme_end + 3);
  return url.substr(0, url.find('/'));
}

}  // namespace

Cors::Cors(std::string_view allowed) : everybody_(allowed == "*") {
  if (everybody_) return;
  for (const auto origin : list_items(allowed)) origins_.emplace_back(origin);
}

bool Cors::allows(const Headers& request) const {
  return everybody_ || std::ranges::find(origins_, request.get("Origin")) != origins_.end();
}

bool Cors::may_change(const Headers& request, std::string_view base) const {
  if (!request.has("Origin") || allows(request)) return true;
  return equal_without_case(authority(request.get("Origin")), authority(base));
}

void Cors::allow_reading(const Headers& request, Headers& answer) const {
  // A cache must not hand the answer for one origin to another.
  if (!origins_.empty()) answer.add("Vary", "Origin");
  if (!allows(request)) return;
  answer.set("Access-Control-Allow-Origin", everybody_ ? "*" : request.get("Origin"));
  answer.set("Access-Control-Expose-Headers", std::string(kReadableHeaders));
}

void Cors::allow_sending(const Headers& request, std::string_view methods, Headers& answer) const {
  if (!allows(request)) return;
  answer.set("Access-Control-Allow-Methods", std::string(methods));
  answer.set("Access-Control-Allow-Headers", std::string(kSendableHeaders));
  answer.set("Access-Control-Max-Age", "86400");
}

}  // namespace citymesh
