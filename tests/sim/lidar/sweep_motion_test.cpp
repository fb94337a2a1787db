#include "sim/lidar/sweep_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/lie.h"
#include "tests/sim/support/motions.h"

namespace tarmac::sim::lidar {
namespace {

using core::Duration;
using core::Time;

/// A body that shakes along and about every axis by sines of `frequency_hz`, as engines make it.
class Shaken : public core::SmoothTrajectory {
 public:
  double frequency_hz = 30, amplitude_m = 1e-4, amplitude_rad = 1e-4;
  mutable int asked = 0;
  Time begin() const override { return Time{}; }
  Time end() const override { return core::time_from_s(10); }
  core::Kinematics at(Time time) const override {
    ++asked;
    const double w = 2 * M_PI * frequency_hz, t = core::to_s(time), s = std::sin(w * t), c = std::cos(w * t);
    const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, 3).normalized();
    core::Kinematics k;
    k.T_world_body.linear() = core::so3::exp(amplitude_rad * s * axis);
    k.T_world_body.translation() =
        Eigen::Vector3d(300, -200, 2) + t * Eigen::Vector3d(8, 1, 0) + amplitude_m * s * axis;
    k.v_world = Eigen::Vector3d(8, 1, 0) + amplitude_m * w * c * axis;
    k.omega_body = amplitude_rad * w * c * axis;
    return k;
  }
};

/// Largest errors over a sweep, at every column of a sensor with 2048 of them.
struct Errors {
  double position_m = 0, angle_rad = 0, velocity_m_s = 0, rate_rad_s = 0;
};

Errors errors_of(const core::SmoothTrajectory& motion, Time begin, Time end) {
  const SweepMotion sweep(motion, begin, end);
  Errors worst;
  for (int k = 0; k <= 2048; ++k) {
    const Time t = begin + k * (end - begin) / 2048;
    const core::Kinematics exact = motion.at(t);
    const BodyState state = sweep.at(t);
    worst.position_m = std::max(worst.position_m, (state.p_world - exact.T_world_body.translation()).norm());
    worst.angle_rad =
        std::max(worst.angle_rad, core::so3::angle_rad(exact.T_world_body.linear().transpose() * state.R_world_body));
    worst.velocity_m_s = std::max(worst.velocity_m_s, (state.v_world - exact.v_world).norm());
    worst.rate_rad_s = std::max(worst.rate_rad_s, (state.omega_body - exact.omega_body).norm());
  }
  return worst;
}

TEST(SweepMotion, FollowsATurningBodyToNanometres) {
  const Errors worst = errors_of(tests::fast_turn({1000, -2000, 3}), core::time_from_s(0.3), core::time_from_s(0.4));
  EXPECT_LT(worst.position_m, 5e-9);
  EXPECT_LT(worst.angle_rad, 1e-11);
  EXPECT_LT(worst.velocity_m_s, 1e-8);
  EXPECT_LT(worst.rate_rad_s, 1e-9);
}

TEST(SweepMotion, HoldsItsToleranceWhateverTheFrequency) {
  for (const double frequency_hz : {3.0, 30.0, 90.0, 300.0}) {
    Shaken motion;
    motion.frequency_hz = frequency_hz;
    const Errors worst = errors_of(motion, core::time_from_s(2), core::time_from_s(2.1));
    // Held at the worst places between nodes; elsewhere a polynomial may be off by a little more.
    EXPECT_LT(worst.position_m, 2 * SweepMotion::position_tolerance_m) << frequency_hz;
    EXPECT_LT(worst.angle_rad, 2 * SweepMotion::angle_tolerance_rad) << frequency_hz;
  }
}

TEST(SweepMotion, AsksTheMotionItselfWherePiecesWouldBeTooShort) {
  Shaken motion;
  motion.frequency_hz = 20'000;  // no polynomial over a millisecond follows that
  const Errors worst = errors_of(motion, core::time_from_s(2), core::time_from_s(2.1));
  EXPECT_EQ(worst.position_m, 0);
  EXPECT_EQ(worst.angle_rad, 0);
}

TEST(SweepMotion, AsksASmoothMotionFarLessOftenThanASweepHasColumns) {
  Shaken motion;
  const SweepMotion sweep(motion, core::time_from_s(1), core::time_from_s(1.1));
  EXPECT_LT(motion.asked, 200);
  EXPECT_GE(sweep.pieces(), 2u);
}

TEST(SweepMotion, NeverAsksOutsideItsSpan) {
  tests::SteadyMotion motion;
  motion.length_s = 0.1;
  motion.v_m_s = {5, 0, 0};
  EXPECT_NO_THROW(SweepMotion(motion, core::time_from_s(0), core::time_from_s(0.1)));
  EXPECT_THROW(SweepMotion(motion, core::time_from_s(0), core::time_from_s(0.1) + Duration(1)), core::OutOfSpan);
  EXPECT_NO_THROW(SweepMotion(motion, core::time_from_s(0), core::time_from_s(0)));
}

}  // namespace
}  // namespace tarmac::sim::lidar
