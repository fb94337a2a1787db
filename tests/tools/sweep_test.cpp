// Sweeps from outside: the program, its children, the store; killed, starved of room, and with hostile estimators.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

#include "core/files.h"
#include "core/random.h"
#include "scenarios/store.h"
#include "tools/tarmac/child.h"
#include "tools/tarmac/child_start.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kScenario = R"(name: short
why: A test.
surprise: None.
duration_s: 1
scene: {kind: stand}
motion: {kind: drive, rest_s: 0, start: {x_m: -60, y_m: -30, speed_m_s: 4}, path: [{straight_m: 60}], speed: []}
rig: {lidar: {model: vlp-16, T_body_lidar: {xyz_m: [1.2, 0, 1.9]}}}
)";
constexpr const char* kSweep = R"(name: small
why: A test.
seeds: 1..2
estimators: [kiss-icp, rigid-icp]
blocks:
  - {scenario: short.yaml}
  - {name: fine, scenario: short.yaml, estimators: [kiss-icp], vary: {estimators.kiss-icp.voxel_size_m: [0.5, 0.7]}}
)";
// Two methods, and two more settings of one, on two seeds of the same drive.
constexpr std::size_t kCells = 8, kRecordings = 2;

struct Ended {
  int code = 0;
  std::string text;
};

class Sweep : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new PrivateFolder;
    core::write_file(path("short.yaml"), kScenario);
    core::write_file(path("small.yaml"), kSweep);
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static fs::path path(const std::string& name) { return folder_->path() / name; }
  static ChildRequest request(std::vector<std::string> words) {
    ChildRequest request;
    words.insert(words.begin(), (program_folder() / "tarmac").string());
    request.command = std::move(words);
    request.working_folder = folder_->path();
    request.log_file = path("log.txt");
    request.limits.wall_s = 240;
    return request;
  }
  static Ended tarmac(std::vector<std::string> words) {
    const ChildResult result = run_child(request(std::move(words)));
    EXPECT_EQ(result.end, ChildResult::End::exited) << result.message << core::read_file(path("log.txt"));
    return {result.code, core::read_file(path("log.txt"))};
  }
  /// `tarmac sweep small.yaml` with the shared cache.
  static std::vector<std::string> small(const std::string& out, std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"sweep", "small.yaml", "-o", path(out).string()};
    const auto unless_given = [&](const char* option, const std::string& value) {
      if (std::find(more.begin(), more.end(), option) == more.end()) words.insert(words.end(), {option, value});
    };
    unless_given("--jobs", "2");
    unless_given("--cache", path("cache").string());
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  static std::string dump(const std::string& out) {
    std::ostringstream text;
    scenarios::Store::open(path(out), scenarios::Store::Access::read_only).dump(text);
    return text.str();
  }
  static std::string sorted_outcomes(const std::string& out) {
    std::string text;
    for (const auto& r : scenarios::Store::open(path(out), scenarios::Store::Access::read_only).results({}))
      text += r.cell.estimator + ": " + r.outcome.status + ": " + r.outcome.message + "\n";
    return text;
  }
  /// The undisturbed sweep that others are held against.
  static const std::string& undisturbed() {
    static const std::string text = [] {
      const Ended ended = tarmac(small("undisturbed"));
      EXPECT_EQ(ended.code, 0) << ended.text;
      return dump("undisturbed");
    }();
    return text;
  }
  static std::map<std::string, std::string> statuses(const std::string& out) {
    std::map<std::string, std::string> found;
    for (const auto& r : scenarios::Store::open(path(out), scenarios::Store::Access::read_only).results({}))
      found[r.cell.estimator] = r.outcome.status;
    return found;
  }
  static PrivateFolder* folder_;
};
PrivateFolder* Sweep::folder_ = nullptr;

TEST_F(Sweep, RunsEveryCellOnceOnSharedRecordings) {
  undisturbed();
  std::size_t scored = 0;
  const auto store = scenarios::Store::open(path("undisturbed"), scenarios::Store::Access::read_only);
  for (const scenarios::CellResult& r : store.results({})) {
    EXPECT_EQ(r.outcome.status, "ok") << r.outcome.message;
    EXPECT_TRUE(fs::is_regular_file(store.folder() / r.outcome.folder / r.cell.estimator / "evaluation.json"));
    EXPECT_FALSE(fs::exists(store.folder() / r.outcome.folder / r.cell.estimator / "diagnostics.bin"));
    for (const scenarios::MetricValue& m : r.metrics)
      if (m.metric == "rpe_1sweep_trans_rmse_m" && m.value && *m.value > 0) ++scored;
  }
  EXPECT_EQ(scored, kCells);
  std::size_t recordings = 0;
  for (const auto& entry : fs::directory_iterator(path("cache"))) recordings += entry.is_directory() ? 1 : 0;
  EXPECT_EQ(recordings, kRecordings);
  EXPECT_TRUE(fs::is_empty(path("undisturbed") / "work"));
}

