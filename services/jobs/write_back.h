#pragma once

#include <memory>
#include <stop_token>
#include <string>

#include "core/base/result.h"
#include "core/pipeline/body_sink.h"

namespace citymesh {

/// Where jobs leave their bodies beside their files: all of a job or nothing, under its id.
/// Thread-safe.
class WriteBackStore {
 public:
  virtual ~WriteBackStore() = default;

  /// What an attempt of a job writes. Nobody sees any of it before commit(); an attempt that goes
  /// without has left nothing.
  class Attempt : public BodySink {
   public:
    /// After finish(). In place of what an earlier attempt of the job may have left; earlier
    /// versions of the same buildings are kept as history. After Unavailable nobody knows whether
    /// it is done: withdraw().
    virtual Result<void> commit() = 0;
  };
  virtual std::unique_ptr<Attempt> begin(const std::string& job_id, const std::string& process,
                                         std::stop_token stop) = 0;

  /// What a job has written is gone, and what it took the place of is in force again. Done already,
  /// it changes nothing.
  virtual Result<void> withdraw(const std::string& job_id) = 0;
};

}  // namespace citymesh
