#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <vector>

#include "services/sqlite/sqlite.h"

namespace citymesh::sqlite {

/// Writes of several threads to one connection. Those that come while the disk is busy go to it
/// together, as one transaction: many threads wait for one commit instead of for each other's.
class GroupCommit {
 public:
  /// The connection is used by whichever thread commits.
  explicit GroupCommit(Connection& connection) : connection_(connection) {}

  /// Runs `work`, alone on the connection. What it wrote is kept when it returns true, and is then
  /// committed when this returns; false or an exception undo it and nothing else. Throws what
  /// `work` threw, and Failure when the commit failed.
  void write(Durability durability, const std::function<bool()>& work);

 private:
  struct Write;
  void commit(const std::vector<Write*>& group);
  void commit_or_throw(const std::vector<Write*>& group);

  Connection& connection_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool committing_ = false;
  std::vector<Write*> waiting_;
};

}  // namespace citymesh::sqlite
