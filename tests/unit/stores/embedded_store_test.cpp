#include "services/stores/embedded_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <atomic>
#include <fstream>
#include <set>
#include <thread>
#include <vector>

#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

using testing::HasSubstr;

constexpr TimeMs kLongLease = 60'000;
constexpr TimeMs kNoLease = 0;  // runs out at once: its worker counts as dead

Job new_job(std::string process = "export-for-simulation") {
  Job job;
  job.id = new_job_id();
  job.spec.process = std::move(process);
  job.spec.inputs_json = R"({"formats":["obj"]})";
  job.created = job.updated = now_ms();
  return job;
}

class EmbeddedStoreTest : public testing::Test {
 protected:
  EmbeddedStoreTest() : store_(reopened()) {}

  std::unique_ptr<EmbeddedStore> reopened(EmbeddedStoreOptions options = {}) {
    auto store = EmbeddedStore::open(folder_ / "jobs.sqlite", options);
    EXPECT_TRUE(store) << store.error().message;
    return store ? *std::move(store) : nullptr;
  }

  Job queued(const std::string& process = "export-for-simulation") {
    auto job = new_job(process);
    EXPECT_TRUE(store_->insert(job));
    return job;
  }

  Claim claimed(TimeMs lease_ms = kLongLease, const std::string& worker = "worker") {
    const auto claim = store_->claim(worker, lease_ms, 0);
    EXPECT_TRUE(claim && *claim);
    return claim && *claim ? **claim : Claim{};
  }

  void execute(const char* sql) {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open((folder_ / "jobs.sqlite").c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(database);
  }

  TempFolder folder_;
  std::unique_ptr<EmbeddedStore> store_;
};

TEST_F(EmbeddedStoreTest, KeepsEveryFieldOfAJobOverAReopening) {
  auto job = new_job();
  job.spec.outputs = {{"obj", Transmission::Reference}, {"report", Transmission::Value}};
  job.spec.response_document = true;
  job.message = "written by \"someone\"\n";
  job.progress = {"heal", 12, 34};
  job.percent = 35;
  job.error = Error{ErrorCode::DataLoss, "G4 fails"};
  job.attempt = 2;
  job.dismiss_requested = true;
  job.started = job.created + 1;
  job.finished = job.created + 2;
  job.owner = "key:city";
  job.trace_id = "4bf92f3577b34da6a3ce929d0e0e4736";
  job.cache_key = "0123abcd";
  job.cached = true;
  job.results = {{"obj", "model.obj", "model/obj", 1234}};
  ASSERT_TRUE(store_->insert(job));

  store_ = reopened();
  const auto read = store_->get(job.id);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->spec, job.spec);
  EXPECT_EQ(read->state, JobState::Accepted);
  EXPECT_EQ(read->message, job.message);
  EXPECT_EQ(read->progress.stage, "heal");
  EXPECT_EQ(read->progress.done, 12u);
  EXPECT_EQ(read->progress.total, 34u);
  EXPECT_EQ(read->percent, 35);
  ASSERT_TRUE(read->error);
  EXPECT_EQ(read->error->code, ErrorCode::DataLoss);
  EXPECT_EQ(read->error->message, "G4 fails");
  EXPECT_EQ(read->attempt, 2u);
  EXPECT_TRUE(read->dismiss_requested);
  EXPECT_EQ(read->created, job.created);
  EXPECT_EQ(read->started, job.started);
  EXPECT_EQ(read->finished, job.finished);
  EXPECT_EQ(read->owner, "key:city");
  EXPECT_EQ(read->trace_id, job.trace_id);
  EXPECT_EQ(read->cache_key, "0123abcd");
  EXPECT_TRUE(read->cached);
  ASSERT_EQ(read->results.size(), 1u);
  EXPECT_EQ(read->results[0].file_name, "model.obj");
  EXPECT_EQ(read->results[0].bytes, 1234u);
}

