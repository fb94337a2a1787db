#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <set>
#include <thread>

#include "core/files.h"
#include "tests/support/temporary_folder.h"
#include "tools/sweeps/recording_cache.h"
#include "tools/sweeps/schedule.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using tests::TemporaryFolder;

// --- schedule ----------------------------------------------------------------------------------------------------

using Kind = SweepTask::Kind;

TEST(SweepSchedule, StartsTheDearestDriveAndItsCellsComeBeforeTheNextDrive) {
  SweepSchedule schedule({{0, 1}, {2}}, {1.0, 5.0});
  const auto first = schedule.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->kind, Kind::simulate);
  EXPECT_EQ(first->world, 1u);
  schedule.simulated(1);
  const auto second = schedule.next();
  EXPECT_EQ(second->kind, Kind::cell);
  EXPECT_EQ(second->cell, 2u);
  EXPECT_EQ(schedule.next()->kind, Kind::simulate);
  schedule.simulated(0);
  EXPECT_EQ(schedule.next()->cell, 0u);
  EXPECT_EQ(schedule.next()->cell, 1u);
  EXPECT_FALSE(schedule.next());
}

TEST(SweepSchedule, TellsTheLastCellOfADriveAndSkipsDrivesWithoutCells) {
  SweepSchedule schedule({{}, {0, 1}}, {9, 1});
  EXPECT_EQ(schedule.next()->world, 1u);
  schedule.simulated(1);
  const auto a = schedule.next(), b = schedule.next();
  EXPECT_FALSE(schedule.finished(*b));
  EXPECT_TRUE(schedule.finished(*a));
}

TEST(SweepSchedule, WaitsForADriveThatAnotherSlotSimulates) {
  SweepSchedule schedule({{7}}, {1});
  ASSERT_EQ(schedule.next()->kind, Kind::simulate);
  std::atomic<bool> got{false};
  std::thread other([&] {
    const auto task = schedule.next();
    EXPECT_TRUE(task && task->cell == 7);
    got = true;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(got);
  schedule.simulated(0);
  other.join();
  EXPECT_TRUE(got);
}

TEST(SweepSchedule, StopsEverybody) {
  SweepSchedule schedule({{0}, {1}}, {1, 1});
  schedule.next();
  schedule.next();
  std::thread other([&] { EXPECT_FALSE(schedule.next()); });
  schedule.stop();
  other.join();
}

// --- cache -------------------------------------------------------------------------------------------------------

/// An entry of about that many bytes.
std::string make_entry(const fs::path& folder, std::size_t bytes) {
  fs::create_directories(folder / "recording");
  core::write_file(folder / "recording" / "data", std::string(bytes, 'x'));
  return "hash";
}

std::set<std::string> entries(const fs::path& root) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(root))
    if (entry.is_directory()) names.insert(entry.path().filename().string());
  return names;
}

TEST(RecordingCache, MakesAnEntryOnceAndFindsItAgain) {
  const TemporaryFolder folder;
  RecordingCache cache(folder / "cache", 0);
  int made = 0;
  const auto make = [&](const fs::path& to) {
    ++made;
    return make_entry(to, 10);
  };
  const CachedRecording first = cache.obtain("a", make);
  EXPECT_TRUE(first.made);
  EXPECT_EQ(first.recording_hash, "hash");
  EXPECT_TRUE(fs::is_regular_file(first.recording() / "data"));
  EXPECT_FALSE(RecordingCache(folder / "cache", 0).obtain("a", make).made);
  EXPECT_EQ(made, 1);
}

TEST(RecordingCache, LeavesNothingOfAnEntryThatFails) {
  const TemporaryFolder folder;
  RecordingCache cache(folder / "cache", 0);
  EXPECT_THROW(cache.obtain("a",
                            [](const fs::path& to) -> std::string {
                              make_entry(to, 10);
                              throw std::runtime_error("no");
                            }),
               std::runtime_error);
  EXPECT_TRUE(entries(folder / "cache").empty());
}

TEST(RecordingCache, RemovesTheLongestUnusedFirstAndNeverWhatIsInUse) {
  const TemporaryFolder folder;
  RecordingCache cache(folder / "cache", 25e-6);  // 25 kB
  const auto make = [](const fs::path& to) { return make_entry(to, 10000); };
  const auto pause = [] { std::this_thread::sleep_for(std::chrono::milliseconds(15)); };
  const CachedRecording in_use = cache.obtain("a", make);
  pause();
  cache.obtain("b", make);
  pause();
  cache.obtain("c", make);
  pause();
  cache.obtain("b", make);  // used again, later than c
  EXPECT_LE(cache.trim(), 25000u);
  EXPECT_THAT(entries(folder / "cache"), ElementsAre("a", "b"));
}

TEST(RecordingCache, RemovesWhatADeadProcessLeftHalfMade) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "cache");
  make_entry(folder / "cache" / "a.part", 10);
  make_entry(folder / "cache" / "b", 10);  // without its mark
  RecordingCache cache(folder / "cache", 0);
  EXPECT_TRUE(entries(folder / "cache").empty());
}

TEST(RecordingCache, IsSharedByProcessesWithoutMakingAnythingTwice) {
  const TemporaryFolder folder;
  const auto work = [&] {
    RecordingCache cache(folder / "cache", 0);
    for (const char* key : {"a", "b", "c"}) {
      cache.obtain(key, [&](const fs::path& to) {
        std::this_thread::sleep_for(std::chrono::milliseconds(30));
        const std::string log = (folder / "made").string();
        std::FILE* out = std::fopen(log.c_str(), "a");
        std::fprintf(out, "%s\n", key);
        std::fclose(out);
        return make_entry(to, 10);
      });
    }
  };
  std::vector<pid_t> children;
  for (int i = 0; i < 3; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      work();
      _exit(0);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
  EXPECT_EQ(core::read_file(folder / "made").size(), 6u) << core::read_file(folder / "made");
}

}  // namespace
}  // namespace tarmac::tools