TEST_F(Sweep, GivesTheSameFiguresWhateverRunsAtOnceAndFromFreshRecordings) {
  ASSERT_EQ(tarmac(small("one", {"--jobs", "1", "--cache", path("cache-one").string()})).code, 0);
  EXPECT_EQ(dump("one"), undisturbed());
}

TEST_F(Sweep, ACellsCommandRunsItAlone) {
  undisturbed();
  const auto store = scenarios::Store::open(path("undisturbed"), scenarios::Store::Access::read_only);
  scenarios::ResultFilter kiss;
  kiss.estimators = {"kiss-icp"};
  const scenarios::CellResult cell = store.results(kiss).back();
  ChildRequest again = request({});
  again.command = {"sh", "-c", "PATH=" + program_folder().string() + ":$PATH; " + cell.outcome.command};
  ASSERT_TRUE(run_child(again).ok()) << cell.outcome.command << core::read_file(path("log.txt"));
  EXPECT_EQ(core::read_file(path("one-cell") / "kiss-icp" / "trajectory.bin"),
            core::read_file(store.folder() / cell.outcome.folder / "kiss-icp" / "trajectory.bin"));
}

TEST_F(Sweep, ADryRunListsTheCellsAndWritesNothing) {
  const Ended ended = tarmac({"sweep", "small.yaml", "--dry-run", "-o", path("dry").string()});
  EXPECT_EQ(ended.code, 0);
  EXPECT_THAT(ended.text, AllOf(HasSubstr("fine estimators.kiss-icp.voxel_size_m=0.5"),
                                HasSubstr("8 cells on 2 recordings"), HasSubstr("Estimated")));
  EXPECT_FALSE(fs::exists(path("dry")));
}

TEST_F(Sweep, HostileEstimatorsAreRecordedAndTheOthersFinish) {
  core::write_file(path("hostile.yaml"), R"yaml(estimators:
  segfault: {command: [sh, -c, 'kill -SEGV $$']}
  hang: {command: [sleep, '1000'], timeout_s: 1}
  glutton: {command: [python3, -c, "x = []\nwhile True: x.append(bytearray(1 << 20))"]
}
  not-a-number: {command: [sh, -c, 'for t in 0 1 2; do echo $t nan nan nan 0 0 0 1; done > "$0"', '{output}']}
  garbage: {command: [sh, -c, 'head -c 100000 /bin/sh > "$0"', '{output}']}
  liar: {command: [sh, -c, 'echo No space left on device; exit 1']}
  flood: {command: [sh, -c, 'yes > "$0"', '{output}']}
)yaml");
  core::write_file(path("hostile-sweep.yaml"), R"(name: hostile
why: A test.
seeds: 1
estimators: [segfault, hang, glutton, not-a-number, garbage, liar, flood, kiss-icp]
limits: {memory_mb: 300, file_mb: 50}
blocks: [{scenario: short.yaml}]
)");
  const auto run = [&](const std::string& out) {
    return tarmac({"sweep", "hostile-sweep.yaml", "--config", "hostile.yaml", "-o", path(out).string(), "--cache",
                   path("cache").string()});
  };
  const Ended ended = run("hostile");
  EXPECT_EQ(ended.code, 3) << ended.text;
  // What is recorded of a failure is the same again, wherever things lay: no folder's name is in it.
  EXPECT_EQ(run("hostile-again").code, 3);
  EXPECT_EQ(sorted_outcomes("hostile-again"), sorted_outcomes("hostile"));
  const std::map<std::string, std::string> expected = {
      {"segfault", "crashed"},   {"hang", "timed_out"}, {"glutton", "out_of_memory"}, {"not-a-number", "bad_output"},
      {"garbage", "bad_output"}, {"liar", "failed"},    {"flood", "failed"},          {"kiss-icp", "ok"}};
  EXPECT_EQ(statuses("hostile"), expected) << ended.text;
  const auto store = scenarios::Store::open(path("hostile"), scenarios::Store::Access::read_only);
  scenarios::ResultFilter failed;
  failed.statuses = {"crashed", "bad_output"};
  for (const scenarios::CellResult& r : store.results(failed)) {
    EXPECT_TRUE(fs::is_regular_file(store.folder() / r.outcome.folder / r.cell.estimator / "log.txt"));
    EXPECT_THAT(r.outcome.command, AllOf(HasSubstr("tarmac run"), HasSubstr(r.cell.estimator)));
    EXPECT_NE(r.outcome.message, "");
  }
}