TEST_F(EmbeddedStoreTest, NamesTheJobThatDoesNotExist) {
  const std::string odd("x'; DROP TABLE job; --\0y", 24);
  for (const auto& id : {std::string("none"), odd, std::string()}) {
    EXPECT_EQ(store_->get(id).error().code, ErrorCode::NotFound);
    EXPECT_EQ(store_->update(id, {}, [](Job&) {}).error().code, ErrorCode::NotFound);
    EXPECT_EQ(store_->erase(id).error().code, ErrorCode::NotFound);
  }
  EXPECT_THAT(store_->get("none").error().message, HasSubstr("none"));
}

TEST_F(EmbeddedStoreTest, RefusesASecondJobOfTheSameId) {
  const auto job = queued();
  EXPECT_EQ(store_->insert(job).error().code, ErrorCode::AlreadyExists);
}

TEST_F(EmbeddedStoreTest, ListsNewestFirstByProcessStateAndPage) {
  std::vector<std::string> exports;
  for (int i = 0; i < 3; ++i) exports.push_back(queued().id);
  const auto other = queued("validate");
  ASSERT_TRUE(store_->update(other.id, {}, [](Job& job) { job.state = JobState::Running; }));

  const auto all = store_->list({});
  ASSERT_TRUE(all);
  ASSERT_EQ(all->size(), 4u);
  EXPECT_EQ((*all)[0].id, other.id);
  EXPECT_EQ((*all)[3].id, exports[0]);

  const auto page = store_->list({.processes = {"export-for-simulation"}, .limit = 1, .offset = 1});
  ASSERT_TRUE(page);
  ASSERT_EQ(page->size(), 1u);
  EXPECT_EQ((*page)[0].id, exports[1]);

  const auto running = store_->list({.states = {JobState::Running}});
  ASSERT_TRUE(running);
  ASSERT_EQ(running->size(), 1u);
  EXPECT_EQ(*store_->count({.states = {JobState::Accepted}}), 3u);
  EXPECT_EQ(*store_->count({.processes = {"validate"}, .limit = 0}), 1u);
  EXPECT_EQ(*store_->count_open(), 4u);
  ASSERT_TRUE(store_->update(other.id, {}, [](Job& job) { job.state = JobState::Failed; }));
  EXPECT_EQ(*store_->count_open(), 3u);
}

TEST_F(EmbeddedStoreTest, ListsAndCountsTheJobsOfOneOwner) {
  std::vector<Job> of_city;
  for (const auto* owner : {"city", "port", "city", "", "city"}) {
    auto job = new_job();
    job.owner = owner;
    ASSERT_TRUE(store_->insert(job));
    if (job.owner == "city") of_city.push_back(job);
  }
  const auto all = store_->list({.owner = "city"});
  ASSERT_TRUE(all);
  ASSERT_EQ(all->size(), 3u);
  EXPECT_EQ(all->front().id, of_city.back().id);
  EXPECT_EQ(store_->list({.owner = "city", .limit = 1, .offset = 2})->at(0).id, of_city[0].id);
  EXPECT_EQ(*store_->count({.owner = "city"}), 3u);
  EXPECT_EQ(*store_->count({.processes = {"validate"}, .owner = "city"}), 0u);
  EXPECT_EQ(*store_->count({.owner = "nobody"}), 0u);
  EXPECT_EQ(*store_->count({}), 5u);

  EXPECT_EQ(*store_->count_open_of("city"), 3u);
  ASSERT_TRUE(store_->update(of_city[1].id, {}, [](Job& job) { job.state = JobState::Failed; }));
  EXPECT_EQ(*store_->count_open_of("city"), 2u);
  EXPECT_EQ(*store_->count_open_of("nobody"), 0u);
}

TEST_F(EmbeddedStoreTest, ErasesAJobWithItsTask) {
  const auto job = queued();
  ASSERT_TRUE(store_->erase(job.id));
  EXPECT_EQ(store_->get(job.id).error().code, ErrorCode::NotFound);
  EXPECT_FALSE(*store_->claim("worker", kLongLease, 0));
}

