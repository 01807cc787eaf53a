#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"

/// What a WFS says, besides city models.
namespace citymesh::wfs {

struct FeatureType {
  std::string name{};              ///< "bldg:Building"
  std::string uri{};               ///< that the prefix stands for; empty: not declared
  std::vector<std::string> crs{};  ///< as spelt, the default one first
};

struct Capabilities {
  std::string version{};
  std::vector<FeatureType> types{};
  std::vector<std::string> formats{};            ///< of GetFeature; empty: not said
  std::optional<bool> pages{};                   ///< whether STARTINDEX can be used
  std::optional<std::uint64_t> count_default{};  ///< most features of an answer
};

/// Errors: FailedPrecondition for what is no such document.
Result<Capabilities> read_capabilities(const std::string& text);

/// What a server says instead of features.
struct ServerError {
  std::string code{};  ///< of an ows:ExceptionReport; empty for another text
  std::string text{};  ///< one line, cut
};

struct AnswerHead {
  bool json = false;
  std::optional<std::uint64_t> matched{}, returned{};
  std::string next{};  ///< link to the next page
  std::optional<ServerError> error{};
};

/// The start of an answer to GetFeature; the rest is not looked at.
AnswerHead read_head(const std::string& text);

}  // namespace citymesh::wfs
