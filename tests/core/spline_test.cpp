#include <gtest/gtest.h>

#include "core/spline_trajectory.h"
#include "tests/core/spline_cases.h"
#include "tests/support/numeric.h"

namespace tarmac::core {
namespace {

using namespace spline_cases;
using tests::pose_difference;

class EverySpline : public ::testing::TestWithParam<Case> {};
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

/// Reach of the differences below.
constexpr std::int64_t kStep_ns = 1'000'000;

std::vector<Time> times_between_knots(const SplineTrajectory& spline) {
  std::vector<Time> times = some_times(spline, 40);
  std::erase_if(times, [&](Time t) { return near_a_knot(spline, t, kStep_ns); });
  EXPECT_GT(times.size(), 20u);
  return times;
}

TEST_P(EverySpline, VelocitiesAndAccelerationsAreTheDerivativesOfThePose) {
  const SplineTrajectory spline = lively(GetParam(), 1);
  for (const Time t : times_between_knots(spline)) {
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
}

TEST_P(EverySpline, RateIsTheDerivativeOfTheStateByTime) {
  const SplineTrajectory spline = lively(GetParam(), 2);
  for (const Time t : times_between_knots(spline)) {
    const Kinematics state = spline.at(t);
    const auto tangent = [&](Time s) { return state_difference(state, spline.at(s)); };
    const StateVector numeric = by_time(tangent, t, kStep_ns);
    EXPECT_LT(tests::relative_difference(spline.rate(t, Derivative::acceleration), numeric), 1e-6);
    const StateVector pose_only = spline.rate(t, Derivative::pose);
    EXPECT_EQ(pose_only.head<6>(), spline.rate(t, Derivative::acceleration).head<6>());
  }
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

}  // namespace
}  // namespace tarmac::core
