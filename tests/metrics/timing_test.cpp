/// Acceptance of "residual vs point time": each fault of timing is found for what it is, with its size, and nothing is
/// found where there is nothing, or where nothing can be told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "metrics/block_bootstrap.h"
#include "metrics/lag.h"
#include "metrics/residuals.h"
#include "tests/metrics/fabricate.h"
#include "tests/metrics/timing_world.h"

namespace tarmac::metrics::tests {
namespace {

using namespace core;
using Verdict = Finding::Verdict;
using testing::HasSubstr;

/// A method that measures its motion inside the sweeps, `late_s` behind the points.
Method measured(const TimingWorld& world, double late_s = 0) {
  return {.placed_by = [&world, late_s](int k, double stamp_s) {
    return world.truth(world.begin_s(k) + stamp_s - late_s);
  }};
}

Finding finding(const Evidence& evidence, const std::string& topic) {
  for (const Finding& f : diagnose(evidence))
    if (f.topic == topic) return f;
  ADD_FAILURE() << "no finding " << topic;
  return {};
}

void expect_only(const Evidence& evidence, const std::vector<std::string>& topics) {
  for (const Finding& f : diagnose(evidence)) {
    if (f.topic == "timing" || f.topic == "residual-trend") continue;
    const bool expected = std::find(topics.begin(), topics.end(), f.topic) != topics.end();
    EXPECT_EQ(f.verdict == Verdict::found, expected) << f.topic << ": " << f.words;
  }
}

TEST(ResidualTiming, ACleanMethodShowsNoiseOnly) {
  const TimingWorld world(1);
  const Evidence evidence = world.examine(measured(world));
  expect_only(evidence, {});
  EXPECT_EQ(finding(evidence, "timing").verdict, Verdict::nothing_found);
  EXPECT_THAT(finding(evidence, "timing").words, HasSubstr("Noise only"));
  EXPECT_NEAR(evidence.spread_m, 0.02, 0.001);
  ASSERT_TRUE(evidence.slopes);
  EXPECT_TRUE(evidence.slopes->inside);
}

TEST(ResidualTiming, OfTwentyCleanDrivesNoneRaisesAnAlarm) {
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const TimingWorld world(seed, 60);
    for (const Finding& f : diagnose(world.examine(measured(world)))) alarms += f.verdict == Verdict::found;
  }
  EXPECT_EQ(alarms, 0);
}

TEST(ResidualTiming, AnOffsetOfClocksIsTheSlopeOverTheChangeOfRate) {
  for (const double late_s : {0.005, -0.003, 0.012}) {
    const TimingWorld world(2);
    const Evidence evidence = world.examine(measured(world, late_s), 0.01);
    expect_only(evidence, {"clock-offset"});
    ASSERT_TRUE(evidence.slopes);
    const Bootstrapped& fitted = evidence.slopes->lag_rotation_s;
    EXPECT_NEAR(fitted.value, late_s, std::max(4 * fitted.sigma, 0.02 * std::abs(late_s)));
    // A sweep's 200 upright rows at a lever of 12 m and 10 mm of noise know their slope to 0.01 / (12 sqrt(200 / 12)) =
    // 0.2 mrad an axis; the rate changes by some 0.06 rad/s a sweep, there are 150: 0.2e-3 / 0.06 / sqrt(150) = 0.3 ms.
    EXPECT_LT(fitted.sigma, 4.5e-4);
    EXPECT_THAT(finding(evidence, "clock-offset").words, HasSubstr(late_s > 0 ? "late" : "early"));
  }
}

TEST(ResidualTiming, AWrongScaleOfStampsIsFoundWithItsSize) {
  for (const double scale : {1.15, 0.85}) {
    const TimingWorld world(3);
    Method method = measured(world);
    method.stamp_s = [scale](double t_s) { return scale * t_s; };
    const Evidence evidence = world.examine(method);
    expect_only(evidence, {"stamp-scale"});
    // Stamps that run 1.15 times as fast overdo the motion by 1 - 1 / 1.15 of what passes by the stamps.
    EXPECT_NEAR(evidence.slopes->scale_translation.value, 1 - 1 / scale, 0.02);
    EXPECT_THAT(finding(evidence, "stamp-scale").words, HasSubstr(scale > 1 ? "overdone" : "underdone"));
  }
}

TEST(ResidualTiming, AWrongUnitIsAMotionThatIsNotUndone) {
  const TimingWorld world(4);
  Method method = measured(world);
  method.stamp_s = [](double t_s) { return t_s / 1000; };
  const Evidence evidence = world.examine(method);
  const Finding found = finding(evidence, "stamp-scale");
  EXPECT_EQ(found.verdict, Verdict::found);
  EXPECT_THAT(found.words, HasSubstr("wrong unit"));
}

TEST(ResidualTiming, ReversedStampsUndoTheMotionBackwards) {
  const TimingWorld world(5);
  Method method = measured(world);
  method.stamp_s = [](double t_s) { return TimingWorld::kSpan - t_s; };
  const Evidence evidence = world.examine(method);
  const Finding found = finding(evidence, "stamp-scale");
  EXPECT_EQ(found.verdict, Verdict::found);
  EXPECT_THAT(found.words, HasSubstr("reversed"));
  EXPECT_NEAR(evidence.slopes->scale_translation.value, 2, 0.1);
  EXPECT_GT(evidence.stamps.descending_share, 0.99);
}

TEST(ResidualTiming, QuantisedStampsMakeASawToothInsideEachStamp) {
  const TimingWorld world(6);
  Method method = measured(world);
  method.stamp_s = [](double t_s) { return 0.01 * std::floor((t_s + 1e-9) / 0.01); };
  const Evidence evidence = world.examine(method);
  const Finding found = finding(evidence, "stamp-quantisation");
  EXPECT_EQ(found.verdict, Verdict::found) << found.words;
  ASSERT_TRUE(evidence.slopes);
  EXPECT_NEAR(evidence.slopes->quantum_s.value, 0.01, std::max(4 * evidence.slopes->quantum_s.sigma, 5e-4));
  EXPECT_NEAR(evidence.stamps.gap_s, 0.01, 1e-4);
}

TEST(ResidualTiming, StampsAsFineAsTheFiringAreNotCalledQuantised) {
  const TimingWorld world(6);
  const Evidence evidence = world.examine(measured(world));
  EXPECT_FALSE(evidence.stamps.quantised());
  EXPECT_EQ(finding(evidence, "stamp-quantisation").verdict, Verdict::nothing_found);
}

/// As kiss-icp places points: by the increment of the sweep before, at constant twist.
TEST(ResidualTiming, TheMotionOfTheSweepBeforeLagsByOneSweep) {
  const TimingWorld world(7);
  Method method{.placed_by = [&world](int k, double stamp_s) -> SE3 {
                  const double t0 = world.begin_s(k) - TimingWorld::kPeriod;
                  const SE3 D = world.truth(t0).inverse() * world.truth(t0 + TimingWorld::kPeriod);
                  return world.truth(t0 + TimingWorld::kPeriod) *
                         se3::exp(stamp_s / TimingWorld::kPeriod * se3::log(D));
                },
                .shape = Method::Shape::screw};
  const Evidence evidence = world.examine(method);
  expect_only(evidence, {"missing-acceleration"});
  const Finding found = finding(evidence, "missing-acceleration");
  EXPECT_THAT(found.words, HasSubstr("sweep before"));
  EXPECT_NEAR(evidence.slopes->lag_rotation_s.value, TimingWorld::kPeriod, 0.02);
  EXPECT_FALSE(evidence.slopes->inside);
  EXPECT_EQ(finding(evidence, "stamp-scale").verdict, Verdict::cannot_be_told) << "its model takes a scale up unseen";
  EXPECT_EQ(finding(evidence, "clock-offset").verdict, Verdict::cannot_be_told);
  EXPECT_THAT(finding(evidence, "clock-offset").words, HasSubstr("no plot over the point's time can show it"));
}

/// As CT-ICP does: right at both ends, straight between.
TEST(ResidualTiming, AConstantTwistThatFitsItsOwnSweepBends) {
  const TimingWorld world(8);
  Method method{.placed_by = [&world](int k, double stamp_s) -> SE3 {
                  const SE3 T0 = world.truth(world.begin_s(k)), T1 = world.truth(world.begin_s(k) + TimingWorld::kSpan);
                  return T0 * se3::exp(stamp_s / TimingWorld::kSpan * se3::log(T0.inverse() * T1));
                },
                .shape = Method::Shape::screw};
  const Evidence evidence = world.examine(method, 0.005);
  ASSERT_TRUE(evidence.slopes);
  EXPECT_NEAR(evidence.slopes->omitted_rotation.value, 1, 0.25);
  EXPECT_LT(std::abs(evidence.slopes->lag_rotation_s.value), 0.01);
}

TEST(ResidualTiming, AWrongUnitShowsInTheStampsAlone) {
  Evidence evidence;  // of a method without residuals
  const auto scale = [&] { return diagnose(evidence).front(); };
  for (const auto& [span, verdict] : {std::pair{1e-3, Verdict::found},
                                      {1e3, Verdict::found},
                                      {1.0, Verdict::cannot_be_told},
                                      {0.2, Verdict::cannot_be_told}}) {
    evidence.stamps.span_share = span;
    EXPECT_EQ(scale().topic, "stamp-scale");
    EXPECT_EQ(scale().verdict, verdict) << span;
  }
  evidence.stamps.span_share = 1e-3;
  EXPECT_THAT(scale().words, HasSubstr("wrong unit"));
}

TEST(ResidualTiming, OnePoseASweepLeavesTheWholeMotion) {
  const TimingWorld world(9);
  Method method{.placed_by = [&world](int k, double) { return world.truth(world.begin_s(k)); },
                .shape = Method::Shape::held};
  const Evidence evidence = world.examine(method);
  const Finding found = finding(evidence, "stamp-scale");
  EXPECT_EQ(found.verdict, Verdict::found);
  EXPECT_THAT(found.words, HasSubstr("holds one pose"));
  EXPECT_NEAR(evidence.slopes->scale_translation.value, -1, 0.05);
  EXPECT_NEAR(evidence.slopes->scale_rotation.value, -1, 0.1);
}

TEST(ResidualTiming, AConstantOffsetOfALidarOnlyMethodIsNotClaimed) {
  // Every stamp is late by 5 ms, and the method knows no other clock: nothing in its residuals changes.
  const TimingWorld world(10);
  Method method = measured(world);
  method.shape = Method::Shape::screw;
  const Evidence evidence = world.examine(method);
  EXPECT_EQ(finding(evidence, "clock-offset").verdict, Verdict::cannot_be_told);
}

TEST(ResidualTiming, SeriesAndRowsAreThereAndTheBandHoldsTheTruth) {
  const TimingWorld world(11);
  RowSet rows("causal");
  std::vector<Series> series;
  Method method = measured(world);
  method.stamp_s = [](double t_s) { return 1.2 * t_s; };
  world.examine(method, 0.02, rows, series);
  std::vector<std::string> names;
  for (const Series& s : series) names.push_back(s.name);
  EXPECT_THAT(names, testing::IsSupersetOf(
                         {"residual_mean_by_phase", "residual_spread_by_phase", "displacement_forward_by_phase",
                          "displacement_left_by_phase", "displacement_up_by_phase", "residual_slope_vs_domega",
                          "residual_slope_vs_domega_fit", "residual_slope_vs_dv", "residual_slope_vs_dv_fit"}));
  for (const Series& s : series) {
    EXPECT_EQ(s.x.size(), s.y.size()) << s.name;
    if (s.name.find("by_phase") == std::string::npos) continue;
    ASSERT_EQ(s.low.size(), s.y.size()) << s.name;
    for (std::size_t b = 0; b < s.y.size(); ++b) {
      if (std::isfinite(s.y[b])) {
        EXPECT_LE(s.low[b], s.high[b]) << s.name;
      }
    }
  }
}

TEST(ResidualTiming, WithoutResidualsItSaysSo) {
  Estimate estimate;
  std::vector<SweepDiagnostics> none;
  const DiagnosticsSource source = diagnostics_of(none);
  RowSet rows("causal");
  std::vector<Series> series;
  const Evidence evidence = examine_residuals(
      {.estimate = estimate, .sweeps = {0, nullptr, {}, 0}, .diagnostics = &source}, {}, rows, series);
  for (const Finding& f : diagnose(evidence)) EXPECT_NE(f.verdict, Verdict::found) << f.topic;
  EXPECT_EQ(finding(evidence, "timing").verdict, Verdict::cannot_be_told);
  for (const Row& row : rows.rows()) EXPECT_FALSE(row.value) << row.metric;
  EXPECT_TRUE(series.empty());
}

TEST(ImpliedDisplacement, IsTheDisplacementThatMakesTheResiduals) {
  const RandomStream random(1, "test/displacement");
  const Eigen::Vector3d d(0.03, -0.02, 0.01);
  PhaseBin bin, flat;
  for (std::uint64_t k = 0; k < 200; ++k) {
    const Eigen::Vector3d n =
        Eigen::Vector3d(random.normal(k, 0), random.normal(k, 1), random.normal(k, 2)).normalized();
    bin.n += 1;
    bin.nn += n * n.transpose();
    bin.nr += n.dot(d) * n;
    flat.n += 1;
    flat.nn += Eigen::Vector3d::UnitZ() * Eigen::RowVector3d::UnitZ();
  }
  EXPECT_LT((implied_displacement(bin) - d).norm(), 1e-12);
  EXPECT_TRUE(implied_displacement(flat).array().isNaN().all()) << "flat ground tells nothing along itself";
}

class Lag : public testing::Test {
 protected:
  /// Poses at 10 Hz that are `lag_s` late, each with errors of its own.
  std::vector<PosePair> pairs(double lag_s, double noise_m, std::uint64_t seed) const {
    const RandomStream random(seed, "test/lag");
    std::vector<PosePair> all;
    for (std::uint64_t k = 0; k < 200; ++k) {
      Vector6 e;
      for (std::uint32_t c = 0; c < 6; ++c) e[c] = (c < 3 ? noise_m : noise_m / 20) * random.normal(k, c);
      const double t_s = world_.begin_s(static_cast<int>(k));
      all.push_back({static_cast<std::int64_t>(k), time_from_s(t_s), world_.truth(t_s),
                     world_.truth(t_s - lag_s) * se3::exp(e), 0});
    }
    return all;
  }
  TimingWorld world_{1};
};

TEST_F(Lag, IsFoundWithinItsOwnSigma) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto fit = fit_lag(pairs(0.005, 0.003, seed), world_.motion(), {});
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->lag_s.value, 0.005, 4 * fit->lag_s.sigma);
    EXPECT_LT(fit->lag_s.sigma, 5e-4);
  }
  const auto exact = fit_lag(pairs(-0.02, 0, 1), world_.motion(), {});
  ASSERT_TRUE(exact);
  EXPECT_NEAR(exact->lag_s.value, -0.02, 1e-6);
}

