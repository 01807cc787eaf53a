#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "services/rest/message.h"

namespace citymesh {

/// Which web pages may use the API from within a browser (CORS, in the Fetch standard).
class Cors {
 public:
  /// `*` for all pages, else the origins of some by comma (`https://portal.example`); empty: only
  /// pages of the service's own origin.
  explicit Cors(std::string_view allowed = {});

  /// False for a request that a page of another origin makes a browser send. Browsers let a page
  /// send some requests unasked and only keep the answer from it, so those that change something
  /// are to be refused. `base` is where the client sees the service.
  bool may_change(const Headers& request, std::string_view base) const;

  /// Tells a browser that the page may read the answer.
  void allow_reading(const Headers& request, Headers& answer) const;
  /// Tells a browser, which asks before (OPTIONS), what the page may send.
  void allow_sending(const Headers& request, std::string_view methods, Headers& answer) const;

 private:
  bool allows(const Headers& request) const;

  bool everybody_ = false;
  std::vector<std::string> origins_;
};

}  // namespace citymesh
