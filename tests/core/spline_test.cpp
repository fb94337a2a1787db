#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/estimate.h"
#include "core/random.h"
#include "core/spline_trajectory.h"
#include "tests/core/parametric_laws.h"
#include "tests/support/numeric.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::core {
namespace {

using tests::message_of;
using tests::pose_difference;

struct Case {
  SplineKind kind;
  int order;
  bool uniform;
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << (c.kind == SplineKind::split ? "split" : "se3") << "_order" << c.order << (c.uniform ? "_even" : "_uneven");
}

constexpr std::int64_t kSpacing_ns = 100'000'000;
constexpr std::int64_t kOrigin_ns = 1'700'000'000'000'000'123;

/// Spacings of 0.1 s, or from 40 to 160 ms.
std::vector<Time> make_knots(int count, bool uniform) {
  const RandomStream stream(1, "test/spline_knots");
  std::vector<Time> knots = {time_from_ns(kOrigin_ns)};
  for (int i = 1; i < count; ++i) {
    const double factor = uniform ? 1 : 0.4 + 1.2 * stream.uniform(static_cast<std::uint64_t>(i));
    knots.push_back(knots.back() + Duration(static_cast<std::int64_t>(factor * kSpacing_ns)));
  }
  return knots;
}

Eigen::Vector3d vector(const RandomStream& stream, std::uint64_t i, std::uint32_t j) {
  return {stream.normal(i, 3 * j), stream.normal(i, 3 * j + 1), stream.normal(i, 3 * j + 2)};
}

/// A lively motion: about 10 m/s and 2 rad/s, changing from one control point to the next.
SplineTrajectory lively(const Case& c, std::uint64_t seed, int n = 12) {
  const RandomStream stream(seed, "test/spline");
  SE3 T = SE3::Identity();
  T.translation() = Eigen::Vector3d(300, -200, 10);
  std::vector<SE3> control;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(n); ++i) {
    Vector6 step;
    step << Eigen::Vector3d(1, 0, 0) + 0.3 * vector(stream, i, 0), 0.15 * vector(stream, i, 1);
    T = se3::normalized(T * se3::exp(step));
    control.push_back(T);
  }
  return {c.kind, c.order, control, make_knots(n + c.order, c.uniform)};
}

/// Times all over the span, the knots among them.
std::vector<Time> some_times(const SplineTrajectory& spline, int count, std::uint64_t seed = 5) {
  const RandomStream stream(seed, "test/times");
  std::vector<Time> times = {spline.begin(), spline.end()};
  const double span_ns = static_cast<double>((spline.end() - spline.begin()).count());
  for (int i = 0; i < count; ++i) {
    times.push_back(spline.begin() +
                    Duration(static_cast<std::int64_t>(span_ns * stream.uniform(static_cast<std::uint64_t>(i)))));
  }
  for (const Time t : spline.knots()) {
    if (spline.covers(t)) times.push_back(t);
  }
  std::sort(times.begin(), times.end());
  return times;
}

bool same_bits(const Kinematics& a, const Kinematics& b) {
  return a.T_world_body.matrix() == b.T_world_body.matrix() && state_difference(a, b).tail<12>().norm() == 0;
}

class EverySpline : public ::testing::TestWithParam<Case> {};
std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const SplineKind kind : {SplineKind::split, SplineKind::se3}) {
    for (const int order : {4, 5, 6}) {
      for (const bool uniform : {true, false}) cases.push_back({kind, order, uniform});
    }
  }
  return cases;
}
INSTANTIATE_TEST_SUITE_P(Spline, EverySpline, ::testing::ValuesIn(all_cases()),
                         [](const auto& each) { return ::testing::PrintToString(each.param); });

