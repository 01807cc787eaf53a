#include "services/stores/folder_results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "services/jobs/job.h"
#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

using testing::HasSubstr;

class FolderResultsTest : public testing::Test {
 protected:
  FolderResultsTest() {
    auto opened = FolderResultStore::open(folder_ / "results");
    EXPECT_TRUE(opened);
    store_ = *std::move(opened);
  }

  void write(std::uint32_t attempt, const std::string& text) {
    const auto folder = store_->stage(job_, attempt);
    ASSERT_TRUE(folder) << folder.error().message;
    EXPECT_TRUE(std::filesystem::is_empty(*folder));
    std::ofstream(*folder / "model.obj") << text;
  }

  Result<std::string> read() { return store_->read(job_, "model.obj", 0, 1000); }

  TempFolder folder_;
  std::unique_ptr<FolderResultStore> store_;
  std::string job_ = new_job_id();
};

TEST_F(FolderResultsTest, FilesAreVisibleAfterTheCommitOnly) {
  write(1, "v 0 0 0");
  EXPECT_EQ(read().error().code, ErrorCode::NotFound);
  ASSERT_TRUE(store_->commit(job_, 1));
  EXPECT_EQ(*read(), "v 0 0 0");
  EXPECT_EQ(*store_->size(job_, "model.obj"), 7u);
}

TEST_F(FolderResultsTest, ReadsPiecesAndNothingAtTheEnd) {
  write(1, "0123456789");
  ASSERT_TRUE(store_->commit(job_, 1));
  EXPECT_EQ(*store_->read(job_, "model.obj", 3, 4), "3456");
  EXPECT_EQ(*store_->read(job_, "model.obj", 8, 100), "89");
  EXPECT_EQ(*store_->read(job_, "model.obj", 10, 100), "");
  EXPECT_EQ(*store_->read(job_, "model.obj", ~std::uint64_t{0}, ~std::uint64_t{0}), "");
}

TEST_F(FolderResultsTest, NeverLeavesTheFolderOfTheJob) {
  write(1, "secret of another job");
  ASSERT_TRUE(store_->commit(job_, 1));
  std::ofstream(folder_ / "outside") << "outside";
  const auto own = folder_ / "results" / job_ / "attempt-1";
  std::filesystem::create_symlink(folder_ / "outside", own / "link");
  std::filesystem::create_directory(own / "sub");

  const std::string with_nul("model.obj\0.txt", 14);
  for (const auto& name :
       {std::string("../../../outside"), std::string("/etc/passwd"), std::string(".."),
        std::string("."), std::string(), std::string("sub"), std::string("sub/../model.obj"),
        std::string("link"), std::string("missing"), with_nul, std::string(5000, 'x')}) {
    EXPECT_EQ(store_->read(job_, name, 0, 10).error().code, ErrorCode::NotFound) << name;
    EXPECT_EQ(store_->size(job_, name).error().code, ErrorCode::NotFound) << name;
  }
  for (const auto& id : {std::string("../results/") + job_, std::string(".."), std::string()}) {
    EXPECT_EQ(store_->read(id, "model.obj", 0, 10).error().code, ErrorCode::NotFound) << id;
    EXPECT_FALSE(store_->stage(id, 1));
    EXPECT_FALSE(store_->erase(id));
  }
  EXPECT_TRUE(std::filesystem::exists(folder_ / "outside"));
}

TEST_F(FolderResultsTest, ANewAttemptStartsEmptyAndReplacesTheOldOne) {
  write(1, "first");
  ASSERT_TRUE(store_->commit(job_, 1));  // and then the worker died before it could say so
  write(2, "second");
  ASSERT_TRUE(store_->commit(job_, 2));
  EXPECT_EQ(*read(), "second");
}

TEST_F(FolderResultsTest, ALateCommitOfAnOldAttemptChangesNothing) {
  write(1, "late");
  const auto late = folder_ / "results" / job_ / "attempt-1.partial";
  const auto kept = folder_ / "kept";
  std::filesystem::rename(late, kept);
  write(2, "owner");
  std::filesystem::rename(kept, late);
  ASSERT_TRUE(store_->commit(job_, 2));
  ASSERT_TRUE(store_->commit(job_, 1));
  EXPECT_EQ(*read(), "owner");
}

TEST_F(FolderResultsTest, StagingAnOldAttemptLeavesItsSuccessorAlone) {
  write(2, "owner");
  ASSERT_TRUE(store_->stage(job_, 1));
  ASSERT_TRUE(store_->commit(job_, 2));
  EXPECT_EQ(*read(), "owner");
}