TEST_F(EmbeddedStoreTest, MarksEveryChangeByALaterTimeAndTellsListeners) {
  const auto job = queued();
  std::vector<TimeMs> heard;
  const auto subscription =
      store_->changes().subscribe([&](const Job& changed) { heard.push_back(changed.updated); });
  auto last = job.updated;
  for (int i = 0; i < 20; ++i) {
    const auto changed = store_->update(job.id, {}, [i](Job& open) { open.percent = i; });
    ASSERT_TRUE(changed);
    EXPECT_GT(changed->updated, last);
    last = changed->updated;
  }
  EXPECT_EQ(heard.size(), 20u);
}

TEST_F(EmbeddedStoreTest, NeverChangesAFinalJob) {
  const auto job = queued();
  ASSERT_TRUE(store_->update(job.id, {}, [](Job& open) { open.state = JobState::Dismissed; }));
  const auto late = store_->update(job.id, {}, [](Job& open) { open.state = JobState::Failed; });
  EXPECT_EQ(late.error().code, ErrorCode::FailedPrecondition);
  EXPECT_THAT(late.error().message, HasSubstr("dismissed"));
  EXPECT_EQ(store_->get(job.id)->state, JobState::Dismissed);
}

TEST_F(EmbeddedStoreTest, HandsOutTheOldestJobFirst) {
  const auto first = queued();
  const auto second = queued();
  EXPECT_EQ(store_->waiting()->tasks, 2u);
  EXPECT_EQ(claimed().job_id, first.id);
  EXPECT_EQ(claimed().job_id, second.id);
  EXPECT_EQ(store_->waiting()->tasks, 0u);
  EXPECT_FALSE(*store_->claim("worker", kLongLease, 0));
}

TEST_F(EmbeddedStoreTest, AJobIsQueuedInTheStepThatStoresIt) {
  const auto job = queued();
  EXPECT_EQ(store_->insert(job).error().code, ErrorCode::AlreadyExists);
  auto ended = new_job();
  ended.state = JobState::Failed;
  ASSERT_TRUE(store_->insert(ended));
  store_ = reopened();  // as after a crash at once
  EXPECT_EQ(claimed().job_id, job.id);
  EXPECT_FALSE(*store_->claim("worker", kLongLease, 0));
}

TEST_F(EmbeddedStoreTest, AJobThatCannotBeQueuedIsNotStored) {
  execute("CREATE TRIGGER full BEFORE INSERT ON task BEGIN SELECT RAISE(ABORT, 'full'); END");
  const auto job = new_job();
  EXPECT_FALSE(store_->insert(job));
  EXPECT_EQ(store_->get(job.id).error().code, ErrorCode::NotFound);
}

