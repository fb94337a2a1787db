// Integrating perfect samples gives the motion back: whatever the synthesiser says of forces, rates, frames and stamps
// is then what the poses do.
#include <gtest/gtest.h>

#include <cstdio>

#include "sim/imu/imu.h"
#include "tests/sim/truth/stand_turn.h"
#include "tests/support/constants.h"

namespace tarmac::sim {
namespace {

using namespace core;
using Eigen::Vector3d;

using tests::g;
constexpr double span_s = 60;

struct Closure {
  double position_m, angle_deg;
};

enum class Rule { trapezoid, euler };

/// Integrates the samples, taken `delay` before their stamps, from the exact state at the first and compares at the
/// end.
Closure integrate(const SmoothTrajectory& motion, std::vector<ImuSample> samples, Duration delay, Rule rule) {
  for (ImuSample& s : samples) s.t -= delay;
  std::erase_if(samples, [&](const ImuSample& s) { return s.t < motion.begin(); });
  const Kinematics start = motion.at(samples.front().t);
  Eigen::Matrix3d R = start.T_world_body.linear();
  Vector3d p = start.T_world_body.translation(), v = start.v_world;
  const Vector3d down(0, 0, -g);
  for (std::size_t k = 0; k + 1 < samples.size(); ++k) {
    const double dt = to_s(samples[k + 1].t - samples[k].t);
    const bool trapezoid = rule == Rule::trapezoid;
    const Vector3d rate =
        trapezoid ? Vector3d((samples[k].gyro_rad_s + samples[k + 1].gyro_rad_s) / 2) : samples[k].gyro_rad_s;
    const Eigen::Matrix3d R_next = R * so3::exp(rate * dt);
    const Vector3d a0 = R * samples[k].accel_m_s2 + down, a1 = R_next * samples[k + 1].accel_m_s2 + down;
    const Vector3d a = trapezoid ? Vector3d((a0 + a1) / 2) : a0;
    p += trapezoid ? Vector3d(v * dt + (2 * a0 + a1) * (dt * dt / 6)) : Vector3d(v * dt);
    v += a * dt;
    R = R_next;
  }
  const SE3 end = motion.pose(samples.back().t);
  return {(p - end.translation()).norm(), so3::angle_rad(R.transpose() * end.linear()) * 180 / std::numbers::pi};
}

Closure close_loop(const SmoothTrajectory& motion, double rate_hz, Rule rule) {
  ImuOptions options;
  options.rate_hz = rate_hz;
  options.sampling = "point";
  return integrate(motion, ideal_imu(motion, options, g, Time(), time_from_s(span_s)), Duration(0), rule);
}

TEST(ImuClosure, AMinuteOfTheStandTurnClosesToACentimetreAndConverges) {
  const auto motion = tests::stand_turn(span_s);
  const Closure at_500 = close_loop(*motion, 500, Rule::trapezoid),
                at_1000 = close_loop(*motion, 1000, Rule::trapezoid);
  const Closure at_2000 = close_loop(*motion, 2000, Rule::trapezoid);
  const Closure euler = close_loop(*motion, 1000, Rule::euler);
  std::printf("closure: 500 Hz %.3g m %.3g deg; 1 kHz %.3g m %.3g deg; 2 kHz %.3g m %.3g deg; Euler %.3g m %.3g deg\n",
              at_500.position_m, at_500.angle_deg, at_1000.position_m, at_1000.angle_deg, at_2000.position_m,
              at_2000.angle_deg, euler.position_m, euler.angle_deg);
  EXPECT_LT(at_1000.position_m, 0.01);
  EXPECT_LT(at_1000.angle_deg, 0.001);
  EXPECT_GT(at_500.position_m / at_1000.position_m, 3.5);
  EXPECT_GT(at_1000.position_m / at_2000.position_m, 3.5);
  EXPECT_GT(at_1000.angle_deg / at_2000.angle_deg, 3.5);
  EXPECT_GT(euler.position_m, 0.01) << "the bound must tell a wrong rule";
}

TEST(ImuClosure, LowPassedSamplesCloseWithTheDelayOnTheirSheetAndNotWithoutIt) {
  const auto motion = tests::stand_turn(span_s);
  ImuOptions options;
  options.rate_hz = 1000;
  options.sampling = "low-pass";
  options.low_pass_hz = 50;
  const auto samples = ideal_imu(*motion, options, g, Time(), time_from_s(span_s));
  const Duration delay = imu_sheet(options).delay;
  const Closure with = integrate(*motion, samples, delay, Rule::trapezoid);
  const Closure without = integrate(*motion, samples, Duration(0), Rule::trapezoid);
  const Closure twice = integrate(*motion, samples, 2 * delay, Rule::trapezoid);
  std::printf("low-pass closure: %.3g m %.3g deg; without its delay %.3g m %.3g deg; with twice %.3g m %.3g deg\n",
              with.position_m, with.angle_deg, without.position_m, without.angle_deg, twice.position_m,
              twice.angle_deg);
  EXPECT_LT(with.position_m, 0.02);
  EXPECT_LT(with.angle_deg, 0.003);
  EXPECT_GT(without.position_m, 3 * with.position_m);
  EXPECT_GT(twice.position_m, 3 * with.position_m);
}

}  // namespace
}  // namespace tarmac::sim
