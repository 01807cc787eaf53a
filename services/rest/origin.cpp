#include "services/rest/origin.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

namespace citymesh {
namespace {

/// What proxies wrote, each list in the order of their writing: the one next to us last.
struct Forwarded {
  std::vector<std::string> clients{}, schemes{}, hosts{};
};

std::vector<std::string> items(const Headers& headers, std::string_view name) {
  const auto header = headers.get(name);
  std::vector<std::string> texts;
  for (const auto item : list_items(header)) texts.emplace_back(item);
  return texts;
}

std::string_view trimmed(std::string_view text) {
  while (text.starts_with(' ') || text.starts_with('\t')) text.remove_prefix(1);
  while (text.ends_with(' ') || text.ends_with('\t')) text.remove_suffix(1);
  return text;
}

/// `for=192.0.2.7;proto=https;host="city.test"`, one such element per proxy.
Forwarded standard_header(const Headers& headers) {
  Forwarded forwarded;
  const auto header = headers.get("Forwarded");
  for (auto element : list_items(header)) {
    std::string client, scheme, host;
    while (!element.empty()) {
      const auto end = std::min(element.find(';'), element.size());
      const auto pair = trimmed(element.substr(0, end));
      element.remove_prefix(std::min(end + 1, element.size()));
      const auto equals = std::min(pair.find('='), pair.size());
      const auto name = pair.substr(0, equals);
      auto value = pair.substr(std::min(equals + 1, pair.size()));
      if (value.size() > 1 && value.starts_with('"') && value.ends_with('"'))
        value = value.substr(1, value.size() - 2);
      if (equal_without_case(name, "for")) client = value;
      if (equal_without_case(name, "proto")) scheme = value;
      if (equal_without_case(name, "host")) host = value;
    }
    forwarded.clients.push_back(std::move(client));
    forwarded.schemes.push_back(std::move(scheme));
    forwarded.hosts.push_back(std::move(host));
  }
  return forwarded;
}

/// What the outermost of the trusted proxies wrote; those in front of it may write what they like.
/// Proxies may also leave a header as they get it: then it is shorter than their number.
std::string outermost(const std::vector<std::string>& written, std::size_t proxies) {
  if (written.empty()) return {};
  return written[written.size() - std::min(proxies, written.size())];
}

/// A path for the front of links, segments of harmless characters; empty for none.
Result<std::string> prefix_of(const Headers& headers, std::size_t proxies) {
  auto prefix = outermost(items(headers, "X-Forwarded-Prefix"), proxies);
  while (prefix.ends_with('/')) prefix.pop_back();
  const bool harmless = std::ranges::all_of(prefix, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("/-._~").find(c) != std::string_view::npos;
  });
  if (!prefix.empty() && (!prefix.starts_with('/') || !harmless ||
                          prefix.find("//") != prefix.npos || prefix.find("..") != prefix.npos))
    return fail(ErrorCode::InvalidArgument,
                "X-Forwarded-Prefix is no path that links can begin with, expected for example "
                "/citymesh");
  return prefix;
}

}  // namespace

Result<Origin> origin_of(const Request& request, const Networks& trusted_proxies,
                         std::string_view public_url) {
  const auto& headers = request.headers;
  std::string scheme = request.secure ? "https" : "http";
  auto host = headers.get("Host");
  std::size_t proxies = 0;
  Origin origin{std::string(public_url), request.peer};

  if (trusted_proxies.contains(request.peer)) {
    const auto forwarded = headers.has("Forwarded") ? standard_header(headers)
                                                    : Forwarded{items(headers, "X-Forwarded-For"),
                                                                items(headers, "X-Forwarded-Proto"),
                                                                items(headers, "X-Forwarded-Host")};
    const auto sender = sender_of(request.peer, forwarded.clients, trusted_proxies);
    origin.client = sender.address;
    proxies = sender.proxies;
    if (auto said = outermost(forwarded.schemes, proxies); !said.empty()) scheme = said;
    if (auto said = outermost(forwarded.hosts, proxies); !said.empty()) host = said;
  }
  if (!public_url.empty()) return origin;
  const auto prefix = proxies > 0 ? prefix_of(headers, proxies) : std::string{};
  if (!prefix) return prefix.error();
  if (scheme != "http" && scheme != "https")
    return fail(ErrorCode::InvalidArgument, "the forwarded protocol is neither http nor https");
  if (!is_valid_host(host))
    return fail(ErrorCode::InvalidArgument, "the Host header is missing or no host name");
  origin.base = fmt::format("{}://{}{}", scheme, host, *prefix);
  return origin;
}

}  // namespace citymesh
