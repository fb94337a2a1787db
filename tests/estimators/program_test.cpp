/// tarmac-estimate as its parent sees it: files, lines and exit codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>

#include "core/diagnostics.h"
#include "core/estimate.h"
#include "core/files.h"
#include "io/sensor/tum.h"
#include "tests/estimators/recordings.h"
#include "tests/support/numeric.h"

namespace tarmac {
namespace {

class EstimateProgram : public testing::Test {
 protected:
  EstimateProgram() {
    const core::Rig rig = tests::rig_with_imu();
    const tests::Motion motion = tests::constant_twist((core::Vector6() << 3, 0.3, -0.2, 0.02, -0.03, 0.17).finished());
    std::vector<core::LidarSweep> sweeps;
    for (int k = 0; k < 4; ++k) sweeps.push_back(tests::sweep_at(k, tests::landmarks(20, 4, 0.3), motion));
    tests::write_recording(folder_ / "recording", rig, sweeps);
  }
  /// @returns the exit code
  int run(const std::string& arguments) {
    const std::string command = std::string(TARMAC_ESTIMATE) + " " + arguments + " > " + (folder_ / "stdout").string() +
                                " 2> " + (folder_ / "stderr").string();
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string on_recording(const std::string& estimator, const std::string& output = "out") {
    return "--recording " + (folder_ / "recording").string() + " --estimator " + estimator + " --output " +
           (folder_ / output).string();
  }
  std::string said(const char* stream) { return core::read_file(folder_ / stream); }
  tests::Folder folder_;
};

TEST_F(EstimateProgram, LeavesTheWholeSetOfFiles) {
  ASSERT_EQ(run(on_recording("kiss-icp") + " --jobs 2 --diagnostics full"), 0) << said("stderr");
  const core::Estimate estimate = core::load_estimate(folder_ / "out/trajectory.bin");
  EXPECT_EQ(estimate.sweeps.size(), 4U);
  EXPECT_EQ(core::load_diagnostics(folder_ / "out/diagnostics.bin").size(), 4U);
  EXPECT_EQ(core::load_timing(folder_ / "out/timing.json").threads, 2);

  // Four sweeps of 100 ms that touch, every 10 ms: 4 x 10 steps and the end.
  const auto dense = io::read_tum(folder_ / "out/trajectory.tum");
  ASSERT_EQ(dense.size(), 41U);
  for (std::size_t k = 0; k + 1 < dense.size(); ++k) EXPECT_EQ((dense[k + 1].t - dense[k].t).count(), 10'000'000);
  for (const io::StampedPose& pose : dense) {
    EXPECT_LT(tests::pose_difference(pose.T, estimate.causal.pose(pose.t)), 1e-9);
  }
  const auto reference = io::read_tum(folder_ / "out/reference.tum");
  ASSERT_EQ(reference.size(), 4U);
  EXPECT_EQ(reference[3].t, estimate.sweeps[3].reference);
  EXPECT_LT(tests::pose_difference(reference[3].T, estimate.sweeps[3].T_map_body), 1e-9);

  EXPECT_THAT(said("stdout"), testing::HasSubstr("threads: 2"));
  EXPECT_THAT(said("stdout"), testing::HasSubstr("kiss-icp: ok, 4 of 4 sweeps ok"));
  EXPECT_THAT(said("stderr"), testing::HasSubstr("progress 1.0000 sweep 4 of 4"));
}

TEST_F(EstimateProgram, GivesTheSameBytesForOneJobAndTwo) {
  ASSERT_EQ(run(on_recording("kiss-icp", "one") + " --jobs 1"), 0);
  ASSERT_EQ(run(on_recording("kiss-icp", "two") + " --jobs 2"), 0);
  for (const char* file : {"trajectory.bin", "trajectory.tum", "reference.tum", "diagnostics.bin"}) {
    EXPECT_EQ(core::read_file(folder_ / "one" / file), core::read_file(folder_ / "two" / file)) << file;
  }
}

TEST_F(EstimateProgram, ReadsOptionsAndRefusesUnknownOnesWithTheirLine) {
  std::ofstream(folder_ / "good.yaml") << "voxel_size_m: 0.8\n";
  std::ofstream(folder_ / "bad.yaml") << "voxel_size_m: 0.8\nvoxelsize_m: 2\n";
  EXPECT_EQ(run(on_recording("kiss-icp") + " --options " + (folder_ / "good.yaml").string()), 0) << said("stderr");
  EXPECT_EQ(run(on_recording("kiss-icp") + " --options " + (folder_ / "bad.yaml").string()), 2);
  EXPECT_THAT(said("stderr"), testing::HasSubstr("bad.yaml:2"));
}

TEST_F(EstimateProgram, BadUsageAndBadInputExitWithTwoAndLeaveNothingThatLooksWhole) {
  ASSERT_EQ(run(on_recording("kiss-icp")), 0);
  EXPECT_EQ(run(on_recording("kis-icp")), 2);
  EXPECT_THAT(said("stderr"), testing::HasSubstr("did you mean kiss-icp?"));
  EXPECT_EQ(run("--recording"), 2);
  EXPECT_EQ(run(on_recording("kiss-icp") + " --diagnostics much"), 2);
  EXPECT_EQ(run(on_recording("kiss-icp") + " --jobs 0"), 2);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/trajectory.bin")) << "nothing was started";

  // A damaged recording: the earlier result may not pass for this one's.
  std::filesystem::resize_file(folder_ / "recording/lidar0.chunks",
                               std::filesystem::file_size(folder_ / "recording/lidar0.chunks") / 2);
  EXPECT_EQ(run(on_recording("kiss-icp")), 2);
  EXPECT_THAT(said("stderr"), testing::HasSubstr("lidar0.chunks"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/trajectory.bin"));
  std::filesystem::remove(folder_ / "recording/manifest.json");
  EXPECT_EQ(run(on_recording("kiss-icp")), 2);
}

TEST_F(EstimateProgram, NotInitialisedIsAnOutcomeAndNoError) {
  EXPECT_EQ(run(on_recording("dead-reckoning")), 0) << said("stderr");
  const core::Estimate estimate = core::load_estimate(folder_ / "out/trajectory.bin");
  EXPECT_EQ(estimate.status, core::RunStatus::not_initialised);
  EXPECT_THAT(said("stdout"), testing::HasSubstr("not_initialised"));
  EXPECT_THAT(said("stdout"), testing::HasSubstr("no sample"));
}

TEST_F(EstimateProgram, ProgressGoesWhereItIsAskedToAndAClosedPipeStopsNothing) {
  EXPECT_EQ(run(on_recording("kiss-icp") + " --progress-fd 3 3> " + (folder_ / "progress").string()), 0);
  EXPECT_THAT(core::read_file(folder_ / "progress"), testing::HasSubstr("progress 1.0000"));
  EXPECT_EQ(said("stderr"), "");
  EXPECT_EQ(run(on_recording("kiss-icp") + " --progress-fd 9"), 0);
}

}  // namespace
}  // namespace tarmac
