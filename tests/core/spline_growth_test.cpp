// What a spline is beside a function of time: parameters, growth, segments, batches.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/estimate.h"
#include "core/spline_trajectory.h"
#include "tests/core/spline_cases.h"
#include "tests/support/numeric.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::core {
namespace {

using namespace spline_cases;
using tests::message_of;

class GrowingSpline : public ::testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Spline, GrowingSpline, ::testing::ValuesIn(all_cases()),
                         [](const auto& each) { return ::testing::PrintToString(each.param); });

TEST_P(GrowingSpline, BatchPosesAreTheSameBitsAsSinglePoses) {
  const SplineTrajectory spline = lively(GetParam(), 8);
  std::vector<Time> times;
  for (const Time t : some_times(spline, 200)) times.insert(times.end(), {t, t});
  std::vector<SE3> poses(times.size());
  spline.poses(times, poses);
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_EQ(poses[i].matrix(), spline.pose(times[i]).matrix()) << i;
    EXPECT_EQ(poses[i].matrix(), spline.at(times[i]).T_world_body.matrix()) << i;
  }
  std::swap(times[10], times[40]);
  EXPECT_THROW(spline.poses(times, poses), InputError);
  times = {spline.begin(), spline.end() + Duration(1)};
  EXPECT_THROW(spline.poses(times, poses), OutOfSpan);
  EXPECT_NO_THROW(spline.poses({}, {}));
}

TEST_P(GrowingSpline, DifferenceUndoesAStepAndItsJacobianCarriesAFurtherOne) {
  expect_consistent_difference(lively(GetParam(), 10));
}

TEST_P(GrowingSpline, ExtendingAndDroppingLeaveTheRestAsItWas) {
  const SplineTrajectory spline = lively(GetParam(), 12);
  const std::vector<Time> times = some_times(spline, 60);
  SplineTrajectory grown = spline;
  const Time end = spline.end() + Duration(3 * kSpacing_ns);
  grown.extend(spline.begin(), end, std::vector<Time>{end + Duration(kSpacing_ns)});
  EXPECT_GE(grown.end(), end);
  for (const Time t : times) EXPECT_TRUE(same_bits(grown.at(t), spline.at(t)));
  grown.drop(4);
  EXPECT_EQ(grown.begin(), spline.knots()[static_cast<std::size_t>(GetParam().order + 3)]);
  int checked = 0;
  for (const Time t : times) {
    EXPECT_EQ(grown.covers(t), t >= grown.begin());
    if (!grown.covers(t)) continue;
    ++checked;
    EXPECT_TRUE(same_bits(grown.at(t), spline.at(t)));
    StateJet before, after;
    spline.jet(t, Derivative::acceleration, before);
    grown.jet(t, Derivative::acceleration, after);
    EXPECT_EQ(before.J, after.J);
    EXPECT_EQ(before.first, after.first + 4 * 6);
  }
  EXPECT_GT(checked, 10);
  EXPECT_THROW(grown.drop(grown.blocks() - GetParam().order + 1), std::invalid_argument);
  EXPECT_THROW(grown.drop(-1), std::invalid_argument);
}

TEST_P(GrowingSpline, ExtendingGoesOnAtConstantVelocity) {
  const Case c = GetParam();
  const std::vector<Time> knots = make_knots(8 + c.order, c.uniform);
  Vector6 twist;
  twist << 8, -1, 0.5, 0.3, -0.8, 1.1;
  std::vector<SE3> control;
  for (int i = 0; i < 8; ++i) {
    const double s = 1e-9 * greville_ns_after(knots[0], knots, c.order, i);
    control.push_back(se3::exp(s * twist));
    if (c.kind == SplineKind::split) control.back().translation() = s * twist.head<3>();
  }
  SplineTrajectory spline(c.kind, c.order, control, knots);
  const Kinematics before = spline.at(spline.end());
  spline.extend(spline.begin(), spline.end() + Duration(7 * kSpacing_ns), {});
  const Kinematics after = spline.at(spline.end());
  EXPECT_LT((after.omega_body - before.omega_body).norm(), 1e-11);
  const auto own_axes = [&](const Kinematics& k) {
    return c.kind == SplineKind::split ? k.v_world : Eigen::Vector3d(k.T_world_body.linear().transpose() * k.v_world);
  };
  EXPECT_LT((own_axes(after) - own_axes(before)).norm(), 1e-10);
}

