/// The record of a sweep against numeric twins.
#include <gtest/gtest.h>

#include "estimators/kiss_icp/record.h"
#include "tests/estimators/landmark_world.h"
#include "tests/support/numeric.h"

namespace tarmac::estimators {
namespace {

using core::Matrix6;
using core::SE3;
using core::Vector6;
using Eigen::Vector3d;

class KissRecord : public testing::Test {
 protected:
  KissRecord() {
    Vector6 twist;
    twist << 3, 0.3, -0.2, 0.1, -0.2, 0.3;
    const tests::Motion motion = tests::constant_twist(twist);
    const std::vector<Vector3d> world = tests::landmarks(30, 4, 0.3);
    for (int k = 0; k < 4; ++k) {
      sweep_ = tests::sweep_at(k, world, motion, {.flash = k < 2, .noise_m = 0.005});
      step_ = odometry_.add(sweep_);
    }
    record_ = record_of(sweep_, odometry_, step_, T_body_lidar_.inverse(), core::DiagnosticsLevel::full);
  }
  SE3 T_map_body() const { return step_.icp.T_map_lidar_linearised * T_body_lidar_.inverse(); }

  SE3 T_body_lidar_ = tests::some_pose();
  KissOdometry odometry_{KissIcpOptions{}};
  core::LidarSweep sweep_;
  KissOdometry::Step step_;
  core::SweepDiagnostics record_;
};

TEST_F(KissRecord, CountsWhatWasDone) {
  EXPECT_EQ(record_.index, 3);
  EXPECT_EQ(record_.points_in, static_cast<int>(sweep_.size()));
  EXPECT_EQ(record_.points_used, static_cast<int>(odometry_.icp_sample().size()));
  EXPECT_GT(record_.residuals, 3 * 1000);
  EXPECT_EQ(record_.residuals, static_cast<int>(record_.rows.size()));
  EXPECT_EQ(record_.iterations, step_.icp.iterations);
  EXPECT_TRUE(record_.converged);
  EXPECT_EQ(record_.scale_m, step_.sigma_m);
}

/// cost(xi) = 1/2 sum w |T_map_body Exp(xi) p - q|^2 with weights and partners frozen. Its second derivative is
/// H_data plus terms with the residuals (5 mm of noise against points tens of metres away: some 1e-4 of it).
TEST_F(KissRecord, HDataIsTheCostsHessianAtTheReferenceInstant) {
  std::vector<Vector3d> p_body, q_map;
  std::vector<double> weights;
  for (std::size_t k = 0; k < odometry_.icp_sample().size(); ++k) {
    const Match& match = odometry_.registration().matches()[k];
    if (!(match.weight > 0)) continue;
    p_body.push_back(T_body_lidar_ * odometry_.deskewed_m()[odometry_.icp_sample()[k]]);
    q_map.push_back(T_map_body() * p_body.back() - match.residual_m);
    weights.push_back(match.weight);
  }
  const auto cost = [&](const Vector6& xi) {
    const SE3 T = T_map_body() * core::se3::exp(xi);
    double sum = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) sum += 0.5 * weights[k] * (T * p_body[k] - q_map[k]).squaredNorm();
    return sum;
  };
  const double h = 1e-3;
  Matrix6 H;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const Vector6 a = h * Vector6::Unit(i), b = h * Vector6::Unit(j);
      H(i, j) = (cost(a + b) - cost(a - b) - cost(b - a) + cost(-a - b)) / (4 * h * h);
    }
  }
  EXPECT_LT((H - record_.H_data).norm() / record_.H_data.norm(), 1e-3);
}

/// Each row by the pose at its point's own time, body frame, right perturbation.
TEST_F(KissRecord, RowsCarryTheJacobianByThePoseAtTheirOwnTime) {
  std::size_t row = 0;
  for (std::size_t k = 0; k < odometry_.icp_sample().size(); ++k) {
    const Match& match = odometry_.registration().matches()[k];
    if (!(match.weight > 0)) continue;
    const std::size_t i = odometry_.icp_sample()[k];
    const SE3 T_at_time =
        step_.icp.T_map_lidar_linearised * step_.motion.T_end_point(sweep_.t_ns[i]) * T_body_lidar_.inverse();
    const Vector3d p_body = T_body_lidar_ * sweep_.point(i), q = T_at_time * p_body - match.residual_m;
    const auto residual = [&](const Vector6& xi) -> Vector3d { return T_at_time * core::se3::exp(xi) * p_body - q; };
    const auto J = tests::numeric_jacobian<3, 6>(residual, Vector6(Vector6::Zero()));
    for (int axis = 0; axis < 3; ++axis, ++row) {
      const core::ResidualRow& r = record_.rows.at(row);
      EXPECT_EQ(r.t_ns, sweep_.t_ns[i]);
      EXPECT_NEAR(r.value, match.residual_m[axis], 1e-7);
      EXPECT_NEAR(r.weight, match.weight, 1e-6);
      for (int c = 0; c < 6; ++c) EXPECT_NEAR(r.jacobian[c], J(axis, c), 1e-5);
    }
  }
  EXPECT_EQ(row, record_.rows.size());
}

/// Moved to the reference instant along the method's own motion, the rows add up to H_data.
TEST_F(KissRecord, RowsAddUpToHData) {
  Matrix6 H = Matrix6::Zero();
  for (const core::ResidualRow& row : record_.rows) {
    // T(t) = T_ref C(t), hence T_ref Exp(xi) C = T(t) Exp(Ad(C^-1) xi).
    const SE3 C = T_body_lidar_ * step_.motion.T_end_point(row.t_ns) * T_body_lidar_.inverse();
    const core::Row6 at_time = Eigen::Map<const Eigen::Matrix<float, 1, 6>>(row.jacobian).cast<double>();
    const core::Row6 J = at_time * core::se3::adjoint(C.inverse());
    H += row.weight * J.transpose() * J;
  }
  EXPECT_LT((H - record_.H_data).norm() / record_.H_data.norm(), 1e-6);
}

TEST_F(KissRecord, LevelSystemHasTheSameBlockAndNoRows) {
  const core::SweepDiagnostics record =
      record_of(sweep_, odometry_, step_, T_body_lidar_.inverse(), core::DiagnosticsLevel::system);
  EXPECT_EQ(record.H_data, record_.H_data);
  EXPECT_TRUE(record.rows.empty());
  EXPECT_EQ(record.residuals, record_.residuals);
}

}  // namespace
}  // namespace tarmac::estimators
