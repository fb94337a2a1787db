// Information blocks: null spaces in closed form, and the laws that eigenvalues have to keep.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "metrics/degeneracy/method_blocks.h"
#include "tests/metrics/surfaces.h"
#include "tests/support/numeric.h"

namespace tarmac::metrics::tests {
namespace {

using namespace core;

const SE3 kStart = pose({0.2, 0.3, 1.6}, {0.03, -0.02, 0.4});

struct NullCase {
  const char* name;
  Surface surface;
  int free_6, free_12;
};

const NullCase kCases[] = {{"Plane", plane({0, 0, 1}, 0), 3, 6},
                           {"FourWallCorridor", corridor(), 1, 2},
                           {"CircularTunnel", tunnel(), 2, 4},
                           {"Sphere", sphere(), 3, 6},
                           {"Room", room(14, 9, 3.5), 0, 0}};

/// Exactly `free` directions: below 1e-12 of the largest eigenvalue, and the next above 1e-4 of it.
void expect_free(const Spectrum& spectrum, int free) {
  const double largest = spectrum.values[spectrum.values.size() - 1];
  for (int k = 0; k < free; ++k) EXPECT_LT(spectrum.values[k] / largest, 1e-12) << "eigenvalue " << k;
  EXPECT_GT(spectrum.values[free] / largest, 1e-4);
}

class NullSpaces : public ::testing::TestWithParam<NullCase> {};

TEST_P(NullSpaces, AreExactWithMotionInsideTheSweep) {
  // The world is turned and moved as a whole as well: no axis is special.
  const SE3 T_world_local = pose({120, -40, 7}, {0.5, -0.8, 1.9});
  Sweep sweep = sweep_of(GetParam().surface, Bumpy(kStart));
  ASSERT_GT(sweep.points.size(), 3000u);
  for (SurfacePoint& point : sweep.points) {
    point.p_world = T_world_local * point.p_world;
    point.n_world = T_world_local.linear() * point.n_world;
  }
  sweep.T_world_c = T_world_local * sweep.T_world_c;
  const auto blocks = sweep.analyse();
  ASSERT_TRUE(blocks);
  expect_free(blocks->pose, GetParam().free_6);
  expect_free(*blocks->two_pose, GetParam().free_12);
  // A free direction of the pose is free in both Schur complements.
  expect_free(*blocks->mean, GetParam().free_6);
  expect_free(*blocks->difference, GetParam().free_6);
}

INSTANTIATE_TEST_SUITE_P(ClosedForm, NullSpaces, ::testing::ValuesIn(kCases),
                         [](const auto& c) { return std::string(c.param.name); });

TEST(Information, ScalesTheBlockPerUnitOfTranslation) {
  const Sweep sweep = sweep_of(room(14, 9, 3.5), Bumpy(kStart));
  const Matrix6 H = scaled_pose_block(exact_information(sweep.points, sweep.T_world_c), sweep.mean_range_m);
  EXPECT_NEAR((H.topLeftCorner<3, 3>().trace()), 1, 1e-12);
}

TEST(Information, FreeDirectionsOfACorridorAreTheAxisAlone) {
  const SE3 T_start = pose({0, 0.3, 1.6}, {0, 0, 0.3});  // 0.3 rad off the axis, and turning
  const Sweep sweep = sweep_of(corridor(), Bumpy(T_start));
  const auto blocks = sweep.analyse();
  const Eigen::Vector3d axis_c = sweep.T_world_c.linear().transpose() * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(std::abs(blocks->pose.vectors.col(0).head<3>().dot(axis_c)), 1, 1e-12);
  EXPECT_LT(blocks->pose.vectors.col(0).tail<3>().norm(), 1e-9);
  const Vector6 shares = weak_shares(blocks->pose, 1e-3);
  EXPECT_NEAR(shares[0], axis_c.x() * axis_c.x(), 1e-9);
  EXPECT_NEAR(shares[1], axis_c.y() * axis_c.y(), 1e-9);
  EXPECT_EQ(weak_directions(shares), "along-track");
}

TEST(Information, FreeDirectionsOfAPlaneAreTheHorizontalOnesAndYaw) {
  const Sweep sweep = sweep_of(plane({0, 0, 1}, 0), Bumpy(pose({0, 0, 1.9}, {0, 0, 2})));
  const Vector6 shares = weak_shares(sweep.analyse()->pose, 1e-3);
  EXPECT_NEAR(shares.sum(), 3, 1e-9);
  EXPECT_EQ(weak_directions(shares), "along-track + cross-track + yaw");
}

TEST(Information, JacobianMatchesCentralDifferencesOfALeftPerturbation) {
  const Sweep sweep = sweep_of(room(14, 9, 3.5), Bumpy(kStart));
  for (std::size_t i = 0; i < sweep.points.size(); i += 997) {
    const SurfacePoint& point = sweep.points[i];
    const auto residual = [&](const Vector6& xi) {
      const SE3 moved = sweep.T_world_c * se3::exp(xi) * sweep.T_world_c.inverse();
      return Eigen::Matrix<double, 1, 1>(point.n_world.dot(moved * point.p_world - point.p_world));
    };
    const Row6 numeric = tarmac::tests::numeric_jacobian<1, 6>(residual, Vector6(Vector6::Zero()), 1e-5);
    const SweepInformation information = exact_information(std::span(&point, 1), sweep.T_world_c);
    EXPECT_LT((information.moment(0) - numeric.transpose() * numeric).norm(), 1e-6 * information.moment(0).norm());
  }
}

/// Rows with phases that know nothing of the geometry: each at the two nodes of Gauss-Legendre, whose mean is 1/2 and
/// mean square 1/3, as those of the uniform distribution.
SweepInformation with_uniform_phases(const Sweep& sweep) {
  SweepInformation information;
  std::vector<SurfacePoint> points = sweep.points;
  const SE3 T_c_world = sweep.T_world_c.inverse();
  for (const SurfacePoint& point : points) {
    const Eigen::Vector3d p = T_c_world * point.p_world, n = T_c_world.linear() * point.n_world;
    Row6 J;
    J << n.transpose(), p.cross(n).transpose();
    for (const double node : {-1.0, 1.0}) information.add(J, 1, 0.5 + node / (2 * std::sqrt(3.0)));
  }
  return information;
}

TEST(TwoPoseBlock, SplitsEachEigenvalueIntoAHalfAndASixthWherePhaseKnowsNothingOfGeometry) {
  for (const NullCase& geometry : kCases) {
    const Sweep sweep = sweep_of(geometry.surface, Bumpy(kStart));
    const auto blocks = analyse(with_uniform_phases(sweep), sweep.mean_range_m);
    std::vector<double> expected;
    for (const double l : blocks->pose.values) {
      expected.push_back(l / 2);
      expected.push_back(l / 6);
    }
    std::sort(expected.begin(), expected.end());
    for (int k = 0; k < 12; ++k)
      EXPECT_NEAR(blocks->two_pose->values[k], expected[static_cast<std::size_t>(k)], 1e-10) << geometry.name;
    for (int k = 0; k < 6; ++k) {  // mean and difference do not mix: l, and l/12
      EXPECT_NEAR(blocks->mean->values[k], blocks->pose.values[k], 1e-10) << geometry.name;
      EXPECT_NEAR(blocks->difference->values[k], blocks->pose.values[k] / 12, 1e-10) << geometry.name;
    }
  }
}

TEST(TwoPoseBlock, OfARoomIsWorseThanThePoseAloneAllowsWherePhaseFollowsAzimuth) {
  const auto blocks = sweep_of(room(12, 8, 3), Bumpy(kStart)).analyse();
  EXPECT_GT(blocks->two_pose->condition(), 3 * blocks->pose.condition());
  EXPECT_LT(blocks->difference->min(), blocks->pose.min() / 12);
}

/// Normals off by s an axis, as from a plane fit.
Sweep with_normal_noise(Sweep sweep, double s_rad, std::uint64_t seed) {
  const RandomStream random(seed, "test/normal_noise");
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    Eigen::Vector3d& n = sweep.points[i].n_world;
    n = (n + s_rad * Eigen::Vector3d(random.normal(i, 0), random.normal(i, 1), random.normal(i, 2))).normalized();
  }
  return sweep;
}

TEST(NormalNoise, LiftsAFreeDirectionToItsSquare) {
  const Sweep exact = sweep_of(corridor(), Bumpy(pose({0, 0.3, 1.6}, {0, 0, 0})));
  for (const double s_deg : {1.0, 2.0, 5.0}) {
    const double s = s_deg * M_PI / 180;
    const auto blocks = with_normal_noise(exact, s, 1).analyse();
    EXPECT_NEAR(blocks->pose.min(), s * s, 0.1 * s * s) << s_deg;
    EXPECT_NEAR(blocks->two_pose->min(), s * s / 6, 0.1 * s * s / 6) << s_deg;
    EXPECT_NEAR(blocks->mean->min(), s * s, 0.1 * s * s) << s_deg;
    EXPECT_NEAR(blocks->difference->min(), s * s / 12, 0.1 * s * s / 12) << s_deg;
    // The rule's thresholds lie above that floor.
    EXPECT_LT(blocks->pose.min(), DegeneracyRule::pose(s).degenerate_below);
    EXPECT_LT(blocks->difference->min(), DegeneracyRule::difference(s).degenerate_below);
  }
}

void expect_same(const Spectrum& a, const Spectrum& b, double tolerance) {
  for (Eigen::Index k = 0; k < a.values.size(); ++k) EXPECT_NEAR(a.values[k], b.values[k], tolerance);
}

void expect_same(const BlockAnalysis& a, const BlockAnalysis& b, double tolerance) {
  expect_same(a.pose, b.pose, tolerance);
  expect_same(*a.two_pose, *b.two_pose, tolerance);
  expect_same(*a.mean, *b.mean, tolerance);
  expect_same(*a.difference, *b.difference, tolerance);
}

TEST(Information, DoesNotChangeWhenEveryPointIsThereTwiceOrWeighsMore) {
  const Sweep sweep = sweep_of(room(60, 8, 3), Bumpy(kStart));
  Sweep twice = sweep;
  twice.points.insert(twice.points.end(), sweep.points.begin(), sweep.points.end());
  expect_same(*twice.analyse(), *sweep.analyse(), 1e-12);
  SweepInformation heavier;
  const SE3 T_c_world = sweep.T_world_c.inverse();
  for (const SurfacePoint& point : sweep.points) {
    const Eigen::Vector3d p = T_c_world * point.p_world, n = T_c_world.linear() * point.n_world;
    Row6 J;
    J << n.transpose(), p.cross(n).transpose();
    heavier.add(J, 1e4, point.phase);
  }
  expect_same(*analyse(heavier, sweep.mean_range_m), *sweep.analyse(), 1e-12);
}

TEST(Information, DoesNotChangeFromMetresToMillimetres) {
  const Sweep sweep = sweep_of(room(60, 8, 3), Bumpy(kStart));
  Sweep mm = sweep;
  for (SurfacePoint& point : mm.points) point.p_world *= 1000;
  mm.T_world_c.translation() *= 1000;
  mm.mean_range_m *= 1000;
  expect_same(*mm.analyse(), *sweep.analyse(), 1e-12);
}

TEST(Information, TurnsItsDirectionsWithTheAxesAndKeepsItsEigenvalues) {
  const Sweep sweep = sweep_of(corridor(), Bumpy(kStart));
  Sweep turned = sweep;
  const Eigen::Matrix3d R = so3::exp({0.4, -1.1, 0.7});
  turned.T_world_c.linear() = sweep.T_world_c.linear() * R;
  expect_same(*turned.analyse(), *sweep.analyse(), 1e-9);
  const Eigen::Vector3d v = sweep.analyse()->pose.vectors.col(0).head<3>(),
                        w = turned.analyse()->pose.vectors.col(0).head<3>();
  EXPECT_NEAR(std::abs((R * w).dot(v)), 1, 1e-9);
}

TEST(Information, IsUnknownWhereThereIsNothingToAnalyse) {
  const Sweep sweep = sweep_of(room(14, 9, 3.5), Bumpy(kStart));
  const auto few = [&](std::size_t n) { return exact_information(std::span(sweep.points).first(n), sweep.T_world_c); };
  EXPECT_FALSE(analyse(few(99), 5));
  EXPECT_TRUE(analyse(few(100), 5));
  EXPECT_FALSE(analyse(few(200), 0));
  EXPECT_FALSE(analyse(few(200), std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(analyse(SweepInformation{}, 5));
  SweepInformation zero;
  for (int k = 0; k < 500; ++k) zero.add(Row6::Zero(), 1, 0.5);  // normals of length 0
  EXPECT_FALSE(analyse(zero, 5));
  SweepInformation damaged = few(100);
  damaged.add(Row6::Constant(std::numeric_limits<double>::quiet_NaN()), 1, 0.5);
  damaged.add(Row6::Ones(), 0, 0.5);
  damaged.add(Row6::Ones(), -1, 0.5);
  EXPECT_EQ(damaged.rows(), 100u);
}

TEST(Information, WithoutPhasesKnowsThePoseAlone) {
  const Sweep sweep = sweep_of(room(14, 9, 3.5), Bumpy(kStart));
  const SweepInformation whole = exact_information(sweep.points, sweep.T_world_c);
  SweepInformation block;
  block.add_block(3 * whole.moment(0), whole.rows());
  const auto blocks = analyse(block, sweep.mean_range_m);
  ASSERT_TRUE(blocks);
  expect_same(blocks->pose, sweep.analyse()->pose, 1e-12);
  EXPECT_FALSE(blocks->two_pose);
  EXPECT_FALSE(blocks->difference);
}

/// The motion as a method's trajectory, at every point's time.
PiecewiseTrajectory sampled(const SmoothTrajectory& motion, const SE3& T_map_world) {
  std::vector<Time> times;
  std::vector<SE3> poses;
  for (int k = 0; k <= 2000; ++k) {
    times.push_back(motion.begin() + k * Duration(50'000));
    poses.push_back(T_map_world * motion.pose(times.back()));
  }
  return PiecewiseTrajectory({Segment::sampled(SegmentModel::sampled_screw, times, poses)});
}

TEST(MethodBlocks, OfExactRowsAreTheOraclesWhateverTheMapFrame) {
  const Bumpy motion(kStart);
  const SE3 T_map_world = pose({-30, 8, 2}, {0.3, 1.0, -2.0});
  for (const NullCase& geometry : kCases) {
    const Sweep sweep = sweep_of(geometry.surface, motion);
    SweepResult result;
    result.begin = motion.begin();
    result.end = result.reference = motion.begin() + Duration(100'000'000);
    const MethodSweep method =
        method_sweep(recorded(sweep, motion, motion.begin(), T_map_world), sampled(motion, T_map_world), result,
                     Eigen::Vector3d::Zero(), sweep.mean_range_m);
    ASSERT_TRUE(method.solve && method.surface) << geometry.name;
    // Rows are floats: 6e-8 of the moment arm.
    expect_same(*method.solve, *sweep.analyse(), 1e-6);
    expect_same(*method.surface, *method.solve, 0);
    EXPECT_EQ(method.solve_rows, sweep.points.size());
  }
}

TEST(MethodBlocks, OfPointToPointRowsAreNeverSingularAndOfItsSurfaceRowsAre) {
  const Bumpy motion(kStart);
  const Sweep sweep = sweep_of(plane({0, 0, 1}, 0), motion);
  SweepDiagnostics record = recorded(sweep, motion, motion.begin(), SE3::Identity());
  std::swap(record.rows, record.surface);
  record.rows_are_surface = false;
  add_axis_rows(sweep, motion, motion.begin(), record);
  SweepResult result;
  result.end = result.reference = motion.begin() + Duration(100'000'000);
  const MethodSweep method =
      method_sweep(record, sampled(motion, SE3::Identity()), result, Eigen::Vector3d::Zero(), sweep.mean_range_m);
  EXPECT_GT(method.solve->pose.min(), 0.03);  // an axis in three, less what rotation takes
  EXPECT_LT(method.surface->pose.values[2], 1e-9);
  EXPECT_GT(method.surface->pose.values[3], 1e-3);
}

TEST(MethodBlocks, KeepPriorsApartAndStateTheirShare) {
  const Bumpy motion(kStart);
  const Sweep sweep = sweep_of(corridor(), motion);
  SweepDiagnostics record = recorded(sweep, motion, motion.begin(), SE3::Identity());
  SweepResult result;
  result.end = motion.begin() + Duration(100'000'000);
  result.reference = result.end;
  result.T_map_body = motion.pose(result.end);
  const auto analysed = [&] {
    return method_sweep(record, sampled(motion, SE3::Identity()), result, Eigen::Vector3d::Zero(), sweep.mean_range_m);
  };
  EXPECT_FALSE(analysed().prior_share);
  record.H_data = 0.5 * Matrix6::Identity();
  record.H_prior = 1.5 * Matrix6::Identity();
  const MethodSweep method = analysed();
  expect_same(*method.solve, *sweep.analyse(), 1e-6);  // the prior is no part of the block
  ASSERT_TRUE(method.prior_share);
  EXPECT_NEAR(*method.prior_share, 0.75, 1e-9);
}

TEST(MethodBlocks, AreUnknownWhereTheTrajectoryIsNot) {
  const Bumpy motion(kStart);
  const Sweep sweep = sweep_of(room(14, 9, 3.5), motion);
  SweepResult result;
  result.begin = motion.begin() + duration_from_s(5);
  result.end = result.reference = result.begin + Duration(100'000'000);
  const MethodSweep method =
      method_sweep(recorded(sweep, motion, motion.begin(), SE3::Identity()), sampled(motion, SE3::Identity()), result,
                   Eigen::Vector3d::Zero(), sweep.mean_range_m);
  EXPECT_FALSE(method.solve);
  EXPECT_FALSE(method.surface);
}

}  // namespace
}  // namespace tarmac::metrics::tests