TEST_P(GrowingSpline, ASegmentHasTheSamePosesFromItsOwnControlPointsOnly) {
  const SplineTrajectory spline = lively(GetParam(), 13);
  const Time t0 = spline.begin() + Duration(2 * kSpacing_ns), t1 = spline.begin() + Duration(3 * kSpacing_ns + 7);
  const Segment segment = spline.segment(t0, t1);
  EXPECT_EQ(segment.times.size(), segment.poses.size() + static_cast<std::size_t>(GetParam().order));
  EXPECT_LT(segment.poses.size(), spline.control_points().size());
  for (const Time t : some_times(spline, 60)) {
    if (t < t0 || t > t1) {
      EXPECT_THROW(segment.pose(t), OutOfSpan);
    } else {
      EXPECT_EQ(segment.pose(t).matrix(), spline.pose(t).matrix());
    }
  }
  EXPECT_EQ(segment.pose(t1).matrix(), spline.pose(t1).matrix());
  EXPECT_THROW(spline.segment(t1, t0), InputError);
  EXPECT_THROW(spline.segment(t0, spline.end() + Duration(1)), OutOfSpan);
  Segment damaged = segment;
  damaged.times.pop_back();
  damaged.times.pop_back();
  damaged.times.pop_back();
  EXPECT_THROW(damaged.pose(t0), InputError);
}

TEST_P(GrowingSpline, ASegmentSurvivesAFileBitByBit) {
  const tests::TemporaryFolder folder;
  const SplineTrajectory spline = lively(GetParam(), 19);
  Estimate estimate;
  estimate.estimator = "test";
  const Time middle = spline.begin() + (spline.end() - spline.begin()) / 2;
  estimate.causal.append(spline.segment(spline.begin(), middle));
  estimate.causal.append(spline.segment(middle, spline.end()));
  save_estimate(folder / "trajectory.bin", estimate);
  const Estimate back = load_estimate(folder / "trajectory.bin");
  for (const Time t : some_times(spline, 30)) EXPECT_EQ(back.causal.pose(t).matrix(), spline.pose(t).matrix());
}

TEST_P(GrowingSpline, ASegmentsJacobiansMatchCentralDifferences) {
  const SplineTrajectory spline = lively(GetParam(), 14);
  const Segment segment = spline.segment(spline.begin(), spline.end());
  for (const Time t : some_times(spline, 10)) {
    std::vector<BlockJacobian> jacobians;
    EXPECT_EQ(segment.pose(t, jacobians).matrix(), segment.pose(t).matrix());
    ASSERT_EQ(jacobians.size(), static_cast<std::size_t>(GetParam().order));
    for (std::size_t block = 0; block < segment.poses.size(); ++block) {
      const auto with_block = [&](const SE3& T_block) {
        Segment moved = segment;
        moved.poses[block] = T_block;
        return moved.pose(t);
      };
      Matrix6 J = Matrix6::Zero();
      for (const BlockJacobian& entry : jacobians) {
        if (entry.block == static_cast<int>(block)) J = entry.jacobian;
      }
      const Matrix6 numeric = tests::numeric_pose_jacobian(with_block, segment.poses[block], 1e-5);
      EXPECT_LT(tests::relative_difference(J, numeric), 1e-6) << "block " << block;
    }
  }
}

TEST_P(GrowingSpline, FirstBlockAtIsTheFirstThatAnyLaterStateDependsOn) {
  const SplineTrajectory spline = lively(GetParam(), 15);
  for (const Time t : some_times(spline, 30)) {
    StateJet jet;
    spline.jet(t, Derivative::pose, jet);
    EXPECT_EQ(6 * spline.first_block_at(t), jet.first);
    SplineTrajectory dropped = spline;
    dropped.drop(spline.first_block_at(t));
    EXPECT_TRUE(dropped.covers(t));
  }
  EXPECT_EQ(spline.first_block_at(spline.begin() - Duration(1)), 0);
  EXPECT_EQ(spline.first_block_at(spline.end() + Duration(1)), spline.blocks() - GetParam().order + 1);
}

