// What every kind of motion owes: velocity, acceleration, angular rate and angular acceleration are the derivatives of
// its pose, it is at least C3, and the same seed is the same motion.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <ostream>
#include <string>

#include "tests/sim/truth/hill.h"
#include "tests/sim/truth/stand_turn.h"
#include "tests/support/numeric_jet.h"

namespace tarmac::sim::truth {
namespace {

using namespace core;
using Eigen::Vector3d;
using tests::derivative_of;

struct Case {
  const char* scenario;
  double duration_s;
  double step_s;              ///< of the differences: small against the fastest thing that moves it
  double v, a, omega, alpha;  ///< what differences may be off
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.scenario;
}

std::string name_of(const testing::TestParamInfo<Case>& info) {
  std::string name = info.param.scenario;
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
}

class EveryMotion : public testing::TestWithParam<Case> {};

/// Rounding of differences grows as 1 / step, their truncation as step^4 times the fifth derivative: hence bounds by
/// kind. Rotors at 230 Hz and heels' strikes are the roughest.
INSTANTIATE_TEST_SUITE_P(Shipped, EveryMotion,
                         testing::Values(Case{"emergency-brake", 20, 2.5e-4, 1e-7, 1e-5, 1e-8, 1e-5},
                                         Case{"kerb-and-joints", 30, 2.5e-4, 1e-7, 1e-5, 1e-7, 1e-5},
                                         Case{"tight-turn-tug", 20, 2.5e-4, 1e-7, 1e-5, 1e-7, 1e-5},
                                         Case{"articulated-tug", 30, 2.5e-4, 1e-7, 1e-5, 1e-7, 1e-5},
                                         Case{"handheld-walk", 30, 1e-4, 1e-7, 1e-5, 1e-7, 1e-4},
                                         Case{"handheld-run", 30, 1e-4, 1e-7, 1e-5, 1e-7, 1e-4},
                                         Case{"drone-survey", 40, 1e-4, 1e-7, 1e-5, 1e-7, 1e-4},
                                         Case{"recorded-path", 45, 1e-3, 1e-9, 1e-8, 1e-9, 1e-8}),
                         name_of);

TEST_P(EveryMotion, KinematicsAreTheDerivativesOfThePose) {
  const Case& c = GetParam();
  const auto motion = tests::shipped_drive(c.scenario, c.duration_s, 1, std::make_shared<tests::Hill>());
  const auto at = [&](double t) { return motion->at(time_from_s(t)); };
  const auto p = [&](double t) -> Vector3d { return at(t).T_world_body.translation(); };
  const auto v = [&](double t) -> Vector3d { return at(t).v_world; };
  const auto R = [&](double t) -> Eigen::Matrix3d { return at(t).T_world_body.linear(); };
  const auto w = [&](double t) -> Vector3d { return at(t).omega_body; };
  const double h = c.step_s;
  double worst[4] = {};
  for (double t = 0.05; t < c.duration_s - 0.05; t += 0.0973) {
    t = std::round(t * 1e6) * 1e-6;  // differences must hit whole nanoseconds
    const Kinematics k = at(t);
    worst[0] = std::max(worst[0], (k.v_world - derivative_of(p, t, h)).norm());
    worst[1] = std::max(worst[1], (k.a_world - derivative_of(v, t, h)).norm());
    const Eigen::Matrix3d W = k.T_world_body.linear().transpose() * derivative_of(R, t, h);
    const Vector3d omega(W(2, 1) - W(1, 2), W(0, 2) - W(2, 0), W(1, 0) - W(0, 1));
    worst[2] = std::max(worst[2], (k.omega_body - omega / 2).norm());
    worst[3] = std::max(worst[3], (k.alpha_body - derivative_of(w, t, h)).norm());
    ASSERT_LT((k.T_world_body.linear().transpose() * k.T_world_body.linear() - Eigen::Matrix3d::Identity()).norm(),
              1e-13);
  }
  std::printf("%s: differences off by %.1e m/s, %.1e m/s^2, %.1e rad/s, %.1e rad/s^2\n", c.scenario, worst[0], worst[1],
              worst[2], worst[3]);
  EXPECT_LT(worst[0], c.v);
  EXPECT_LT(worst[1], c.a);
  EXPECT_LT(worst[2], c.omega);
  EXPECT_LT(worst[3], c.alpha);
}

/// C3: the jerk has no jumps. Halving the step must shrink the largest change of the acceleration's slope from one
/// interval to the next; where the slope jumps it stays.
TEST_P(EveryMotion, AccelerationHasNoKinks) {
  const Case& c = GetParam();
  const double end_s = 12;
  const auto motion = tests::shipped_drive(c.scenario, end_s);
  const auto largest_kink = [&](double h) {
    double worst = 0;
    Vector3d before = motion->at(time_from_s(4)).a_world, slope = Vector3d::Zero();
    const int count = static_cast<int>((end_s - 4.01) / h);
    for (int k = 1; k <= count; ++k) {
      const Vector3d now = motion->at(time_from_s(4 + k * h)).a_world;
      const Vector3d next = (now - before) / h;
      if (k > 1) worst = std::max(worst, (next - slope).norm());
      slope = next, before = now;
    }
    return worst;
  };
  const double coarse = largest_kink(4e-4), fine = largest_kink(1e-4);
  EXPECT_LT(fine, 0.5 * coarse) << "a jerk that jumps changes the slope by as much at any step";
}

TEST_P(EveryMotion, SameSeedSameBitsAndAnotherSeedAnotherMotion) {
  const std::string scenario = GetParam().scenario;
  const auto a = tests::shipped_drive(scenario, 12, 5), b = tests::shipped_drive(scenario, 12, 5),
             c = tests::shipped_drive(scenario, 12, 6);
  for (const double t : {0.0, 4.321, 7.7, 11.9}) {
    const Kinematics want = a->at(time_from_s(t)), got = b->at(time_from_s(t));
    EXPECT_EQ(want.T_world_body.matrix(), got.T_world_body.matrix());
    EXPECT_EQ(want.a_world, got.a_world);
    EXPECT_EQ(want.alpha_body, got.alpha_body);
  }
  if (scenario == "recorded-path") {
    EXPECT_EQ(a->pose(time_from_s(11)).matrix(), c->pose(time_from_s(11)).matrix()) << "nothing in it is drawn";
  } else {
    EXPECT_NE(a->pose(time_from_s(11)).matrix(), c->pose(time_from_s(11)).matrix());
  }
}

TEST_P(EveryMotion, ResolvedTextMakesTheSameMotionAndResolvesToItself) {
  const auto node = tests::shipped_motion(GetParam().scenario);
  const std::string resolved = resolve_motion(node);
  const auto again = ConfigNode::parse("motion:\n" + resolved, "resolved").child("motion");
  EXPECT_EQ(resolve_motion(again), resolved);
  const auto a = make_motion(node, duration_from_s(9), nullptr, 3),
             b = make_motion(again, duration_from_s(9), nullptr, 3);
  for (const double t : {0.0, 5.5, 8.9}) {
    EXPECT_EQ(a->pose(time_from_s(t)).matrix(), b->pose(time_from_s(t)).matrix());
  }
}

TEST_P(EveryMotion, RestsBeforeItSetsOff) {
  const auto motion = tests::shipped_drive(GetParam().scenario, 12);
  double farthest = 0;
  for (double t = 0; t < 3; t += 0.01) {
    farthest =
        std::max(farthest, (motion->pose(time_from_s(t)).translation() - motion->pose(Time()).translation()).norm());
  }
  EXPECT_LT(farthest, 0.02) << "engines shake, and people sway";
  EXPECT_GT((motion->pose(time_from_s(11.9)).translation() - motion->pose(Time()).translation()).norm(), 4);
}

}  // namespace
}  // namespace tarmac::sim::truth
