#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "sim/truth/function_class.h"
#include "sim/truth/motion.h"
#include "tests/sim/truth/stand_turn.h"
#include "tests/support/numeric.h"

namespace tarmac::sim::truth {
namespace {

using namespace core;
using Eigen::Vector3d;
using testing::AllOf;
using testing::HasSubstr;

std::shared_ptr<const SmoothTrajectory> make(const std::string& yaml) {
  return make_motion(ConfigNode::parse(yaml, "test.yaml"), duration_from_s(10), nullptr, 1);
}

TEST(MotionKinds, ConstantTwistIsTheExponentialWithExactDerivatives) {
  const auto motion = make(
      "{kind: constant-twist, start: {xyz_m: [1, 2, 3], rpy_deg: [10, 20, 30]}, v_body_m_s: [4, 0.5, 0.2], "
      "omega_body_rad_s: [0.1, -0.2, 0.5]}");
  Vector6 xi;
  xi << 4, 0.5, 0.2, 0.1, -0.2, 0.5;
  const SE3 start = motion->pose(Time());
  const double h = 1e-4;
  for (const double t : {0.5, 3.3, 9.0}) {
    const Kinematics k = motion->at(time_from_s(t));
    EXPECT_LT(tests::pose_difference(k.T_world_body, start * se3::exp(t * xi)), 1e-13);
    const auto p = [&](double s) -> Vector3d { return motion->pose(time_from_s(s)).translation(); };
    const auto v = [&](double s) -> Vector3d { return motion->at(time_from_s(s)).v_world; };
    EXPECT_LT((k.v_world - (p(t + h) - p(t - h)) / (2 * h)).norm(), 1e-7);
    EXPECT_LT((k.a_world - (v(t + h) - v(t - h)) / (2 * h)).norm(), 1e-7);
    EXPECT_EQ(k.omega_body, Vector3d(0.1, -0.2, 0.5));
    EXPECT_EQ(k.alpha_body, Vector3d::Zero().eval());
  }
}

TEST(MotionKinds, StraightKeepsItsWorldVelocityAndStillStaysPut) {
  const auto straight =
      make("{kind: straight, start: {xyz_m: [1, 2, 3], rpy_deg: [0, 0, 90]}, v_world_m_s: [8, 1, 0]}");
  const Kinematics k = straight->at(time_from_s(2.5));
  EXPECT_LT((k.T_world_body.translation() - Vector3d(21, 4.5, 3)).norm(), 1e-12);
  EXPECT_LT((k.v_world - Vector3d(8, 1, 0)).norm(), 1e-12);
  EXPECT_LT(k.a_world.norm(), 1e-12);
  const auto still = make("{kind: still, start: {xyz_m: [1, 2, 3]}}");
  EXPECT_EQ(still->pose(time_from_s(9)).matrix(), still->pose(Time()).matrix());
  EXPECT_EQ(still->at(time_from_s(1)).v_world, Vector3d::Zero().eval());
  EXPECT_THROW(still->pose(time_from_s(11)), OutOfSpan);
}

TEST(MotionKinds, ResolvedTextMakesTheSameMotionAndResolvesToItself) {
  const auto node = tests::stand_turn_motion();
  const std::string resolved = resolve_motion(node);
  EXPECT_EQ(resolved.substr(0, 14), "  kind: drive\n");
  const auto again = ConfigNode::parse("motion:\n" + resolved, "resolved").child("motion");
  EXPECT_EQ(resolve_motion(again), resolved);
  const auto a = make_motion(node, duration_from_s(12), nullptr, 3),
             b = make_motion(again, duration_from_s(12), nullptr, 3);
  for (const double t : {0.0, 5.5, 11.9}) {
    EXPECT_EQ(a->pose(time_from_s(t)).matrix(), b->pose(time_from_s(t)).matrix());
  }
}

TEST(MotionKinds, EveryKindHasOptionsAndAFunctionClass) {
  ASSERT_EQ(motion_kinds().size(), 8u);
  for (const std::string& kind : motion_kinds()) {
    EXPECT_FALSE(describe_motion(kind).empty()) << kind;
    EXPECT_FALSE(motion_function_class(kind).empty()) << kind;
  }
}

TEST(MotionKinds, AnUnknownKindIsAnErrorWithASuggestion) {
  const auto error_of = [](const std::string& yaml) -> std::string {
    try {
      make(yaml);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(error_of("kind: drvie\n"),
              AllOf(HasSubstr("test.yaml:1"), HasSubstr("kind"), HasSubstr("did you mean drive")));
  EXPECT_THAT(error_of("start: {}\n"), HasSubstr("kind"));
  EXPECT_THAT(error_of("{kind: still, v_world_m_s: [1, 0, 0]}"), HasSubstr("v_world_m_s"));
  EXPECT_THROW(describe_motion("walk"), InputError);
}

}  // namespace
}  // namespace tarmac::sim::truth