TEST_F(EmbeddedStoreTest, AWaitingClaimWakesUpForANewJob) {
  std::string got;
  {
    const std::jthread waiter([&] {
      const auto claim = store_->claim("worker", kLongLease, 60'000);
      if (claim && *claim) got = (*claim)->job_id;
    });
    queued();
  }
  EXPECT_FALSE(got.empty());
}

TEST_F(EmbeddedStoreTest, EightThreadsClaimEachJobOnce) {
  constexpr int kJobs = 100;
  std::set<std::string> pushed;
  for (int i = 0; i < kJobs; ++i) pushed.insert(queued().id);

  std::mutex mutex;
  std::multiset<std::string> taken;
  {
    std::vector<std::jthread> workers;
    for (int w = 0; w < 8; ++w)
      workers.emplace_back([&, w] {
        for (;;) {
          const auto claim = store_->claim(std::to_string(w), kLongLease, 0);
          ASSERT_TRUE(claim) << claim.error().message;
          if (!*claim) return;
          const std::scoped_lock lock(mutex);
          taken.insert((*claim)->job_id);
        }
      });
  }
  EXPECT_EQ(taken.size(), pushed.size());
  EXPECT_EQ(std::set<std::string>(taken.begin(), taken.end()), pushed);
}

TEST_F(EmbeddedStoreTest, TwoOpeningsOfOneFileClaimEachJobOnce) {
  constexpr int kJobs = 40;
  for (int i = 0; i < kJobs; ++i) queued();
  const auto other = reopened();
  std::atomic<int> taken = 0;
  {
    std::vector<std::jthread> workers;
    for (auto* store : {store_.get(), other.get()})
      workers.emplace_back([&taken, store] {
        for (;;) {
          const auto claim = store->claim("worker", kLongLease, 0);
          ASSERT_TRUE(claim) << claim.error().message;
          if (!*claim) return;
          ++taken;
        }
      });
  }
  EXPECT_EQ(taken, kJobs);
}

TEST_F(EmbeddedStoreTest, AJobWhoseLeaseRanOutIsClaimedAgainAsTheNextAttempt) {
  const auto job = queued();
  const auto dead = claimed(kNoLease, "dead");
  EXPECT_EQ(dead.attempt, 1u);
  const auto next = claimed(kLongLease, "next");
  EXPECT_EQ(next.job_id, job.id);
  EXPECT_EQ(next.attempt, 2u);
  EXPECT_EQ(store_->get(job.id)->attempt, 2u);
}

TEST_F(EmbeddedStoreTest, AHeartbeatKeepsTheLease) {
  queued();
  const auto claim = claimed(kNoLease);
  ASSERT_TRUE(store_->heartbeat(claim, kLongLease));
  EXPECT_FALSE(*store_->claim("other", kLongLease, 0));
}

TEST_F(EmbeddedStoreTest, ALateWorkerCanChangeNothing) {
  const auto job = queued();
  const auto late = claimed(kNoLease, "late");
  ASSERT_TRUE(store_->update(job.id, late.attempt, [](Job& j) { j.state = JobState::Running; }));
  const auto owner = claimed(kLongLease, "owner");

  const auto lost = ErrorCode::FailedPrecondition;
  EXPECT_EQ(store_->heartbeat(late, kLongLease).error().code, lost);
  EXPECT_EQ(store_->done(late).error().code, lost);
  EXPECT_EQ(store_->release(late).error().code, lost);
  EXPECT_EQ(store_->set_progress(job.id, late.attempt, {"heal", 1, 2}, "", 50).error().code, lost);
  const auto update = store_->update(job.id, late.attempt, [](Job& j) { j.percent = 99; });
  EXPECT_EQ(update.error().code, lost);
  EXPECT_THAT(update.error().message, HasSubstr("attempt 1 is over"));
  EXPECT_TRUE(store_->update(job.id, owner.attempt, [](Job& j) { j.percent = 50; }));
  EXPECT_EQ(store_->get(job.id)->percent, 50);
}

TEST_F(EmbeddedStoreTest, AJobThatKillsItsWorkersIsFailedAfterTheLastTry) {
  const auto poison = queued();
  const auto healthy = queued();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(claimed(kNoLease).job_id, poison.id);

  while (!*store_->claim("worker", kLongLease, 0)) {
  }
  const auto failed = store_->get(poison.id);
  ASSERT_TRUE(failed);
  EXPECT_EQ(failed->state, JobState::Failed);
  EXPECT_EQ(failed->attempt, 3u);
  EXPECT_THAT(failed->message, HasSubstr("the worker died 3 times"));
  EXPECT_TRUE(failed->finished);
  ASSERT_TRUE(failed->error);
  EXPECT_EQ(store_->get(healthy.id)->attempt, 1u);
}

TEST_F(EmbeddedStoreTest, AReleasedJobWasNoDeath) {
  const auto job = queued();
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(store_->release(claimed()));
  EXPECT_EQ(claimed().attempt, 11u);
  EXPECT_EQ(store_->get(job.id)->state, JobState::Accepted);
}

TEST_F(EmbeddedStoreTest, AJobToDismissIsNotTriedAgain) {
  const auto job = queued();
  (void)claimed(kNoLease);
  ASSERT_TRUE(store_->update(job.id, {}, [](Job& j) {
    j.state = JobState::Running;
    j.dismiss_requested = true;
  }));
  EXPECT_FALSE(*store_->claim("worker", kLongLease, 0));
  EXPECT_EQ(store_->get(job.id)->state, JobState::Dismissed);
}

TEST_F(EmbeddedStoreTest, RecoveryEndsLeasesAndQueuesWhatAKilledProcessLeft) {
  const auto running = queued();
  const auto claim = claimed();
  ASSERT_TRUE(
      store_->update(running.id, claim.attempt, [](Job& j) { j.state = JobState::Running; }));
  ASSERT_TRUE(store_->set_progress(running.id, claim.attempt, {"heal", 1, 2}, "heal: 1 of 2", 50));
  const auto never_pushed = new_job();
  ASSERT_TRUE(store_->insert(never_pushed));

  store_ = reopened();
  EXPECT_EQ(*store_->recover(), 1u);
  EXPECT_EQ(store_->get(running.id)->state, JobState::Accepted);
  EXPECT_EQ(store_->get(running.id)->progress.done, 0u);
  EXPECT_EQ(store_->get(running.id)->percent, 0);
  EXPECT_EQ(claimed().job_id, running.id);
  EXPECT_EQ(claimed().job_id, never_pushed.id);
}

TEST_F(EmbeddedStoreTest, ProgressIsForTheRunningAttemptOnly) {
  const auto job = queued();
  const auto claim = claimed();
  EXPECT_FALSE(store_->set_progress(job.id, claim.attempt, {"heal", 1, 2}, "m", 50));
  ASSERT_TRUE(store_->update(job.id, claim.attempt, [](Job& j) { j.state = JobState::Running; }));
  ASSERT_TRUE(store_->set_progress(job.id, claim.attempt, {"heal", 1, 2}, "heal: 1 of 2", 50));
  EXPECT_EQ(store_->get(job.id)->message, "heal: 1 of 2");
  EXPECT_EQ(store_->get(job.id)->percent, 50);
}

/// As the first version wrote it: a job that is done and one that waits.
constexpr const char* kVersion1 = R"sql(
  PRAGMA application_id = 0x63746d73;
  PRAGMA user_version = 1;
  CREATE TABLE job (
    id TEXT PRIMARY KEY,
    process TEXT NOT NULL,
    inputs TEXT NOT NULL,
    outputs TEXT NOT NULL,
    response_document INTEGER NOT NULL,
    state TEXT NOT NULL,
    message TEXT NOT NULL,
    stage TEXT NOT NULL,
    done INTEGER NOT NULL,
    total INTEGER NOT NULL,
    percent INTEGER NOT NULL,
    error_code TEXT NOT NULL,
    error_message TEXT NOT NULL,
    attempt INTEGER NOT NULL,
    dismiss_requested INTEGER NOT NULL,
    created INTEGER NOT NULL,
    updated INTEGER NOT NULL,
    started INTEGER,
    finished INTEGER,
    results TEXT NOT NULL
  ) STRICT;
  CREATE INDEX job_by_time ON job (created DESC);
  CREATE INDEX job_open ON job (state) WHERE state IN ('accepted', 'running');
  CREATE TABLE task (
    seq INTEGER PRIMARY KEY AUTOINCREMENT,
    job_id TEXT NOT NULL UNIQUE REFERENCES job (id) ON DELETE CASCADE,
    worker TEXT NOT NULL DEFAULT '',
    attempt INTEGER NOT NULL DEFAULT 0,
    lease_until INTEGER NOT NULL DEFAULT 0,
    deaths INTEGER NOT NULL DEFAULT 0
  ) STRICT;
  INSERT INTO job VALUES
    ('00000000-0000-4000-8000-000000000001', 'heal', '{}', '{"obj":"value"}', 0, 'successful',
     '2 buildings', '', 2, 2, 100, '', '', 1, 0, 1000, 3000, 2000, 3000,
     '[{"bytes":9,"file_name":"model.obj","media_type":"model/obj","output":"obj"}]'),
    ('00000000-0000-4000-8000-000000000002', 'heal', '{}', '{}', 0, 'accepted', 'queued', '', 0, 0,
     0, '', '', 0, 0, 4000, 4000, NULL, NULL, '[]');
  INSERT INTO task (job_id) VALUES ('00000000-0000-4000-8000-000000000002');
)sql";

