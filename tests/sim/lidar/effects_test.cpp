#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "sim/lidar/effects/echoes.h"
#include "tests/support/constants.h"

namespace tarmac::sim::lidar {
namespace {

using tests::rad;

const Profile& ouster() {
  return profile("ouster-os1-64-gen2");
}

Echoes echoes_at(const std::vector<double>& ranges_m, float signal = 0.5f) {
  Echoes e;
  e.resize(ranges_m.size());
  e.range_m = ranges_m;
  e.channels = 64;
  std::fill(e.signal.begin(), e.signal.end(), signal);
  std::fill(e.cos_incidence.begin(), e.cos_incidence.end(), 1.0f);
  return e;
}

double signal_of(const scenes::Material& material, double incidence_deg) {
  Echoes e = echoes_at({10});
  e.cos_incidence[0] = static_cast<float>(std::cos(incidence_deg * rad));
  Reflectance({material})(e);
  return e.signal[0];
}

double normal_cdf(double x) {
  return 0.5 * std::erfc(-x / std::sqrt(2.0));
}

TEST(RangeNoise, ErrorOverSigmaIsStandardNormal) {
  // 4 ranges, one a step of the table; 400,000 draws in batches as a sweep has them.
  constexpr std::size_t batch = 1000, batches = 400;
  const RangeNoise noise(ouster(), 1, 42, "test/range_noise");
  for (const double range_m : {0.8, 12.0, 35.0, 90.0}) {
    const double sigma_m = ouster().sigma_at_m(range_m);
    double sum = 0, squares = 0;
    for (std::size_t b = 0; b < batches; ++b) {
      Echoes e = echoes_at(std::vector<double>(batch, range_m));
      e.first_firing = b * batch;
      noise(e);
      for (const double measured : e.range_m) {
        const double x = (measured - range_m) / sigma_m;
        sum += x;
        squares += x * x;
      }
    }
    const double n = batch * batches, mean = sum / n;
    EXPECT_LT(std::abs(mean), 4 / std::sqrt(n)) << range_m;
    EXPECT_NEAR(squares / n - mean * mean, 1, 0.01) << range_m;
  }
}

TEST(RangeNoise, DrawBelongsToTheFiringHoweverTheBatchesAreCut) {
  const RangeNoise noise(ouster(), 1, 42, "test/range_noise");
  Echoes whole = echoes_at(std::vector<double>(300, 30.0)), part = echoes_at(std::vector<double>(77, 30.0));
  part.first_firing = 101;
  noise(whole);
  noise(part);
  for (std::size_t i = 0; i < part.size(); ++i) EXPECT_EQ(part.range_m[i], whole.range_m[101 + i]);
}

TEST(RangeNoise, LeavesMissingEchoesMissing) {
  Echoes e = echoes_at({0, 20, 0});
  RangeNoise(ouster(), 1, 1, "test")(e);
  ChannelBias(ouster(), 1, 1, "test")(e);
  quantise(0.001, e);
  EXPECT_EQ(e.range_m[0], 0);
  EXPECT_EQ(e.range_m[2], 0);
}

TEST(ChannelBias, IsConstantPerChannelAndSpreadAsTheProfileSays) {
  double squares = 0;
  std::size_t n = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const ChannelBias bias(ouster(), 1, seed, "test/channel_bias");
    for (const double b : bias.bias_m()) squares += b * b;
    n += bias.bias_m().size();
  }
  // 12800 draws: the standard deviation of their root mean square is 0.6 %.
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(n)), ouster().channel_bias_sigma_m,
              0.03 * ouster().channel_bias_sigma_m);
  const ChannelBias bias(ouster(), 1, 5, "test/channel_bias");
  Echoes e = echoes_at(std::vector<double>(64 * 3, 25.0));
  bias(e);
  for (std::size_t i = 0; i < e.size(); ++i) EXPECT_EQ(e.range_m[i], 25.0 + bias.bias_m()[i % 64]);
}

TEST(Quantisation, RoundsToTheNearestStep) {
  Echoes e = echoes_at({10.0004, 10.0006, 0.0});
  quantise(0.001, e);
  EXPECT_NEAR(e.range_m[0], 10.000, 1e-12);
  EXPECT_NEAR(e.range_m[1], 10.001, 1e-12);
  EXPECT_EQ(e.range_m[2], 0);
}

