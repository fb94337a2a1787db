#include "tools/tarmac/provenance.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/error.h"
#include "tools/tarmac/child.h"
#include "tools/tarmac/layout.h"
#include "tools/tarmac/outcome.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;

TEST(Provenance, ComesBackAsItWasWritten) {
  const PrivateFolder folder;
  Provenance p;
  p.scenario = "drive \"one\"";
  p.seed = 18446744073709551615u;
  p.recording_hash = "00ff";
  p.command = "tarmac run x";
  p.isa = "avx2";
  p.options = "kiss-icp:\n  a: 1\n";
  save_provenance(folder.path() / "provenance.json", p);
  const Provenance back = load_provenance(folder.path() / "provenance.json");
  EXPECT_EQ(back.scenario, p.scenario);
  EXPECT_EQ(back.seed, p.seed);
  EXPECT_EQ(back.recording_hash, p.recording_hash);
  EXPECT_EQ(back.options, p.options);
  EXPECT_EQ(back.isa, p.isa);
}

TEST(Provenance, HalfOfAFileIsRefused) {
  const PrivateFolder folder;
  std::ofstream(folder.path() / "provenance.json") << "{\"scenario\": \"dri";
  EXPECT_THROW(load_provenance(folder.path() / "provenance.json"), core::DamagedFile);
}

TEST(ShellCommand, QuotesWhatAShellWouldTouch) {
  EXPECT_EQ(shell_command({"tarmac", "run", "a b", "x=$y", "it's"}), "tarmac run 'a b' 'x=$y' 'it'\\''s'");
}

TEST(RunFolders, AreTheFolderItselfOrItsSeedsInOrder) {
  const PrivateFolder folder;
  EXPECT_THROW(runs_below(folder.path()), core::InputError);
  for (const char* seed : {"seed-10", "seed-2", "seed-x"}) {
    fs::create_directory(folder.path() / seed);
    std::ofstream(folder.path() / seed / "provenance.json") << "{}";
  }
  const auto runs = runs_below(folder.path());
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].root.filename(), "seed-2");
  EXPECT_EQ(runs[1].root.filename(), "seed-10");
}

TEST(EstimatorFolders, WithoutAnOutcomeAreNotFinished) {
  const PrivateFolder folder;
  fs::create_directory(folder.path() / "half");
  fs::create_directory(folder.path() / "whole");
  save_outcome(folder.path() / "whole", {"whole", "crashed", "signal 11", 1, 2, 3, 1, "00ff"});
  const auto folders = estimator_folders(RunFolder{folder.path()});
  ASSERT_EQ(folders.size(), 1u);
  EXPECT_EQ(load_outcome(folders[0]).status, "crashed");
  EXPECT_TRUE(load_outcome(folders[0]).failed());
}

TEST(LatestLink, PointsAtTheNewestAndSparesWhatIsNoLink) {
  const PrivateFolder folder;
  fs::create_directory(folder.path() / "a");
  fs::create_directory(folder.path() / "b");
  link_latest(folder.path() / "a");
  link_latest(folder.path() / "b");
  EXPECT_EQ(fs::read_symlink(folder.path() / "latest"), "b");
  fs::remove(folder.path() / "latest");
  fs::create_directory(folder.path() / "latest");
  link_latest(folder.path() / "a");
  EXPECT_FALSE(fs::is_symlink(folder.path() / "latest"));
}

}  // namespace
}  // namespace tarmac::tools
