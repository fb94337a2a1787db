/// The least-squares problem of one sweep with its associations fixed: derivatives, both solvers, null space.
#include "estimators/ct_icp/elastic_problem.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "tests/estimators/room_world.h"
#include "tests/support/numeric.h"

namespace tarmac::estimators {
namespace {

using core::SE3;
using core::Segment;
using core::SegmentModel;
using core::Vector6;
using Vector12 = Eigen::Matrix<double, 12, 1>;

const core::Time kBegin = core::time_from_ns(0), kEnd = core::time_from_ns(100'000'000);

Segment moved(const Segment& segment, const Eigen::VectorXd& x) {
  Segment out = segment;
  for (std::size_t b = 0; b < segment.poses.size(); ++b) {
    out.poses[b] = segment.poses[b] * core::se3::exp(Vector6(x.segment<6>(6 * static_cast<Eigen::Index>(b))));
  }
  return out;
}

/// Points on the walls of a room, seen from a moving sensor, each tied to its wall with a little noise.
struct Fixture {
  Segment truth;
  std::vector<Keypoint> keypoints;
  std::vector<Association> associations;
  Regularisers regularisers;
  RobustLoss loss;
  bool regularised = true;

  explicit Fixture(SegmentModel model = SegmentModel::two_pose_slerp, double noise_m = 0.02, int points = 600) {
    const SE3 T0 = tests::some_pose(0.3, 0.5);
    truth = model == SegmentModel::held ? Segment::hold(kBegin, kEnd, T0)
                                        : Segment::two_pose(model, kBegin, T0, kEnd, T0 * tests::some_pose(0.15, 0.9));
    const core::RandomStream random(1, "test/walls");
    const SegmentSampler sampler(truth);
    for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(points); ++i) {
      const int axis = static_cast<int>(i % 3);
      Eigen::Vector3d q(12 * random.uniform(i, 0) - 6, 10 * random.uniform(i, 1) - 5, 6 * random.uniform(i, 2) - 3);
      const double side = random.uniform(i, 3) < 0.5 ? -1 : 1;
      q[axis] = side * Eigen::Vector3d(6, 5, 3)[axis];
      Association a;
      a.used = i % 10 != 9;
      a.q_map = q;
      a.n_map = -side * Eigen::Vector3d::Unit(axis);
      a.weight = 0.3 + 0.6 * random.uniform(i, 4);
      Keypoint keypoint;
      keypoint.alpha = random.uniform(i, 5);
      // One in twelve is far off, for the losses to have work.
      const double off_m = noise_m * random.normal(i, 6) * (i % 12 == 0 ? 15 : 1);
      const Eigen::Vector3d along(random.normal(i, 7), random.normal(i, 8), random.normal(i, 9));
      const Eigen::Vector3d on_wall = q + 0.2 * (along - a.n_map * a.n_map.dot(along));
      keypoint.p_body = sampler.pose(keypoint.alpha).inverse() * (on_wall + off_m * a.n_map);
      keypoints.push_back(keypoint);
      associations.push_back(a);
    }
    regularisers.beta_location = 0.001;
    regularisers.beta_constant_velocity = 0.002;
    regularisers.beta_small_velocity = 0.003;
    regularisers.beta_orientation = 0.004;
    regularisers.T_previous_begin = T0 * tests::some_pose(-0.2, -1.1);
    regularisers.T_previous_end = T0 * tests::some_pose(0.05, 0.1);
  }
  ElasticProblem problem() const { return {keypoints, associations, loss, regularised ? &regularisers : nullptr}; }
  Segment start() const {
    Vector12 x;
    x << 0.05, -0.03, 0.02, 0.01, -0.015, 0.02, -0.04, 0.06, 0.03, -0.02, 0.01, 0.015;
    return moved(truth, x);
  }
};

double difference(const Segment& a, const Segment& b) {
  double most = 0;
  for (std::size_t k = 0; k < a.poses.size(); ++k) {
    most = std::max(most, tests::pose_difference(a.poses[k], b.poses[k]));
  }
  return most;
}

class EveryProblem : public testing::TestWithParam<std::tuple<SegmentModel, Loss>> {
 protected:
  Fixture fixture_ = make();

