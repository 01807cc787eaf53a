#include "services/wfs/url.h"

#include <curl/curl.h>
#include <fmt/format.h>
#include <strings.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

namespace citymesh::wfs {
namespace {

struct FreeUrl {
  void operator()(CURLU* url) const { curl_url_cleanup(url); }
};
using Url = std::unique_ptr<CURLU, FreeUrl>;

Url parsed(const std::string& text) {
  Url url(curl_url());
  if (url && curl_url_set(url.get(), CURLUPART_URL, text.c_str(), 0) != CURLUE_OK) url.reset();
  return url;
}

std::string part(const Url& url, CURLUPart which, unsigned flags = 0) {
  char* text = nullptr;
  if (curl_url_get(url.get(), which, &text, flags) != CURLUE_OK) return {};
  std::string copy(text);
  curl_free(text);
  return copy;
}

void set_part(const Url& url, CURLUPart which, const std::string& text, unsigned flags = 0) {
  (void)curl_url_set(url.get(), which, text.empty() ? nullptr : text.c_str(), flags);
}

bool same_text(const std::string& a, const std::string& b) {
  return ::strcasecmp(a.c_str(), b.c_str()) == 0;
}

bool is_web(const Url& url) {
  const auto scheme = part(url, CURLUPART_SCHEME);
  return scheme == "http" || scheme == "https";
}

bool belongs_to_a_request(std::string_view parameter) {
  constexpr std::array kNames{"service", "version", "request", "acceptversions"};
  const std::string name(parameter.substr(0, parameter.find('=')));
  return std::ranges::any_of(kNames, [&](const char* known) { return same_text(name, known); });
}

}  // namespace

Result<std::string> service_url(const std::string& url) {
  const auto parts = parsed(url);
  if (!parts || !is_web(parts) || part(parts, CURLUPART_HOST).empty())
    return fail(ErrorCode::InvalidArgument,
                fmt::format("'{}' is no address of a WFS, expected http://host/path or https://",
                            shown_url(url)));
  std::string kept;
  const std::string query = part(parts, CURLUPART_QUERY);
  for (std::string_view rest = query; !rest.empty();) {
    const auto parameter = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(rest.size(), parameter.size() + 1));
    if (parameter.empty() || belongs_to_a_request(parameter)) continue;
    kept += (kept.empty() ? "" : "&") + std::string(parameter);
  }
  set_part(parts, CURLUPART_QUERY, kept);
  set_part(parts, CURLUPART_FRAGMENT, {});
  return part(parts, CURLUPART_URL);
}

std::string shown_url(const std::string& url) {
  const auto parts = parsed(url);
  if (!parts) return "?";
  for (const auto which :
       {CURLUPART_USER, CURLUPART_PASSWORD, CURLUPART_OPTIONS, CURLUPART_QUERY, CURLUPART_FRAGMENT})
    set_part(parts, which, {});
  return part(parts, CURLUPART_URL);
}

std::string with_parameters(const std::string& url, const Parameters& parameters) {
  const auto parts = parsed(url);
  if (!parts) return url;
  for (const auto& [name, value] : parameters)
    set_part(parts, CURLUPART_QUERY, fmt::format("{}={}", name, value),
             CURLU_APPENDQUERY | CURLU_URLENCODE);
  return part(parts, CURLUPART_URL);
}

std::optional<std::string> next_page(const std::string& url, const std::string& link) {
  const auto ours = parsed(url), next = parsed(url);
  if (!ours || !next || curl_url_set(next.get(), CURLUPART_URL, link.c_str(), 0) != CURLUE_OK ||
      !is_web(next))
    return std::nullopt;
  const bool same_origin = part(ours, CURLUPART_SCHEME) == part(next, CURLUPART_SCHEME) &&
                           same_text(part(ours, CURLUPART_HOST), part(next, CURLUPART_HOST)) &&
                           part(ours, CURLUPART_PORT, CURLU_DEFAULT_PORT) ==
                               part(next, CURLUPART_PORT, CURLU_DEFAULT_PORT);
  if (!same_origin) return std::nullopt;
  set_part(next, CURLUPART_USER, part(ours, CURLUPART_USER));
  set_part(next, CURLUPART_PASSWORD, part(ours, CURLUPART_PASSWORD));
  set_part(next, CURLUPART_FRAGMENT, {});
  return part(next, CURLUPART_URL);
}

}  // namespace citymesh::wfs