TEST(Detection, HoldsTheRangesOfTheDataSheet) {
  for (const std::string& name : profile_names()) {
    const Profile& p = profile(name);
    const Detection detection(p, 3, "test/detection");
    EXPECT_NEAR(normal_cdf(detection.snr(0.1, p.range_10_percent_m) - p.threshold_snr), 0.9, 1e-9);
    EXPECT_NEAR(normal_cdf(detection.snr(0.8, p.range_80_percent_m) - p.threshold_snr), 0.9, 1e-9);
  }
}

double share_detected(float signal, double range_m) {
  constexpr std::size_t n = 20000;
  Echoes e = echoes_at(std::vector<double>(n, range_m), signal);
  Detection(ouster(), 3, "test/detection")(e);
  return 1 - static_cast<double>(std::count(e.range_m.begin(), e.range_m.end(), 0.0)) / n;
}

TEST(Detection, ShareOfEchoesIsTheModelsProbability) {
  const Detection model(ouster(), 3, "test/detection");
  for (const double range_m : {38.0, 45.0, 50.0, 55.0}) {
    const double expected = normal_cdf(model.snr(0.1, range_m) - ouster().threshold_snr);
    // 5 standard deviations of a share of 20000, and 0.3 % for the table that stands in for the power law.
    EXPECT_NEAR(share_detected(0.1f, range_m), expected, 5 * std::sqrt(expected * (1 - expected) / 20000) + 0.003)
        << range_m;
  }
}

TEST(Detection, FallsWithRangeAndRisesWithReflectance) {
  double last = 2;
  for (double range_m = 35; range_m < 75; range_m += 4) {
    const double share = share_detected(0.1f, range_m);
    EXPECT_LE(share, last) << range_m;
    last = share;
  }
  EXPECT_LT(last, 0.01);
  last = -1;
  for (float signal = 0.02f; signal < 0.25f; signal += 0.02f) {
    const double share = share_detected(signal, 48);
    EXPECT_GE(share, last) << signal;
    last = share;
  }
  EXPECT_GT(last, 0.99);
}

TEST(Reflectance, LambertianSignalIsReflectanceTimesCosine) {
  scenes::Material lambert;
  lambert.diffuse = 0.4;
  for (const double angle : {0.0, 30.0, 60.0, 85.0})
    EXPECT_NEAR(signal_of(lambert, angle), 0.4 * std::cos(angle * rad), 1e-6);
}

TEST(Reflectance, RoughSurfaceHoldsUpAtGrazingIncidence) {
  // Oren-Nayar seen from the light: A + B sin tan, in double.
  scenes::Material rough;
  rough.diffuse = 0.3;
  rough.oren_nayar_sigma_rad = 0.35;
  const double s2 = 0.35 * 0.35, A = 1 - 0.5 * s2 / (s2 + 0.33), B = 0.45 * s2 / (s2 + 0.09);
  for (const double angle : {0.0, 30.0, 60.0, 75.0, 85.0}) {
    const double theta = angle * rad, factor = A + B * std::sin(theta) * std::tan(theta);
    EXPECT_NEAR(signal_of(rough, angle), 0.3 * factor * std::cos(theta), 1e-5) << angle;
  }
  EXPECT_NEAR(signal_of(rough, 88), 0.3 * 5 * std::cos(88 * rad), 1e-5);  // capped
}

TEST(Reflectance, GlossyLobeIsThatOfMicrofacets) {
  scenes::Material paint;
  paint.diffuse = 0;
  paint.specular_f0 = 0.04;
  paint.ggx_alpha = 0.05;
  EXPECT_NEAR(signal_of(paint, 0), 0.04 / (4 * 0.05 * 0.05), 1e-3);
  for (const double angle : {1.0, 2.0, 5.0, 20.0}) {
    const double c = std::cos(angle * rad), t = std::tan(angle * rad), a2 = 0.05 * 0.05;
    const double D = a2 / (M_PI * std::pow(c * c * (a2 - 1) + 1, 2)), G1 = 2 / (1 + std::sqrt(1 + a2 * t * t));
    const double rho = M_PI * 0.04 * D * G1 * G1 / (4 * c * c);
    EXPECT_NEAR(signal_of(paint, angle) / (rho * c), 1, 2e-3) << angle;
  }
}

