// From echoes to returns: noise, detection and intensity against the models that the options describe.
#include "sim/lidar/receiver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tarmac::sim::lidar {
namespace {

constexpr std::size_t batch = 1024;  // 16 cycles of 64 channels

const Profile& ouster() {
  return profile("ouster-os1-64-gen2");
}

FiringTable firing() {
  return FiringTable(ouster(), mode_of(ouster(), 1024, 10));
}

double normal_cdf(double x) {
  return 0.5 * std::erfc(-x / std::sqrt(2.0));
}

NoiseOptions quiet() {
  return {.range_scale = 0, .channel_bias_scale = 0, .quantisation = false, .dropout = false, .intensity = false};
}

/// Every firing sees the same echoes, strongest first; ranges are the sensor's raw ones.
EchoField field_of(const std::vector<Echo>& echoes) {
  EchoField field;
  field.resize(batch);
  for (std::uint32_t f = 0; f < batch; ++f)
    for (std::uint32_t slot = 0; slot < echoes.size(); ++slot) {
      Echo echo = echoes[slot];
      echo.t_m -= ouster().range_offset_m;
      if (slot == 0)
        field.put(f, echo);
      else
        field.others.push_back({f, slot, echo});
    }
  return field;
}

Echo echo_at(double range_m, float signal, float cosine = 1) {
  Echo echo;
  echo.t_m = range_m;
  echo.signal = signal;
  echo.cos_incidence = cosine;
  return echo;
}

/// Calls back with the returns of batch after batch.
template <class Use>
void receive(const std::vector<Echo>& echoes, const NoiseOptions& noise, const BeamOptions& options,
             std::size_t batches, const Use& use, std::uint64_t seed = 1) {
  const Receiver receiver(ouster(), firing(), noise, options, 0, seed);
  const EchoField field = field_of(echoes);
  Receiver::Scratch scratch;
  Returns firsts, seconds;
  for (std::size_t b = 0; b < batches; ++b) {
    receiver(field, 0, batch, b * batch, scratch, firsts, seconds);
    use(firsts, seconds);
  }
}

struct Moments {
  double n = 0, sum = 0, squares = 0;
  void add(double x) {
    ++n;
    sum += x;
    squares += x * x;
  }
  double mean() const { return sum / n; }
  double variance() const { return squares / n - mean() * mean(); }
};

TEST(SnrNoise, MeetsTheSheetOnItsReferenceTarget) {
  for (const std::string& name : profile_names()) {
    const Profile& p = profile(name);
    const SnrNoise noise(p, 1, 0.12, 1, "test");
    for (double range_m = 1; range_m < p.max_range_m; range_m *= 1.3)
      EXPECT_NEAR(noise.sigma_m(range_m, 0.8, 1), p.sigma_at_m(range_m), 1e-12) << name << " at " << range_m;
  }
}

TEST(SnrNoise, ErrorOverSigmaIsStandardNormalForBothReturns) {
  NoiseOptions noise = quiet();
  noise.range_scale = 1;
  BeamOptions options;
  options.range_noise = "snr";
  options.returns = "dual";
  struct Target {
    double range_m;
    float signal, cosine;
  };
  // Dark and bright, square and slanted, in three rows of the sheet; the second echo lies 5 m behind.
  for (const Target& t : {Target{8, 0.8f, 1}, {15, 0.05f, 0.3f}, {35, 0.4f, 0.1f}, {60, 3, 0.7f}}) {
    const SnrNoise model(ouster(), 1, options.spot_smear, 1, "test");
    Moments first, second, product;
    receive({echo_at(t.range_m, t.signal, t.cosine), echo_at(t.range_m + 5, t.signal / 4, t.cosine)}, noise, options,
            400, [&](const Returns& a, const Returns& b) {
              ASSERT_EQ(b.size(), a.size());
              for (std::size_t i = 0; i < a.size(); ++i) {
                EXPECT_EQ(a.true_range_m[i], t.range_m);
                const double x = (a.echoes.range_m[i] - a.true_range_m[i]) /
                                 model.sigma_m(t.range_m, static_cast<double>(t.signal), static_cast<double>(t.cosine));
                const double y =
                    (b.echoes.range_m[i] - b.true_range_m[i]) /
                    model.sigma_m(t.range_m + 5, static_cast<double>(t.signal / 4), static_cast<double>(t.cosine));
                first.add(x);
                second.add(y);
                product.add(x * y);
              }
            });
    for (const Moments& m : {first, second}) {
      EXPECT_LT(std::abs(m.mean()), 4 / std::sqrt(m.n)) << t.range_m;
      EXPECT_NEAR(m.variance(), 1, 0.01) << t.range_m;
    }
    EXPECT_LT(std::abs(product.mean()), 4 / std::sqrt(product.n));  // two draws, not one
  }
}

TEST(SnrNoise, GrowsWithIncidenceAndDarkness) {
  const SnrNoise noise(ouster(), 1, 0.12, 1, "test");
  EXPECT_NEAR(noise.sigma_m(15, 0.08, 1) / noise.sigma_m(15, 0.8, 1), std::sqrt(0.5 + 5), 1e-9);
  const double square = noise.sigma_m(15, 0.8, 1), slanted = noise.sigma_m(15, 0.8, 0.2);
  const double smear_m = 0.12 * 15 * 3.14e-3 * std::sqrt(1 - 0.04) / 0.2;
  EXPECT_NEAR(slanted, std::hypot(square, smear_m), 1e-9);
}

TEST(Receiver, ShareOfDetectedEchoesIsTheModelsProbabilityForStrongestAndOthers) {
  NoiseOptions noise = quiet();
  noise.dropout = true;
  BeamOptions options;
  options.returns = "dual";
  const Detection model(ouster(), 1, "test");
  for (const double range_m : {40.0, 45.0, 50.0, 53.0}) {
    constexpr float weak = 0.1f, stronger = 0.11f;
    const double p = normal_cdf(model.snr(stronger, range_m) - ouster().threshold_snr);
    const double q = normal_cdf(model.snr(weak, range_m + 2) - ouster().threshold_snr);
    double n = 0, either = 0, both = 0;
    receive({echo_at(range_m, stronger), echo_at(range_m + 2, weak)}, noise, options, 200,
            [&](const Returns& a, const Returns& b) {
              for (std::size_t i = 0; i < a.size(); ++i) either += a.echoes.range_m[i] > 0;
              both += static_cast<double>(b.size());
              n += static_cast<double>(a.size());
            });
    const auto bound = [&](double share) { return 4 * std::sqrt(share * (1 - share) / n) + 0.003; };  // 0.3 %: a table
    EXPECT_NEAR(both / n, p * q, bound(p * q)) << range_m;
    EXPECT_NEAR(either / n, 1 - (1 - p) * (1 - q), bound(1 - (1 - p) * (1 - q))) << range_m;
  }
}

TEST(Receiver, IntensityFollowsItsLawForBothReturns) {
  NoiseOptions noise = quiet();
  noise.intensity = true;
  BeamOptions options;
  options.returns = "dual";
  Moments first, second;
  receive({echo_at(20, 0.6f), echo_at(30, 0.2f)}, noise, options, 100, [&](const Returns& a, const Returns& b) {
    for (const float v : a.echoes.intensity) first.add(static_cast<double>(v));
    for (const float v : b.echoes.intensity) second.add(static_cast<double>(v));
  });
  const auto check = [](const Moments& m, double percent) {
    const double sigma = 1 + 0.05 * percent, rounded = std::sqrt(sigma * sigma + 1.0 / 12);
    EXPECT_NEAR(m.mean(), percent, 4 * rounded / std::sqrt(m.n));
    EXPECT_NEAR(m.variance(), rounded * rounded, 0.02 * rounded * rounded);
  };
  check(first, 60);
  check(second, 20);
}

TEST(Receiver, FirstLastAndStrongestChooseAmongWhatIsDetected) {
  const std::vector<Echo> echoes{echo_at(20, 0.5f), echo_at(10, 0.02f), echo_at(30, 0.3f)};
  const auto range_of = [&](const std::string& returns) {
    BeamOptions options;
    options.returns = returns;
    double range_m = 0;
    receive(echoes, quiet(), options, 1, [&](const Returns& a, const Returns&) { range_m = a.echoes.range_m[7]; });
    return range_m;
  };
  EXPECT_EQ(range_of("strongest"), 20);
  EXPECT_EQ(range_of("first"), 10);
  EXPECT_EQ(range_of("last"), 30);
  BeamOptions dual;
  dual.returns = "dual";
  receive(echoes, quiet(), dual, 1, [&](const Returns& a, const Returns& b) {
    EXPECT_EQ(a.echoes.range_m[7], 20);
    EXPECT_EQ(b.echoes.range_m[7], 30);
  });
  // The strongest is the last: then the second strongest comes with it.
  receive({echo_at(20, 0.5f), echo_at(10, 0.05f), echo_at(5, 0.001f)}, quiet(), dual, 1,
          [&](const Returns& a, const Returns& b) {
            EXPECT_EQ(a.echoes.range_m[7], 20);
            EXPECT_EQ(b.echoes.range_m[7], 10);
          });
}

TEST(Receiver, EchoesBeyondWhatTheSensorMeasuresAreNotChosen) {
  BeamOptions options;
  options.returns = "first";
  receive({echo_at(20, 0.5f), echo_at(0.1, 0.5f)}, quiet(), options, 1,
          [&](const Returns& a, const Returns&) { EXPECT_EQ(a.echoes.range_m[3], 20); });
}

TEST(Receiver, FalseAlarmsComeAsOftenAsToldAnywhereInRange) {
  BeamOptions options;
  options.false_alarms_per_shot = 0.01;
  double n = 0, alarms = 0;
  std::vector<double> places;
  const double low = ouster().min_range_m, high = ouster().max_range_m;
  receive({echo_at(0, 0)}, quiet(), options, 400, [&](const Returns& a, const Returns&) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      ++n;
      if (a.echoes.range_m[i] <= 0) continue;
      ++alarms;
      EXPECT_EQ(a.kind[i], ReturnKind::noise);
      places.push_back((a.echoes.range_m[i] - low) / (high - low));
    }
  });
  EXPECT_NEAR(alarms / n, 0.01, 4 * std::sqrt(0.01 * 0.99 / n));
  std::sort(places.begin(), places.end());
  double distance = 0;  // Kolmogorov's, with its 1e-6 quantile
  for (std::size_t k = 0; k < places.size(); ++k)
    distance = std::max(distance, std::abs(places[k] - (static_cast<double>(k) + 0.5) / alarms));
  EXPECT_LT(distance, 2.7 / std::sqrt(alarms));
}

