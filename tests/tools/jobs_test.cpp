// The scenario with everything on: its recording depends on scenario, seed and build, never on the number of threads.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <thread>

#include "core/files.h"
#include "sim/truth/ground_truth.h"
#include "tools/tarmac/child.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;
using sim::truth::ReturnKind;

class EverythingOn : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new PrivateFolder;
    for (const int jobs : {1, 2}) simulate(jobs);
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static void simulate(int jobs) {
    ChildRequest request;
    request.command = {(program_folder() / "tarmac").string(),
                       "simulate",
                       "everything-on",
                       "-o",
                       run(jobs).string(),
                       "--jobs",
                       std::to_string(jobs),
                       "--set",
                       "duration_s=3"};
    request.working_folder = folder_->path();
    request.log_file = folder_->path() / "log.txt";
    request.limits.wall_s = 300;
    ASSERT_TRUE(run_child(request).ok()) << core::read_file(request.log_file);
  }
  static fs::path run(int jobs) { return folder_->path() / fmt::format("jobs-{}", jobs); }
  static std::map<std::string, std::string> bytes_of(int jobs) {
    std::map<std::string, std::string> files;
    for (const char* part : {"recording", "truth"})
      for (const auto& entry : fs::directory_iterator(run(jobs) / part))
        files[fmt::format("{}/{}", part, entry.path().filename().string())] = core::read_file(entry.path());
    return files;
  }
  static PrivateFolder* folder_;
};
PrivateFolder* EverythingOn::folder_ = nullptr;

TEST_F(EverythingOn, GivesTheSameBytesForOneJobAndTwo) {
  const std::map<std::string, std::string> one = bytes_of(1);
  ASSERT_GE(one.size(), 14u);
  const std::map<std::string, std::string> two = bytes_of(2);
  ASSERT_EQ(two.size(), one.size());
  for (const auto& [name, bytes] : one) EXPECT_TRUE(two.at(name) == bytes) << name;
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "one core: two jobs were one thread";
}

/// Otherwise the comparison above would say little.
TEST_F(EverythingOn, HasEveryKindOfReturnAndThingsThatMove) {
  const sim::truth::GroundTruth truth = sim::truth::load_ground_truth(run(2) / "truth");
  EXPECT_EQ(truth.rig.lidars.size(), 3u);
  EXPECT_GE(truth.faults.size(), 8u);
  std::map<ReturnKind, std::size_t> kinds;
  std::size_t moving = 0;
  for (std::size_t lidar = 0; lidar < truth.rig.lidars.size(); ++lidar)
    for (const sim::truth::PointLabels& labels : truth.labels(lidar, sim::truth::Columns::labels_and_point_truth)) {
      EXPECT_TRUE(labels.has_point_truth());
      for (std::size_t i = 0; i < labels.label.size(); ++i) {
        ++kinds[labels.kind_of(i)];
        moving += labels.moving[i];
      }
    }
  for (const ReturnKind kind :
       {ReturnKind::surface, ReturnKind::mixed, ReturnKind::edge, ReturnKind::dirt, ReturnKind::transmitted,
        ReturnKind::ghost, ReturnKind::retro_halo, ReturnKind::self, ReturnKind::saturated, ReturnKind::noise})
    EXPECT_GT(kinds[kind], 0u) << name_of(kind);
  EXPECT_GT(moving, 1000u);
}

}  // namespace
}  // namespace tarmac::tools
