#include "metrics/align.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "tests/metrics/fabricate.h"

namespace tarmac::metrics::tests {
namespace {

using namespace core;

const Eigen::Matrix3d kIdentity = Eigen::Matrix3d::Identity();

Eigen::Matrix3Xd random_points(int n, const char* name) {
  const RandomStream stream(11, name);
  Eigen::Matrix3Xd p(3, n);
  for (int k = 0; k < n; ++k)
    for (int axis = 0; axis < 3; ++axis)
      p(axis, k) = 20 * stream.normal(static_cast<std::uint64_t>(k), static_cast<std::uint32_t>(axis));
  return p;
}

Eigen::Matrix3Xd moved(const SE3& T, double scale, const Eigen::Matrix3Xd& p) {
  return (T.linear() * (scale * p)).colwise() + T.translation();
}

double cost(const Similarity& A, const Eigen::Matrix3Xd& p, const Eigen::Matrix3Xd& q) {
  return (moved(A.T_world_map, A.scale, p) - q).squaredNorm();
}

TEST(Align, Se3RecoversAKnownMotion) {
  const SE3 truth = pose({100, -40, 7}, {0.3, -1.1, 2.0});
  const Eigen::Matrix3Xd p = random_points(50, "align");
  const Fit fit = align_se3(p, moved(truth, 1, p), kIdentity);
  EXPECT_LT((fit.A.T_world_map.matrix() - truth.matrix()).norm(), 1e-12 * truth.matrix().norm());
  EXPECT_EQ(fit.note, "");
}

TEST(Align, Sim3RecoversAKnownScaleToo) {
  const SE3 truth = pose({100, -40, 7}, {0.3, -1.1, 2.0});
  const Eigen::Matrix3Xd p = random_points(50, "align");
  const auto fit = align_sim3(p, moved(truth, 0.37, p), kIdentity);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->A.scale, 0.37, 1e-14);
  EXPECT_LT((fit->A.T_world_map.matrix() - truth.matrix()).norm(), 1e-12 * truth.matrix().norm());
}

TEST(Align, YawPositionRecoversATurnAboutTheVerticalOfALevelledMap) {
  const SE3 truth = pose({100, -40, 7}, {0, 0, -2.9});
  const Eigen::Matrix3d level = so3::exp(Eigen::Vector3d(0.2, -0.1, 0.05));
  const Eigen::Matrix3Xd p = random_points(50, "align");
  const Fit fit = align_yaw_position(level.transpose() * p, moved(truth, 1, p), level);
  EXPECT_LT((fit.A.T_world_map.linear() - truth.linear() * level).norm(), 1e-13);
  EXPECT_LT((fit.A.T_world_map.translation() - truth.translation()).norm(), 1e-11);
}

/// With noise no closed form is known; but at a minimum every small step costs more.
TEST(Align, NoSmallStepImprovesAFitOfNoisyPoints) {
  const Eigen::Matrix3Xd p = random_points(30, "align"),
                         q = moved(pose({5, 6, 7}, {1, 2, -0.5}), 1.2, p) + 0.05 * random_points(30, "noise");
  const Similarity se3 = align_se3(p, q, kIdentity).A, sim3 = align_sim3(p, q, kIdentity)->A,
                   yaw = align_yaw_position(p, q, kIdentity).A;
  for (int axis = 0; axis < 6; ++axis)
    for (const double step : {-1e-4, 1e-4}) {
      Vector6 d = Vector6::Zero();
      d[axis] = step;
      const SE3 left = se3::exp(d);
      EXPECT_GT(cost({1, left * se3.T_world_map}, p, q), cost(se3, p, q)) << axis;
      EXPECT_GT(cost({sim3.scale, left * sim3.T_world_map}, p, q), cost(sim3, p, q)) << axis;
      EXPECT_GT(cost({sim3.scale + step, sim3.T_world_map}, p, q), cost(sim3, p, q));
      const bool tilts = axis == 3 || axis == 4;
      if (tilts) continue;
      EXPECT_GT(cost({1, left * yaw.T_world_map}, p, q), cost(yaw, p, q)) << axis;
    }
  EXPECT_LE(cost(sim3, p, q), cost(se3, p, q));
  EXPECT_LE(cost(se3, p, q), cost(yaw, p, q));
}

TEST(Align, NeverMirrors) {
  Eigen::Matrix3Xd p = random_points(30, "align"), q = p;
  q.row(0) *= -1;
  EXPECT_NEAR(align_se3(p, q, kIdentity).A.T_world_map.linear().determinant(), 1, 1e-12);
  q = -p;
  EXPECT_GE(align_sim3(p, q, kIdentity)->A.scale, 0);
}

TEST(Align, OnALineTheFreeRotationIsThePreferredOneAndSaidSo) {
  const Eigen::Vector3d direction = Eigen::Vector3d(1, 2, -0.3).normalized();
  Eigen::Matrix3Xd p(3, 20);
  for (int k = 0; k < 20; ++k) p.col(k) = Eigen::Vector3d(50, 60, 7) + k * direction;
  const SE3 truth = pose({100, -40, 7}, {0.3, -1.1, 2.0});
  const Eigen::Matrix3Xd q = moved(truth, 1, p);
  const Fit fit = align_se3(p, q, truth.linear());
  EXPECT_NE(fit.note.find("line"), std::string::npos) << fit.note;
  EXPECT_LT(cost(fit.A, p, q), 1e-20);
  EXPECT_LT((fit.A.T_world_map.linear() - truth.linear()).norm(), 1e-12);
  // A preference turned about the line is kept as it is; one turned across it gives way by the smallest turn.
  const Eigen::Matrix3d about = truth.linear() * so3::exp(0.8 * direction);
  EXPECT_LT((align_se3(p, q, about).A.T_world_map.linear() - about).norm(), 1e-12);
  const Eigen::Vector3d across = direction.unitOrthogonal();
  const Fit given_way = align_se3(p, q, truth.linear() * so3::exp(0.4 * across));
  EXPECT_LT((given_way.A.T_world_map.linear() - truth.linear()).norm(), 1e-12);
}

TEST(Align, OneSinglePlaceTakesThePreferredRotation) {
  const Eigen::Matrix3Xd p = Eigen::Vector3d(3, 4, 5).replicate(1, 10), q = Eigen::Vector3d(1, 1, 1).replicate(1, 10);
  const Eigen::Matrix3d preferred = so3::exp(Eigen::Vector3d(0.1, 0.2, 0.3));
  const Fit fit = align_se3(p, q, preferred);
  EXPECT_EQ(fit.A.T_world_map.linear(), preferred);
  EXPECT_LT(cost(fit.A, p, q), 1e-25);
  EXPECT_NE(fit.note, "");
  EXPECT_FALSE(align_sim3(p, q, preferred));
}

TEST(Align, NamesAreReadWithDashOrUnderscoreAndOthersRefused) {
  EXPECT_EQ(alignment("first-pose"), Alignment::first_pose);
  EXPECT_EQ(alignment("yaw_pos"), Alignment::yaw_pos);
  try {
    alignment("rigid");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("sim3"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace tarmac::metrics::tests