TEST_F(Lag, CorrectedPosesHaveTheErrorThatIsLeft) {
  const std::vector<PosePair> late = pairs(0.02, 0, 1);
  double worst = 0;
  for (const PosePair& pair : shifted(late, world_.motion(), 0.02))
    worst = std::max(worst, (pair.T_world_body.inverse() * pair.T_map_body).translation().norm());
  EXPECT_LT(worst, 1e-9);
}

TEST_F(Lag, CannotBeToldFromFewPoses) {
  std::vector<PosePair> few = pairs(0.005, 0.003, 1);
  few.resize(15);
  EXPECT_FALSE(fit_lag(few, world_.motion(), {}));
}

TEST_F(Lag, CannotBeToldWhereTheMotionIsSteady) {
  Vector6 twist;
  twist << 5, 0, 0, 0, 0, 0.3;
  const ConstantTwist steady(SE3::Identity(), twist, Time{}, time_from_s(100));
  const RandomStream random(1, "test/steady");
  std::vector<PosePair> all;
  for (std::uint64_t k = 0; k < 200; ++k) {
    Vector6 e;
    for (std::uint32_t c = 0; c < 6; ++c) e[c] = 1e-3 * random.normal(k, c);
    const Time t = time_from_s(1 + 0.1 * static_cast<double>(k));
    all.push_back({static_cast<std::int64_t>(k), t, steady.pose(t), steady.pose(t) * se3::exp(e), 0});
  }
  EXPECT_FALSE(fit_lag(all, steady, {}));
}

