#include "core/gp_trajectory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>

#include "core/error.h"
#include "core/estimate.h"
#include "core/lie_derivatives.h"
#include "tests/core/gp_examples.h"
#include "tests/core/parametric_laws.h"
#include "tests/support/numeric.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::core {
namespace {

using tests::GpCase;
using tests::message_of;
using tests::pose_difference;
using tests::relative_difference;

Time at_ms(double ms) {
  return time_from_s(ms * 1e-3);
}

class EveryProcess : public ::testing::TestWithParam<GpCase> {
 protected:
  GpPrior prior() const { return GetParam().prior(); }
};
INSTANTIATE_TEST_SUITE_P(Gp, EveryProcess, ::testing::ValuesIn(tests::every_gp()),
                         [](const auto& each) { return each.param.name; });

GpTrajectory moved(const GpTrajectory& trajectory, int parameter, double step) {
  GpTrajectory out = trajectory;
  Eigen::VectorXd d = Eigen::VectorXd::Zero(trajectory.parameters());
  d[parameter] = step;
  out.retract(d);
  return out;
}

TEST_P(EveryProcess, StateJacobiansMatchCentralDifferences) {
  for (const double angle_rad : {0.0, 1e-7, 0.05, 0.2, 0.6}) {
    const GpTrajectory trajectory = tests::random_gp(prior(), 1, 4, angle_rad);
    for (const double ms : {0.0, 0.5, 37.0, 99.9, 100.0, 150.0, 250.0, 299.0, 300.0}) {
      const Time t = at_ms(ms);
      StateJet jet;
      trajectory.jet(t, Derivative::acceleration, jet);
      EXPECT_EQ(jet.state.T_world_body.matrix(), trajectory.pose(t).matrix()) << ms;
      EXPECT_LT(state_difference(trajectory.at(t), jet.state).norm(), 1e-15) << ms;
      Eigen::MatrixXd J = Eigen::MatrixXd::Zero(18, trajectory.parameters());
      J.middleCols(jet.first, jet.columns()) = jet.J;
      Eigen::MatrixXd numeric(18, trajectory.parameters());
      constexpr double step = 1e-5;
      for (int k = 0; k < trajectory.parameters(); ++k) {
        numeric.col(k) =
            state_difference(moved(trajectory, k, -step).at(t), moved(trajectory, k, step).at(t)) / (2 * step);
      }
      for (int row = 0; row < 18; row += 3) {
        EXPECT_LT(relative_difference(J.middleRows<3>(row), numeric.middleRows<3>(row)), 1e-6)
            << "angle_rad " << angle_rad << " ms " << ms << " row " << row;
      }
    }
  }
}

TEST_P(EveryProcess, LowerDerivativesAreTheUpperRows) {
  const GpTrajectory trajectory = tests::random_gp(prior(), 2, 3, 0.3);
  for (const double ms : {0.0, 70.0, 100.0, 200.0}) {
    StateJet full, part;
    trajectory.jet(at_ms(ms), Derivative::acceleration, full);
    for (const Derivative upto : {Derivative::pose, Derivative::velocity}) {
      trajectory.jet(at_ms(ms), upto, part);
      const int rows = state_row::filled(upto);
      Eigen::MatrixXd a = Eigen::MatrixXd::Zero(rows, trajectory.parameters()), b = a;
      a.middleCols(full.first, full.columns()) = full.J.topRows(rows);
      b.middleCols(part.first, part.columns()) = part.J.topRows(rows);
      EXPECT_LT((a - b).norm(), 1e-12) << ms;
    }
  }
}

TEST_P(EveryProcess, PriorJacobianMatchesCentralDifferences) {
  for (const double angle_rad : {0.0, 1e-7, 0.05, 0.2, 0.6}) {
    const GpTrajectory trajectory = tests::random_gp(prior(), 3, 3, angle_rad);
    for (int i = 0; i < trajectory.priors(); ++i) {
      PriorJet jet;
      trajectory.prior(i, jet);
      ASSERT_EQ(jet.J.cols(), 2 * trajectory.block_size());
      Eigen::MatrixXd numeric(jet.e.size(), jet.J.cols());
      constexpr double step = 1e-5;
      for (int k = 0; k < jet.J.cols(); ++k) {
        PriorJet high, low;
        moved(trajectory, jet.first + k, step).prior(i, high);
        moved(trajectory, jet.first + k, -step).prior(i, low);
        numeric.col(k) = (high.e - low.e) / (2 * step);
      }
      EXPECT_LT(relative_difference(jet.J, numeric), 1e-6) << angle_rad;
    }
  }
}

TEST_P(EveryProcess, RatesMatchCentralDifferencesInTime) {
  const GpTrajectory trajectory = tests::random_gp(prior(), 4, 4, 0.4);
  for (const double ms : {1.0, 37.0, 99.0, 150.0, 250.0}) {
    const auto central = [&](double h_ms) -> StateVector {
      return state_difference(trajectory.at(at_ms(ms - h_ms)), trajectory.at(at_ms(ms + h_ms))) / (2e-3 * h_ms);
    };
    const StateVector numeric = (4 * central(0.05) - central(0.1)) / 3;
    const StateVector rate = trajectory.rate(at_ms(ms), Derivative::acceleration);
    for (int row = 0; row < 18; row += 3) {
      EXPECT_LT(relative_difference(rate.segment<3>(row), numeric.segment<3>(row)), 1e-6) << ms << " row " << row;
    }
  }
}

TEST_P(EveryProcess, HitsItsKnotsAndApproachesThem) {
  const GpTrajectory trajectory = tests::random_gp(prior(), 5, 4, 0.5);
  for (const GpKnot& knot : trajectory.knots()) {
    const Kinematics expected = kinematics(knot), state = trajectory.at(knot.t);
    EXPECT_EQ(trajectory.pose(knot.t).matrix(), knot.T_world_body.matrix());
    EXPECT_EQ(state.v_world, expected.v_world);
    EXPECT_EQ(state.omega_body, expected.omega_body);
    if (prior().model != GpModel::wnoa) {
      EXPECT_EQ(state.a_world, expected.a_world);
      EXPECT_EQ(state.alpha_body, expected.alpha_body);
    }
    // A nanosecond beside it nothing has jumped: what it changes by in that time, and rounding.
    const StateVector rate = trajectory.rate(knot.t, Derivative::acceleration);
    for (const Duration beside : {Duration(-1), Duration(1)}) {
      if (!trajectory.covers(knot.t + beside)) continue;
      const StateVector d = state_difference(state, trajectory.at(knot.t + beside));
      EXPECT_LT(d.head<12>().norm(), 5e-9 * (100 + rate.head<12>().norm()));
      // Jerk and snap on the other side of the knot are others, but no more than tens of times.
      if (prior().model != GpModel::wnoa) {
        EXPECT_LT(d.tail<6>().norm(), 50e-9 * (1000 + rate.tail<6>().norm()));
      }
    }
  }
}

/// Constant velocity, and without noise nothing else: the mean that a prior begins with.
TEST_P(EveryProcess, GrowsByItsMeanSoThatThePriorIsContent) {
  GpTrajectory trajectory = tests::random_gp(prior(), 6, 2, 0.2);
  const std::vector<Time> times = {at_ms(150), at_ms(300), at_ms(301)};
  trajectory.extend(at_ms(100), at_ms(300.5), times);
  ASSERT_EQ(trajectory.blocks(), 5);
  EXPECT_EQ(trajectory.end(), at_ms(301));
  PriorJet jet;
  for (int i = 1; i < trajectory.priors(); ++i) {
    trajectory.prior(i, jet);
    // Whitened, since one millisecond's noise is tiny.
    EXPECT_LT(jet.e.dot(jet.information * jet.e), 1e-9) << i;
  }
  // Up to the next knot the motion is the prediction itself; further on only a constant twist goes on alike, since
  // every knot has a local variable of its own.
  const GpTrajectory from = tests::random_gp(prior(), 6, 2, 0.2);
  for (const double ms : {100.0, 120.0, 150.0, 200.0, 300.0}) {
    if (ms > 150 && prior().model != GpModel::wnoa) break;
    EXPECT_LT(pose_difference(trajectory.pose(at_ms(ms)), from.extrapolated(at_ms(ms)).T_world_body), 1e-12) << ms;
  }
}

TEST_P(EveryProcess, GrowsToTheEndWhereTheListEndsBefore) {
  GpTrajectory trajectory(prior(), {{at_ms(0)}});
  trajectory.extend(at_ms(0), at_ms(100), {});
  EXPECT_EQ(trajectory.end(), at_ms(100));
  const std::vector<Time> times = {at_ms(150)};
  trajectory.extend(at_ms(120), at_ms(200), times);
  EXPECT_EQ(trajectory.blocks(), 4);
  EXPECT_EQ(trajectory.end(), at_ms(200));
  trajectory.extend(at_ms(120), at_ms(200), {});
  EXPECT_EQ(trajectory.blocks(), 4) << "what is covered needs no knot";
}

TEST_P(EveryProcess, RefusesBadInput) {
  const GpPrior good = prior();
  const GpKnot knot{at_ms(0)};
  GpTrajectory trajectory(good, {knot});
  const std::vector<Time> same = {at_ms(50), at_ms(50)}, close = {at_ms(50), at_ms(50.9)},
                          back = {at_ms(50), at_ms(20)};
  for (const auto& times : {same, close, back}) {
    EXPECT_THROW(trajectory.extend(at_ms(0), at_ms(10), times), InputError);
    EXPECT_EQ(trajectory.blocks(), 1) << "a refused list leaves no trace";
  }
  EXPECT_THAT(message_of<InputError>([&] { trajectory.extend(at_ms(0), at_ms(10), close); }),
              ::testing::HasSubstr("900000 ns after"));
  EXPECT_THROW(trajectory.extend(at_ms(-5), at_ms(10), {}), InputError);
  EXPECT_THROW(trajectory.extend(at_ms(5), at_ms(4), {}), InputError);
  EXPECT_THROW(GpTrajectory(good, {}), InputError);
  EXPECT_THROW(GpTrajectory(good, {{at_ms(0)}, {at_ms(0)}}), InputError);
  GpKnot broken = knot;
  broken.varpi[4] = std::nan("");
  EXPECT_THROW(GpTrajectory(good, {broken}), InputError);
  GpPrior still = good;
  still.qc[2] = 0;
  EXPECT_THROW(GpTrajectory(still, {knot}), InputError);
  if (good.model == GpModel::singer) {
    GpPrior growing = good;
    growing.rate[1] = -1;
    EXPECT_THROW(GpTrajectory(growing, {knot}), InputError);
  }
}

TEST_P(EveryProcess, NeverExtrapolates) {
  const GpTrajectory trajectory = tests::random_gp(prior(), 7, 3, 0.2);
  StateJet jet;
  SE3 T;
  for (const Time t : {trajectory.begin() - Duration(1), trajectory.end() + Duration(1)}) {
    EXPECT_FALSE(trajectory.covers(t));
    EXPECT_THROW(trajectory.pose(t), OutOfSpan);
    EXPECT_THROW(trajectory.at(t), OutOfSpan);
    EXPECT_THROW(trajectory.jet(t, Derivative::pose, jet), OutOfSpan);
    EXPECT_THROW(trajectory.rate(t, Derivative::pose), OutOfSpan);
    EXPECT_THROW(trajectory.poses({&t, 1}, {&T, 1}), OutOfSpan);
    EXPECT_THROW(trajectory.segment(trajectory.begin(), t), OutOfSpan);
  }
}

TEST_P(EveryProcess, ForgetsKnotsAndKeepsTheMotionAfterThem) {
  const GpTrajectory before = tests::random_gp(prior(), 8, 6, 0.3);
  EXPECT_EQ(before.first_block_at(at_ms(-50)), 0);
  EXPECT_EQ(before.first_block_at(at_ms(250)), 2);
  EXPECT_EQ(before.first_block_at(at_ms(300)), 3);
  GpTrajectory after = before;
  after.drop(before.first_block_at(at_ms(250)));
  EXPECT_EQ(after.begin(), at_ms(200));
  for (const double ms : {200.0, 250.0, 300.0, 471.0}) {
    EXPECT_EQ(state_difference(before.at(at_ms(ms)), after.at(at_ms(ms))).tail<12>().norm(), 0) << ms;
    EXPECT_EQ(after.pose(at_ms(ms)).matrix(), before.pose(at_ms(ms)).matrix());
  }
  PriorJet a, b;
  after.prior(0, a);
  before.prior(2, b);
  EXPECT_EQ(a.first, 0);
  EXPECT_EQ(a.e, b.e);
  EXPECT_EQ(a.J, b.J);
  EXPECT_THROW(after.drop(4), std::invalid_argument);
}

TEST_P(EveryProcess, ValuesAndDifferencesUndoSteps) {
  GpTrajectory trajectory = tests::random_gp(prior(), 9, 3, 0.3);
  const Eigen::VectorXd base = trajectory.value(1);
  const int size = trajectory.block_size();
  Eigen::VectorXd d;
  Eigen::MatrixXd J;
  trajectory.difference(1, base, d, J);
  EXPECT_LT(d.norm(), 1e-15);
  EXPECT_LT((J - Eigen::MatrixXd::Identity(size, size)).norm(), 1e-14);
  Eigen::VectorXd step = Eigen::VectorXd::Zero(trajectory.parameters());
  for (int i = 0; i < step.size(); ++i) step[i] = 0.3 * std::sin(1 + i);
  trajectory.retract(step);
  trajectory.difference(1, base, d, J);
  EXPECT_LT((d - step.segment(size, size)).norm(), 1e-14);
  Eigen::MatrixXd numeric(size, size);
  constexpr double h = 1e-6;
  for (int k = 0; k < size; ++k) {
    Eigen::VectorXd high, low;
    Eigen::MatrixXd unused;
    moved(trajectory, size + k, h).difference(1, base, high, unused);
    moved(trajectory, size + k, -h).difference(1, base, low, unused);
    numeric.col(k) = (high - low) / (2 * h);
  }
  EXPECT_LT(relative_difference(J, numeric), 1e-6);
}

TEST_P(EveryProcess, ManyPosesAtOnceAreTheSameBits) {
  const GpTrajectory trajectory = tests::random_gp(prior(), 10, 8, 0.4);
  std::vector<Time> times;
  for (int i = 0; i <= 7000; ++i) {
    for (int repeat = 0; repeat < 1 + i % 3; ++repeat) times.push_back(time_from_ns(100'000LL * i));
  }
  std::vector<SE3> poses(times.size());
  trajectory.poses(times, poses);
  for (std::size_t i = 0; i < times.size(); ++i) ASSERT_EQ(poses[i].matrix(), trajectory.pose(times[i]).matrix()) << i;
}

TEST_P(EveryProcess, ASegmentIsTheSameMotion) {
  const GpTrajectory trajectory = tests::random_gp(prior(), 11, 6, 0.3);
  struct Span {
    double begin_ms, end_ms;
    std::size_t knots;
  };
  for (const Span& span : {Span{0, 500, 6}, Span{150, 350, 4}, Span{100, 200, 2}, Span{220, 280, 2}, Span{300, 300, 2},
                           Span{500, 500, 2}, Span{400, 500, 2}, Span{100, 300.5, 4}}) {
    const Segment segment = trajectory.segment(at_ms(span.begin_ms), at_ms(span.end_ms));
    EXPECT_EQ(segment.poses.size(), span.knots) << span.begin_ms << " to " << span.end_ms;
    for (int i = 0; i <= 10; ++i) {
      const Time t = at_ms(span.begin_ms + (span.end_ms - span.begin_ms) * i / 10);
      EXPECT_EQ(segment.pose(t).matrix(), trajectory.pose(t).matrix());
    }
    EXPECT_THROW(segment.pose(segment.t0 - Duration(1)), OutOfSpan);
    EXPECT_THROW(segment.pose(segment.t1 + Duration(1)), OutOfSpan);
  }
  const GpTrajectory back = GpTrajectory::from_segment(trajectory.segment(at_ms(100), at_ms(500)), prior().qc);
  EXPECT_EQ(back.at(at_ms(444)).a_world, trajectory.at(at_ms(444)).a_world);
  EXPECT_THROW(GpTrajectory(prior(), {{at_ms(0)}}).segment(at_ms(0), at_ms(0)), std::logic_error);
}

TEST_P(EveryProcess, ASegmentsJacobiansMatchCentralDifferences) {
  for (const double angle_rad : {0.0, 0.2, 0.6}) {
    const Segment segment = tests::random_gp(prior(), 12, 4, angle_rad).segment(at_ms(0), at_ms(300));
    for (const double ms : {0.0, 30.0, 100.0, 199.0, 300.0}) {
      std::vector<BlockJacobian> jacobians;
      EXPECT_EQ(segment.pose(at_ms(ms), jacobians).matrix(), segment.pose(at_ms(ms)).matrix());
      for (int block = 0; block < 4; ++block) {
        Matrix6 J = Matrix6::Zero();
        for (const BlockJacobian& entry : jacobians) {
          if (entry.block == block) J = entry.jacobian;
        }
        const auto with_block = [&](const SE3& T) {
          Segment other = segment;
          other.poses[static_cast<std::size_t>(block)] = T;
          return other.pose(at_ms(ms));
        };
        const Matrix6 numeric =
            tests::numeric_pose_jacobian(with_block, segment.poses[static_cast<std::size_t>(block)], 1e-5);
        EXPECT_LT(relative_difference(J, numeric), 1e-6) << angle_rad << " at " << ms << " block " << block;
      }
    }
  }
}

TEST_P(EveryProcess, ASegmentSurvivesTheFile) {
  const tests::TemporaryFolder folder;
  const GpTrajectory trajectory = tests::random_gp(prior(), 13, 5, 0.3);
  Estimate estimate;
  estimate.estimator = "test";
  estimate.causal.append(trajectory.segment(at_ms(50), at_ms(380)));
  save_estimate(folder / "trajectory.bin", estimate);
  const Estimate back = load_estimate(folder / "trajectory.bin");
  ASSERT_EQ(back.causal.segments().size(), 1u);
  EXPECT_EQ(back.causal.segments()[0].model, estimate.causal.segments()[0].model);
  for (const double ms : {50.0, 99.0, 100.0, 233.0, 380.0}) {
    EXPECT_EQ(back.causal.pose(at_ms(ms)).matrix(), trajectory.pose(at_ms(ms)).matrix()) << ms;
  }
  EXPECT_THROW(back.causal.pose(at_ms(49)), OutOfSpan);
}

TEST_P(EveryProcess, ACloneIsItsOwn) {
  const GpTrajectory trajectory = tests::random_gp(prior(), 14, 3, 0.3);
  const SE3 before = trajectory.pose(at_ms(150));
  const auto clone = trajectory.clone();
  EXPECT_EQ(clone->pose(at_ms(150)).matrix(), before.matrix());
  clone->retract(Eigen::VectorXd::Constant(clone->parameters(), 0.1));
  EXPECT_GT(pose_difference(clone->pose(at_ms(150)), before), 0.01);
  EXPECT_EQ(trajectory.pose(at_ms(150)).matrix(), before.matrix());
}

TEST_P(EveryProcess, ObeysTheLawsOfTrajectoriesWithParameters) {
  const GpTrajectory trajectory = tests::random_gp(prior(), 16, 4, 0.3);
  for (const double ms : {13.0, 150.0, 271.0}) expect_exact_jet(trajectory, at_ms(ms));
  // Differences of 0.1 ms: what they miss is the fifth derivative's.
  for (const double ms : {13.0, 150.0, 271.0}) expect_exact_rate(trajectory, at_ms(ms), 1e-4);
  expect_consistent_difference(trajectory);
}

/// zeta = Jr^-1 varpi' + 1/2 curly(eta) varpi. Exact would be (d/dt Jr^-1(xi)) varpi in place of the second term. With
/// E = curly(eta), E eta = 0 and varpi = eta - 1/2 X eta + ...: the published term is -1/4 E X eta, the exact one d/dt
/// (1/2 X + 1/12 X^2) varpi = (-1/4 + 1/12) E X eta, up to |xi|^2. So the first is three halves of the second, with its
/// sign.
TEST(PublishedAcceleration, IsThreeHalvesOfTheExactTermForSmallTurns) {
  const GpCase wnoj = tests::every_gp()[1];
  for (const double angle_rad : {1e-3, 1e-2}) {
    GpTrajectory trajectory = tests::random_gp(wnoj.prior(), 17, 2, angle_rad);
    std::vector<GpKnot> knots = trajectory.knots();
    Vector6 xi = tests::random6(RandomStream(17, "test/published"), 0);
    xi *= angle_rad / xi.norm();
    knots[1].T_world_body = knots[0].T_world_body * se3::exp(xi);
    trajectory = GpTrajectory(wnoj.prior(), knots);
    const GpInterval interval(GpModel::wnoj, group_axes(wnoj.prior()), knots[0], knots[1]);
    const Vector6 eta = interval.gamma_2()[1];
    const Matrix6 J_inverse = se3::right_jacobian_inverse(xi);
    const Vector6 published = interval.gamma_2()[2] - J_inverse * knots[1].dvarpi;
    const Vector6 exact = se3::right_jacobian_inverse_derivative(xi, knots[1].varpi) * eta;
    EXPECT_LT((published - 1.5 * exact).norm(), 3 * angle_rad * exact.norm()) << angle_rad;
  }
}

TEST(GpKnot, IsTheKinematicsSeenFromTheBody) {
  const GpTrajectory trajectory = tests::random_gp(tests::every_gp()[1].prior(), 15, 2, 0.4);
  const Kinematics state = trajectory.at(at_ms(40)), back = kinematics(gp_knot(at_ms(40), state));
  EXPECT_LT(state_difference(back, state).norm(), 1e-13);
  const GpKnot still_in_world = gp_knot(at_ms(0), {SE3::Identity(), {2, 0, 0}, {0, 0, 0}, {0, 0, 1}, {0, 0, 0}});
  // A body that turns to the left while it drifts along x sees its velocity turn to the right.
  EXPECT_LT((still_in_world.dvarpi.head<3>() - Eigen::Vector3d(0, -2, 0)).norm(), 1e-15);
}

TEST(Wnoa, HasAConstantTwistBetweenKnotsThatHaveOne) {
  const GpCase wnoa = tests::every_gp()[0];
  Vector6 varpi;
  varpi << 15, -2, 0.5, 0.3, -0.8, 2.5;
  const GpTrajectory from = {wnoa.prior(), {{at_ms(0), se3::exp(Vector6::Constant(0.4)), varpi}}};
  GpTrajectory trajectory = from;
  trajectory.extend(at_ms(0), at_ms(200), {});
  for (int i = 0; i <= 20; ++i) {
    const double s = 0.01 * i;
    const SE3 expected = from.knots()[0].T_world_body * se3::exp(s * varpi);
    EXPECT_LT(pose_difference(trajectory.pose(at_ms(1000 * s)), expected), 1e-12);
    const Kinematics state = trajectory.at(at_ms(1000 * s));
    EXPECT_LT((state.v_world - expected.linear() * varpi.head<3>()).norm(), 1e-12);
    EXPECT_LT((state.omega_body - varpi.tail<3>()).norm(), 1e-12);
    EXPECT_LT(state.alpha_body.norm(), 1e-9);
  }
}

TEST(Wnoj, HasAConstantAccelerationInPureTranslation) {
  const GpCase wnoj = tests::every_gp()[1];
  const Eigen::Vector3d v(8, -1, 0.3), a(-6, 2, 1);
  GpKnot knot{at_ms(0)};
  knot.varpi << v, 0, 0, 0;
  knot.dvarpi << a, 0, 0, 0;
  GpTrajectory trajectory(wnoj.prior(), {knot});
  const std::vector<Time> times = {at_ms(70), at_ms(200)};
  trajectory.extend(at_ms(0), at_ms(200), times);
  for (int i = 0; i <= 20; ++i) {
    const double s = 0.01 * i;
    const Kinematics state = trajectory.at(at_ms(1000 * s));
    EXPECT_LT((state.T_world_body.translation() - (s * v + 0.5 * s * s * a)).norm(), 1e-12);
    EXPECT_LT((state.v_world - (v + s * a)).norm(), 1e-12);
    EXPECT_LT((state.a_world - a).norm(), 1e-11);
  }
}

}  // namespace
}  // namespace tarmac::core
