#include "tools/tarmac/foreign.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace tarmac::tools {
namespace {

using core::time_from_s;
using testing::HasSubstr;

/// Ten empty sweeps of 0.1 s from a LiDAR 2 m above and 1 m ahead of the body.
core::Recording ten_sweeps(const std::filesystem::path& folder) {
  core::Rig rig;
  rig.lidars.resize(1);
  rig.lidars[0].model = "test";
  rig.lidars[0].T_body_lidar.translation() = Eigen::Vector3d(1, 0, 2);
  core::RecordingWriter writer(folder, rig);
  for (int i = 0; i < 10; ++i) {
    core::LidarSweep sweep;
    sweep.index = i;
    sweep.begin = time_from_s(0.1 * i);
    sweep.end = time_from_s(0.1 * i + 0.0999);
    sweep.push_back({5, 0, 0}, 0, 0, 1);
    writer.write(sweep);
  }
  writer.finish();
  return core::Recording::open(folder);
}

std::vector<io::StampedPose> straight_drive() {
  std::vector<io::StampedPose> poses;
  for (int i = 0; i <= 8; ++i) {
    core::SE3 T = core::SE3::Identity();
    T.linear() = core::so3::exp({0, 0, 0.1 * i});
    T.translation() = Eigen::Vector3d(0.5 * i, 0, 0);
    poses.push_back({time_from_s(0.1 * i + 0.05), T});
  }
  return poses;
}

TEST(ForeignPoses, OfTheLidarBecomePosesOfTheBody) {
  const PrivateFolder folder;
  const core::Recording recording = ten_sweeps(folder.path() / "recording");
  ForeignTool tool;
  const core::Estimate lidar = estimate_from_poses("mine", tool, straight_drive(), recording);
  tool.frame = "body";
  const core::Estimate body = estimate_from_poses("mine", tool, straight_drive(), recording);
  const core::SE3 T_body_lidar = recording.rig().lidars[0].T_body_lidar;
  for (const double t_s : {0.05, 0.11, 0.4, 0.85}) {
    const core::SE3 difference =
        (lidar.causal.pose(time_from_s(t_s)) * T_body_lidar).inverse() * body.causal.pose(time_from_s(t_s));
    EXPECT_LT((difference.matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-12);
  }
}

TEST(ForeignPoses, CoverOnlyTheSweepsWhoseEndTheySpan) {
  const PrivateFolder folder;
  const core::Recording recording = ten_sweeps(folder.path() / "recording");
  const core::Estimate estimate = estimate_from_poses("mine", {}, straight_drive(), recording);
  ASSERT_EQ(estimate.sweeps.size(), 10u);
  EXPECT_EQ(estimate.sweeps[0].status, core::SweepStatus::ok);
  EXPECT_EQ(estimate.sweeps[7].status, core::SweepStatus::ok);
  EXPECT_EQ(estimate.sweeps[8].status, core::SweepStatus::lost);  // ends at 0.8999 s, the last pose is at 0.85 s
  EXPECT_EQ(estimate.sweeps[9].status, core::SweepStatus::lost);
}

TEST(ForeignPoses, InterpolateAsTheBlockSays) {
  const PrivateFolder folder;
  const core::Recording recording = ten_sweeps(folder.path() / "recording");
  ForeignTool tool;
  tool.frame = "body";
  tool.interpolation = "hold";
  EXPECT_EQ(
      estimate_from_poses("mine", tool, straight_drive(), recording).causal.pose(time_from_s(0.149)).translation().x(),
      0);
  tool.interpolation = "slerp";
  EXPECT_NEAR(
      estimate_from_poses("mine", tool, straight_drive(), recording).causal.pose(time_from_s(0.1)).translation().x(),
      0.25, 1e-12);
}

TEST(ForeignCommand, FillsInItsPlacesAndKeepsScriptsReachable) {
  const PrivateFolder folder;
  ForeignTool tool;
  tool.command = {"prog", "--in={input}", "{output}", "-x"};
  const ChildRequest request = foreign_command(tool, folder.path());
  EXPECT_THAT(request.command, testing::ElementsAre("prog", "--in=" + (folder.path() / "input").string(),
                                                    (folder.path() / "output" / "foreign.tum").string(), "-x"));
}

TEST(EstimatorRequests, AreCheckedBeforeAnythingRuns) {
  const auto blocks = [](const char* text) {
    return std::vector<core::ConfigNode>{core::ConfigNode::parse(text, "conf.yaml")};
  };
  const auto error_of = [](const std::string& list, const std::vector<core::ConfigNode>& nodes) -> std::string {
    try {
      request_estimators(list, nodes);
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(error_of("kis-icp", {}), HasSubstr("did you mean 'kiss-icp'"));
  EXPECT_THAT(error_of("kiss-icp", blocks("kiss-icp: {voxel_sise_m: 1}")), HasSubstr("voxel_size_m"));
  EXPECT_THAT(error_of("mine", blocks("mine: {command: []}")), HasSubstr("command"));
  EXPECT_THAT(error_of("mine", blocks("mine: {command: [a], frame: sensor}")), HasSubstr("lidar, body"));
  EXPECT_THAT(error_of("all", blocks("kis-icp: {}")), HasSubstr("kiss-icp"));
  EXPECT_THAT(error_of("kiss-icp", blocks("kiss-icp: {command: [a]}")), HasSubstr("another name"));
  const auto requests = request_estimators("all", blocks("mine: {command: [a, '{input}']}"));
  EXPECT_EQ(requests.back().name, "mine");
  EXPECT_GE(requests.size(), 4u);
}

}  // namespace
}  // namespace tarmac::tools
