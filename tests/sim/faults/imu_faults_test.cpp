#include "sim/faults/imu_faults.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/faults/fabricate.h"

namespace tarmac::sim::faults {
namespace {

using namespace core;

constexpr std::size_t kSamples = 4000;
constexpr std::int64_t period_ns = 5'000'000;

/// Samples that say which they are: gyro x = number.
std::vector<ImuSample> clean() {
  std::vector<ImuSample> samples(kSamples);
  for (std::size_t k = 0; k < kSamples; ++k) {
    samples[k].t = time_from_ns(static_cast<std::int64_t>(k + 1) * period_ns);
    samples[k].gyro_rad_s.x() = static_cast<double>(k);
  }
  return samples;
}

struct Result {
  std::vector<ImuSample> samples = clean();
  std::vector<truth::Fault> log;
  explicit Result(const std::string& imu) {
    const ImuFaultOptions options = tests::faults_of("faults: {imu: {" + imu + "}}").imu;
    const std::size_t lost = apply_imu_faults(options, 1, "imu0", samples);
    log = imu_log(options, lost, samples.size() + lost, "imu0");
  }
};

std::int64_t true_ns(const ImuSample& sample) {
  return (std::llround(sample.gyro_rad_s.x()) + 1) * period_ns;
}

TEST(ImuFaults, NothingAskedForChangesNothingAndLogsNothing) {
  const Result result("");
  ASSERT_EQ(result.samples.size(), kSamples);
  for (const ImuSample& s : result.samples) EXPECT_EQ(to_ns(s.t), true_ns(s));
  EXPECT_TRUE(result.log.empty());
}

TEST(ImuFaults, OffsetAndDriftRestampEverySample) {
  const Result offset("clock_offset_ms: -5"), drift("clock_drift_ppm: 100");
  ASSERT_EQ(offset.samples.size(), kSamples);
  for (const ImuSample& s : offset.samples) ASSERT_EQ(to_ns(s.t), true_ns(s) - 5'000'000);
  for (const ImuSample& s : drift.samples) ASSERT_EQ(to_ns(s.t), true_ns(s) + true_ns(s) / 10'000);
  ASSERT_EQ(offset.log.size(), 1u);
  EXPECT_EQ(offset.log[0].kind, "clock-offset");
  EXPECT_EQ(offset.log[0].sensor, "imu0");
  EXPECT_EQ(offset.log[0].parameters.at("offset_ms"), -5);
  EXPECT_EQ(drift.log.at(0).parameters.at("drift_ppm"), 100);
}

TEST(ImuFaults, JitterHasItsSigmaAndStampsStayInOrder) {
  const Result little("jitter_ms: 0.3"), huge("jitter_ms: 20");
  double sum2 = 0;
  for (const ImuSample& s : little.samples) sum2 += std::pow(1e-6 * static_cast<double>(to_ns(s.t) - true_ns(s)), 2);
  EXPECT_NEAR(std::sqrt(sum2 / kSamples) / 0.3, 1, 0.05);  // 4000 draws: 1 sigma is 1.1 %
  ASSERT_EQ(huge.samples.size(), kSamples);
  for (std::size_t k = 1; k < kSamples; ++k) {
    ASSERT_LT(huge.samples[k - 1].t, huge.samples[k].t);
    ASSERT_EQ(huge.samples[k].gyro_rad_s.x(), static_cast<double>(k));
  }
}

TEST(ImuFaults, GapsAreEmptyByTheTrueClock) {
  const Result result("gaps: [{from_s: 1, to_s: 2}, {from_s: 10, to_s: 10.5}], clock_offset_ms: 100");
  EXPECT_EQ(result.samples.size(), kSamples - 200 - 100);
  for (const ImuSample& s : result.samples) {
    const double t_s = 1e-9 * static_cast<double>(true_ns(s));
    EXPECT_FALSE((t_s >= 1 && t_s < 2) || (t_s >= 10 && t_s < 10.5)) << t_s;
  }
  ASSERT_EQ(result.log.size(), 3u);
  EXPECT_EQ(result.log[1].kind, "gap");
  EXPECT_EQ(result.log[1].parameters.at("from_s"), 1);
  EXPECT_EQ(result.log[2].parameters.at("to_s"), 10.5);
}

TEST(ImuFaults, LostSamplesAreCountedInTheLog) {
  const Result result("lost_samples: 0.05");
  const double lost = static_cast<double>(kSamples - result.samples.size());
  EXPECT_NEAR(lost / kSamples, 0.05, 4 * std::sqrt(0.05 * 0.95 / kSamples));
  EXPECT_EQ(result.log.at(0).parameters.at("lost"), lost);
  EXPECT_EQ(result.log.at(0).parameters.at("samples"), static_cast<double>(kSamples));
}

}  // namespace
}  // namespace tarmac::sim::faults