/// Derivative by time of f at t within one interval between knots, by Richardson's extrapolation of central
/// differences.
template <class F>
auto by_time(const F& f, Time t, std::int64_t step_ns) {
  const auto central = [&](std::int64_t h_ns) {
    using Value = std::decay_t<decltype(f(t))>;
    return Value((f(t + Duration(h_ns)) - f(t - Duration(h_ns))) / (2e-9 * static_cast<double>(h_ns)));
  };
  return std::decay_t<decltype(f(t))>((4 * central(step_ns / 2) - central(step_ns)) / 3);
}

bool near_a_knot(const SplineTrajectory& spline, Time t, std::int64_t margin_ns) {
  for (const Time knot : spline.knots()) {
    if (std::abs((t - knot).count()) <= margin_ns) return true;
  }
  return false;
}

TEST_P(EverySpline, VelocitiesAndAccelerationsAreTheDerivativesOfThePose) {
  const SplineTrajectory spline = lively(GetParam(), 1);
  constexpr std::int64_t kStep_ns = 1'000'000;
  int checked = 0;
  for (const Time t : some_times(spline, 40)) {
    if (near_a_knot(spline, t, kStep_ns)) continue;
    ++checked;
    const Kinematics state = spline.at(t);
    const auto p = [&](Time s) {
      return Eigen::Vector3d(spline.at(s).T_world_body.translation() - state.T_world_body.translation());
    };
    const auto phi = [&](Time s) {
      return so3::log(state.T_world_body.linear().transpose() * spline.at(s).T_world_body.linear());
    };
    EXPECT_LT((by_time(p, t, kStep_ns) - state.v_world).norm(), 1e-7);
    EXPECT_LT((by_time(phi, t, kStep_ns) - state.omega_body).norm(), 1e-7);
    const auto v = [&](Time s) { return spline.at(s).v_world; };
    const auto omega = [&](Time s) { return spline.at(s).omega_body; };
    EXPECT_LT((by_time(v, t, kStep_ns) - state.a_world).norm(), 1e-6);
    EXPECT_LT((by_time(omega, t, kStep_ns) - state.alpha_body).norm(), 1e-6);
  }
  EXPECT_GT(checked, 20);
}

TEST_P(EverySpline, RateIsTheDerivativeOfTheStateByTime) {
  const SplineTrajectory spline = lively(GetParam(), 2);
  constexpr std::int64_t kStep_ns = 1'000'000;
  int checked = 0;
  for (const Time t : some_times(spline, 40)) {
    if (near_a_knot(spline, t, kStep_ns)) continue;
    ++checked;
    const Kinematics state = spline.at(t);
    const auto tangent = [&](Time s) { return state_difference(state, spline.at(s)); };
    const StateVector numeric = by_time(tangent, t, kStep_ns);
    EXPECT_LT(tests::relative_difference(spline.rate(t, Derivative::acceleration), numeric), 1e-6);
    const StateVector pose_only = spline.rate(t, Derivative::pose);
    EXPECT_EQ(pose_only.head<6>(), spline.rate(t, Derivative::acceleration).head<6>());
  }
  EXPECT_GT(checked, 20);
}

/// Central differences of the whole state by every parameter of the spline.
Eigen::MatrixXd numeric_jacobian(const SplineTrajectory& spline, Time t) {
  constexpr double kStep = 1e-5;
  Eigen::MatrixXd J(static_cast<int>(state_row::count), spline.parameters());
  for (int i = 0; i < spline.parameters(); ++i) {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(spline.parameters());
    d[i] = kStep;
    SplineTrajectory high = spline, low = spline;
    high.retract(d);
    low.retract(-d);
    // The logarithm of R^T R has last digits even for one and the same R.
    const Kinematics before = low.at(t), after = high.at(t);
    J.col(i) =
        same_bits(before, after) ? StateVector::Zero() : StateVector(state_difference(before, after) / (2 * kStep));
  }
  return J;
}

