// What a server says, and where its links lead: nothing of it may break the reader or lead a
// password astray.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "services/wfs/answers.h"
#include "services/wfs/url.h"

namespace {

using namespace citymesh::wfs;

void demand(bool promise) {
  if (!promise) abort();
}

constexpr std::size_t kMostText = 2000;  // of a message

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (const auto capabilities = read_capabilities(text); !capabilities) {
    const auto& message = capabilities.error().message;
    demand(!message.empty() && message.size() < kMostText);
  }
  const auto head = read_head(text);
  if (head.error) demand(head.error->text.size() < kMostText);
  demand(!head.json || !head.error);

  const std::string ours = "https://user:password@host/wfs";
  for (const auto& link : {head.next, text.substr(0, text.find('\n'))})
    if (auto next = next_page(ours, link)) {
      std::ranges::transform(*next, next->begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
      });
      demand(next->starts_with("https://user:password@host/") ||
             next->starts_with("https://user:password@host:443/"));
    }
  if (const auto url = service_url(text)) demand(!shown_url(*url).empty());
  return 0;
}
