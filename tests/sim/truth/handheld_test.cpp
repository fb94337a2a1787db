// A person's gait, against what gait studies report for walking and running.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "sim/truth/gait.h"
#include "sim/truth/motion.h"
#include "tests/sim/truth/stand_turn.h"
#include "tests/support/constants.h"

namespace tarmac::sim::truth {
namespace {

using namespace core;
using Eigen::Vector3d;
using testing::HasSubstr;

using tests::deg;

/// Straight on at one speed, without looks around.
std::shared_ptr<const SmoothTrajectory> straight_on(const std::string& gait, double speed_m_s, std::uint64_t seed,
                                                    const std::string& more = "") {
  const std::string yaml = "kind: handheld\ngait_name: " + gait +
                           "\nrest_s: 1\npath: [{straight_m: 300}]\nspeed: [{to_m_s: " + std::to_string(speed_m_s) +
                           ", peak_m_s2: 1.5}]\n" + more;
  return make_motion(ConfigNode::parse(yaml, "test.yaml"), duration_from_s(50), nullptr, seed);
}

struct Figures {
  double rate_rms_deg_s, rate_peak_deg_s, up_peak_m_s2, rise_m, sway_m, steps_hz, roll_rms_deg, pitch_rms_deg;
};

double rms(const std::vector<double>& values) {
  double mean = 0, sum2 = 0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  for (const double v : values) sum2 += (v - mean) * (v - mean);
  return std::sqrt(sum2 / static_cast<double>(values.size()));
}

/// Frequency at which a signal of 1 ms samples has most of its power, between 1.2 and 4 Hz.
double strongest_hz(const std::vector<double>& x) {
  double best = 0, best_hz = 0;
  for (double hz = 1.2; hz < 4; hz += 0.01) {
    double c = 0, s = 0;
    for (std::size_t k = 0; k < x.size(); k += 10) {
      const double angle = 2 * std::numbers::pi * hz * static_cast<double>(k) * 1e-3;
      c += x[k] * std::cos(angle), s += x[k] * std::sin(angle);
    }
    if (c * c + s * s > best) best = c * c + s * s, best_hz = hz;
  }
  return best_hz;
}

Figures figures_of(const SmoothTrajectory& motion) {
  Figures f{};
  double rate2 = 0;
  std::vector<double> z, y, up, roll, pitch;
  for (double t = 8; t < 48; t += 1e-3) {
    const Kinematics k = motion.at(time_from_s(t));
    const Eigen::Matrix3d R = k.T_world_body.linear();
    const double rate = k.omega_body.norm() * deg;
    rate2 += rate * rate;
    f.rate_peak_deg_s = std::max(f.rate_peak_deg_s, rate);
    f.up_peak_m_s2 = std::max(f.up_peak_m_s2, k.a_world.z());
    z.push_back(k.T_world_body.translation().z());
    y.push_back(k.T_world_body.translation().y());
    up.push_back(k.a_world.z());
    roll.push_back(std::atan2(R(2, 1), R(2, 2)) * deg);
    pitch.push_back(-std::asin(R(2, 0)) * deg);
  }
  f.rate_rms_deg_s = std::sqrt(rate2 / static_cast<double>(z.size()));
  f.rise_m = 2 * std::numbers::sqrt2 * rms(z);  // of a sine
  f.sway_m = 2 * std::numbers::sqrt2 * rms(y);
  f.steps_hz = strongest_hz(up);
  f.roll_rms_deg = rms(roll), f.pitch_rms_deg = rms(pitch);
  return f;
}

void print(const char* gait, const Figures& f) {
  std::printf(
      "%s: %.1f deg/s rms, %.0f peak; up %.1f m/s^2; rise %.3f m, sway %.3f m; %.2f steps/s; roll %.1f, pitch %.1f "
      "deg\n",
      gait, f.rate_rms_deg_s, f.rate_peak_deg_s, f.up_peak_m_s2, f.rise_m, f.sway_m, f.steps_hz, f.roll_rms_deg,
      f.pitch_rms_deg);
}

void expect_between(double value, double low, double high, const char* what) {
  EXPECT_GE(value, low) << what;
  EXPECT_LE(value, high) << what;
}

TEST(Handheld, WalkHasTheFiguresOfWalking) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Figures f = figures_of(*straight_on("walk", 1.3, seed));
    print("walk", f);
    expect_between(f.rate_rms_deg_s, 15, 30, "angular rate rms");
    expect_between(f.rate_peak_deg_s, 60, 120, "angular rate peak");
    expect_between(f.steps_hz, 1.7, 2.1, "steps");
    expect_between(f.rise_m, 0.03, 0.055, "rise and fall");
    expect_between(f.roll_rms_deg, 2, 4, "roll");
    expect_between(f.pitch_rms_deg, 2, 4, "pitch");
    expect_between(f.up_peak_m_s2, 2, 4 + 5, "upward: steps, and a strike of at most 10 times 0.5");
  }
}

