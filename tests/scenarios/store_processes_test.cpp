// Several processes and one store; processes that are ended at any moment.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <functional>
#include <set>

#include "tests/scenarios/store_cells.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::scenarios {
namespace {

using tarmac::tests::TemporaryFolder;
using testing::IsEmpty;
using testing::SizeIs;
using namespace scenarios::tests;
namespace fs = std::filesystem;

/// A process that does some work and ends without running the test's own ends.
pid_t in_child(const std::function<void()>& work) {
  const pid_t pid = ::fork();
  if (pid != 0) return pid;
  int code = 0;
  try {
    work();
  } catch (const std::exception& error) {
    fmt::print(stderr, "child: {}\n", error.what());
    code = 1;
  }
  ::_exit(code);
}

int status_of(pid_t pid) {
  int status = 0;
  EXPECT_EQ(::waitpid(pid, &status, 0), pid);
  return status;
}

/// Numbers from a process to its parent, each written after what it tells of.
class Pipe {
 public:
  Pipe() { EXPECT_EQ(::pipe(ends_.data()), 0); }
  ~Pipe() {
    ::close(ends_[0]);
    if (ends_[1] >= 0) ::close(ends_[1]);
  }
  void tell(std::size_t number) const { EXPECT_EQ(::write(ends_[1], &number, sizeof number), ssize_t{sizeof number}); }
  void close_writing() {
    ::close(ends_[1]);
    ends_[1] = -1;
  }
  bool hear(std::size_t& number) const { return ::read(ends_[0], &number, sizeof number) == ssize_t{sizeof number}; }

 private:
  std::array<int, 2> ends_{};
};

TEST(StoreProcesses, TwoWritersFinishDisjointCellsAtTheSameTime) {
  const TemporaryFolder folder;
  constexpr std::size_t kCells = 200;
  { const Store made = Store::create(folder.path(), kIdentity, "", cells(kCells)); }
  std::vector<pid_t> children;
  for (const std::size_t part : {0u, 1u}) {
    children.push_back(in_child([&] {
      Store store = Store::open(folder.path(), Store::Access::read_write);
      store.start(false);
      for (std::size_t i = part; i < kCells; i += 2) run(store, i);
    }));
  }
  for (const pid_t child : children) EXPECT_EQ(status_of(child), 0);
  Store store = Store::open(folder.path(), Store::Access::read_write);
  const StoreStart start = store.start(false);
  EXPECT_EQ(start.done, kCells);
  EXPECT_EQ(start.released, 0u);
  Store one = Store::create(folder / "alone", kIdentity, "", cells(kCells));
  one.start(false);
  for (std::size_t i = 0; i < kCells; ++i) run(one, i);
  EXPECT_EQ(dump(store), dump(one));
}

TEST(StoreProcesses, TwoWritersThatWantTheSameCellsRunEachOnce) {
  const TemporaryFolder folder;
  constexpr std::size_t kCells = 150;
  { const Store made = Store::create(folder.path(), kIdentity, "", cells(kCells)); }
  std::array<Pipe, 2> ran;
  std::vector<pid_t> children;
  for (const std::size_t writer : {0u, 1u}) {
    children.push_back(in_child([&] {
      Store store = Store::open(folder.path(), Store::Access::read_write);
      store.start(false);
      for (std::size_t i = 0; i < kCells; ++i) {
        if (!store.claim(cell(i).key)) continue;
        store.finish(cell(i).key, outcome(i), metrics(i));
        ran[writer].tell(i);
      }
    }));
  }
  std::multiset<std::size_t> numbers;
  for (Pipe& pipe : ran) {
    pipe.close_writing();
    std::size_t number = 0;
    while (pipe.hear(number)) numbers.insert(number);
  }
  for (const pid_t child : children) EXPECT_EQ(status_of(child), 0);
  EXPECT_EQ(numbers.size(), kCells);
  EXPECT_EQ(std::set<std::size_t>(numbers.begin(), numbers.end()).size(), kCells);
  EXPECT_THAT(Store::open(folder.path(), Store::Access::read_only).results({}), SizeIs(kCells));
}

/// Kills a writer after it has acknowledged so many cells and then a little more.
void kill_writer_after(std::size_t acknowledged, useconds_t more_us) {
  const TemporaryFolder folder;
  constexpr std::size_t kCells = 400;
  { const Store made = Store::create(folder.path(), kIdentity, "", cells(kCells)); }
  Pipe pipe;
  const pid_t writer = in_child([&] {
    Store store = Store::open(folder.path(), Store::Access::read_write);
    store.start(false);
    core::write_file(store.work_folder() / "half", "made");
    for (std::size_t i = 0; i < kCells; ++i) {
      if (i + 1 < kCells && !store.claim(cell(i + 1).key) && i == 0) throw std::runtime_error("not pending");
      if (i == 0 && !store.claim(cell(0).key)) throw std::runtime_error("not pending");
      store.finish(cell(i).key, outcome(i), metrics(i));
      pipe.tell(i);
    }
    ::pause();
  });
  pipe.close_writing();
  std::set<std::size_t> told;
  std::size_t number = 0;
  while (told.size() < acknowledged && pipe.hear(number)) told.insert(number);
  ::usleep(more_us);
  ::kill(writer, SIGKILL);
  EXPECT_TRUE(WIFSIGNALED(status_of(writer)));
  while (pipe.hear(number)) told.insert(number);

  Store store = Store::open(folder.path(), Store::Access::read_write);
  EXPECT_EQ(store.query("select count(*) from all_cells").rows.at(0).at(0), std::to_string(kCells));
  const std::vector<CellResult> results = store.results({});
  std::set<std::string> finished;
  for (const CellResult& result : results) {
    finished.insert(result.cell.key);
    EXPECT_THAT(result.metrics, SizeIs(4)) << "an outcome comes with all its metrics";
  }
  for (const std::size_t i : told) EXPECT_TRUE(finished.contains(cell(i).key)) << "acknowledged cell " << i;
  EXPECT_LE(finished.size(), told.size() + 1) << "and at most the one that was not acknowledged yet";
  const StoreStart start = store.start(false);
  EXPECT_EQ(start.done, finished.size());
  EXPECT_EQ(start.pending, kCells - finished.size());
  EXPECT_GE(start.released, 1u) << "the cells that were claimed";
  EXPECT_LE(start.released, 2u);
  EXPECT_EQ(start.running_elsewhere, 0u);
  for (const auto& entry : fs::directory_iterator(folder / "work"))
    EXPECT_EQ(entry.path().stem(), store.work_folder().filename()) << "of the dead one nothing stays";
  for (std::size_t i = 0; i < kCells; ++i)
    if (!finished.contains(cell(i).key)) run(store, i);
  EXPECT_THAT(store.pending(), IsEmpty());
}

TEST(StoreProcesses, AKilledWriterLosesNoneOfTheCellsThatItHadFinished) {
  // Moments spread over finish(): the delay walks through the fraction of a millisecond that it takes.
  for (std::size_t round = 0; round < 12; ++round)
    kill_writer_after(1 + 17 * round, static_cast<useconds_t>(97 * round));
}

TEST(StoreProcesses, ClaimsOfALivingWriterStay) {
  const TemporaryFolder folder;
  { const Store made = Store::create(folder.path(), kIdentity, "", cells(3)); }
  Pipe claimed, done;
  const pid_t other = in_child([&] {
    Store store = Store::open(folder.path(), Store::Access::read_write);
    store.start(false);
    if (!store.claim(cell(1).key)) throw std::runtime_error("not pending");
    core::write_file(store.work_folder() / "half", "made");
    claimed.tell(1);
    std::size_t number = 0;
    done.hear(number);
    store.finish(cell(1).key, outcome(1), {});
  });
  std::size_t number = 0;
  ASSERT_TRUE(claimed.hear(number));
  Store store = Store::open(folder.path(), Store::Access::read_write);
  const StoreStart start = store.start(false);
  EXPECT_EQ(start.running_elsewhere, 1u);
  EXPECT_EQ(start.released, 0u);
  EXPECT_FALSE(store.claim(cell(1).key));
  EXPECT_THAT(store.unfinished(ResultFilter{}).at(1).outcome.status, testing::Eq("running"));
  std::size_t halves = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "work"))
    halves += entry.path().filename() == "half" ? 1 : 0;
  EXPECT_EQ(halves, 1u) << "files of a living writer stay";
  done.tell(1);
  EXPECT_EQ(status_of(other), 0);
  EXPECT_EQ(store.pending(), (std::vector<std::string>{cell(0).key, cell(2).key}));
}