TEST(BlockBootstrap, DrawsWholeBlocksAndTheSameOnesEveryTime) {
  const auto draws = block_bootstrap(100, {.replicates = 50, .block = 10}, "test");
  for (const std::vector<int>& times : draws) {
    int sum = 0;
    for (const int n : times) sum += n;
    EXPECT_EQ(sum, 100);
  }
  EXPECT_EQ(draws, block_bootstrap(100, {.replicates = 50, .block = 10}, "test"));
  EXPECT_NE(draws, block_bootstrap(100, {.replicates = 50, .block = 10}, "another"));
}

/// The spread of means over resamples is that of the mean itself.
TEST(BlockBootstrap, GivesTheStandardErrorOfAMean) {
  const RandomStream random(3, "test/bootstrap");
  std::vector<double> x;
  for (std::uint64_t k = 0; k < 2000; ++k) x.push_back(random.normal(k));
  std::vector<double> means;
  for (const std::vector<int>& times : block_bootstrap(x.size(), {.replicates = 400, .block = 10}, "test")) {
    double sum = 0;
    for (std::size_t k = 0; k < x.size(); ++k) sum += times[k] * x[k];
    means.push_back(sum / 2000);
  }
  // 400 replicates know their spread to 1 / sqrt(800) = 3.5 %, 200 blocks the data's to 5 %.
  EXPECT_NEAR(bootstrapped(0, means).sigma, 1 / std::sqrt(2000.0), 0.2 / std::sqrt(2000.0));
}

}  // namespace
}  // namespace tarmac::metrics::tests
