#include "services/sqlite/group_commit.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <latch>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/temp_folder.h"

namespace citymesh::sqlite {
namespace {

class GroupCommitTest : public ::testing::Test {
 protected:
  GroupCommitTest() { connection_.run("CREATE TABLE t (n INTEGER NOT NULL UNIQUE)"); }

  void insert(std::int64_t n) {
    connection_.query("INSERT INTO t (n) VALUES (?1)").bind(1, n).run();
  }
  std::int64_t rows() {
    Connection other(folder_.path() / "db");
    return other.value("SELECT count(*) FROM t");
  }

  TempFolder folder_;
  Connection connection_{folder_.path() / "db"};
  GroupCommit commits_{connection_};
};

TEST_F(GroupCommitTest, WhatIsKeptIsCommittedWhenTheCallReturns) {
  commits_.write(Durability::Full, [&] {
    insert(1);
    return true;
  });
  EXPECT_EQ(rows(), 1);
}

TEST_F(GroupCommitTest, WhatIsNotKeptIsUndone) {
  commits_.write(Durability::Full, [&] {
    insert(1);
    return false;
  });
  EXPECT_EQ(rows(), 0);
}

TEST_F(GroupCommitTest, AnExceptionUndoesItsOwnWriteAndReachesItsCaller) {
  EXPECT_THROW(commits_.write(Durability::Full,
                              [&]() -> bool {
                                insert(1);
                                throw std::runtime_error("no");
                              }),
               std::runtime_error);
  EXPECT_EQ(rows(), 0);
}

TEST_F(GroupCommitTest, AStatementThatFailsDisturbsNoNeighbour) {
  // The first write holds the connection until all others wait: they share one transaction.
  constexpr int kOthers = 8;
  std::latch begun(1);
  std::atomic<int> failed{0};
  std::vector<std::jthread> threads;
  threads.reserve(kOthers + 1);
  threads.emplace_back([&] {
    commits_.write(Durability::Full, [&] {
      begun.count_down();
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      return true;
    });
  });
  begun.wait();
  for (int i = 0; i < kOthers; ++i)
    threads.emplace_back([&, i] {
      try {
        commits_.write(Durability::Full, [&] {
          insert(i / 2);  // each number twice: the second one violates UNIQUE
          return true;
        });
      } catch (const Failure&) {
        ++failed;
      }
    });
  threads.clear();
  EXPECT_EQ(failed, kOthers / 2);
  EXPECT_EQ(rows(), kOthers / 2);
}

TEST_F(GroupCommitTest, NothingIsLostAmongManyThreads) {
  constexpr int kThreads = 8, kWrites = 100;
  {
    std::vector<std::jthread> threads;
    threads.reserve(kThreads);
    for (int t = 0; t < kThreads; ++t)
      threads.emplace_back([&, t] {
        for (int i = 0; i < kWrites; ++i)
          commits_.write(Durability::Relaxed, [&] {
            insert(t * kWrites + i);
            return i % 4 != 0;
          });
      });
  }
  EXPECT_EQ(rows(), kThreads * kWrites * 3 / 4);
}

}  // namespace
}  // namespace citymesh::sqlite
