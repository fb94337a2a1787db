// Shipped drives and what a drive can be told, against the figures of ordinary vehicles and drivers.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "sim/truth/motion.h"
#include "tests/sim/truth/stand_turn.h"
#include "tests/support/constants.h"

namespace tarmac::sim::truth {
namespace {

using namespace core;

using tests::deg;

double forward(const Kinematics& k) {
  return k.T_world_body.linear().col(0).dot(k.a_world);
}
double pitch_deg(const Kinematics& k) {
  return -std::asin(k.T_world_body.linear()(2, 0)) * deg;
}

TEST(EmergencyBrake, HasTheFiguresOfOne) {
  const auto motion = tests::shipped_drive("emergency-brake", 34);
  double hardest = 0, dive = 0, rebound = 0, brake_s = 0, stop_s = 0;
  for (double t = 8; t < 16; t += 1e-3) {
    const Kinematics k = motion->at(time_from_s(t));
    hardest = std::min(hardest, forward(k));
    if (forward(k) < -3 && brake_s == 0) brake_s = t;
    dive = std::max(dive, pitch_deg(k));
    const double speed = k.v_world.head<2>().norm();
    if (brake_s > 0 && stop_s == 0 && speed < 0.15) stop_s = t;
    if (stop_s > 0 && t < stop_s + 0.6) rebound = std::max(rebound, forward(k));
  }
  std::printf("emergency-brake: %.1f m/s^2 from %.2f s, standing at %.2f s, dive %.1f deg, rebound %.1f m/s^2\n",
              hardest, brake_s, stop_s, dive, rebound);
  EXPECT_LT(hardest, -5);
  EXPECT_GT(hardest, -10) << "7 and the ripple and how the body surges";
  EXPECT_GT(dive, 1);
  EXPECT_LT(dive, 3.2);
  EXPECT_GT(stop_s - brake_s, 1);
  EXPECT_LT(stop_s - brake_s, 1.7);
  EXPECT_GT(rebound, 1) << "the jerk back when it stands";
  EXPECT_LT(motion->at(time_from_s(33)).v_world.norm(), 0.05);
}

/// Without suspension and shaking, so that the profile itself is seen.
std::shared_ptr<const SmoothTrajectory> bare(const std::string& speed, double duration_s) {
  return make_motion(
      ConfigNode::parse("kind: drive\nrest_s: 0\npath: [{straight_m: 900}]\nstop_peak_m_s2: 0\n"
                        "jitter: {speed_fraction_rms: 0}\nwander: {lateral_rms_m: 0}\n"
                        "road: {roughness: none, joint_spacing_m: 0}\nsuspension: {dive_deg_per_m_s2: 0}\n"
                        "vibration: {engine_rms_m_s2: 0, engine_rms_deg_s: 0, rolling_rms_m_s2: 0, "
                        "rolling_rms_deg_s: 0}\n" +
                            speed,
                        "test.yaml"),
      duration_from_s(duration_s), nullptr, 1);
}

TEST(Onset, AccelerationComesUpWithinItStaysAndGoes) {
  const auto motion = bare("start: {speed_m_s: 8}\nspeed: [{at_s: 2, to_m_s: 0, peak_m_s2: 6, onset_s: 0.2}]\n", 5);
  const auto a = [&](double t) { return motion->at(time_from_s(t)).a_world.x(); };
  EXPECT_NEAR(a(2), 0, 1e-12);
  for (double t = 2.2; t <= 2 + 8 / 6.0; t += 0.01) EXPECT_NEAR(a(t), -6, 1e-9) << t;
  EXPECT_NEAR(a(2 + 8 / 6.0 + 0.2), 0, 1e-9);
  double jerk = 0;
  for (double t = 2; t < 2.2; t += 1e-3) jerk = std::max(jerk, std::abs(a(t + 1e-3) - a(t)) / 1e-3);
  EXPECT_NEAR(jerk, 2 * 6 / 0.2, 1) << "twice the mean";
  EXPECT_NEAR(motion->pose(time_from_s(5)).translation().x(), 8 * 2 + 4 * (8 / 6.0 + 0.2), 1e-9)
      << "half the speed, on average";
}

TEST(AntiLock, RipplesAtItsFrequencyAndMovesNothingForGood) {
  const std::string brake = "start: {speed_m_s: 8}\nspeed: [{at_s: 2, to_m_s: 0, peak_m_s2: 6, onset_s: 0.2";
  const auto with = bare(brake + ", abs_m_s2: 1, abs_hz: 6}]\n", 5), without = bare(brake + "}]\n", 5);
  double largest = 0;
  int crossings = 0;
  double before = 0;
  for (double t = 2.25; t < 3.25; t += 1e-3) {
    const double ripple = with->at(time_from_s(t)).a_world.x() - without->at(time_from_s(t)).a_world.x();
    largest = std::max(largest, std::abs(ripple));
    crossings += before * ripple < 0, before = ripple;
  }
  EXPECT_NEAR(largest, 1, 0.15);
  EXPECT_NEAR(crossings, 12, 1) << "twice a period, over a second";
  EXPECT_NEAR(with->pose(time_from_s(5)).translation().x(), without->pose(time_from_s(5)).translation().x(), 1e-12);
}

TEST(Surge, BodyIsPushedForwardByBrakingAndSwingsBack) {
  const std::string brake = "start: {speed_m_s: 8}\nspeed: [{at_s: 2, to_m_s: 0, peak_m_s2: 6, onset_s: 0.2}]\n";
  const auto with = bare(brake, 6);
  const auto surging = make_motion(
      ConfigNode::parse(
          "kind: drive\nrest_s: 0\npath: [{straight_m: 900}]\nstop_peak_m_s2: 0\njitter: {speed_fraction_rms: 0}\n"
          "wander: {lateral_rms_m: 0}\nroad: {roughness: none, joint_spacing_m: 0}\n"
          "suspension: {dive_deg_per_m_s2: 0, surge_hz: 3, surge_damping: 0.15}\n"
          "vibration: {engine_rms_m_s2: 0, engine_rms_deg_s: 0, rolling_rms_m_s2: 0, rolling_rms_deg_s: 0}\n" +
              brake,
          "test.yaml"),
      duration_from_s(6), nullptr, 1);
  const auto shift = [&](double t) {
    return surging->pose(time_from_s(t)).translation().x() - with->pose(time_from_s(t)).translation().x();
  };
  const double steady = 6 / std::pow(2 * std::numbers::pi * 3, 2);
  EXPECT_NEAR(shift(1.9), 0, 1e-12);
  EXPECT_NEAR(shift(3.2), steady, 0.25 * steady) << "a / w^2, still ringing a little";
  double back = 0, jerk_back = 0;
  for (double t = 3.4; t < 4.2; t += 1e-3) {
    back = std::min(back, shift(t));
    jerk_back =
        std::max(jerk_back, std::abs(surging->at(time_from_s(t)).a_world.x() - with->at(time_from_s(t)).a_world.x()));
  }
  EXPECT_LT(back, -0.2 * steady);
  EXPECT_GT(jerk_back, 1);
  EXPECT_NEAR(shift(6), 0, 0.05 * steady);
}

struct Speeds {
  double mean = 0, rms = 0, least = 1e9, most = 0, length_m = 0;
};
Speeds speeds_of(const SmoothTrajectory& motion, double from_s, double to_s) {
  Speeds s;
  double sum = 0, sum2 = 0;
  int n = 0;
  for (double t = from_s; t < to_s; t += 0.01, ++n) {
    const double v = motion.at(time_from_s(t)).v_world.head<2>().norm();
    sum += v, sum2 += v * v;
    s.least = std::min(s.least, v), s.most = std::max(s.most, v);
    s.length_m += v * 0.01;
  }
  s.mean = sum / n;
  s.rms = std::sqrt(sum2 / n - s.mean * s.mean);
  return s;
}

TEST(SpeedRipple, IsAShareOfTheSpeedAtEverySpeedAndSeed) {
  // Survey, taxiway, highway: 1.5 % of the speed, with waves of its own length for each.
  for (const auto& [speed, jitter] : {std::pair{4.2, "min_wavelength_m: 15, max_wavelength_m: 90"},
                                      std::pair{6.5, "min_wavelength_m: 15, max_wavelength_m: 90"},
                                      std::pair{30.0, "min_wavelength_m: 60, max_wavelength_m: 400"}}) {
    double share2 = 0;
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      const auto motion = make_motion(
          ConfigNode::parse(
              fmt::format("kind: drive\nrest_s: 0\nstart: {{speed_m_s: {}}}\npath: [{{straight_m: 9000}}]\n"
                          "stop_peak_m_s2: 0\njitter: {{speed_fraction_rms: 0.015, {}}}\nroad: {{roughness: none}}\n",
                          speed, jitter),
              "test.yaml"),
          duration_from_s(90), nullptr, seed);
      const Speeds s = speeds_of(*motion, 0, 90);
      share2 += std::pow(s.rms / s.mean, 2) / 2;
      EXPECT_NEAR(s.mean, speed, 0.02 * speed);
    }
    EXPECT_NEAR(std::sqrt(share2), 0.015, 0.003) << speed;
  }
}

TEST(TightTurn, TurnsAtTheRatesOfATugAndPitchesAtItsTyresFrequency) {
  const auto motion = tests::shipped_drive("tight-turn-tug", 46);
  double rate = 0, fastest = 0, pitch_rate2 = 0;
  int n = 0;
  for (double t = 5; t < 44; t += 1e-3, ++n) {
    const Kinematics k = motion->at(time_from_s(t));
    fastest = std::max(fastest, k.v_world.norm());
    rate = std::max(rate, std::abs(k.omega_body.z()));
    pitch_rate2 += k.omega_body.y() * k.omega_body.y();
  }
  std::printf("tight-turn-tug: %.2f m/s, %.2f rad/s, pitch rate %.2f deg/s rms\n", fastest, rate,
              std::sqrt(pitch_rate2 / n) * deg);
  EXPECT_GT(rate, 0.4);
  EXPECT_LT(rate, 0.65);
  EXPECT_LT(fastest, 2.7);
  EXPECT_GT(std::sqrt(pitch_rate2 / n) * deg, 0.8);
  EXPECT_LT(std::sqrt(pitch_rate2 / n) * deg, 5);
}

}  // namespace
}  // namespace tarmac::sim::truth