struct Draws {
  double operator()() { return stream.uniform(i++); }
  core::RandomStream stream{1, "tests/sweep/kill"};
  std::uint64_t i = 0;
};

/// Children of a process, and theirs.
std::vector<pid_t> descendants(pid_t process) {
  std::vector<pid_t> found;
  std::error_code gone;
  for (const auto& task : fs::directory_iterator("/proc/" + std::to_string(process) + "/task", gone)) {
    std::ifstream children(task.path() / "children");
    for (pid_t child = 0; children >> child;) {
      found.push_back(child);
      for (const pid_t below : descendants(child)) found.push_back(below);
    }
  }
  return found;
}

/// Starts the program, kills it (or one of its children, again and again) at a drawn moment; true when it was hit.
bool disturb(const ChildRequest& sweep, bool children, Draws& draw) {
  const int no_progress = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  const StartedChild started = start_child(sweep, no_progress);
  ::close(no_progress);
  EXPECT_GT(started.pid, 0);
  bool hit = false;
  const auto pause = [&] {
    std::this_thread::sleep_for(std::chrono::microseconds(static_cast<std::int64_t>(1e6 * draw())));
  };
  pause();
  int status = 0;
  while (::waitpid(started.pid, &status, WNOHANG) == 0) {
    if (!children) {
      hit = ::kill(started.pid, SIGKILL) == 0;
      ::waitpid(started.pid, &status, 0);
      break;
    }
    const std::vector<pid_t> running = descendants(started.pid);
    if (!running.empty()) {
      hit =
          ::kill(running[static_cast<std::size_t>(draw() * static_cast<double>(running.size()))], SIGKILL) == 0 || hit;
    }
    pause();
  }
  if (started.pidfd >= 0) ::close(started.pidfd);
  return hit;
}

/// How thorough: rounds of killing, two a build; tests/README.md says how to ask for more.
int kill_rounds() {
  const char* rounds = std::getenv("TARMAC_KILL_ROUNDS");
  return rounds ? std::atoi(rounds) : 2;
}

TEST_F(Sweep, KilledAtDrawnMomentsAndResumedItEqualsAnUndisturbedRun) {
  undisturbed();
  Draws draw;
  int hits = 0;
  for (int round = 0; round < kill_rounds(); ++round) {
    for (const bool children : {false, true}) {
      const std::string out = "killed-" + std::to_string(round) + (children ? "-children" : "-parent");
      hits += disturb(request(small(out, {"--cache", path("cache-" + out).string()})), children, draw) ? 1 : 0;
      const Ended ended = tarmac(small(out, {"--resume", "--cache", path("cache-" + out).string()}));
      EXPECT_EQ(ended.code, 0) << ended.text;
      EXPECT_EQ(dump(out), undisturbed()) << ended.text;
    }
  }
  RecordProperty("hits", hits);
  EXPECT_GE(hits, kill_rounds()) << "too few of the kills met a running sweep";
}

TEST_F(Sweep, AKilledChildIsNoAnswerAndTheNextStartSaysWhatItDoes) {
  core::write_file(path("killed.yaml"), "estimators: {suicide: {command: [sh, -c, 'kill -KILL $$']}}\n");
  const std::vector<std::string> words = {"sweep",    "small.yaml",          "--set", "duration_s=1",
                                          "--config", "killed.yaml",         "-o",    path("suicide").string(),
                                          "--cache",  path("cache").string()};
  core::write_file(path("suicide.yaml"),
                   "name: suicide\nwhy: x\nseeds: 1\nestimators: [suicide]\nblocks: [{scenario: short.yaml}]\n");
  std::vector<std::string> sweep = words;
  sweep[1] = "suicide.yaml";
  EXPECT_EQ(tarmac(sweep).code, 3);
  EXPECT_EQ(statuses("suicide").at("suicide"), "killed");
  sweep.emplace_back("--resume");
  const Ended again = tarmac(sweep);
  EXPECT_THAT(again.text, HasSubstr("1 cells had been killed from outside: they are run again"));
}

TEST_F(Sweep, ShardsMergedEqualTheWhole) {
  EXPECT_EQ(tarmac(small("part-1", {"--shard", "1/2"})).code, 0);
  EXPECT_EQ(tarmac(small("part-2", {"--shard", "2/2"})).code, 0);
  for (const std::vector<std::string>& other : {std::vector<std::string>{"--resume"}, {"--resume", "--shard", "2/2"}}) {
    const Ended ended = tarmac(small("part-1", other));
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.text, HasSubstr("another shard's"));
  }
  const std::vector<fs::path> parts = {path("part-1"), path("part-2")};
  EXPECT_EQ(scenarios::merge_stores(parts, path("merged")), kCells);
  EXPECT_EQ(dump("merged"), undisturbed());
  for (const char* bad : {"0/2", "3/2", "1", "a/b", "1/2x"}) {
    const Ended ended = tarmac(small("bad", {"--shard", bad}));
    EXPECT_EQ(ended.code, 2) << bad;
    EXPECT_THAT(ended.text, HasSubstr("expected I/N"));
  }
}