 private:
  static Fixture make() {
    Fixture fixture(std::get<0>(GetParam()));
    fixture.loss = {std::get<1>(GetParam()), 0.1, 0.004};
    return fixture;
  }
};

TEST_P(EveryProblem, GradientIsTheNumericOneOfTheCost) {
  const Segment motion = fixture_.start();
  const auto at = [&](const Vector12& x) {
    return Eigen::Matrix<double, 1, 1>(cost(fixture_.problem(), moved(motion, x)));
  };
  const Vector12 zero = Vector12::Zero();
  const Eigen::VectorXd numeric =
      tests::numeric_jacobian<1, 12>(at, zero).transpose().head(6 * static_cast<Eigen::Index>(motion.poses.size()));
  NormalEquations equations(static_cast<int>(motion.poses.size()));
  assemble(fixture_.problem(), motion, equations);
  EXPECT_EQ(equations.data_rows(), 540);
  EXPECT_LT(tests::relative_difference(Eigen::VectorXd(equations.g_data() + equations.g_prior()), numeric), 1e-6);
}

// Both lower the same cost, with the same weights, loss and regularisers, from the same start.
TEST_P(EveryProblem, BothSolversAgreeWithinAMicrometreAndAMicroradian) {
  Segment by_steps = fixture_.start(), by_ceres = fixture_.start();
  for (int k = 0; k < 300; ++k) ASSERT_TRUE(gauss_newton_step(fixture_.problem(), by_steps));
  ASSERT_TRUE(solve_with_ceres(fixture_.problem(), 300, by_ceres));
  for (std::size_t b = 0; b < by_steps.poses.size(); ++b) {
    const SE3 &a = by_steps.poses[b], &c = by_ceres.poses[b];
    EXPECT_LT((a.translation() - c.translation()).norm(), 1e-6);
    EXPECT_LT(core::so3::angle_rad(a.linear().transpose() * c.linear()), 1e-6);
  }
  EXPECT_GT(difference(by_steps, fixture_.start()), 0.02);
  EXPECT_LT(difference(by_steps, fixture_.truth), 0.2);
}

std::string problem_name(const testing::TestParamInfo<std::tuple<SegmentModel, Loss>>& info) {
  const char* models[] = {"none", "slerp", "screw", "held"};
  const char* losses[] = {"standard", "cauchy", "huber", "tolerant", "truncated"};
  return std::string(models[static_cast<int>(std::get<0>(info.param))]) + "_" +
         losses[static_cast<int>(std::get<1>(info.param))];
}

INSTANTIATE_TEST_SUITE_P(
    Problems, EveryProblem,
    testing::Combine(testing::Values(SegmentModel::two_pose_slerp, SegmentModel::two_pose_screw, SegmentModel::held),
                     testing::Values(Loss::standard, Loss::cauchy, Loss::huber, Loss::tolerant, Loss::truncated)),
    problem_name);

TEST(ElasticProblem, RegularisersAreOneByOneThoseOfTheirDefinition) {
  const Fixture fixture;
  const SE3 &begin = fixture.truth.poses[0], &end = fixture.truth.poses[1];
  const SE3 &last_begin = fixture.regularisers.T_previous_begin, &last_end = fixture.regularisers.T_previous_end;
  const auto sum_of = [&](double lc, double cv, double sv, double o) {
    Regularisers only = fixture.regularisers;
    only.beta_location = lc, only.beta_constant_velocity = cv, only.beta_small_velocity = sv, only.beta_orientation = o;
    double sum = 0;
    for (const PriorRow& row : prior_rows(only, 250, fixture.truth)) sum += row.weight * row.value * row.value;
    return sum;
  };
  const Eigen::Vector3d step = end.translation() - begin.translation();
  const Eigen::Vector3d last_step = last_end.translation() - last_begin.translation();
  const double dot = Eigen::Quaterniond(begin.linear()).dot(Eigen::Quaterniond(last_end.linear()));
  EXPECT_NEAR(sum_of(0.1, 0, 0, 0), 25 * (begin.translation() - last_end.translation()).squaredNorm(), 1e-12);
  EXPECT_NEAR(sum_of(0, 0.1, 0, 0), 25 * (step - last_step).squaredNorm(), 1e-12);
  EXPECT_NEAR(sum_of(0, 0, 0.1, 0), 25 * step.squaredNorm(), 1e-12);
  EXPECT_NEAR(sum_of(0, 0, 0, 0.1), 25 * std::pow(1 - dot * dot, 2), 1e-12);
}

TEST(ElasticProblem, RegularisersDerivativesMatchCentralDifferences) {
  const Fixture fixture;
  const std::vector<PriorRow> rows = prior_rows(fixture.regularisers, 540, fixture.truth);
  ASSERT_EQ(rows.size(), 10U);
  const auto values = [&](const Vector12& x) {
    const std::vector<PriorRow> there = prior_rows(fixture.regularisers, 540, moved(fixture.truth, x));
    Eigen::Matrix<double, 10, 1> v;
    for (int i = 0; i < 10; ++i) v[i] = there[static_cast<std::size_t>(i)].value;
    return v;
  };
  const Vector12 zero = Vector12::Zero();
  const Eigen::Matrix<double, 10, 12> numeric = tests::numeric_jacobian<10, 12>(values, zero);
  for (int i = 0; i < 10; ++i) {
    const PriorRow& row = rows[static_cast<std::size_t>(i)];
    Eigen::Matrix<double, 1, 12> J;
    J << row.by_begin, row.by_end;
    EXPECT_LT((J - numeric.row(i)).norm(), 1e-8) << "row " << i;
  }
}

TEST(ElasticProblem, QuirkDrawsTheBeginToThisEndAndHasNoCrossBlock) {
  Fixture fixture;
  fixture.regularisers.beta_small_velocity = fixture.regularisers.beta_orientation = 0;
  fixture.regularisers.quirk = true;
  NormalEquations equations(2);
  assemble(fixture.problem(), fixture.truth, equations);
  const double N = equations.data_rows();
  const Eigen::Vector3d step = fixture.truth.poses[1].translation() - fixture.truth.poses[0].translation();
  const Eigen::Vector3d g_begin = fixture.truth.poses[0].linear() * equations.g_prior().segment<3>(0);
  EXPECT_LT((g_begin + N * 0.001 * step).norm(), 1e-12);
  EXPECT_EQ((equations.H_prior().block<6, 6>(0, 6).norm()), 0);
  EXPECT_LT((equations.H_prior().block<3, 3>(6, 6) - N * 0.002 * Eigen::Matrix3d::Identity()).norm(), 1e-12);
  Segment motion = fixture.start();
  EXPECT_TRUE(gauss_newton_step(fixture.problem(), motion));
  EXPECT_THROW(solve_with_ceres(fixture.problem(), 5, motion), std::invalid_argument);
}

TEST(ElasticProblem, TheLossLeavesRegularisersAlone) {
  Fixture fixture;
  fixture.regularisers.T_previous_end.translation() += Eigen::Vector3d(50, 0, 0);
  NormalEquations plain(2), robust(2);
  assemble(fixture.problem(), fixture.truth, plain);
  fixture.loss = {Loss::cauchy, 0.01, 0};
  assemble(fixture.problem(), fixture.truth, robust);
  EXPECT_EQ(plain.H_prior(), robust.H_prior());
  EXPECT_EQ(plain.g_prior(), robust.g_prior());
  EXPECT_GT((plain.H_data() - robust.H_data()).norm(), 0.1 * plain.H_data().norm());
}

/// Rows of an endless corridor along x, seen by a spinning sensor at rest: exact normals, all weights 1.
Fixture corridor() {
  Fixture fixture(SegmentModel::two_pose_slerp, 0, 0);
  fixture.truth = Segment::two_pose(SegmentModel::two_pose_slerp, kBegin, SE3::Identity(), kEnd, SE3::Identity());
  fixture.regularisers = {};
  for (int column = 0; column < 512; ++column) {
    for (int ring = 0; ring < 32; ++ring) {
      const double azimuth = 2 * M_PI * (column + 0.5) / 512, elevation = (ring - 15.5) * 1.45 * M_PI / 180;
      const Eigen::Vector3d u(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                              std::sin(elevation));
      // 4 m wide, 3 m high.
      const double to_wall = 2 / std::abs(u.y()), to_floor = 1.5 / std::abs(u.z());
      const double range_m = std::min(to_wall, to_floor);
      if (range_m > 60) continue;
      Association a{.used = true, .q_map = range_m * u, .n_map = Eigen::Vector3d::Zero(), .weight = 1};
      if (to_wall < to_floor) {
        a.n_map.y() = u.y() > 0 ? -1 : 1;
      } else {
        a.n_map.z() = u.z() > 0 ? -1 : 1;
      }
      fixture.keypoints.push_back({.p_body = range_m * u, .alpha = column / 511.0});
      fixture.associations.push_back(a);
    }
  }
  return fixture;
}

/// Per residual, rotations divided by the mean range: metres throughout.
Eigen::VectorXd scaled_eigenvalues(const Fixture& fixture, const Eigen::MatrixXd& H, int rows) {
  double mean_range_m = 0;
  for (const Keypoint& keypoint : fixture.keypoints) mean_range_m += keypoint.p_body.norm();
  mean_range_m /= static_cast<double>(fixture.keypoints.size());
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(H.rows());
  for (Eigen::Index b = 0; b < H.rows(); b += 6) scale.segment<3>(b + 3).setConstant(1 / mean_range_m);
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scale.asDiagonal() * H * scale.asDiagonal() / rows)
      .eigenvalues();
}

