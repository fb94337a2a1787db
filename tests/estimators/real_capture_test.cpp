/// The methods on a capture of a real sensor. Needs the data folder that TARMAC_DATA names.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "estimators/registry.h"
#include "estimators/run.h"
#include "io/sensor/plain.h"
#include "tests/estimators/recordings.h"

namespace tarmac::estimators {
namespace {

class RealCapture : public testing::Test {
 protected:
  void SetUp() override {
    const char* data = std::getenv("TARMAC_DATA");
    const std::filesystem::path plain = std::filesystem::path(data ? data : "") / "ouster" / "plain";
    if (!data || !std::filesystem::exists(plain)) {
      std::fprintf(stderr,
                   "SKIPPED: TARMAC_DATA does not name a folder with ouster/plain: nothing is tested on real data\n");
      GTEST_SKIP() << "TARMAC_DATA does not name a folder with ouster/plain";
    }
    io::import_plain(plain, folder_ / "recording", {});
  }
  RunResult run(const char* name) {
    const core::Recording recording = core::Recording::open(folder_ / "recording");
    return run_estimator(recording, *find_estimator(name), {}, {.rig = recording.rig()}, {});
  }
  tests::Folder folder_;
};

/// The vehicle drove ahead (+x of the sensor) at some 2.5 m/s, and the sweeps are 0.1 s long.
TEST_F(RealCapture, EveryStepIsForwardByAQuarterOfAMetreOrSo) {
  for (const char* name : {"kiss-icp", "rigid-icp"}) {
    const RunResult result = run(name);
    ASSERT_EQ(result.estimate.sweeps.size(), 3U) << name;
    for (std::size_t k = 1; k < 3; ++k) {
      const core::SE3 step = result.estimate.sweeps[k - 1].T_map_body.inverse() * result.estimate.sweeps[k].T_map_body;
      EXPECT_EQ(result.estimate.sweeps[k].status, core::SweepStatus::ok);
      EXPECT_GT(step.translation().x(), 0.15) << name << ", step " << k;
      EXPECT_LT(step.translation().norm(), 0.40) << name << ", step " << k;
      EXPECT_LT(std::abs(step.translation().y()) + std::abs(step.translation().z()), 0.05) << name << ", step " << k;
      EXPECT_LT(core::so3::angle_rad(step.linear()), 0.01) << name << ", step " << k;
    }
  }
}

TEST_F(RealCapture, WithoutCalibrationDeadReckoningIsNotInitialised) {
  const RunResult result = run("dead-reckoning");
  EXPECT_EQ(result.estimate.status, core::RunStatus::not_initialised);
  EXPECT_THAT(result.estimate.message, testing::HasSubstr("no calibration"));
}

}  // namespace
}  // namespace tarmac::estimators
