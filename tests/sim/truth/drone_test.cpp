#include "sim/truth/drone.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "scenes/paths/smooth_step.h"
#include "sim/truth/motion.h"
#include "sim/truth/series.h"
#include "tests/sim/truth/stand_turn.h"
#include "tests/support/constants.h"
#include "tests/support/numeric_jet.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::sim::truth {
namespace {

using namespace core;
using Eigen::Vector3d;
using testing::AllOf;
using testing::HasSubstr;

using tests::deg;

TEST(Series, QuotientsRootsAndCompositionsHaveTheDerivativesOfWhatTheyAre) {
  // f(t) = sqrt(1 + sin(t)^2) exp(-t) / (2 + cos(3 t)) at t = 0.7
  const double t = 0.7;
  const auto f = [](double x) {
    return std::sqrt(1 + std::sin(x) * std::sin(x)) * std::exp(-x) / (2 + std::cos(3 * x));
  };
  const Series<4> x = Series<4>::line(t, 1), one = Series<4>::constant(1);
  const Series<4> s = sin_cos(x).sin;
  const Series<4> y = sqrt(one + s * s) * exp(-x) / (Series<4>::constant(2) + sin_cos(3.0 * x).cos);
  EXPECT_NEAR(y.value(), f(t), 1e-15);
  const auto d1 = [&](double at) { return tests::derivative_of(f, at, 1e-3); };
  const auto d2 = [&](double at) { return tests::derivative_of(d1, at, 1e-2); };
  EXPECT_NEAR(y.d1(), d1(t), 1e-10);
  EXPECT_NEAR(y.d2(), d2(t), 1e-6);
  // Third and fourth from the series' own at neighbours.
  const auto second = [&](double at) {
    const Series<4> u = Series<4>::line(at, 1), su = sin_cos(u).sin;
    return (sqrt(one + su * su) * exp(-u) / (Series<4>::constant(2) + sin_cos(3.0 * u).cos)).d2();
  };
  const auto third = [&](double at) { return tests::derivative_of(second, at, 1e-3); };
  EXPECT_NEAR(6 * y.c[3], third(t), 1e-8);
  EXPECT_NEAR(24 * y.c[4], tests::derivative_of(third, t, 4e-3), 1e-5);
}

TEST(Series, SmoothStepIsTheOneOfTheJets) {
  for (const double u : {-0.5, 0.0, 0.001, 0.02, 0.3, 0.5, 0.9, 0.999, 1.0, 3.0}) {
    const Series<4> s = smooth_step(Series<4>::line(u, 1));
    const Jet h = scenes::smooth_step(u);
    EXPECT_NEAR(s.c[0], h.f, 1e-15) << u;
    EXPECT_NEAR(s.c[1], h.d1, 1e-13) << u;
    EXPECT_NEAR(2 * s.c[2], h.d2, 1e-11) << u;
    EXPECT_NEAR(6 * s.c[3], h.d3, 1e-9) << u;
  }
}

std::string straight_flight(const std::string& more) {
  return "kind: drone\nrest_s: 1\ntake_off: {height_m: 5, climb_m_s: 2}\npath: [{straight_m: 300}]\nstop_peak_m_s2: 0\n"
         "jitter: {speed_fraction_rms: 0}\n" +
         more;
}

std::shared_ptr<const SmoothTrajectory> fly(const std::string& yaml, double duration_s) {
  return make_motion(ConfigNode::parse(yaml, "test.yaml"), duration_from_s(duration_s), nullptr, 1);
}

const std::string calm =
    "wind: {mean_m_s: 0, gust_m_s: 0}\n"
    "airframe: {jitter_deg: 0, rotor_rms_m_s2: 0, rotor_rms_deg_s: 0, drag_per_s: 0.2}\n";

TEST(Drone, TiltIsWhatAccelerationAndDragNeed) {
  const auto motion = fly(straight_flight(calm + "speed: [{to_m_s: 6, peak_m_s2: 2}]\n"), 30);
  for (double t = 0.5; t < 30; t += 0.25) {
    const Kinematics k = motion->at(time_from_s(t));
    const Vector3d thrust = k.a_world + Vector3d(0, 0, 9.81) + 0.2 * k.v_world;
    EXPECT_LT((thrust.normalized() - k.T_world_body.linear().col(2)).norm(), 1e-12) << t;
  }
  const Eigen::Matrix3d R = motion->pose(time_from_s(29)).linear();
  EXPECT_NEAR(std::atan2(R(0, 2), R(2, 2)), std::atan2(0.2 * 6, 9.81), 1e-12) << "steady: against drag alone";
  EXPECT_EQ(motion->at(time_from_s(0.9)).v_world, Vector3d::Zero().eval());
}

/// The mean of a gust's push is nothing, so it is the position hold's answer that wanders: an oscillator, which an
/// integration of its own equation must give back.
TEST(Drone, GivesWayToGustsAsItsPositionHoldAnswersThem) {
  const auto still = fly(straight_flight(calm), 60);
  const auto blown =
      fly(straight_flight("wind: {mean_m_s: 0, gust_m_s: 1}\nairframe: {jitter_deg: 0, rotor_rms_m_s2: 0, "
                          "rotor_rms_deg_s: 0, drag_per_s: 0.2, hold_hz: 0.12, hold_damping: 0.7}\n"),
          60);
  const auto give = [&](double t) -> Vector3d {
    return blown->pose(time_from_s(t)).translation() - still->pose(time_from_s(t)).translation();
  };
  const double hold = 2 * std::numbers::pi * 0.12;
  double push2 = 0, give2 = 0;
  int n = 0;
  for (double t = 12; t < 58; t += 0.01) {  // airborne
    const Vector3d a = blown->at(time_from_s(t)).a_world - still->at(time_from_s(t)).a_world;
    const Vector3d v = blown->at(time_from_s(t)).v_world - still->at(time_from_s(t)).v_world;
    const Vector3d push = a + 2 * 0.7 * hold * v + hold * hold * give(t);
    push2 += push.head<2>().squaredNorm() / 2, give2 += give(t).head<2>().squaredNorm() / 2, ++n;
  }
  const double push_rms = std::sqrt(push2 / n), give_rms = std::sqrt(give2 / n);
  std::printf("gusts: push %.3f m/s^2, give %.3f m\n", push_rms, give_rms);
  EXPECT_NEAR(push_rms, 0.2 * 1, 0.08) << "drag times the gusts' rms, over a minute of a slow process";
  EXPECT_GT(give_rms, 0.1);
  EXPECT_LT(give_rms, 0.5);
}

TEST(Drone, ShippedSurveyHasTheFiguresOfASurvey) {
  const auto motion = tests::shipped_drive("drone-survey", 64);
  double tilt = 0, speed = 0, accel = 0, yaw = 0, climb = 0, top = 0;
  for (double t = 0; t < 64; t += 0.005) {
    const Kinematics k = motion->at(time_from_s(t));
    tilt = std::max(tilt, std::acos(std::min(1.0, k.T_world_body.linear()(2, 2))) * deg);
    speed = std::max(speed, k.v_world.head<2>().norm());
    accel = std::max(accel, k.a_world.norm());
    yaw = std::max(yaw, std::abs(k.omega_body.z()) * deg);
    climb = std::max(climb, std::abs(k.v_world.z()));
    top = std::max(top, k.T_world_body.translation().z());
  }
  std::printf(
      "drone-survey: tilt %.1f deg, %.1f m/s, %.1f m/s^2 with rotors, yaw %.0f deg/s, climb %.1f m/s, %.1f m up\n",
      tilt, speed, accel, yaw, climb, top);
  EXPECT_GT(tilt, 8);
  EXPECT_LT(tilt, 25);
  EXPECT_NEAR(speed, 6, 2);
  EXPECT_LT(accel, 10);
  EXPECT_GT(yaw, 20);
  EXPECT_LT(yaw, 50);
  EXPECT_NEAR(climb, 3, 0.6);
  EXPECT_NEAR(top, 22, 1.5);
}

TEST(Drone, AggressiveFlightTiltsByTwentyToFortyDegrees) {
  const auto motion = fly(R"(
kind: drone
regime: aggressive
rest_s: 1
take_off: {height_m: 10, climb_m_s: 5}
path: [{straight_m: 40}, {turn_deg: 180, radius_m: 14, blend_m: 12}, {straight_m: 20}, {turn_deg: -120, radius_m: 12, blend_m: 10}, {straight_m: 60}]
speed: [{to_m_s: 9.5, peak_m_s2: 6}]
stop_peak_m_s2: 6
)",
                          25);
  double tilt = 0, rate = 0;
  for (double t = 0; t < 25; t += 0.005) {
    const Kinematics k = motion->at(time_from_s(t));
    tilt = std::max(tilt, std::acos(std::min(1.0, k.T_world_body.linear()(2, 2))) * deg);
    rate = std::max(rate, k.omega_body.norm() * deg);
  }
  std::printf("aggressive: tilt %.1f deg, %.0f deg/s\n", tilt, rate);
  EXPECT_GT(tilt, 20);
  EXPECT_LT(tilt, 45);
  EXPECT_GT(rate, 80);
  EXPECT_LT(rate, 400);
}