// The axis is unseen at the begin and at the end; regularisers on translation lift both. With location b and velocity
// v along the axis they are beta b^2 + beta v^2 on (b, b + v): the matrix beta [2 -1; -1 1], whose smaller eigenvalue
// is beta (3 - sqrt 5) / 2 = 0.38 beta; as diagonal, the quirk's, it is beta.
TEST(ElasticProblem, EndlessCorridorHasTwoNullDirectionsThatTheRegularisersLift) {
  Fixture fixture = corridor();
  NormalEquations equations(2);
  assemble(fixture.problem(), fixture.truth, equations);
  const int rows = equations.data_rows();
  const Eigen::VectorXd bare = scaled_eigenvalues(fixture, equations.H_data(), rows);
  EXPECT_LT(bare[1] / bare[11], 1e-12);
  EXPECT_GT(bare[2] / bare[11], 1e-4);
  EXPECT_EQ(equations.H_prior().norm(), 0);

  // Translation of the whole leaves it so: pure translation inside the sweep.
  Fixture driving = corridor();
  for (Keypoint& keypoint : driving.keypoints) keypoint.p_body.x() -= keypoint.alpha * 0.8;
  driving.truth.poses[1].translation().x() = 0.8;
  assemble(driving.problem(), driving.truth, equations);
  const Eigen::VectorXd moving = scaled_eigenvalues(driving, equations.H_data(), rows);
  EXPECT_LT(moving[1] / moving[11], 1e-12);
  EXPECT_GT(moving[2] / moving[11], 1e-4);

  fixture.regularisers.beta_location = fixture.regularisers.beta_constant_velocity = 0.001;
  assemble(fixture.problem(), fixture.truth, equations);
  const Eigen::MatrixXd H = equations.H_data() + equations.H_prior();
  EXPECT_NEAR(scaled_eigenvalues(fixture, H, rows)[0], 0.001 * (3 - std::sqrt(5.0)) / 2, 2e-6);
  fixture.regularisers.quirk = true;
  assemble(fixture.problem(), fixture.truth, equations);
  const Eigen::MatrixXd H_quirk = equations.H_data() + equations.H_prior();
  EXPECT_NEAR(scaled_eigenvalues(fixture, H_quirk, rows)[0], 0.001, 5e-6);
}

TEST(ElasticProblem, AllPointsAtTheBeginLeaveTheEndUnseen) {
  Fixture fixture;
  fixture.regularised = false;
  Fixture rigid(SegmentModel::held);
  rigid.keypoints = fixture.keypoints;
  for (Keypoint& keypoint : fixture.keypoints) keypoint.alpha = 0;
  NormalEquations equations(2), of_begin(1);
  assemble(fixture.problem(), fixture.truth, equations);
  rigid.truth.poses[0] = fixture.truth.poses[0];
  assemble(rigid.problem(), rigid.truth, of_begin);
  EXPECT_LT((equations.H_data().topLeftCorner<6, 6>() - of_begin.H_data()).norm(), 1e-9 * of_begin.H_data().norm());
  EXPECT_LT((equations.g_data().head<6>() - of_begin.g_data()).norm(), 1e-9 * of_begin.H_data().norm());
  EXPECT_LT(equations.H_data().bottomRightCorner(6, 6).norm(), 1e-20);
  Segment motion = fixture.start();
  const Segment before = motion;
  EXPECT_FALSE(gauss_newton_step(fixture.problem(), motion));
  EXPECT_EQ(difference(motion, before), 0);
}

}  // namespace
}  // namespace tarmac::estimators
