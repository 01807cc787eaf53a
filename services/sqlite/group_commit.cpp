#include "services/sqlite/group_commit.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace citymesh::sqlite {

struct GroupCommit::Write {
  Durability durability{};
  const std::function<bool()>& work;
  std::exception_ptr failure{};
  bool done = false;
};

void GroupCommit::write(Durability durability, const std::function<bool()>& work) {
  Write own{durability, work};
  std::unique_lock lock(mutex_);
  waiting_.push_back(&own);
  changed_.wait(lock, [&] { return own.done || !committing_; });
  if (!own.done) {
    committing_ = true;
    const auto group = std::exchange(waiting_, {});
    lock.unlock();
    commit(group);
    lock.lock();
    for (Write* write : group) write->done = true;
    committing_ = false;
    changed_.notify_all();
  }
  if (own.failure) std::rethrow_exception(own.failure);
}

void GroupCommit::commit(const std::vector<Write*>& group) {
  try {
    commit_or_throw(group);
  } catch (...) {
    for (Write* write : group)
      if (!write->failure) write->failure = std::current_exception();
  }
}

void GroupCommit::commit_or_throw(const std::vector<Write*>& group) {
  const bool full = std::ranges::any_of(
      group, [](const Write* write) { return write->durability == Durability::Full; });
  Transaction transaction(connection_, full ? Durability::Full : Durability::Relaxed);
  for (Write* write : group) {
    connection_.run("SAVEPOINT one");
    bool keep = false;
    try {
      keep = write->work();
    } catch (...) {
      write->failure = std::current_exception();
    }
    // A full disk has undone everything already: then this fails, and all of the group with it.
    if (!keep) connection_.run("ROLLBACK TO one");
    connection_.run("RELEASE one");
  }
  transaction.commit();
}

}  // namespace citymesh::sqlite
