// What the error generator makes is what the data sheet says, measured as a user would: from the samples of still runs.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "sim/imu/imu.h"

namespace tarmac::sim {
namespace {

using namespace core;

constexpr double rate_hz = 200;
constexpr std::size_t hour = 3600 * 200;
constexpr int runs = 4;

enum class Triad { gyro, accel };

/// Samples of one hour of nothing but errors, no saturation.
std::vector<ImuSample> still_hour(ImuModel model, std::uint64_t seed) {
  model.gyro.range = model.accel.range = 0;
  std::vector<ImuSample> samples(hour);
  add_imu_errors(samples, model, rate_hz, seed, "imu0");
  return samples;
}

std::vector<double> axis_of(const std::vector<ImuSample>& samples, Triad triad, int axis) {
  std::vector<double> values;
  values.reserve(samples.size());
  for (const ImuSample& s : samples) values.push_back(triad == Triad::gyro ? s.gyro_rad_s[axis] : s.accel_m_s2[axis]);
  return values;
}

/// Overlapped Allan variance for clusters of m samples.
double allan_variance(const std::vector<double>& values, std::size_t m) {
  std::vector<double> sum(values.size() + 1, 0.0);
  for (std::size_t k = 0; k < values.size(); ++k) sum[k + 1] = sum[k] + values[k];
  double total = 0;
  const std::size_t count = values.size() - 2 * m + 1;
  for (std::size_t k = 0; k < count; ++k) {
    const double difference = (sum[k + 2 * m] - 2 * sum[k + m] + sum[k]) / static_cast<double>(m);
    total += difference * difference;
  }
  return total / (2 * static_cast<double>(count));
}

/// N by a weighted fit of N^2 / tau over tau = 0.1 to 1 s; weights fall with tau, as the number of clusters does.
double fitted_density(const std::vector<double>& values) {
  double weighted = 0, weights = 0;
  for (const std::size_t m : {20u, 30u, 45u, 65u, 95u, 140u, 200u}) {
    const double tau = static_cast<double>(m) / rate_hz, weight = 1 / tau;
    weighted += weight * allan_variance(values, m) * tau;
    weights += weight;
  }
  return std::sqrt(weighted / weights);
}

TEST(ImuNoise, DensityOverThreeAxesAndFourHoursIsTheDataSheetsWithinTwoPercent) {
  const ImuModel& model = imu_model("adis16470");
  double gyro = 0, accel = 0;
  for (int run = 1; run <= runs; ++run) {
    const auto samples = still_hour(model, static_cast<std::uint64_t>(run));
    for (int axis = 0; axis < 3; ++axis) {
      gyro += fitted_density(axis_of(samples, Triad::gyro, axis)) / (3 * runs);
      accel += fitted_density(axis_of(samples, Triad::accel, axis)) / (3 * runs);
    }
  }
  std::printf("density / data sheet: gyro %.4f, accel %.4f\n", gyro / model.gyro.noise_density,
              accel / model.accel.noise_density);
  EXPECT_NEAR(gyro / model.gyro.noise_density, 1, 0.02);
  EXPECT_NEAR(accel / model.accel.noise_density, 1, 0.02);
}

TEST(ImuNoise, BiasIncrementsPooledOverAxesHaveTheirVarianceWithinHalfAPercent) {
  ImuModel model = imu_model("bmi088");
  model.gyro.noise_density = model.accel.noise_density = 0;  // what is left is the realised bias
  const auto samples = still_hour(model, 1);
  for (const Triad triad : {Triad::gyro, Triad::accel}) {
    const double walk = triad == Triad::gyro ? model.gyro.random_walk : model.accel.random_walk;
    double sum2 = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto bias = axis_of(samples, triad, axis);
      for (std::size_t k = 1; k < bias.size(); ++k) sum2 += (bias[k] - bias[k - 1]) * (bias[k] - bias[k - 1]);
    }
    const double variance = sum2 / static_cast<double>(3 * (hour - 1));
    std::printf("bias increments: variance / configured = %.5f\n", variance / (walk * walk / rate_hz));
    EXPECT_NEAR(variance / (walk * walk / rate_hz), 1, 0.005);
  }
}

TEST(ImuNoise, AStrongWalkIsRecoveredWithinFivePercent) {
  // K = 10 N/s: K^2 tau / 3 by a fit over 1 to 10 s, after the white part N^2 / tau is taken off.
  ImuModel model = imu_model("adis16470");
  model.gyro.random_walk = 10 * model.gyro.noise_density;
  double mean = 0;
  for (int run = 1; run <= runs; ++run) {
    const auto samples = still_hour(model, static_cast<std::uint64_t>(run));
    for (int axis = 0; axis < 3; ++axis) {
      const auto values = axis_of(samples, Triad::gyro, axis);
      double weighted = 0, weights = 0;
      for (const std::size_t m : {200u, 400u, 900u, 2000u}) {
        const double tau = static_cast<double>(m) / rate_hz, weight = 1 / tau, N = model.gyro.noise_density;
        weighted += weight * (allan_variance(values, m) - N * N / tau) * 3 / tau;
        weights += weight;
      }
      mean += std::sqrt(weighted / weights) / (3 * runs);
    }
  }
  EXPECT_NEAR(mean / model.gyro.random_walk, 1, 0.05);
}

TEST(ImuNoise, TurnOnBiasesOverManyRunsHaveTheirSigma) {
  const ImuModel& model = imu_model("icm-20948");
  double sum2 = 0;
  constexpr int n = 4000;
  for (int run = 0; run < n; ++run) {
    ImuModel quiet = model;
    quiet.accel.noise_density = quiet.accel.random_walk = 0;
    std::vector<ImuSample> one(1);
    add_imu_errors(one, quiet, rate_hz, static_cast<std::uint64_t>(run), "imu0");
    sum2 += one[0].accel_m_s2.squaredNorm() / 3;
  }
  // The relative standard deviation of a variance from 3 n draws is sqrt(2 / 3n) = 1.3 %.
  EXPECT_NEAR(sum2 / n / (model.accel.turn_on_sigma * model.accel.turn_on_sigma), 1, 0.05);
}

}  // namespace
}  // namespace tarmac::sim
