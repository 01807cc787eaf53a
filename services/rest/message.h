#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/result.h"

namespace citymesh {

/// Header fields in the order given; names compare without case.
class Headers {
 public:
  void set(std::string_view name, std::string value);  ///< replaces
  void add(std::string_view name, std::string value);  ///< beside others of that name
  /// All values of that name joined by ", "; empty when there is none.
  std::string get(std::string_view name) const;
  bool has(std::string_view name) const;
  const std::vector<std::pair<std::string, std::string>>& all() const { return fields_; }

 private:
  std::vector<std::pair<std::string, std::string>> fields_;
};

struct Request {
  std::string method{};
  std::string target{};  ///< as received: path and query, percent-encoded
  Headers headers{};
  std::string body{};
  std::string peer{};   ///< address of the other end of the connection
  bool secure = false;  ///< whether it came over TLS
};

/// A result file that is read while it is sent.
struct FilePiece {
  std::uint64_t bytes = 0;
  std::function<Result<std::string>(std::uint64_t offset, std::uint64_t max_bytes)> read{};
};

struct Response;

/// What an answer that follows a job has to say at a moment.
struct FollowStep {
  std::string bytes{};                 ///< to be sent now; of answers that stream
  std::shared_ptr<Response> answer{};  ///< what had to wait; of answers that do not
  bool end = false;                    ///< nothing follows
};

/// An answer that depends on how a job goes on.
struct Follow {
  std::string job_id{};
  bool streams = false;  ///< header at once and the body as it comes; else the answer comes whole
  double longest_s = 0;
  /// May block. Called at once, whenever the job may have changed, and a last time when
  /// `longest_s` have passed or the server stops.
  std::function<FollowStep(bool last)> step{};
  std::function<void()> client_left{};  ///< may block; called instead of further steps
};

struct Response {
  int status = 200;
  Headers headers{};
  std::vector<std::variant<std::string, FilePiece>> body{};  ///< sent one after the other
  std::optional<Follow> follow{};
};

std::uint64_t body_bytes(const Response& response);
/// The whole body in memory. Errors: those of reading a file piece.
Result<std::string> body_text(const Response& response);
Response text_response(int status, std::string_view media_type, std::string body);

/// The path of a target in decoded segments, and its query parameters.
struct Target {
  std::vector<std::string> segments{};  ///< `/jobs/1` is {jobs, 1}; `/` is empty
  std::map<std::string, std::string> query{};
};

/// Errors: InvalidArgument for a target that is no origin-form, for bad percent-encoding, and for
/// control characters.
Result<Target> parse_target(std::string_view target);

/// A path segment or query value, percent-encoded.
std::string encode_segment(std::string_view text);

std::string encode_base64(std::string_view bytes);

/// How much a client wants a media type, from its Accept header: 0 (not at all) to 1; the most
/// specific range counts. No header means 1.
double accept_quality(std::string_view accept, std::string_view media_type);
/// Whether Accept names the media type itself, not by a wildcard.
bool accept_names(std::string_view accept, std::string_view media_type);

/// The trimmed items of a header that is a list; a comma within double quotes does not separate.
/// Empty items are left out.
std::vector<std::string_view> list_items(std::string_view list);

/// `Content-Type` without parameters, in lower case.
std::string media_type_of(std::string_view content_type);

/// Whether a Prefer header holds the preference, as in `Prefer: respond-async, wait=10`.
bool prefers(std::string_view prefer, std::string_view preference);
/// The value of a preference, as 10 in `Prefer: wait=10`; nothing when it is absent.
std::optional<std::string> preference_value(std::string_view prefer, std::string_view preference);

/// `host[:port]` of a Host header that is safe to repeat in links.
bool is_valid_host(std::string_view host);

bool equal_without_case(std::string_view a, std::string_view b);

}  // namespace citymesh