TEST_F(EmbeddedStoreTest, BringsADatabaseOfTheFirstVersionUpToDateWithItsJobs) {
  store_.reset();
  std::filesystem::remove_all(folder_ / "jobs.sqlite");
  execute(kVersion1);
  for (int time = 0; time < 2; ++time) {  // the second time there is nothing to do
    store_ = reopened();
    ASSERT_TRUE(store_);
    const auto done = store_->get("00000000-0000-4000-8000-000000000001");
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(done->state, JobState::Successful);
    EXPECT_EQ(done->finished, 3000);
    EXPECT_EQ(done->results.at(0).file_name, "model.obj");
    EXPECT_EQ(done->idempotency_key, "");
    EXPECT_TRUE(done->spec.subscriber.empty());
    EXPECT_EQ(*store_->count({}), 2u);
  }
  EXPECT_EQ(claimed().job_id, "00000000-0000-4000-8000-000000000002");
  auto job = new_job();
  job.idempotency_key = "key";
  ASSERT_TRUE(store_->insert(job));
  EXPECT_EQ(store_->get_by_key("", "key")->id, job.id);
}

/// What the second version added to the first.
constexpr const char* kVersion2 = R"sql(
  ALTER TABLE job ADD COLUMN idempotency_key TEXT NOT NULL DEFAULT '';
  CREATE UNIQUE INDEX job_by_key ON job (idempotency_key) WHERE idempotency_key <> '';
  UPDATE job SET idempotency_key = 'old key' WHERE state = 'accepted';
  PRAGMA user_version = 2;
)sql";

