#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/http_receiver.h"

namespace citymesh::wfs_support {

/// How a server behaves: servers in the field differ, and some are wrong.
struct Manners {
  std::string version = "2.0.2";
  std::string default_crs{};  ///< empty: that of the file
  std::vector<std::string> other_crs{};
  std::optional<bool> says_pages = true;         ///< ImplementsResultPaging; none: not said
  std::optional<std::uint64_t> count_default{};  ///< said, and the most that it gives
  std::uint64_t secret_limit = UINT64_MAX;       ///< the most that it gives, not said
  bool links_next = true;
  std::string next_origin{};  ///< of these links; empty: its own
  bool knows_matched = true;  ///< else "unknown"
  bool knows_start = true;    ///< else every page is the first one
  bool overlaps = false;      ///< a page begins with the last feature of the one before
  bool missing_id_is_error = false;
  int busy = 0;  ///< so many requests for features are answered with 503
  bool html = false, exception = false, redirects = false, locked = false;
  bool cut = false;            ///< less than Content-Length
  bool cut_unnoticed = false;  ///< without a Content-Length
  bool entities = false;       ///< a document type that defines entities
  bool slow = false;           ///< never answers for features
  std::string json{};          ///< a CityJSON document instead, all on one page
};

/// A WFS 2.0 on loopback over the buildings of an unpacked CityGML file: GetCapabilities,
/// GetFeature with BBOX (of envelopes), RESOURCEID, COUNT, STARTINDEX, RESULTTYPE.
class TestWfs {
 public:
  explicit TestWfs(const std::filesystem::path& file, Manners manners = {});
  ~TestWfs();

  std::string url() const { return receiver_.url("/wfs"); }
  std::string url_with_password() const;
  std::uint16_t port() const { return receiver_.port(); }
  /// Parameters of the requests for features so far, names in capitals.
  std::vector<std::map<std::string, std::string>> requests() const;
  /// Headers of the last request.
  std::string last_header() const;

 private:
  struct Feature {
    std::string id{}, text{};
    double min_x = 0, min_y = 0, max_x = 0, max_y = 0;
  };
  using Parameters = std::map<std::string, std::string>;

  std::string respond(const std::string& request);
  std::string capabilities() const;
  std::string features(const Parameters& parameters);
  std::vector<const Feature*> chosen(const Parameters& parameters, std::string& problem) const;

  Manners manners_;
  std::vector<Feature> features_{};
  std::string namespaces_{}, envelope_{}, crs_{};
  mutable std::mutex mutex_{};
  std::vector<Parameters> requests_{};
  std::string last_header_{};
  std::condition_variable done_{};
  bool ends_ = false;
  HttpReceiver receiver_{};
};

}  // namespace citymesh::wfs_support