TEST_P(EverySpline, JacobiansMatchCentralDifferencesAndEverythingElseIsExactlyZero) {
  const SplineTrajectory spline = lively(GetParam(), 3, 9);
  for (const Time t : some_times(spline, 6)) {
    StateJet jet;
    spline.jet(t, Derivative::acceleration, jet);
    ASSERT_EQ(jet.columns(), 6 * GetParam().order);
    EXPECT_TRUE(same_bits(jet.state, spline.at(t)));
    Eigen::MatrixXd numeric = numeric_jacobian(spline, t);
    const auto there = numeric.middleCols(jet.first, jet.columns());
    for (int row = 0; row < state_row::count; row += 3) {
      EXPECT_LT(tests::relative_difference(jet.J.middleRows<3>(row), there.middleRows<3>(row)), 1e-6)
          << "rows from " << row << ", t " << (t - spline.begin()).count();
    }
    numeric.middleCols(jet.first, jet.columns()).setZero();
    EXPECT_EQ(numeric.cwiseAbs().maxCoeff(), 0) << "columns that were not reported";
  }
}

TEST_P(EverySpline, JacobiansHoldForSmallTurnsAndNoneAtAll) {
  for (const double turn_rad : {0.0, 1e-9, 1e-4, 0.19, 0.21, 1.4}) {
    const RandomStream stream(4, "test/small_turns");
    std::vector<SE3> control(1, SE3::Identity());
    for (std::uint64_t i = 1; i < 8; ++i) {
      Vector6 step;
      step << vector(stream, i, 0), turn_rad * vector(stream, i, 1).normalized();
      control.push_back(control.back() * se3::exp(step));
    }
    const SplineTrajectory spline(GetParam().kind, GetParam().order, control,
                                  make_knots(8 + GetParam().order, GetParam().uniform));
    for (const Time t : some_times(spline, 2)) {
      StateJet jet;
      spline.jet(t, Derivative::acceleration, jet);
      const Eigen::MatrixXd numeric = numeric_jacobian(spline, t).middleCols(jet.first, jet.columns());
      for (int row = 0; row < state_row::count; row += 3) {
        EXPECT_LT(tests::relative_difference(jet.J.middleRows<3>(row), numeric.middleRows<3>(row)), 1e-6)
            << "turn " << turn_rad << " rows from " << row;
      }
    }
  }
}

TEST_P(EverySpline, LowerDerivativesFillTheSameRows) {
  const SplineTrajectory spline = lively(GetParam(), 5);
  for (const Time t : some_times(spline, 10)) {
    StateJet all;
    spline.jet(t, Derivative::acceleration, all);
    for (const Derivative upto : {Derivative::pose, Derivative::velocity}) {
      StateJet jet;
      spline.jet(t, upto, jet);
      const int rows = state_row::filled(upto);
      EXPECT_EQ(jet.first, all.first);
      EXPECT_EQ(jet.J.topRows(rows), all.J.topRows(rows));
    }
  }
}

TEST_P(EverySpline, IsSmoothAcrossKnots) {
  const SplineTrajectory spline = lively(GetParam(), 6);
  for (const Time knot : spline.knots()) {
    if (!spline.covers(knot) || !spline.covers(knot - Duration(1))) continue;
    const StateVector jump = state_difference(spline.at(knot - Duration(1)), spline.at(knot)) -
                             1e-9 * spline.rate(knot, Derivative::acceleration);
    // Order 4 has a jump of jerk at knots, so that a nanosecond leaves about 1e-9 x jerk in the accelerations.
    EXPECT_LT(jump.head<12>().norm(), 1e-10);
    EXPECT_LT(jump.tail<6>().norm(), 1e-5);
  }
}

