// Integrating perfect samples of the other motions gives them back too: trapezoid at 1 kHz for whatever has wheels, a
// rule of fourth order at 4 kHz for what is carried or flies.
#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "sim/imu/imu.h"
#include "tests/sim/truth/stand_turn.h"
#include "tests/support/constants.h"

namespace tarmac::sim {
namespace {

using namespace core;
using Eigen::Matrix3d;
using Eigen::Vector3d;

using tests::g;

struct Closure {
  double position_m, angle_deg;
};

std::vector<ImuSample> points(const SmoothTrajectory& motion, double rate_hz) {
  ImuOptions options;
  options.rate_hz = rate_hz;
  options.sampling = "point";
  return ideal_imu(motion, options, g, Time(), motion.end());
}

Closure difference(const SmoothTrajectory& motion, Time t, const Vector3d& p, const Matrix3d& R) {
  const SE3 end = motion.pose(t);
  return {(p - end.translation()).norm(), so3::angle_rad(R.transpose() * end.linear()) * 180 / std::numbers::pi};
}

enum class Rule { trapezoid, euler };

Closure integrate(const SmoothTrajectory& motion, double rate_hz, Rule rule = Rule::trapezoid) {
  const std::vector<ImuSample> samples = points(motion, rate_hz);
  const Kinematics start = motion.at(samples.front().t);
  Matrix3d R = start.T_world_body.linear();
  Vector3d p = start.T_world_body.translation(), v = start.v_world;
  for (std::size_t k = 0; k + 1 < samples.size(); ++k) {
    const double dt = to_s(samples[k + 1].t - samples[k].t);
    const bool euler = rule == Rule::euler;
    const Vector3d rate =
        euler ? samples[k].gyro_rad_s : Vector3d((samples[k].gyro_rad_s + samples[k + 1].gyro_rad_s) / 2);
    const Matrix3d next = R * so3::exp(rate * dt);
    const Vector3d a0 = R * samples[k].accel_m_s2 - Vector3d(0, 0, g);
    const Vector3d a1 = next * samples[k + 1].accel_m_s2 - Vector3d(0, 0, g);
    p += euler ? Vector3d(v * dt) : Vector3d(v * dt + (2 * a0 + a1) * (dt * dt / 6));
    v += euler ? Vector3d(a0 * dt) : Vector3d((a0 + a1) * (dt / 2));
    R = next;
  }
  return difference(motion, samples.back().t, p, R);
}

struct State {
  Matrix3d R;
  Vector3d v, p;
};
State slope(const State& x, const ImuSample& s) {
  return {x.R * so3::hat(s.gyro_rad_s), x.R * s.accel_m_s2 - Vector3d(0, 0, g), x.v};
}
State moved(const State& x, double h, const State& d) {
  return {x.R + h * d.R, x.v + h * d.v, x.p + h * d.p};
}

/// Runge and Kutta's, over two samples at a time: the one between them is its middle.
Closure fourth_order(const SmoothTrajectory& motion, double rate_hz) {
  const std::vector<ImuSample> s = points(motion, rate_hz);
  const Kinematics start = motion.at(s.front().t);
  State x{start.T_world_body.linear(), start.v_world, start.T_world_body.translation()};
  std::size_t k = 0;
  for (; k + 2 < s.size(); k += 2) {
    const double h = to_s(s[k + 2].t - s[k].t);
    const State a = slope(x, s[k]), b = slope(moved(x, h / 2, a), s[k + 1]), c = slope(moved(x, h / 2, b), s[k + 1]);
    const State d = slope(moved(x, h, c), s[k + 2]);
    x = moved(x, h / 6, {a.R + 2 * b.R + 2 * c.R + d.R, a.v + 2 * b.v + 2 * c.v + d.v, a.p + 2 * b.p + 2 * c.p + d.p});
  }
  return difference(motion, s[k].t, x.p, Eigen::Quaterniond(x.R).normalized().toRotationMatrix());
}

std::string name_of(std::string scenario) {
  for (char& c : scenario) c = c == '-' ? '_' : c;
  return scenario;
}

class OnWheels : public testing::TestWithParam<std::pair<const char*, double>> {};
INSTANTIATE_TEST_SUITE_P(Shipped, OnWheels,
                         testing::Values(std::pair{"emergency-brake", 34.0}, std::pair{"kerb-and-joints", 40.0},
                                         std::pair{"tight-turn-tug", 46.0}, std::pair{"articulated-tug", 60.0},
                                         std::pair{"recorded-path", 48.0}),
                         [](const auto& test) { return name_of(test.param.first); });

TEST_P(OnWheels, ClosesToACentimetreAndConverges) {
  const auto [scenario, span_s] = GetParam();
  const auto motion = tests::shipped_drive(scenario, span_s);
  const Closure at_500 = integrate(*motion, 500), at_1000 = integrate(*motion, 1000),
                at_2000 = integrate(*motion, 2000);
  std::printf("closure %s, %.0f s: 500 Hz %.2g m %.2g deg; 1 kHz %.2g m %.2g deg; 2 kHz %.2g m %.2g deg\n", scenario,
              span_s, at_500.position_m, at_500.angle_deg, at_1000.position_m, at_1000.angle_deg, at_2000.position_m,
              at_2000.angle_deg);
  EXPECT_LT(at_1000.position_m, 0.01);
  EXPECT_LT(at_1000.angle_deg, 0.001);
  EXPECT_GT(at_500.position_m / at_1000.position_m, 3.5);
  EXPECT_GT(at_1000.position_m / at_2000.position_m, 3.5);
  // Drives that begin and end at rest let much of the first order cancel.
  EXPECT_GT(integrate(*motion, 1000, Rule::euler).position_m, 4 * at_1000.position_m);
}

class CarriedOrFlying : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Shipped, CarriedOrFlying, testing::Values("handheld-walk", "handheld-run", "drone-survey"),
                         [](const auto& test) { return name_of(test.param); });

TEST_P(CarriedOrFlying, ClosesByAFourthOrderRuleAndNotByEuler) {
  const auto motion = tests::shipped_drive(GetParam(), std::string(GetParam()) == "handheld-run" ? 36 : 60);
  const Closure at_2000 = fourth_order(*motion, 2000), at_4000 = fourth_order(*motion, 4000);
  const Closure by_trapezoid = integrate(*motion, 1000);
  std::printf("closure %s: 2 kHz %.2g m %.2g deg; 4 kHz %.2g m %.2g deg; trapezoid at 1 kHz %.2g m %.2g deg\n",
              GetParam(), at_2000.position_m, at_2000.angle_deg, at_4000.position_m, at_4000.angle_deg,
              by_trapezoid.position_m, by_trapezoid.angle_deg);
  EXPECT_GT(at_2000.position_m / at_4000.position_m, 12) << "sixteen, in the limit";
  EXPECT_LT(at_4000.position_m, 0.001);
  EXPECT_LT(at_4000.angle_deg, 0.001);
  EXPECT_GT(by_trapezoid.position_m, 10 * at_4000.position_m) << "a rule of lower order";
  EXPECT_GT(integrate(*motion, 4000, Rule::euler).position_m, 0.001) << "the bound must tell a wrong rule";
}

}  // namespace
}  // namespace tarmac::sim