TEST_F(EmbeddedStoreTest, JobsOfTheSecondVersionBelongToNobodyAndKeepTheirKeys) {
  store_.reset();
  std::filesystem::remove_all(folder_ / "jobs.sqlite");
  execute(kVersion1);
  execute(kVersion2);
  for (int time = 0; time < 2; ++time) {
    store_ = reopened();
    ASSERT_TRUE(store_);
    EXPECT_EQ(*store_->count({.owner = ""}), 2u);
    EXPECT_EQ(store_->get_by_key("", "old key")->id, "00000000-0000-4000-8000-000000000002");
  }
  auto job = new_job();
  job.idempotency_key = "old key";
  EXPECT_EQ(store_->insert(job).error().code, ErrorCode::AlreadyExists);
  job.owner = "city";
  EXPECT_TRUE(store_->insert(job));
}

/// What the third and fourth versions added, with a job of each kind.
constexpr const char* kVersion3 = R"sql(
  ALTER TABLE job ADD COLUMN owner TEXT NOT NULL DEFAULT '';
  DROP INDEX job_by_key;
  CREATE UNIQUE INDEX job_by_key ON job (owner, idempotency_key) WHERE idempotency_key <> '';
  CREATE INDEX job_by_owner ON job (owner, created DESC);
  CREATE INDEX job_open_by_owner ON job (owner) WHERE state IN ('accepted', 'running');
  UPDATE job SET owner = 'city';
  PRAGMA user_version = 3;
)sql";
constexpr const char* kVersion4 = R"sql(
  ALTER TABLE job ADD COLUMN subscriber TEXT NOT NULL DEFAULT '{}';
  ALTER TABLE job ADD COLUMN callback_attempts INTEGER NOT NULL DEFAULT 0;
  ALTER TABLE job ADD COLUMN callback_due INTEGER;
  CREATE INDEX job_by_callback ON job (callback_due) WHERE callback_due IS NOT NULL;
  UPDATE job SET subscriber = '{"success":"https://portal.example/done"}', callback_due = 5000
    WHERE state = 'successful';
  PRAGMA user_version = 4;
)sql";