TEST_F(Sweep, RefusesToMixWhatDoesNotBelongTogether) {
  undisturbed();
  const Ended twice = tarmac(small("undisturbed"));
  EXPECT_EQ(twice.code, 2);
  EXPECT_THAT(twice.text, HasSubstr("--resume"));
  const Ended other_cells = tarmac(small("undisturbed", {"--resume", "--set", "duration_s=1.5"}));
  EXPECT_EQ(other_cells.code, 2);
  EXPECT_THAT(other_cells.text, HasSubstr("list of cells"));
  const Ended fast = tarmac(small("undisturbed", {"--resume", "--fast"}));
  EXPECT_EQ(fast.code, 2);
  EXPECT_THAT(fast.text, HasSubstr("its build was"));
  const fs::path program = program_folder() / "tarmac-cell";  // any other program than the one before
  const Ended other_build = tarmac(small("undisturbed", {"--resume", "--estimator-program", program.string()}));
  EXPECT_EQ(other_build.code, 2);
  EXPECT_THAT(other_build.text, HasSubstr("its build was"));
  EXPECT_EQ(dump("undisturbed"), undisturbed());
}

TEST_F(Sweep, BadInputNamesFileLineAndField) {
  core::write_file(path("bad.yaml"),
                   "name: bad\nwhy: x\nseeds: 1\nestimators: [kiss-icp]\nblocks:\n"
                   "  - scenario: short.yaml\n    vary: {motion.crusie_m_s: [1]}\n");
  const Ended ended = tarmac({"sweep", "bad.yaml", "-o", path("bad-out").string()});
  EXPECT_EQ(ended.code, 2);
  EXPECT_THAT(ended.text, AllOf(HasSubstr("bad.yaml:"), HasSubstr("crusie_m_s")));
  EXPECT_FALSE(fs::exists(path("bad-out")));
}

/// The words as a shell has them.
std::string quoted(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += " '" + word + "'";
  return text;
}

TEST_F(Sweep, AFullDiskStopsItAndAfterRoomIsMadeItGoesOn) {
  undisturbed();
  // A small file system of our own, in a name space of mounts: needs no rights where the kernel lends them.
  const std::string mount = path("small-disk").string();
  fs::create_directories(mount);
  std::vector<int> ballasts_kb = {5000};  // of 9000; it decides what is running when the disk is full
  if (kill_rounds() > 2) ballasts_kb = {4000, 4500, 5000, 5500, 6000, 7000, 8000, 8500, 8900};
  for (const int ballast_kb : ballasts_kb) {
    const std::string name = "full-" + std::to_string(ballast_kb);
    const std::vector<std::string> words = {"sweep",  "small.yaml", "-o",      mount + "/out",
                                            "--jobs", "2",          "--cache", mount + "/recordings"};
    std::vector<std::string> again = words;
    again.emplace_back("--resume");
    ChildRequest run = request({});
    run.command = {"unshare",
                   "--map-root-user",
                   "--mount",
                   "sh",
                   "-c",
                   "mount -t tmpfs -o size=9000k tmpfs '" + mount + "' || exit 77\n" +  //
                       "dd if=/dev/zero of='" + mount + "/ballast' bs=1k count=" + std::to_string(ballast_kb) +
                       " 2>/dev/null\n" + quoted(request(words).command) + "; echo first ended with $?\n" +
                       "mount -o remount,size=200m '" + mount + "'\n" + "test -f '" + mount + "/out/store.sqlite' || " +
                       "echo nothing to resume\n" + quoted(request(again).command) + "; echo second ended with $?\n" +
                       "cp -r '" + mount + "/out' '" + path(name).string() + "'\n"};
    const ChildResult result = run_child(run);
    const std::string text = core::read_file(path("log.txt"));
    if (result.code == 77 || text.find("unshare: ") != std::string::npos) {
      GTEST_SKIP() << "NO NAME SPACE OF MOUNTS HERE: the full disk is not tested: " << text;
    }
    EXPECT_THAT(text, AllOf(HasSubstr("first ended with 3"), HasSubstr("no room left"), HasSubstr("--resume"),
                            HasSubstr("second ended with 0")))
        << ballast_kb;
    EXPECT_EQ(dump(name), undisturbed()) << text;
  }
}

}  // namespace
}  // namespace tarmac::tools