TEST(Reflectance, HoldsTheTablesOfTheModels) {
  // Equivalent reflectance over diffuse reflectance, by slope and angle: Oren-Nayar seen from the light.
  const double rough[][7] = {{0.20, 0.95, 0.99, 1.15, 1.45, 1.72, 2.52},
                             {0.35, 0.86, 0.94, 1.25, 1.80, 2.31, 3.82},
                             {0.50, 0.78, 0.88, 1.28, 1.98, 2.63, 4.55}};
  const double rough_deg[] = {0, 30, 60, 75, 80, 85};
  for (const auto& row : rough)
    for (int k = 0; k < 6; ++k) {
      scenes::Material m;
      m.diffuse = 0.3;
      m.oren_nayar_sigma_rad = row[0];
      EXPECT_NEAR(signal_of(m, rough_deg[k]) / (0.3 * std::cos(rough_deg[k] * rad)), row[k + 1], 0.0051)
          << row[0] << " at " << rough_deg[k];
    }
  // Glossy skin and polished metal: alpha, F0, then 0, 1, 2, 5, 10 and 20 degrees.
  const double glossy[][8] = {
      {0.05, 0.04, 4.0, 3.2, 1.8, 0.25, 0.024, 0.002},    {0.10, 0.04, 1.0, 0.94, 0.80, 0.33, 0.065, 0.007},
      {0.20, 0.04, 0.25, 0.25, 0.24, 0.18, 0.087, 0.020}, {0.05, 0.87, 87, 69, 39, 5.4, 0.53, 0.043},
      {0.15, 0.87, 9.7, 9.4, 8.7, 5.5, 1.9, 0.30},        {0.30, 0.60, 1.7, 1.7, 1.6, 1.45, 1.0, 0.39}};
  const double glossy_deg[] = {0, 1, 2, 5, 10, 20};
  for (const auto& row : glossy)
    for (int k = 0; k < 6; ++k) {
      scenes::Material m;
      m.diffuse = 0;
      m.ggx_alpha = row[0];
      m.specular_f0 = row[1];
      const double rho = signal_of(m, glossy_deg[k]) / std::cos(glossy_deg[k] * rad);
      EXPECT_NEAR(rho / row[k + 2], 1, row[k + 2] < 0.01 ? 0.2 : 0.05) << row[0] << " at " << glossy_deg[k];
    }
}

TEST(Reflectance, RetroLobeOutshinesEverythingUpToWideAngles) {
  scenes::Material tape;
  tape.diffuse = 0;
  tape.retro = 300;
  EXPECT_NEAR(signal_of(tape, 0), 300, 1e-3);
  EXPECT_NEAR(signal_of(tape, 30), 300 * std::exp(-1.0) * std::cos(30 * rad), 0.01);
  EXPECT_LT(signal_of(tape, 75), 0.1);
}

TEST(Intensity, IsPercentOfReflectanceAndLogarithmicAbove) {
  const auto intensity_of = [](float signal) {
    Echoes e = echoes_at({10}, signal);
    Intensity(false, 1, "test/intensity")(e);
    return e.intensity[0];
  };
  EXPECT_EQ(intensity_of(0), 0);
  EXPECT_EQ(intensity_of(0.37f), 37);
  EXPECT_EQ(intensity_of(1), 100);
  EXPECT_EQ(intensity_of(10), std::round(100 + 155.0 / 2));
  EXPECT_EQ(intensity_of(100), 255);
  EXPECT_EQ(intensity_of(5000), 255);
}

TEST(Intensity, NoiseIsFivePercentAndOneCount) {
  Echoes e = echoes_at(std::vector<double>(20000, 10.0), 0.5f);
  Intensity(true, 9, "test/intensity")(e);
  double sum = 0, squares = 0;
  for (const float value : e.intensity) {
    sum += value;
    squares += static_cast<double>(value) * value;
  }
  const double mean = sum / 20000, sigma = std::sqrt(squares / 20000 - mean * mean);
  EXPECT_NEAR(mean, 50, 0.2);
  EXPECT_NEAR(sigma, std::sqrt(3.5 * 3.5 + 1.0 / 12), 0.1);  // 1 + 5 % of 50; rounding adds a twelfth
}

}  // namespace
}  // namespace tarmac::sim::lidar
