/// What becomes of bad data, whatever the method.
#include "estimators/run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "estimators/registry.h"
#include "tests/estimators/recordings.h"

namespace tarmac::estimators {
namespace {

using core::RunStatus;
using core::SweepStatus;

class RunEstimator : public testing::Test {
 protected:
  RunEstimator() {
    for (int k = 0; k < 6; ++k) sweeps_.push_back(tests::sweep_at(k, world_, motion_, {.flash = k < 2}));
  }
  RunResult run(const char* name = "kiss-icp", const core::Progress& progress = {}) {
    return run(*find_estimator(name), progress);
  }
  RunResult run(const EstimatorEntry& entry, const core::Progress& progress = {}) {
    const core::Recording recording = tests::write_recording(folder_ / "recording", rig_, sweeps_, imu_);
    return run_estimator(recording, entry, {}, {.rig = recording.rig()}, progress);
  }
  static SweepStatus status(const RunResult& result, std::size_t k) { return result.estimate.sweeps.at(k).status; }

  tests::Folder folder_;
  core::Rig rig_ = tests::rig_with_imu();
  std::vector<Eigen::Vector3d> world_ = tests::landmarks(20, 4, 0.3);
  tests::Motion motion_ = tests::constant_twist((core::Vector6() << 3, 0.3, -0.2, 0.02, -0.03, 0.17).finished());
  std::vector<core::LidarSweep> sweeps_;
  std::vector<core::ImuSample> imu_;
};

TEST_F(RunEstimator, KeepsOneResultAndOneTimingASweepAndReportsProgress) {
  double last = 0;
  const RunResult result = run("kiss-icp", [&](double fraction, const std::string& note) {
    EXPECT_GT(fraction, last);
    EXPECT_FALSE(note.empty());
    last = fraction;
  });
  EXPECT_EQ(last, 1.0);
  EXPECT_EQ(result.estimate.estimator, "kiss-icp");
  EXPECT_EQ(result.estimate.status, RunStatus::ok);
  ASSERT_EQ(result.estimate.sweeps.size(), 6U);
  EXPECT_EQ(result.diagnostics.size(), 6U);
  ASSERT_EQ(result.timing.sweeps.size(), 6U);
  EXPECT_GT(result.timing.sweeps[5].wall_ms, 0);
  EXPECT_GT(result.timing.sweeps[5].cpu_ms, 0);
  EXPECT_GE(result.timing.sweeps[5].stages_ms.size(), 4U);
  EXPECT_GT(result.timing.wall_s, 0);
  EXPECT_GT(result.timing.peak_memory_mb, 1);
  EXPECT_EQ(result.estimate.causal.segments().size(), 6U);
  EXPECT_TRUE(result.log.empty());
}

TEST_F(RunEstimator, DropsPointsThatAreNotFiniteAndCountsThem) {
  const RunResult clean = run();
  // Bad points added to the clean sweeps change nothing but the log.
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    sweeps_[3].push_back({bad, 1, 1}, 50'000'000, 0, 0);
    sweeps_[3].push_back({1, 1, bad}, 50'000'000, 0, 0);
  }
  const RunResult result = run();
  EXPECT_THAT(result.log, testing::ElementsAre("sweep 3: 4 points dropped, their coordinates are not finite"));
  EXPECT_EQ(result.estimate.sweeps[5].T_map_body.matrix(), clean.estimate.sweeps[5].T_map_body.matrix());
}

TEST_F(RunEstimator, ASweepOfNothingButNanIsEmptyAndTheRunGoesOn) {
  for (float& x : sweeps_[3].x_m) x = std::numeric_limits<float>::quiet_NaN();
  const RunResult result = run();
  EXPECT_EQ(status(result, 3), SweepStatus::empty);
  EXPECT_EQ(status(result, 4), SweepStatus::ok);
  EXPECT_THAT(result.log, testing::Contains("sweep 3: no point left"));
}

TEST_F(RunEstimator, AnEmptySweepIsEmptyAndTheRunGoesOn) {
  sweeps_[0] = tests::empty_sweep(0, sweeps_[0].begin, sweeps_[0].end);
  sweeps_[4] = tests::empty_sweep(4, sweeps_[4].begin, sweeps_[4].end);
  const RunResult result = run();
  EXPECT_EQ(status(result, 0), SweepStatus::empty);
  EXPECT_EQ(status(result, 4), SweepStatus::empty);
  EXPECT_EQ(status(result, 5), SweepStatus::ok);
  EXPECT_EQ(result.estimate.status, RunStatus::ok);
}

TEST_F(RunEstimator, ASweepThatBeginsBeforeItsPredecessorEndedIsDropped) {
  sweeps_[3].begin -= core::Duration(1000);
  const RunResult result = run();
  ASSERT_EQ(result.estimate.sweeps.size(), 6U);
  EXPECT_EQ(status(result, 3), SweepStatus::out_of_order);
  EXPECT_EQ(status(result, 5), SweepStatus::ok);
  EXPECT_EQ(result.estimate.causal.segments().size(), 5U);
  EXPECT_THAT(result.log, testing::ElementsAre(testing::HasSubstr("sweep 3: dropped")));
}

TEST_F(RunEstimator, SwappedSweepsLoseTheLaterOne) {
  std::swap(sweeps_[2], sweeps_[3]);
  const RunResult result = run();
  EXPECT_EQ(result.estimate.sweeps[2].index, 3);
  EXPECT_EQ(status(result, 2), SweepStatus::ok);
  EXPECT_EQ(status(result, 3), SweepStatus::out_of_order);
}

TEST_F(RunEstimator, WithoutImuSamplesDeadReckoningIsNotInitialised) {
  const RunResult result = run("dead-reckoning");
  EXPECT_EQ(result.estimate.status, RunStatus::not_initialised);
  EXPECT_THAT(result.estimate.message, testing::HasSubstr("no sample"));
  rig_.imus.clear();
  EXPECT_THAT(run("dead-reckoning").estimate.message, testing::HasSubstr("needs an IMU"));
}

TEST_F(RunEstimator, WithoutSweepsNothingIsInitialised) {
  sweeps_.clear();
  imu_ = tests::imu_at_rest(rig_, 2);
  for (const EstimatorEntry* entry : estimators()) {
    const RunResult result = run(*entry);
    EXPECT_EQ(result.estimate.status, RunStatus::not_initialised) << entry->name;
    EXPECT_THAT(result.estimate.message, testing::HasSubstr("no LiDAR sweep"));
  }
}

TEST_F(RunEstimator, ImuSamplesThatRepeatGoBackOrAreNotFiniteAreDropped) {
  for (int k = 6; k < 36; ++k) {
    const core::Time begin = sweeps_.back().end;
    sweeps_.push_back(tests::empty_sweep(k, begin, begin + core::Duration(100'000'000)));
  }
  imu_ = tests::imu_at_rest(rig_, 3.6);
  const RunResult clean = run("dead-reckoning");
  std::vector<core::ImuSample> dirty;
  for (std::size_t k = 0; k < imu_.size(); ++k) {
    dirty.push_back(imu_[k]);
    if (k == 200) dirty.push_back(imu_[k]);
    if (k == 210) dirty.push_back(imu_[k - 3]);
    if (k == 220) {
      dirty.push_back(imu_[k]);
      dirty.back().t += core::Duration(5'000'000);
      dirty.back().gyro_rad_s.x() = std::numeric_limits<double>::quiet_NaN();
    }
  }
  imu_ = dirty;
  const RunResult result = run("dead-reckoning");
  EXPECT_EQ(status(result, 35), SweepStatus::ok);
  EXPECT_EQ(result.estimate.sweeps[35].T_map_body.matrix(), clean.estimate.sweeps[35].T_map_body.matrix());
  EXPECT_THAT(result.log, testing::Contains(testing::HasSubstr("3 IMU samples dropped")));
}

/// A method that breaks at its fourth sweep.
class Breaks : public Estimator {
 public:
  using Estimator::add;
  SweepOutcome add(const core::LidarSweep& sweep) override {
    if (sweep.index == 3) throw std::runtime_error("matrix has no inverse");
    SweepOutcome outcome;
    outcome.result = {.index = sweep.index, .begin = sweep.begin, .end = sweep.end, .reference = sweep.end};
    if (sweep.index == wrong_) outcome.result.T_map_body.translation().x() = std::numeric_limits<double>::quiet_NaN();
    outcome.motion.push_back(core::Segment::hold(sweep.begin, sweep.end, core::SE3::Identity()));
    return outcome;
  }
  std::int64_t wrong_ = -1;
};

TEST_F(RunEstimator, AMethodThatThrowsHasFailedAndKeepsWhatItGave) {
  EstimatorEntry entry = *find_estimator("kiss-icp");
  entry.name = "breaks";
  entry.make = [](const core::ConfigNode&, const EstimatorContext&) -> std::unique_ptr<Estimator> {
    return std::make_unique<Breaks>();
  };
  const RunResult result = run(entry);
  EXPECT_EQ(result.estimate.status, RunStatus::failed);
  EXPECT_EQ(result.estimate.message, "matrix has no inverse");
  EXPECT_EQ(result.estimate.sweeps.size(), 3U);
}

TEST_F(RunEstimator, APoseThatIsNotFiniteIsAFailure) {
  EstimatorEntry entry = *find_estimator("kiss-icp");
  entry.name = "breaks";
  entry.make = [](const core::ConfigNode&, const EstimatorContext&) -> std::unique_ptr<Estimator> {
    auto method = std::make_unique<Breaks>();
    method->wrong_ = 1;
    return method;
  };
  const RunResult result = run(entry);
  EXPECT_EQ(result.estimate.status, RunStatus::failed);
  EXPECT_THAT(result.estimate.message, testing::HasSubstr("not finite for sweep 1"));
  EXPECT_EQ(result.estimate.sweeps.size(), 1U);
}

TEST_F(RunEstimator, WhatProgressThrowsEndsTheRun) {
  struct Interrupted {};
  EXPECT_THROW(run("kiss-icp", [](double, const std::string&) { throw Interrupted(); }), Interrupted);
}

}  // namespace
}  // namespace tarmac::estimators