TEST(Drone, RotorsHaveTheConfiguredRmsAndSpinUpWithinTheRest) {
  const auto with = fly(straight_flight("wind: {mean_m_s: 0, gust_m_s: 0}\nairframe: {jitter_deg: 0}\n"), 20);
  const auto without = fly(straight_flight(calm), 20);
  double a2 = 0, w2 = 0;
  int n = 0;
  for (double t = 10; t < 19; t += 0.4e-3) {
    const Kinematics k = with->at(time_from_s(t)), k0 = without->at(time_from_s(t));
    a2 += (k.a_world - k0.a_world).squaredNorm() / 3, w2 += (k.omega_body - k0.omega_body).squaredNorm() / 3, ++n;
  }
  EXPECT_NEAR(std::sqrt(a2 / n), 0.8, 0.08);
  EXPECT_NEAR(std::sqrt(w2 / n) * deg, 0.8, 0.08);
}

std::string error_of_flight(const std::string& yaml) {
  return tests::message_of<InputError>([&] { fly(yaml, 30); });
}

TEST(Drone, ErrorsNameFileLineAndField) {
  EXPECT_THAT(error_of_flight(straight_flight(
                  "speed: [{to_m_s: 20, peak_m_s2: 12, onset_s: 0.1}]\nairframe: {max_tilt_deg: 30}\n")),
              AllOf(HasSubstr("test.yaml:8"), HasSubstr("airframe"), HasSubstr("max_tilt_deg")));
  EXPECT_THAT(error_of_flight("kind: drone\nstart: {speed_m_s: 3}\npath: [{straight_m: 9}]\n"),
              AllOf(HasSubstr("test.yaml:2"), HasSubstr("start.speed_m_s"), HasSubstr("on the ground")));
  EXPECT_THAT(error_of_flight("kind: drone\npath: [{straight_m: 90}]\nspeed:\n  - {to_m_s: 3, abs_m_s2: 1}\n"),
              AllOf(HasSubstr("test.yaml:4"), HasSubstr("abs_m_s2")));
}

}  // namespace
}  // namespace tarmac::sim::truth