TEST_F(EmbeddedStoreTest, JobsOfTheThirdVersionKeepTheirOwners) {
  store_.reset();
  std::filesystem::remove_all(folder_ / "jobs.sqlite");
  for (const auto* step : {kVersion1, kVersion2, kVersion3}) execute(step);
  for (int time = 0; time < 2; ++time) {
    store_ = reopened();
    ASSERT_TRUE(store_);
    const auto jobs = store_->list({.owner = "city"});
    ASSERT_TRUE(jobs) << jobs.error().message;
    ASSERT_EQ(jobs->size(), 2u);
    EXPECT_EQ(jobs->at(1).message, "2 buildings");
    EXPECT_TRUE(jobs->at(1).spec.subscriber.empty());
    EXPECT_EQ(*store_->count_open_of("city"), 1u);
    EXPECT_EQ(store_->get_by_key("city", "old key")->id, jobs->at(0).id);
  }
  EXPECT_EQ(claimed().job_id, "00000000-0000-4000-8000-000000000002");
}

TEST_F(EmbeddedStoreTest, JobsOfTheFourthVersionKeepTheirSubscribersAndAreNoTwins) {
  store_.reset();
  std::filesystem::remove_all(folder_ / "jobs.sqlite");
  for (const auto* step : {kVersion1, kVersion2, kVersion3, kVersion4}) execute(step);
  for (int time = 0; time < 2; ++time) {
    store_ = reopened();
    ASSERT_TRUE(store_);
    const auto done = store_->get("00000000-0000-4000-8000-000000000001");
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(done->spec.subscriber.success_uri, "https://portal.example/done");
    EXPECT_EQ(done->cache_key, "");
    EXPECT_FALSE(done->cached);
  }
  EXPECT_EQ(store_->get_by_cache_key("").error().code, ErrorCode::NotFound);
  const auto due = store_->take_callback(6000, [](std::uint32_t) { return std::nullopt; });
  ASSERT_TRUE(due && *due);
  EXPECT_EQ((*due)->job.id, "00000000-0000-4000-8000-000000000001");
}

TEST_F(EmbeddedStoreTest, TheLastJobThatHasResultsIsFoundByItsCacheKey) {
  const auto stored = [this](TimeMs finished, JobState state, const std::string& key) {
    auto job = new_job();
    job.state = state;
    job.cache_key = key;
    job.finished = finished;
    if (state == JobState::Successful) job.results = {{"obj", "model.obj", "model/obj", 4}};
    EXPECT_TRUE(store_->insert(job));
    return job.id;
  };
  const auto first = stored(1000, JobState::Successful, "key");
  const auto last = stored(3000, JobState::Successful, "key");
  stored(2000, JobState::Successful, "other");
  stored(4000, JobState::Failed, "key");
  stored(5000, JobState::Successful, "");
  EXPECT_EQ(store_->get_by_cache_key("key")->id, last);
  ASSERT_TRUE(store_->drop_results(last, "results have expired"));
  EXPECT_EQ(store_->get(last)->cache_key, "");
  EXPECT_EQ(store_->get_by_cache_key("key")->id, first);
  ASSERT_TRUE(store_->erase(first));
  for (const auto* none : {"key", "", "ke"})
    EXPECT_EQ(store_->get_by_cache_key(none).error().code, ErrorCode::NotFound);
}