TEST(StoreProcesses, AWriterThatEndsNormallyGivesBackWhatItHadClaimed) {
  const TemporaryFolder folder;
  {
    Store store = Store::create(folder.path(), kIdentity, "", cells(2));
    store.start(false);
    ASSERT_TRUE(store.claim(cell(0).key));
  }
  Store store = Store::open(folder.path(), Store::Access::read_write);
  EXPECT_THAT(store.pending(), SizeIs(2));
  EXPECT_EQ(store.start(false).released, 0u);
  EXPECT_EQ(store.query("select ended from runs order by id").rows.at(0).at(0), "finished");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "work"), fs::directory_iterator()), 2);
}

TEST(StoreProcesses, AForkedChildThatEndsDoesNotEndItsParentsRun) {
  const TemporaryFolder folder;
  Store store = Store::create(folder.path(), kIdentity, "", cells(2));
  store.start(false);
  ASSERT_TRUE(store.claim(cell(0).key));
  const pid_t child = in_child([&] { const Store gone = std::move(store); });
  EXPECT_EQ(status_of(child), 0);
  EXPECT_TRUE(fs::exists(store.work_folder()));
  store.finish(cell(0).key, outcome(0), {});
}

TEST(StoreProcesses, OfTwoThatMakeAStoreOneSucceeds) {
  const TemporaryFolder folder;
  std::vector<pid_t> children;
  for (int i = 0; i < 4; ++i) {
    children.push_back(in_child([&] {
      try {
        const Store made = Store::create(folder.path(), kIdentity, "", cells(50));
      } catch (const core::InputError&) {
        ::_exit(2);
      }
    }));
  }
  int made = 0;
  for (const pid_t child : children) {
    const int status = status_of(child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_NE(WEXITSTATUS(status), 1);
    made += WEXITSTATUS(status) == 0 ? 1 : 0;
  }
  EXPECT_EQ(made, 1);
  EXPECT_THAT(Store::open(folder.path(), Store::Access::read_only).pending(), SizeIs(50));
}

TEST(StoreProcesses, AKilledMakerLeavesNoStore) {
  for (int round = 0; round < 6; ++round) {
    const TemporaryFolder folder;
    const pid_t maker = in_child([&] { const Store made = Store::create(folder.path(), kIdentity, "", cells(3000)); });
    ::usleep(static_cast<useconds_t>(3000 * round));
    ::kill(maker, SIGKILL);
    status_of(maker);
    if (fs::exists(folder / "store.sqlite")) {
      EXPECT_THAT(Store::open(folder.path(), Store::Access::read_only).pending(), SizeIs(3000));
      continue;
    }
    Store store = Store::create(folder.path(), kIdentity, "", cells(3000));
    store.start(false);
    EXPECT_THAT(store.pending(), SizeIs(3000));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "work"), fs::directory_iterator()), 2);
  }
}

}  // namespace
}  // namespace tarmac::scenarios