TEST_P(EverySpline, AFarControlPointChangesNothing) {
  const SplineTrajectory spline = lively(GetParam(), 7);
  for (int block = 0; block < spline.blocks(); ++block) {
    SplineTrajectory moved = spline;
    Eigen::VectorXd step = Eigen::VectorXd::Zero(spline.parameters());
    step.segment<6>(6 * block).setConstant(0.1);
    moved.retract(step);
    int changed = 0;
    for (const Time t : some_times(spline, 60)) {
      StateJet jet;
      spline.jet(t, Derivative::pose, jet);
      const bool near = jet.first <= 6 * block && 6 * block < jet.first + jet.columns();
      if (!near) {
        EXPECT_TRUE(same_bits(spline.at(t), moved.at(t))) << "block " << block;
      }
      if (near && !same_bits(spline.at(t), moved.at(t))) ++changed;
    }
    EXPECT_GT(changed, 0) << "block " << block;
  }
}

TEST_P(EverySpline, BatchPosesAreTheSameBitsAsSinglePoses) {
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

TEST_P(EverySpline, PosesAreTheProductOfExponentials) {
  // The definition, with weights by the blending matrix and the group's own functions.
  const SplineTrajectory spline = lively(GetParam(), 9);
  const int k = GetParam().order;
  for (const Time t : some_times(spline, 20)) {
    const auto i = static_cast<std::size_t>(spline.first_block_at(t));
    const auto knots = std::span<const Time>(spline.knots()).subspan(i + 1, static_cast<std::size_t>(2 * k - 2));
    const double u = ratio(t, knots[static_cast<std::size_t>(k - 2)], knots[static_cast<std::size_t>(k - 1)]);
    Eigen::VectorXd powers(k);
    for (int m = 0; m < k; ++m) powers[m] = std::pow(u, m);
    const Eigen::VectorXd lambda = cumulative(blending_matrix(k, knots)).transpose() * powers;
    const auto& C = spline.control_points();
    SE3 T = C[i];
    for (int j = 1; j < k; ++j) {
      const SE3 &before = C[i + static_cast<std::size_t>(j) - 1], &after = C[i + static_cast<std::size_t>(j)];
      if (GetParam().kind == SplineKind::se3) {
        T = T * se3::exp(lambda[j] * se3::log(before.inverse() * after));
      } else {
        T.linear() = T.linear() * so3::exp(lambda[j] * so3::log(before.linear().transpose() * after.linear()));
        T.translation() += lambda[j] * (after.translation() - before.translation());
      }
    }
    EXPECT_LT(pose_difference(T, spline.pose(t)), 1e-12);
  }
}

TEST_P(EverySpline, AConstantMotionIsReproducedFromControlPointsOnIt) {
  const Case c = GetParam();
  const std::vector<Time> knots = make_knots(9 + c.order, c.uniform);
  Vector6 twist;  // per second
  twist << 8, -1, 0.5, 0.3, -0.8, 1.1;
  const Eigen::Vector3d v_world(5, 2, -1);
  const SE3 T0 = se3::exp((Vector6() << 1, 2, 3, 0.4, 0.5, 0.6).finished());
  const auto truth = [&](double s) {
    SE3 T = T0 * se3::exp(s * twist);
    if (c.kind == SplineKind::split) T.translation() = T0.translation() + s * v_world;
    return T;
  };
  std::vector<SE3> control;
  for (int i = 0; i < 9; ++i) control.push_back(truth(1e-9 * greville_ns_after(knots[0], knots, c.order, i)));
  const SplineTrajectory spline(c.kind, c.order, control, knots);
  for (const Time t : some_times(spline, 20)) {
    const Kinematics state = spline.at(t);
    EXPECT_LT(pose_difference(state.T_world_body, truth(to_s(t - knots[0]))), 1e-12);
    EXPECT_LT((state.omega_body - twist.tail<3>()).norm(), 1e-12);
    EXPECT_LT(state.alpha_body.norm(), 1e-10);
    const Eigen::Vector3d v = c.kind == SplineKind::split ? v_world : state.T_world_body.linear() * twist.head<3>();
    EXPECT_LT((state.v_world - v).norm(), 1e-11);
  }
}

TEST_P(EverySpline, AtRestNothingMoves) {
  const Case c = GetParam();
  const SE3 T = se3::exp((Vector6() << 1, 2, 3, 0.4, 0.5, 0.6).finished());
  const SplineTrajectory spline = SplineTrajectory::at_rest(c.kind, c.order, T, make_knots(6 + c.order, c.uniform));
  EXPECT_EQ(spline.blocks(), 6);
  for (const Time t : some_times(spline, 5)) {
    const Kinematics state = spline.at(t);
    EXPECT_LT(pose_difference(state.T_world_body, T), 1e-15);
    EXPECT_EQ(state.v_world.norm() + state.omega_body.norm() + state.a_world.norm() + state.alpha_body.norm(), 0);
  }
}

TEST_P(EverySpline, DifferenceUndoesAStepAndItsJacobianCarriesAFurtherOne) {
  expect_consistent_difference(lively(GetParam(), 10));
}

TEST_P(EverySpline, ExtendingAndDroppingLeaveTheRestAsItWas) {
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

TEST_P(EverySpline, ExtendingGoesOnAtConstantVelocity) {
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

TEST_P(EverySpline, ASegmentHasTheSamePosesFromItsOwnControlPointsOnly) {
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

TEST_P(EverySpline, ASegmentSurvivesAFileBitByBit) {
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

TEST_P(EverySpline, ASegmentsJacobiansMatchCentralDifferences) {
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

TEST_P(EverySpline, FirstBlockAtIsTheFirstThatAnyLaterStateDependsOn) {
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

/// A cubic polynomial's control points are its blossom: of t^3 the mean of the products of three of the knots that a
/// control point lies under, and so on (here by the three-fold symmetric means over order - 1 knots).
TEST(SplitSpline, ReproducesCubicPolynomialsOfPosition) {
  for (const int order : {4, 5, 6}) {
    const std::vector<Time> knots = make_knots(10 + order, false);
    const double coefficient[] = {1.0, -2.0, 3.0, 5.0};
    std::vector<SE3> control(10, SE3::Identity());
    for (int i = 0; i < 10; ++i) {
      std::vector<double> s;
      for (int j = 1; j < order; ++j) s.push_back(to_s(knots[static_cast<std::size_t>(i + j)] - knots[0]));
      double sum[4] = {1, 0, 0, 0}, count[4] = {1, 0, 0, 0};
      for (std::size_t a = 0; a < s.size(); ++a) {
        sum[1] += s[a];
        ++count[1];
        for (std::size_t b = a + 1; b < s.size(); ++b) {
          sum[2] += s[a] * s[b];
          ++count[2];
          for (std::size_t c = b + 1; c < s.size(); ++c) {
            sum[3] += s[a] * s[b] * s[c];
            ++count[3];
          }
        }
      }
      double x = 0;
      for (int m = 0; m < 4; ++m) x += coefficient[m] * sum[m] / count[m];
      control[static_cast<std::size_t>(i)].translation() = Eigen::Vector3d(x, -2 * x, 1);
    }
    const SplineTrajectory spline(SplineKind::split, order, control, knots);
    for (const Time t : some_times(spline, 30)) {
      const double s = to_s(t - knots[0]);
      const Kinematics state = spline.at(t);
      const double x = 1 - 2 * s + 3 * s * s + 5 * s * s * s;
      EXPECT_NEAR(state.T_world_body.translation().x(), x, 1e-13 * (1 + std::abs(x)));
      EXPECT_NEAR(state.T_world_body.translation().y(), -2 * x, 1e-13 * (1 + std::abs(x)));
      EXPECT_NEAR(state.v_world.x(), -2 + 6 * s + 15 * s * s, 1e-11);
      EXPECT_NEAR(state.a_world.x(), 6 + 30 * s, 1e-9);
      EXPECT_NEAR(spline.rate(t, Derivative::acceleration)[state_row::acceleration], 30, 1e-7);
    }
  }
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