TEST(Receiver, WhatIsTooBrightClipsAndReadsLong) {
  BeamOptions options;
  options.saturation = true;
  options.saturation_signal = 20;
  options.saturation_bias_m = 0.04;
  receive({echo_at(15, 200)}, quiet(), options, 1, [&](const Returns& a, const Returns&) {
    EXPECT_NEAR(a.echoes.range_m[5], 15 + 0.04 * 0.5, 1e-9);  // ten times, of a hundred
    EXPECT_EQ(a.true_range_m[5], 15);
    EXPECT_EQ(a.echoes.intensity[5], 255);
    EXPECT_EQ(a.kind[5], ReturnKind::saturated);
  });
  receive({echo_at(15, 19)}, quiet(), options, 1, [&](const Returns& a, const Returns&) {
    EXPECT_EQ(a.echoes.range_m[5], 15);
    EXPECT_EQ(a.kind[5], ReturnKind::surface);
  });
}

TEST(Receiver, RangesWalkWithBrightness) {
  BeamOptions options;
  options.range_walk_m = 0.01;
  for (const auto& [signal, bias_m] : {std::pair{0.002f, -0.01}, {0.02f, -0.01}, {0.2f, 0.0}, {2.0f, 0.01}})
    receive({echo_at(15, signal)}, quiet(), options, 1, [&, bias = bias_m](const Returns& a, const Returns&) {
      EXPECT_NEAR(a.echoes.range_m[5], 15 + bias, 1e-8);
    });
}

TEST(Receiver, DualReturnsLeaveTheFirstOnesDrawsAlone) {
  BeamOptions strongest, dual;
  strongest.false_alarms_per_shot = 1e-9;  // the same way, without a second return
  dual.returns = "dual";
  std::vector<Returns> a, b;
  const std::vector<Echo> echoes{echo_at(30, 0.3f), echo_at(33, 0.1f)};
  receive(echoes, {}, strongest, 3, [&](const Returns& first, const Returns&) { a.push_back(first); });
  receive(echoes, {}, dual, 3, [&](const Returns& first, const Returns&) { b.push_back(first); });
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].echoes.range_m, b[k].echoes.range_m);
    EXPECT_EQ(a[k].echoes.intensity, b[k].echoes.intensity);
  }
}

}  // namespace
}  // namespace tarmac::sim::lidar