TEST_F(EmbeddedStoreTest, AnIdempotencyKeyBelongsToOneJobUntilThatIsErased) {
  auto first = new_job(), second = new_job();
  first.idempotency_key = second.idempotency_key = "key";
  ASSERT_TRUE(store_->insert(first));
  store_ = reopened();
  const auto refused = store_->insert(second);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::AlreadyExists);
  EXPECT_FALSE(store_->get(second.id));
  EXPECT_EQ(store_->get_by_key("", "key")->id, first.id);
  ASSERT_TRUE(store_->update(first.id, {}, [](Job& job) { job.state = JobState::Failed; }));
  EXPECT_EQ(store_->get_by_key("", "key")->id, first.id);

  ASSERT_TRUE(store_->erase(first.id));
  EXPECT_EQ(store_->get_by_key("", "key").error().code, ErrorCode::NotFound);
  EXPECT_TRUE(store_->insert(second));
}

TEST_F(EmbeddedStoreTest, TheIdempotencyKeyOfOneOwnerIsFreeForAnother) {
  auto first = new_job(), second = new_job();
  first.idempotency_key = second.idempotency_key = "key";
  first.owner = "city";
  second.owner = "port";
  ASSERT_TRUE(store_->insert(first));
  ASSERT_TRUE(store_->insert(second));
  EXPECT_EQ(store_->get_by_key("city", "key")->id, first.id);
  EXPECT_EQ(store_->get_by_key("port", "key")->id, second.id);
  EXPECT_FALSE(store_->get_by_key("", "key"));
}

TEST_F(EmbeddedStoreTest, JobsWithoutAnIdempotencyKeyAreNeverTakenForEachOther) {
  ASSERT_TRUE(store_->insert(new_job()));
  ASSERT_TRUE(store_->insert(new_job()));
  EXPECT_FALSE(store_->get_by_key("", ""));
}

TEST_F(EmbeddedStoreTest, RefusesADatabaseOfANewerVersion) {
  store_.reset();
  execute("PRAGMA user_version = 99");
  const auto opened = EmbeddedStore::open(folder_ / "jobs.sqlite");
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::FailedPrecondition);
  EXPECT_THAT(opened.error().message, HasSubstr("schema version 99"));
  EXPECT_THAT(opened.error().message, HasSubstr("jobs.sqlite"));
}

TEST_F(EmbeddedStoreTest, RefusesADatabaseOfSomebodyElse) {
  store_.reset();
  std::filesystem::remove(folder_ / "jobs.sqlite");
  execute("CREATE TABLE notes (text)");
  const auto opened = EmbeddedStore::open(folder_ / "jobs.sqlite");
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::DataLoss);
  EXPECT_THAT(opened.error().message, HasSubstr("is not a job database of citymesh"));
}

TEST_F(EmbeddedStoreTest, RefusesAFileThatIsNoDatabase) {
  const auto file = folder_ / "garbage.sqlite";
  std::ofstream(file) << std::string(8192, 'x');
  const auto opened = EmbeddedStore::open(file);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::DataLoss);
  EXPECT_THAT(opened.error().message, HasSubstr("garbage.sqlite"));
}

TEST_F(EmbeddedStoreTest, RefusesADamagedDatabase) {
  for (int i = 0; i < 50; ++i) queued();
  store_.reset();
  const auto file = folder_ / "jobs.sqlite";
  const auto size = std::filesystem::file_size(file);
  ASSERT_GT(size, 8192u);
  {
    std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(4096);
    bytes << std::string(size - 4096, '\x5a');
  }
  const auto opened = EmbeddedStore::open(file);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::DataLoss);
  EXPECT_THAT(opened.error().message, HasSubstr("damaged"));
}

TEST_F(EmbeddedStoreTest, NamesAFolderThatDoesNotExist) {
  const auto opened = EmbeddedStore::open(folder_ / "missing" / "jobs.sqlite");
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::Unavailable);
  EXPECT_THAT(opened.error().message, HasSubstr("missing"));
}

}  // namespace
}  // namespace citymesh
