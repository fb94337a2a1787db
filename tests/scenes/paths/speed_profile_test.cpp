#include "scenes/paths/speed_profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "tests/support/numeric_jet.h"

namespace tarmac::scenes {
namespace {

using tests::derivative_of;

SpeedProfile make_profile(const SpeedPlan& plan, double path_m, double ripple) {
  std::vector<SpeedProfile::Problem> problems;
  const Waves waves(ripple, 15, 90, 4, core::RandomStream(1, "test/jitter"));
  SpeedProfile profile(plan, path_m, waves.integral(), problems);
  for (const auto& problem : problems) ADD_FAILURE() << problem.event << ": " << problem.message;
  return profile;
}

SpeedPlan brake() {
  SpeedPlan plan;
  plan.events = {{.to_m_s = 7, .peak_m_s2 = 1.8}, {.to_m_s = 2.5, .peak_m_s2 = 5.5, .at_m = 69}};
  plan.stop_peak_m_s2 = 1;
  return plan;
}

TEST(SpeedProfile, DerivativesMatchDifferencesThroughRampsAndRipple) {
  const SpeedProfile profile = make_profile(brake(), 100, 0.02);
  const auto f = [&](double t) { return profile.at(t).f; };
  const auto d1 = [&](double t) { return profile.at(t).d1; };
  const auto d2 = [&](double t) { return profile.at(t).d2; };
  for (double t = 3.05; t < 35; t += 0.173) {
    const Jet s = profile.at(t);
    EXPECT_NEAR(s.d1, derivative_of(f, t, 2e-3), 2e-8) << t;
    EXPECT_NEAR(s.d2, derivative_of(d1, t, 2e-3), 2e-6) << t;
    EXPECT_NEAR(s.d3, derivative_of(d2, t, 2e-3), 2e-4) << t;
  }
}

TEST(SpeedProfile, OnsetAndAntiLockHaveExactDerivativesAndKeepTheDistance) {
  SpeedPlan plan = brake();
  plan.events[0].onset_s = 0.5;
  plan.events[1].onset_s = 0.2, plan.events[1].abs_m_s2 = 1, plan.events[1].abs_hz = 6;
  const SpeedProfile profile = make_profile(plan, 100, 0.02);
  const auto f = [&](double t) { return profile.at(t).f; };
  const auto d1 = [&](double t) { return profile.at(t).d1; };
  const auto d2 = [&](double t) { return profile.at(t).d2; };
  for (double t = 3.03; t < 25; t += 0.0373) {
    const Jet s = profile.at(t);
    EXPECT_NEAR(s.d1, derivative_of(f, t, 1e-3), 1e-8) << t;
    EXPECT_NEAR(s.d2, derivative_of(d1, t, 1e-3), 1e-6) << t;
    EXPECT_NEAR(s.d3, derivative_of(d2, t, 1e-3), 1e-3) << t;
  }
  const auto& ramp = profile.ramps()[2];
  EXPECT_DOUBLE_EQ(ramp.duration_s, 4.5 / 5.5 + 0.2);
  const Jet before = profile.planned(ramp.end_s() - 1e-9), after = profile.planned(ramp.end_s() + 1e-9);
  EXPECT_NEAR(before.f, after.f, 1e-8);
  EXPECT_NEAR(before.d1, 2.5, 1e-9);
  double slowest = 1e9;
  for (double t = ramp.t_s; t < ramp.end_s(); t += 1e-3) slowest = std::min(slowest, profile.at(t).d1);
  EXPECT_GT(slowest, 2.3);
}

TEST(SpeedProfile, RestIsExactlyRestBeforeAndAfter) {
  const SpeedProfile profile = make_profile(brake(), 100, 0.02);
  for (const double t : {0.0, 1.234, 3.0}) {
    EXPECT_EQ(profile.at(t).f, 0) << t;
    EXPECT_EQ(profile.at(t).d1, 0) << t;
  }
  const double end_s = profile.ramps().back().end_s();
  for (const double t : {0.1, 7.7, 1000.0}) {
    EXPECT_EQ(profile.at(end_s + t).f, profile.at(end_s + 0.05).f) << t;
    EXPECT_EQ(profile.at(end_s + t).d1, 0) << t;
    EXPECT_EQ(profile.at(end_s + t).d2, 0) << t;
  }
}

TEST(SpeedProfile, BrakesWithThePeakAtThePlaceAndStopsAtTheEnd) {
  const SpeedProfile profile = make_profile(brake(), 100, 0);
  ASSERT_EQ(profile.ramps().size(), 4u);
  const auto& ramp = profile.ramps()[2];
  EXPECT_NEAR(profile.at(ramp.t_s).f, 69, 1e-12);
  double peak = 0;
  for (double t = ramp.t_s; t < ramp.end_s(); t += 1e-3) peak = std::min(peak, profile.at(t).d2);
  EXPECT_NEAR(peak, -5.5, 1e-4);
  EXPECT_DOUBLE_EQ(profile.at(ramp.end_s()).d1, 2.5);
  EXPECT_NEAR(profile.at(100).f, 100, 1e-12);
}

TEST(SpeedProfile, RippleIsAShareOfTheSpeedAndAlwaysOnWhileMoving) {
  SpeedPlan plan;
  plan.start_m_s = 5;
  plan.stop_peak_m_s2 = 0;
  const SpeedProfile profile = make_profile(plan, 1e5, 0.015);
  double sum2 = 0;
  constexpr int n = 100000;
  for (int k = 0; k < n; ++k) sum2 += std::pow(profile.at(k * 0.01).d1 / 5 - 1, 2);
  EXPECT_NEAR(std::sqrt(sum2 / n), 0.015, 0.001);
}

TEST(SpeedProfile, NamesTheEventThatDoesNotFit) {
  const auto problem_of = [](std::vector<SpeedEvent> events) {
    SpeedPlan plan;
    plan.events = std::move(events);
    plan.stop_peak_m_s2 = 0;
    std::vector<SpeedProfile::Problem> problems;
    const SpeedProfile profile(plan, 100, Waves(), problems);
    EXPECT_EQ(problems.size(), 1u);
    return problems.empty() ? SpeedProfile::Problem{99, ""} : problems[0];
  };
  const auto too_late = problem_of({{.to_m_s = 7}, {.to_m_s = 2, .peak_m_s2 = 1, .by_m = 30}});
  EXPECT_EQ(too_late.event, 1u);
  EXPECT_NE(too_late.message.find("raise peak_m_s2"), std::string::npos) << too_late.message;
  EXPECT_NE(problem_of({{.to_m_s = 7, .at_m = 3}}).message.find("stands still"), std::string::npos);
  EXPECT_NE(problem_of({{.to_m_s = 7, .at_s = 3, .at_m = 3}}).message.find("exclude"), std::string::npos);
  EXPECT_NE(problem_of({{.to_m_s = 7, .peak_m_s2 = 7, .onset_s = 1.5}}).message.find("onset_s"), std::string::npos);
  EXPECT_NE(problem_of({{.to_m_s = 7}, {.to_m_s = 5, .at_s = 4}}).message.find("before the end"), std::string::npos);
}

}  // namespace
}  // namespace tarmac::scenes
