// What the error generator makes is what the data sheet says, measured as a user would: from the samples of still runs,
// for every device. Quantisation and saturation are off, and so is what is constant over a run.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "sim/imu/imu.h"
#include "sim/imu/low_pass.h"
#include "tests/sim/imu/allan.h"

namespace tarmac::sim {
namespace {

using namespace core;
using tests::NoiseModel;

constexpr double rate_hz = 100;
constexpr std::size_t hour = 3600 * 100;

enum class Triad { gyro, accel };
const TriadModel& of(const ImuModel& model, Triad triad) {
  return triad == Triad::gyro ? model.gyro : model.accel;
}
const char* name_of(Triad triad) {
  return triad == Triad::gyro ? "gyro" : "accel";
}

ImuErrorOptions only(bool white_noise, bool bias_instability, bool bias_walk) {
  ImuErrorOptions options = ImuErrorOptions::none();
  options.white_noise = white_noise;
  options.bias_instability = bias_instability;
  options.bias_walk = bias_walk;
  return options;
}

/// One hour of nothing but errors. Draws are named after the device: no two devices share them.
struct StillHour {
  std::vector<ImuSample> samples = std::vector<ImuSample>(hour);
  RealisedImuErrors errors;
  StillHour(const ImuModel& model, const ImuErrorOptions& options, int run, std::size_t bias_every = hour)
      : errors(add_imu_errors(samples, model, options, {rate_hz, 0}, static_cast<std::uint64_t>(run),
                              std::string(model.name), bias_every)) {}
  std::vector<double> sums(Triad triad, int axis) const {
    std::vector<double> values(hour);
    for (std::size_t k = 0; k < hour; ++k)
      values[k] = triad == Triad::gyro ? samples[k].gyro_rad_s[axis] : samples[k].accel_m_s2[axis];
    return tests::running_sum(values);
  }
};

/// N by a weighted fit of N^2 / tau over tau = 0.1 to 1 s; weights fall with tau, as the number of clusters does.
double fitted_density(const std::vector<double>& sums) {
  double weighted = 0, weights = 0;
  for (const std::size_t m : {10u, 15u, 22u, 32u, 47u, 70u, 100u}) {
    const double tau = static_cast<double>(m) / rate_hz, weight = 1 / tau;
    weighted += weight * tests::overlapped_allan_variance(sums, m) * tau;
    weights += weight;
  }
  return std::sqrt(weighted / weights);
}

/// K by a fit of K^2 tau / 3 over 1 to 10 s, after the white part N^2 / tau is taken off.
double fitted_walk(const std::vector<double>& sums, double density) {
  double weighted = 0, weights = 0;
  for (const std::size_t m : {100u, 200u, 450u, 1000u}) {
    const double tau = static_cast<double>(m) / rate_hz, weight = 1 / tau;
    weighted += weight * (tests::overlapped_allan_variance(sums, m) - density * density / tau) * 3 / tau;
    weights += weight;
  }
  return std::sqrt(weighted / weights);
}

double pooled_increment_variance(const std::vector<Eigen::Vector3d>& bias) {
  double sum2 = 0;
  for (std::size_t k = 1; k < bias.size(); ++k) sum2 += (bias[k] - bias[k - 1]).squaredNorm();
  return sum2 / (3 * static_cast<double>(bias.size() - 1));
}

class EveryImu : public testing::TestWithParam<ImuModel> {};
INSTANTIATE_TEST_SUITE_P(ImuNoise, EveryImu, testing::ValuesIn(imu_models().begin(), imu_models().end()),
                         [](const auto& test) {
                           std::string name(test.param.name);
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

TEST_P(EveryImu, DensityOverThreeAxesAndFourHoursIsTheSheetsWithinTwoPercent) {
  const ImuModel& model = GetParam();
  constexpr int runs = 4;
  double density[2] = {0, 0};
  for (int run = 1; run <= runs; ++run) {
    const StillHour still(model, only(true, true, false), run);
    for (const Triad triad : {Triad::gyro, Triad::accel})
      for (int axis = 0; axis < 3; ++axis)
        density[triad == Triad::accel] += fitted_density(still.sums(triad, axis)) / (3 * runs);
  }
  for (const Triad triad : {Triad::gyro, Triad::accel}) {
    const double ratio = density[triad == Triad::accel] / of(model, triad).noise_density;
    std::printf("%s %s: density / sheet %.4f\n", model.name.data(), name_of(triad), ratio);
    EXPECT_NEAR(ratio, 1, 0.02) << name_of(triad);
  }
}

TEST_P(EveryImu, IncrementsOfTheRealisedBiasPooledOverAxesHaveTheirVarianceWithinHalfAPercent) {
  // Gauss-Markov: 2 sigma^2 (1 - exp(-dt / tau)); walk: K^2 dt. Over short times the two are the same.
  const ImuModel& model = GetParam();
  for (const bool walk : {false, true}) {
    const StillHour still(model, only(false, !walk, walk), 1, 1);
    for (const Triad triad : {Triad::gyro, Triad::accel}) {
      const TriadModel& sheet = of(model, triad);
      const double markov = -2 * sheet.bias_sigma * sheet.bias_sigma * std::expm1(-1 / (rate_hz * sheet.bias_tau_s));
      const double configured = walk ? sheet.random_walk * sheet.random_walk / rate_hz : markov;
      EXPECT_NEAR(markov / (sheet.random_walk * sheet.random_walk / rate_hz), 1, 2e-3)
          << "the table agrees with itself";
      const auto& bias = triad == Triad::gyro ? still.errors.gyro.bias : still.errors.accel.bias;
      const double ratio = pooled_increment_variance(bias) / configured;
      std::printf("%s %s: variance of %s increments / configured %.5f\n", model.name.data(), name_of(triad),
                  walk ? "walk" : "Gauss-Markov", ratio);
      EXPECT_NEAR(ratio, 1, 0.005) << name_of(triad) << (walk ? " walk" : " Gauss-Markov");
    }
  }
}

TEST_P(EveryImu, MeanAllanCurveOf32HoursLiesInsideTheBandOfItsClosedForm) {
  // One curve of a triad is the mean of 32 runs and 3 axes. The whole curve is inside with 99.9 %: each of its points
  // gets its share of the 0.1 %.
  const ImuModel& model = GetParam();
  constexpr int runs = 32;
  std::vector<std::size_t> clusters;
  for (std::size_t m = 1; hour / m >= 5; m *= 2) clusters.push_back(m);
  std::vector<double> measured[2] = {std::vector<double>(clusters.size(), 0.0),
                                     std::vector<double>(clusters.size(), 0.0)};
  for (int run = 1; run <= runs; ++run) {
    const StillHour still(model, only(true, true, false), run);
    for (const Triad triad : {Triad::gyro, Triad::accel})
      for (int axis = 0; axis < 3; ++axis) {
        const std::vector<double> sums = still.sums(triad, axis);
        for (std::size_t i = 0; i < clusters.size(); ++i)
          measured[triad == Triad::accel][i] += tests::allan_variance(sums, clusters[i]) / (3 * runs);
      }
  }
  for (const Triad triad : {Triad::gyro, Triad::accel}) {
    const TriadModel& sheet = of(model, triad);
    const NoiseModel closed{rate_hz, sheet.noise_density, sheet.bias_sigma, sheet.bias_tau_s};
    double nearest = 1;  // to an edge of the band: 1 in the middle, 0 on the edge
    for (std::size_t i = 0; i < clusters.size(); ++i) {
      const double value = measured[triad == Triad::accel][i];
      const auto band = closed.band(clusters[i], hour, 3 * runs, 1 - 0.001 / static_cast<double>(clusters.size()));
      EXPECT_GT(value, band.low) << name_of(triad) << " at " << static_cast<double>(clusters[i]) / rate_hz << " s";
      EXPECT_LT(value, band.high) << name_of(triad) << " at " << static_cast<double>(clusters[i]) / rate_hz << " s";
      const double middle = closed.allan_variance(clusters[i]);
      nearest =
          std::min({nearest, (value - band.low) / (middle - band.low), (band.high - value) / (band.high - middle)});
    }
    std::printf("%s %s: least distance to an edge of the band %.2f of its half width\n", model.name.data(),
                name_of(triad), nearest);
  }
}

TEST(ImuNoise, AStrongWalkIsRecoveredWithinFivePercent) {
  // K = 10 N/s. From an hour of a real grade K cannot be had that well.
  ImuModel model = imu_model("adis16470");
  model.gyro.random_walk = 10 * model.gyro.noise_density;
  constexpr int runs = 4;
  double mean = 0;
  for (int run = 1; run <= runs; ++run) {
    const StillHour still(model, only(true, false, true), run);
    for (int axis = 0; axis < 3; ++axis)
      mean += fitted_walk(still.sums(Triad::gyro, axis), model.gyro.noise_density) / (3 * runs);
  }
  std::printf("strong walk: K / configured %.4f\n", mean / model.gyro.random_walk);
  EXPECT_NEAR(mean / model.gyro.random_walk, 1, 0.05);
}

TEST(ImuNoise, LowPassedNoiseHasTheSheetsDensityBelowTheCutoffAndItsClosedFormVariance) {
  // At 25 Hz and 100 Hz sampling, aliases add |H(100 Hz)|^2 x 2 = 0.8 % to the power at rest.
  const ImuModel& model = imu_model("bmi088");
  std::vector<ImuSample> samples(hour);
  add_imu_errors(samples, model, only(true, false, false), {rate_hz, 25}, 1, "imu0");
  double variance = 0, density = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const ImuSample& s : samples) values.push_back(s.gyro_rad_s[axis]);
    for (const double v : values) variance += v * v / (3 * static_cast<double>(hour));
    const auto sums = tests::running_sum(values);
    double weighted = 0, weights = 0;
    for (const std::size_t m : {100u, 150u, 220u, 320u}) {  // clusters much longer than the filter's memory
      const double tau = static_cast<double>(m) / rate_hz;
      weighted += tests::overlapped_allan_variance(sums, m);
      weights += 1 / tau;
    }
    density += std::sqrt(weighted / weights) / 3;
  }
  const double N = model.gyro.noise_density;
  EXPECT_NEAR(variance / (N * N * LowPass(25).stationary()(0, 0)), 1, 0.02);
  EXPECT_NEAR(density / N, 1.004, 0.03);
}

TEST(ImuNoise, TurnOnBiasesScalesAndMisalignmentsOverManyRunsHaveTheirSigma) {
  const ImuModel& model = imu_model("icm-20948");
  double turn_on = 0, scale = 0, misalignment = 0, g = 0;
  constexpr int n = 4000;
  for (int run = 0; run < n; ++run) {
    std::vector<ImuSample> one(1);
    const RealisedImuErrors e =
        add_imu_errors(one, model, ImuErrorOptions(), {rate_hz, 0}, static_cast<std::uint64_t>(run), "imu0");
    turn_on += e.accel.turn_on_bias.squaredNorm() / (3 * n);
    const Eigen::Matrix3d off = e.gyro.matrix - Eigen::Matrix3d::Identity();
    scale += off.diagonal().squaredNorm() / (3 * n);
    misalignment += (off.squaredNorm() - off.diagonal().squaredNorm()) / (6 * n);
    g += e.gyro.g_sensitivity.squaredNorm() / (9 * n);
  }
  // The relative standard deviation of a variance from 3 n draws is sqrt(2 / 3n) = 1.3 %.
  EXPECT_NEAR(turn_on / std::pow(model.accel.turn_on_sigma, 2), 1, 0.05);
  EXPECT_NEAR(scale / std::pow(model.gyro.scale_sigma, 2), 1, 0.05);
  EXPECT_NEAR(misalignment / std::pow(model.gyro.misalignment_sigma_rad, 2), 1, 0.05);
  EXPECT_NEAR(g / std::pow(model.g_sensitivity_sigma, 2), 1, 0.05);
}

TEST(AllanVariance, ClosedFormsOfSampledAndContinuousNoiseAgreeWhereClustersAreLong) {
  const NoiseModel model{100, 1e-3, 2e-4, 300};
  for (const std::size_t m : {100u, 1000u, 10000u, 60000u})
    EXPECT_NEAR(model.allan_variance(m) / continuous_allan_variance(model, static_cast<double>(m) / 100), 1, 2e-4) << m;
  // Over short times the bias is a walk of K^2 = 2 sigma^2 / tau: K^2 T / 3.
  const NoiseModel bias_only{100, 0, 2e-4, 300};
  EXPECT_NEAR(bias_only.allan_variance(300) / (2 * 4e-8 / 300 * 3 / 3), 1, 0.01);
}

TEST(AllanVariance, BandOfWhiteNoiseNarrowsWithTheNumberOfClusters) {
  // Clusters side by side: neighbouring differences have correlation -1/2, so the variance of the mean of their squares
  // is 2 (1 + 2 / 4) / D = 3 / D of its square.
  const NoiseModel white{100, 1, 0, 1};
  const auto band = white.band(100, 360000, 100, 0.99);
  const double half_width = (band.high - band.low) / 2 / white.allan_variance(100);
  EXPECT_NEAR(half_width, 2.576 * std::sqrt(3.0 / 3600 / 100), 1e-4);
}

}  // namespace
}  // namespace tarmac::sim