TEST_F(FolderResultsTest, FilesOfAnotherJobAreReusedAtNoCostAndStayWhenThatOneGoes) {
  write(1, "v 0 0 0");
  ASSERT_TRUE(store_->commit(job_, 1));
  const auto other = new_job_id();
  const auto staged = store_->stage(other, 1);
  ASSERT_TRUE(staged);
  const std::vector<ResultFile> files{{"obj", "model.obj", "model/obj", 7}};
  ASSERT_TRUE(store_->reuse(job_, files, other, 1));
  EXPECT_EQ(std::filesystem::hard_link_count(*staged / "model.obj"), 2u);
  EXPECT_EQ(store_->read(other, "model.obj", 0, 10).error().code, ErrorCode::NotFound);
  ASSERT_TRUE(store_->commit(other, 1));
  ASSERT_TRUE(store_->erase(job_));
  EXPECT_EQ(*store_->read(other, "model.obj", 0, 10), "v 0 0 0");
}

TEST_F(FolderResultsTest, WhatCannotBeLinkedIsCopied) {
  write(1, "v 0 0 0");
  ASSERT_TRUE(store_->commit(job_, 1));
  const auto other = new_job_id();
  ASSERT_TRUE(store_->stage(other, 1));
  // A file system of its own, where there is one.
  const auto elsewhere = std::filesystem::path("/dev/shm") / job_;
  std::error_code none;
  std::filesystem::copy(folder_ / "results" / job_, elsewhere,
                        std::filesystem::copy_options::recursive, none);
  if (none) GTEST_SKIP() << none.message();
  ASSERT_TRUE(store_->erase(job_));
  std::filesystem::create_symlink(elsewhere, folder_ / "results" / job_);
  EXPECT_TRUE(store_->reuse(job_, {{"obj", "model.obj", "model/obj", 7}}, other, 1));
  EXPECT_TRUE(store_->commit(other, 1));
  std::filesystem::remove_all(elsewhere);
  EXPECT_EQ(*store_->read(other, "model.obj", 0, 10), "v 0 0 0");
}

TEST_F(FolderResultsTest, ReusesNothingThatIsGoneOrElsewhere) {
  write(1, "v 0 0 0");
  const std::vector<ResultFile> files{{"obj", "model.obj", "model/obj", 7}};
  const auto other = new_job_id();
  ASSERT_TRUE(store_->stage(other, 1));
  EXPECT_EQ(store_->reuse(job_, files, other, 1).error().code, ErrorCode::NotFound);  // not yet
  ASSERT_TRUE(store_->commit(job_, 1));
  std::ofstream(folder_ / "outside") << "outside";
  for (const auto* name : {"missing", "../../../outside", "/etc/passwd", "..", ""})
    EXPECT_EQ(store_->reuse(job_, {{"obj", name, "model/obj", 7}}, other, 1).error().code,
              ErrorCode::NotFound)
        << name;
  EXPECT_FALSE(store_->reuse("../results/" + job_, files, other, 1));
  EXPECT_FALSE(store_->reuse(job_, files, "../results/" + other, 1));
  ASSERT_TRUE(store_->erase(job_));
  EXPECT_EQ(store_->reuse(job_, files, other, 1).error().code, ErrorCode::NotFound);
}

TEST_F(FolderResultsTest, DiscardLeavesNothingBehind) {
  write(1, "x");
  ASSERT_TRUE(store_->discard(job_, 1));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "results" / job_));
  EXPECT_TRUE(store_->discard(job_, 1));  // also when there is nothing
}

TEST_F(FolderResultsTest, EraseRemovesAllAttempts) {
  write(1, "x");
  ASSERT_TRUE(store_->commit(job_, 1));
  ASSERT_TRUE(store_->erase(job_));
  EXPECT_EQ(read().error().code, ErrorCode::NotFound);
}

TEST_F(FolderResultsTest, CommittingWhatWasNeverStagedIsAnError) {
  const auto committed = store_->commit(job_, 7);
  ASSERT_FALSE(committed);
  EXPECT_EQ(committed.error().code, ErrorCode::Unavailable);
  EXPECT_THAT(committed.error().message, HasSubstr("attempt-7"));
}

TEST_F(FolderResultsTest, NamesARootThatCannotBeMade) {
  std::ofstream(folder_ / "file") << "x";
  const auto opened = FolderResultStore::open(folder_ / "file" / "results");
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::Unavailable);
  EXPECT_THAT(opened.error().message, HasSubstr("file/results"));
}

}  // namespace
}  // namespace citymesh