TEST(SplineKnots, NeverMoveAndOnlyLaterOnesAreTaken) {
  const Case c{SplineKind::split, 4, true};
  SplineTrajectory spline = lively(c, 16, 6);
  const std::vector<Time> before = spline.knots();
  const Time last = before.back();
  // Two of the caller's lie among existing ones, one after them; the rest repeats the last spacing, 30 ms.
  const std::vector<Time> wanted = {last - Duration(5), last, last + Duration(30'000'000)};
  const Time end = last + Duration(45'000'000);
  spline.extend(spline.begin(), end, wanted);
  ASSERT_GE(spline.knots().size(), before.size() + 2);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(spline.knots()[i], before[i]);
  for (std::size_t i = before.size(); i < spline.knots().size(); ++i) {
    EXPECT_EQ(spline.knots()[i], last + Duration(30'000'000 * static_cast<std::int64_t>(i - before.size() + 1)));
  }
  EXPECT_EQ(spline.knots().size(), spline.control_points().size() + 4);
  EXPECT_GE(spline.end(), end);
  EXPECT_LT(spline.end() - Duration(30'000'000), end) << "no more knots than are needed";
  const std::size_t knots = spline.knots().size();
  spline.extend(spline.begin(), end, {});
  EXPECT_EQ(spline.knots().size(), knots) << "what is covered already needs none";
  EXPECT_THROW(spline.extend(spline.begin() - Duration(1), end, {}), InputError);
  EXPECT_THROW(spline.extend(spline.begin(), end, std::vector<Time>{last, last}), InputError);
}

TEST(SplineTrajectory, NeverAnswersOutsideItsSpan) {
  const SplineTrajectory spline = lively({SplineKind::se3, 4, false}, 17);
  EXPECT_EQ(spline.begin(), spline.knots()[3]);
  EXPECT_EQ(spline.end(), spline.knots()[12] - Duration(1));
  StateJet jet;
  for (const Time t : {spline.begin() - Duration(1), spline.end() + Duration(1)}) {
    EXPECT_FALSE(spline.covers(t));
    EXPECT_THROW(spline.pose(t), OutOfSpan);
    EXPECT_THROW(spline.at(t), OutOfSpan);
    EXPECT_THROW(spline.jet(t, Derivative::pose, jet), OutOfSpan);
    EXPECT_THROW(spline.rate(t, Derivative::pose), OutOfSpan);
  }
}

TEST(SplineTrajectory, RefusesWhatMakesNoSpline) {
  const auto make = [](int order, std::size_t n, std::vector<Time> knots) {
    return SplineTrajectory(SplineKind::split, order, std::vector<SE3>(n, SE3::Identity()), std::move(knots));
  };
  EXPECT_THROW(make(3, 5, make_knots(8, true)), InputError);
  EXPECT_THROW(make(7, 8, make_knots(15, true)), InputError);
  EXPECT_THROW(make(4, 3, make_knots(7, true)), InputError);
  EXPECT_THROW(make(4, 6, make_knots(9, true)), InputError);
  auto knots = make_knots(10, true);
  knots[9] = knots[8];
  EXPECT_THROW(make(4, 6, knots), InputError);
  std::swap(knots[4], knots[5]);
  EXPECT_THAT(message_of<InputError>([&] { make(4, 6, knots); }), ::testing::HasSubstr("knot 5"));
  EXPECT_THROW(SplineTrajectory::at_rest(SplineKind::se3, 4, SE3::Identity(), {}), InputError);
  SE3 bad = SE3::Identity();
  bad.translation().x() = std::nan("");
  EXPECT_THROW(SplineTrajectory::at_rest(SplineKind::se3, 4, bad, make_knots(10, true)), InputError);
}

TEST(SplineTrajectory, AStepThatIsNotFiniteChangesNothing) {
  SplineTrajectory spline = lively({SplineKind::split, 4, true}, 18);
  const Kinematics before = spline.at(spline.begin());
  Eigen::VectorXd step = Eigen::VectorXd::Ones(spline.parameters());
  step[5] = std::nan("");
  EXPECT_THROW(spline.retract(step), std::domain_error);
  EXPECT_TRUE(same_bits(before, spline.at(spline.begin())));
  EXPECT_THROW(spline.retract(Eigen::VectorXd::Zero(6)), std::invalid_argument);
}

}  // namespace
}  // namespace tarmac::core
