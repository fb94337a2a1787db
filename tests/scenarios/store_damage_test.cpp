// Stores that are damaged, of another version, or on a full disk.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "scenarios/store_schema.h"
#include "tests/scenarios/store_cells.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::scenarios {
namespace {

using tarmac::tests::message_of;
using tarmac::tests::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;
using testing::SizeIs;
using namespace scenarios::tests;
namespace fs = std::filesystem;

std::string open_error(const fs::path& folder, Store::Access access = Store::Access::read_only) {
  return message_of<core::InputError>([&] {
    const Store store = Store::open(folder, access);
    store.results({});
    store.pending();
  });
}

/// A store with a few finished cells, closed.
void make(const fs::path& folder, std::size_t n = 40) {
  Store store = Store::create(folder, kIdentity, "", cells(n));
  store.start(false);
  for (std::size_t i = 0; i + 1 < n; ++i) run(store, i);
}

void change(const fs::path& folder, const std::string& sql) {
  Database db(folder / "store.sqlite", Database::Mode::read_write);
  db.execute(sql);
}

TEST(StoreDamage, WhatIsNoStoreIsSaidSo) {
  const TemporaryFolder folder;
  EXPECT_THAT(open_error(folder / "nowhere"), AllOf(HasSubstr("nowhere"), HasSubstr("no store.sqlite")));
  core::write_file(folder / "store.sqlite", std::string(5000, 'x'));
  for (const auto access : {Store::Access::read_only, Store::Access::read_write})
    EXPECT_THAT(open_error(folder.path(), access), AllOf(HasSubstr("store.sqlite"), HasSubstr("no SQLite file")));
  core::write_file(folder / "store.sqlite", "");
  EXPECT_THAT(open_error(folder.path()), HasSubstr("no store of a sweep"));
  fs::remove(folder / "store.sqlite");
  {
    Database other(folder / "store.sqlite", Database::Mode::create);
    other.execute("create table cells(a); insert into cells values(1)");
  }
  EXPECT_THAT(open_error(folder.path()), HasSubstr("no store of a sweep"));
}

TEST(StoreDamage, ACutFileIsRefusedWhereverItIsCut) {
  const TemporaryFolder folder;
  make(folder / "whole");
  const std::string whole = core::read_file(folder / "whole" / "store.sqlite");
  ASSERT_FALSE(fs::exists(folder / "whole" / "store.sqlite-wal")) << "a closed store is one file";
  for (int tenth = 1; tenth < 10; ++tenth) {
    const fs::path cut = folder / ("cut" + std::to_string(tenth));
    fs::create_directories(cut);
    core::write_file(cut / "store.sqlite", whole.substr(0, whole.size() * static_cast<std::size_t>(tenth) / 10));
    EXPECT_THAT(open_error(cut), AllOf(HasSubstr(cut.string()), HasSubstr("damaged"))) << tenth;
    EXPECT_THAT(open_error(cut, Store::Access::read_write), HasSubstr("damaged")) << tenth;
  }
}

TEST(StoreDamage, MissingTablesAndViewsAreNamed) {
  for (const std::string what : {"table claims", "table metric_values", "view results", "view deterministic"}) {
    const TemporaryFolder folder;
    make(folder.path(), 2);
    change(folder.path(), "drop " + what);
    EXPECT_THAT(open_error(folder.path()), HasSubstr("'" + what.substr(what.find(' ') + 1) + "'"));
  }
  const TemporaryFolder folder;
  make(folder.path(), 2);
  change(folder.path(), "delete from meta where name = 'build'");
  EXPECT_THAT(open_error(folder.path()), HasSubstr("does not say its build"));
}

TEST(StoreDamage, CreateRefusesAFolderThatHasAStore) {
  const TemporaryFolder folder;
  make(folder.path(), 2);
  const std::string before = dump(Store::open(folder.path(), Store::Access::read_only));
  EXPECT_THAT(message_of<core::InputError>([&] { Store::create(folder.path(), kIdentity, "", cells(3)); }),
              AllOf(HasSubstr("already"), HasSubstr("--resume")));
  EXPECT_EQ(dump(Store::open(folder.path(), Store::Access::read_only)), before);
}

TEST(StoreVersion, ANewerOneIsRefused) {
  const TemporaryFolder folder;
  make(folder.path(), 2);
  change(folder.path(), fmt::format("pragma user_version = {}", kStoreSchema + 1));
  for (const auto access : {Store::Access::read_only, Store::Access::read_write})
    EXPECT_THAT(open_error(folder.path(), access),
                AllOf(HasSubstr(fmt::format("schema {}", kStoreSchema + 1)), HasSubstr("newer program")));
}

/// Two versions that are still to come: the machinery is proved on them, the product has one version so far.
constexpr Migration kNext[] = {{kStoreSchema, "alter table outcomes add column machine text not null default ''"},
                               {kStoreSchema + 1,
                                "create table notes(cell integer primary key, note text not null);"
                                "insert into notes select cell, status from outcomes where status <> 'ok'"}};
constexpr Migration kBroken[] = {{kStoreSchema, "create table notes(a); insert into no_such_table values(1)"}};

std::int64_t version(const fs::path& file) {
  Database db(file, Database::Mode::read_only);
  return db.integer("pragma user_version");
}

TEST(StoreVersion, AnOlderOneIsMigratedStepByStepAndKept) {
  const TemporaryFolder folder;
  {
    Store store = Store::create(folder.path(), kIdentity, "", cells(4));
    store.start(false);
    run(store, 0);
    run(store, 1, "crashed");
  }
  const std::string before = dump(Store::open(folder.path(), Store::Access::read_only));
  const Schema next{kStoreSchema + 2, kNext};
  EXPECT_THAT(message_of<core::InputError>([&] { open_database(folder.path(), Store::Access::read_only, next); }),
              AllOf(HasSubstr("older schema"), HasSubstr("tarmac sweep"), HasSubstr("--resume")));
  EXPECT_EQ(version(folder / "store.sqlite"), kStoreSchema) << "reading changes nothing";
  {
    const auto db = open_database(folder.path(), Store::Access::read_write, next);
    EXPECT_EQ(db->integer("select count(*) from outcomes where machine = ''"), 2);
    EXPECT_EQ(db->integer("select count(*) from notes where note = 'crashed'"), 1);
  }
  EXPECT_EQ(version(folder / "store.sqlite"), kStoreSchema + 2);
  EXPECT_NO_THROW(open_database(folder.path(), Store::Access::read_only, next)) << "now it may be read";

  const fs::path kept = folder / fmt::format("store.sqlite.v{}", kStoreSchema);
  ASSERT_TRUE(fs::exists(kept));
  fs::create_directories(folder / "old");
  fs::rename(kept, folder / "old/store.sqlite");
  EXPECT_EQ(dump(Store::open(folder / "old", Store::Access::read_only)), before) << "the file before is whole";
}

TEST(StoreVersion, AStepThatFailsChangesNothing) {
  const TemporaryFolder folder;
  make(folder.path(), 3);
  const std::string before = dump(Store::open(folder.path(), Store::Access::read_only));
  EXPECT_THROW(open_database(folder.path(), Store::Access::read_write, {kStoreSchema + 1, kBroken}), std::logic_error);
  EXPECT_EQ(version(folder / "store.sqlite"), kStoreSchema);
  EXPECT_EQ(dump(Store::open(folder.path(), Store::Access::read_write)), before);
  Database db(folder / "store.sqlite", Database::Mode::read_only);
  EXPECT_EQ(db.integer("select count(*) from sqlite_schema where name = 'notes'"), 0);
}

/// Runs in a process of its own, in which no file may grow beyond a limit: writes fail there as on a full disk.
int exit_code_of_child(const std::function<void()>& work) {
  const pid_t pid = ::fork();
  if (pid == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    try {
      work();
      ::_exit(0);
    } catch (const std::exception& error) {
      fmt::print(stderr, "child: {}\n", error.what());
      ::_exit(1);
    }
  }
  int status = 0;
  ::waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void limit_files(rlim_t bytes) {
  rlimit limit{};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = bytes;
  if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) throw std::runtime_error("setrlimit");
}

TEST(StoreFullDisk, LosesTheTransactionAloneAndIsUsableOnceThereIsRoom) {
  const TemporaryFolder folder;
  constexpr std::size_t kCells = 300;
  { const Store made = Store::create(folder.path(), kIdentity, "", cells(kCells)); }
  const int code = exit_code_of_child([&] {
    Store store = Store::open(folder.path(), Store::Access::read_write);
    store.start(false);
    std::size_t finished = 0, failures = 0;
    limit_files(2'000'000);
    for (std::size_t i = 0; i < kCells; ++i) {
      for (;;) {
        try {
          if (!store.claim(cell(i).key)) {
            // It was this process's before the finish() that failed.
          }
          store.finish(cell(i).key, outcome(i), metrics(i));
          ++finished;
          break;
        } catch (const StoreFull& full) {
          const std::string text = full.what();
          if (text.find("store.sqlite") == std::string::npos || text.find("free some space") == std::string::npos)
            throw std::runtime_error("what to do is missing: " + text);
          if (store.results({}).size() != finished) throw std::runtime_error("finished cells were lost");
          ++failures;
          limit_files(RLIM_INFINITY);
        }
      }
    }
    if (failures != 1) throw std::runtime_error(fmt::format("{} writes failed, expected 1", failures));
  });
  EXPECT_EQ(code, 0);
  Store store = Store::open(folder.path(), Store::Access::read_only);
  Store one = Store::create(folder / "alone", kIdentity, "", cells(kCells));
  one.start(false);
  for (std::size_t i = 0; i < kCells; ++i) run(one, i);
  EXPECT_EQ(dump(store), dump(one));
}

TEST(StoreFullDisk, AStoreThatDoesNotFitIsNotMade) {
  const TemporaryFolder folder;
  const int code = exit_code_of_child([&] {
    limit_files(100'000);
    try {
      const Store made = Store::create(folder.path(), kIdentity, "", cells(3000));
    } catch (const StoreFull&) {
      return;
    }
    throw std::runtime_error("it was made");
  });
  EXPECT_EQ(code, 0);
  EXPECT_FALSE(fs::exists(folder / "store.sqlite"));
  EXPECT_THAT(Store::create(folder.path(), kIdentity, "", cells(3000)).pending(), SizeIs(3000));
}

}  // namespace
}  // namespace tarmac::scenarios
