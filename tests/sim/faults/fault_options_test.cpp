#include "sim/faults/fault_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace tarmac::sim::faults {
namespace {

using core::ConfigNode;
using testing::AllOf;
using testing::HasSubstr;

std::string error_of(const std::string& yaml, bool has_imu = true, double sweep_rate_hz = 10) {
  try {
    read_faults(ConfigNode::parse(yaml, "drive.yaml").child("faults"), has_imu, {sweep_rate_hz});
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(FaultOptions, MistakesAreNamedWithFileLineFieldAndWhatIsAllowed) {
  EXPECT_THAT(error_of("faults:\n  lidar:\n    clock_ofset_ms: 5\n"),
              AllOf(HasSubstr("drive.yaml:3"), HasSubstr("did you mean 'clock_offset_ms'")));
  EXPECT_THAT(error_of("faults:\n  lidar: {stamp: middle}\n"),
              AllOf(HasSubstr("drive.yaml:2"), HasSubstr("faults.lidar.stamp"), HasSubstr("begin, mid, end")));
  EXPECT_THAT(error_of("faults: {lidar: {point_time_unit: s}}"), HasSubstr("ns, us, ms"));
  EXPECT_THAT(error_of("faults: {lidar: {lost_packets: 1.5}}"), HasSubstr("at most 1"));
  EXPECT_THAT(error_of("faults: {lidar: {point_time_scale: 0}}"), HasSubstr("above 0"));
  EXPECT_THAT(error_of("faults: {lidar: {float32_epoch_s: 1.7e9}}"), HasSubstr("at most 16000000"));
  EXPECT_THAT(error_of("faults: {lidar: 5}"), HasSubstr("must be a block"));
  EXPECT_THAT(error_of("faults: {lidr: {}}"), HasSubstr("did you mean 'lidar'"));
}

TEST(FaultOptions, IntervalsMustEndAfterTheyBegin) {
  EXPECT_THAT(error_of("faults:\n  imu:\n    gaps:\n      - {from_s: 5, to_s: 4}\n"),
              AllOf(HasSubstr("drive.yaml:4"), HasSubstr("faults.imu.gaps.0"), HasSubstr("above from_s")));
  EXPECT_THAT(error_of("faults: {lidar: {sweep_gaps: [{from_s: 1, to_s: 1}]}}"), HasSubstr("above from_s"));
  EXPECT_THAT(error_of("faults: {lidar: {lost_sectors: [{from_s: 3, to_s: 2}]}}"), HasSubstr("above from_s"));
  EXPECT_EQ(error_of("faults: {lidar: {lost_sectors: [{from_deg: 350, to_deg: 10, from_s: 3}]}}"), "no error");
}

TEST(FaultOptions, FaultsOfAnImuThatTheRigHasNotAreRefused) {
  EXPECT_THAT(error_of("faults:\n  imu: {jitter_ms: 1}\n", false),
              AllOf(HasSubstr("drive.yaml:2"), HasSubstr("no IMU")));
}

TEST(FaultOptions, ThoseWithoutEffectAreRefused) {
  EXPECT_THAT(error_of("faults:\n  lidar:\n    float32_epoch_s: 100\n"),
              AllOf(HasSubstr("drive.yaml:3"), HasSubstr("float32_epoch_s: has no effect here")));
  EXPECT_THAT(error_of("faults: {lidar: {packet_columns: 8}}"), HasSubstr("packet_columns: has no effect here"));
  EXPECT_THAT(error_of("faults: {lidar: {point_time_missing: true, point_time_reversed: true}}"),
              HasSubstr("point_time_missing: stands beside"));
  EXPECT_EQ(error_of("faults: {lidar: {packet_columns: 8, lost_packets: 0.1}}"), "no error");
  EXPECT_EQ(error_of("faults: {lidar: {float32_epoch_s: 100, point_time_float32: true}}"), "no error");
}

TEST(FaultOptions, PointTimesMustFitTheRecording) {
  EXPECT_EQ(error_of("faults: {lidar: {point_time_scale: 10}}"), "no error");
  EXPECT_THAT(error_of("faults:\n  lidar: {point_time_scale: 50}\n"),
              AllOf(HasSubstr("drive.yaml:2"), HasSubstr("point_time_scale"), HasSubstr("at most 10.7")));
  EXPECT_EQ(error_of("faults: {lidar: {point_time_scale: 50, point_time_unit: us}}"), "no error");
}

TEST(FaultOptions, MistakesOfTheCommandLineAreReportedAsSuch) {
  ConfigNode node = ConfigNode::parse("name: drive\n", "drive.yaml");
  node.set("faults.lidar.clock_offset_ms", "five");
  try {
    read_faults(node.child("faults"), true, {10.0});
    FAIL();
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("--set faults.lidar.clock_offset_ms"), HasSubstr("finite number")));
  }
}

TEST(FaultOptions, ASectorOfAllAzimuthsHoldsAllAndOneAcrossZeroWraps) {
  const Sector all{.from_deg = 0, .to_deg = 360, .when = {}}, across{.from_deg = 350, .to_deg = 10, .when = {}};
  for (const double azimuth : {0.0, 9.99, 10.0, 180.0, 349.9, 350.0, 359.99}) {
    EXPECT_TRUE(all.holds(azimuth)) << azimuth;
    EXPECT_EQ(across.holds(azimuth), azimuth < 10 || azimuth >= 350) << azimuth;
  }
}

}  // namespace
}  // namespace tarmac::sim::faults