TEST(Handheld, BriskWalkHasTheFiguresOfOne) {
  const Figures f = figures_of(*straight_on("brisk", 1.7, 1));
  print("brisk", f);
  expect_between(f.rate_rms_deg_s, 30, 60, "angular rate rms");
  expect_between(f.steps_hz, 2, 2.3, "steps");
  expect_between(f.rise_m, 0.04, 0.07, "rise and fall");
  expect_between(f.roll_rms_deg, 3, 6, "roll");
  expect_between(f.pitch_rms_deg, 3, 6, "pitch");
}

TEST(Handheld, RunHasTheFiguresOfRunning) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Figures f = figures_of(*straight_on("run", 3, seed));
    print("run", f);
    expect_between(f.rate_rms_deg_s, 60, 120, "angular rate rms");
    expect_between(f.rate_peak_deg_s, 200, 400, "angular rate peak");
    expect_between(f.steps_hz, 2.5, 3.0, "steps");
    expect_between(f.rise_m, 0.07, 0.12, "rise and fall");
    expect_between(f.roll_rms_deg, 5, 10, "roll");
    expect_between(f.pitch_rms_deg, 5, 10, "pitch");
    expect_between(f.up_peak_m_s2, 10, 20 + 20, "upward, with a strike of at most 40 times 0.5");
  }
}

TEST(Handheld, StepsComeUnevenlyByTheirJitter) {
  const GaitOptions gait;
  const StepPhase phase(gait, 4);
  std::vector<double> lengths;
  double before = 0;
  for (int k = 1; k <= 2000; ++k) {
    double low = (k - 1) * gait.step_length_m * 0.9, high = (k + 2) * gait.step_length_m * 1.1;
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      (phase.at({middle, 1, 0, 0}).f < k ? low : high) = middle;
    }
    if (k > 1) lengths.push_back((high - before) / gait.step_length_m);
    before = high;
  }
  const double jitter = rms(lengths);
  std::printf("steps: jitter %.4f\n", jitter);
  expect_between(jitter, 0.02, 0.04, "jitter of a step's duration");
  EXPECT_NEAR(jitter, gait.rate_jitter, 0.15 * gait.rate_jitter)
      << "averaged over a step, a wave of three steps loses a sixth";
}

TEST(Handheld, AStrikeSwellsWithinFifteenMillisecondsRingsAndIsOver) {
  GaitOptions gait;
  gait.strike_m_s2 = 10;
  Strikes strikes(gait, 1);
  strikes.add(1, 1);
  double peak = 0, peak_s = 0;
  for (double t = 1; t < 1.6; t += 1e-5) {
    const double a = strikes.at(t)[2].d2;
    if (std::abs(a) > peak) peak = std::abs(a), peak_s = t - 1;
  }
  EXPECT_GT(peak, 7);  // 10, uneven by at most 30 %
  EXPECT_LT(peak, 13);
  EXPECT_LT(peak_s, 0.02);
  EXPECT_EQ(strikes.at(1)[2].d2, 0);
  EXPECT_EQ(strikes.at(1.5)[2].f, 0);
  EXPECT_LT(std::abs(strikes.at(1.3)[2].d2), 0.01 * peak) << "25 % of critical damping";
}

/// What online time offsets are estimated on: a minute with at least 20 deg/s.
TEST(Handheld, ShippedWalkIsAMinuteOfAtLeastTwentyDegreesPerSecond) {
  const auto motion = tests::shipped_drive("handheld-walk", 60);
  double sum2 = 0, peak = 0;
  for (int k = 0; k < 60000; ++k) {
    const double rate = motion->at(time_from_ns(k * 1'000'000LL)).omega_body.norm() * deg;
    sum2 += rate * rate, peak = std::max(peak, rate);
  }
  std::printf("handheld-walk: %.1f deg/s rms, %.0f peak\n", std::sqrt(sum2 / 60000), peak);
  EXPECT_GT(std::sqrt(sum2 / 60000), 20);
  EXPECT_LT(peak, 250);
}

TEST(Handheld, LooksAroundGoLeftRightAndBack) {
  const auto motion = straight_on("walk", 1.3, 1,
                                  "gait: {roll_rms_deg: 0, pitch_rms_deg: 0, yaw_deg: 0, strike_m_s2: 0}\n"
                                  "hold: {posture_deg: 0, tremor_deg: 0}\nwander: {lateral_rms_m: 0}\n"
                                  "looks: [{at_s: 10, left_deg: 60, right_deg: 45, period_s: 4}]\n");
  const auto yaw_deg = [&](double t) {
    const Eigen::Matrix3d R = motion->pose(time_from_s(t)).linear();
    return std::atan2(R(1, 0), R(0, 0)) * deg;
  };
  EXPECT_NEAR(yaw_deg(10), 0, 1e-9);
  EXPECT_NEAR(yaw_deg(11), 60, 1e-9);
  EXPECT_NEAR(yaw_deg(13), -45, 1e-9);
  EXPECT_NEAR(yaw_deg(14), 0, 1e-9);
  double fastest = 0;
  for (double t = 10; t < 14; t += 1e-3)
    fastest = std::max(fastest, std::abs(motion->at(time_from_s(t)).omega_body.z()) * deg);
  EXPECT_NEAR(fastest, 2 * 60 / 1.0, 0.1) << "2 angle / time, of 60 deg in 1 s and of 105 in 2";
}

}  // namespace
}  // namespace tarmac::sim::truth
