// The oracle traced through a scene of meshes: macro normals, static returns, true firing times.
#include "metrics/degeneracy/oracle.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/metrics/surfaces.h"
#include "tests/sim/support/shapes.h"

namespace tarmac::metrics::tests {
namespace {

using namespace core;

constexpr double kReach_m = 100;

/// Texture of 3 mm from trough to crest, 5 cm long.
class Texture final : public scenes::Relief {
 public:
  double height_m(double x, double y, Eigen::Vector2d* gradient = nullptr) const override {
    constexpr double amplitude_m = 1.5e-3, k = 2 * M_PI / 0.05;
    if (gradient) *gradient = amplitude_m * k * Eigen::Vector2d(std::cos(k * x), -std::sin(k * y));
    return amplitude_m * (std::sin(k * x) + std::cos(k * y));
  }
};

struct Wall {
  Surface surface;
  bool moving = false;
};

/// Pavement, and walls at x = +-10 and y = +-7: instance 0 is the pavement.
struct World {
  scenes::Scene scene = tarmac::tests::empty_scene();
  std::vector<Wall> surfaces;
};

World make_world(bool with_walls, bool with_relief = false) {
  World world;
  if (with_relief) world.scene.relief = std::make_shared<Texture>();
  world.scene.materials[0].has_relief = with_relief;
  tarmac::tests::add_instance(world.scene, tarmac::tests::square(150), SE3::Identity());
  world.surfaces.push_back({plane({0, 0, 1}, 0)});
  if (!with_walls) return world;
  for (const double side : {-1.0, 1.0}) {
    tarmac::tests::add_instance(world.scene, tarmac::tests::square(150), pose({side * 10, 0, 0}, {0, M_PI / 2, 0}));
    world.surfaces.push_back({plane({1, 0, 0}, side * 10)});
    tarmac::tests::add_instance(world.scene, tarmac::tests::square(150), pose({0, side * 7, 0}, {M_PI / 2, 0, 0}));
    world.surfaces.push_back({plane({0, 1, 0}, side * 7)});
  }
  return world;
}

struct RecordedSweeps {
  std::vector<LidarSweep> sweeps;
  std::vector<sim::truth::PointLabels> labels;
  sim::truth::GroundTruth truth;
  std::vector<Sweep> exact;  ///< the same beams in closed form, static ones
  SweepSource source() const {
    return {sweeps.size(), [this](std::size_t i) { return sweeps[i]; }, truth.rig, 0};
  }
};

/// Two sweeps of 24 rings and 256 columns, along a constant twist, from a LiDAR that is mounted askew.
RecordedSweeps record(const World& world) {
  RecordedSweeps out;
  Vector6 xi;
  xi << 6, 0.3, 0, 0.02, -0.05, 0.9;
  const auto motion =
      std::make_shared<ConstantTwist>(pose({-1, 0.5, 0.1}, {0.01, 0.02, 0.3}), xi, Time{}, time_from_s(0.25));
  out.truth.motion = motion;
  LidarSheet& sheet = out.truth.rig.lidars.emplace_back();
  sheet.T_body_lidar = lidar_mount();
  sheet.max_range_m = kReach_m;
  for (int k = 0; k < 2; ++k) {
    LidarSweep& sweep = out.sweeps.emplace_back();
    sim::truth::PointLabels& labels = out.labels.emplace_back();
    Sweep& exact = out.exact.emplace_back();
    sweep.index = k;
    sweep.begin = labels.begin = Time{} + k * kSpan;
    sweep.end = labels.end = sweep.begin + kSpan;
    exact.T_world_c = motion->pose(sweep.begin + kSpan / 2) * Eigen::Translation3d(lidar_mount().translation());
    for (int c = 0; c < 256; ++c) {
      const auto t_ns = static_cast<std::int32_t>((c * kSpan / 255).count());
      const SE3 T = motion->pose(sweep.begin + Duration(t_ns)) * lidar_mount();
      for (int r = 0; r < 24; ++r) {
        const double azimuth = 2 * M_PI * c / 256, elevation = (-25 + 2 * r) * M_PI / 180;
        const Eigen::Vector3d d_lidar(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                      std::sin(elevation));
        std::optional<SurfacePoint> best;
        std::size_t instance = 0;
        for (std::size_t s = 0; s < world.surfaces.size(); ++s) {
          const auto hit = world.surfaces[s].surface(T.translation(), T.linear() * d_lidar);
          if (!hit || (best && (best->p_world - T.translation()).norm() < (hit->p_world - T.translation()).norm()))
            continue;
          best = hit;
          instance = s;
        }
        if (!best) continue;
        sweep.push_back((T.inverse() * best->p_world).cast<float>(), t_ns, 0, 1);
        labels.t_ns.push_back(t_ns);
        labels.instance.push_back(static_cast<std::uint32_t>(instance));
        labels.moving.push_back(world.surfaces[instance].moving);
        labels.label.push_back(scenes::Label::other);
        if (world.surfaces[instance].moving) continue;
        best->phase = c / 255.0;
        exact.points.push_back(*best);
        exact.mean_range_m += (best->p_world - T.translation()).norm();
      }
    }
    exact.mean_range_m /= static_cast<double>(exact.points.size());
  }
  return out;
}

Oracle oracle_of(const World& world, const RecordedSweeps& recorded, const OracleSettings& settings = {}) {
  const sim::raycast::Tracer tracer(std::make_shared<const scenes::Scene>(world.scene), {});
  return make_oracle(recorded.source(), recorded.truth, recorded.labels, tracer, settings);
}

TEST(Oracle, OfAPlaneLeavesThreeDirectionsFree) {
  const World world = make_world(false);
  const RecordedSweeps recorded = record(world);
  for (const OracleSweep& sweep : oracle_of(world, recorded).sweeps) {
    ASSERT_TRUE(sweep.blocks);
    EXPECT_EQ(sweep.disagreeing, 0u);
    EXPECT_GT(sweep.points, 2000u);
    EXPECT_LT(sweep.blocks->pose.values[2], 1e-12);
    EXPECT_GT(sweep.blocks->pose.values[3], 1e-3);
    EXPECT_LT(sweep.blocks->two_pose->values[5], 1e-12);
    EXPECT_GT(sweep.blocks->two_pose->values[6], 1e-5);
    EXPECT_LT(*sweep.lambda_pose(), kOracleDegenerateBelow);
    EXPECT_LT(*sweep.lambda_difference(), kOracleShearDegenerateBelow);
  }
}

TEST(Oracle, OfARoomIsTheClosedFormsBlock) {
  const World world = make_world(true);
  const RecordedSweeps recorded = record(world);
  const Oracle oracle = oracle_of(world, recorded);
  for (std::size_t k = 0; k < oracle.sweeps.size(); ++k) {
    const OracleSweep& sweep = oracle.sweeps[k];
    EXPECT_EQ(sweep.points, recorded.exact[k].points.size());
    EXPECT_LT(sweep.disagreeing, sweep.points / 200);  // beams into the corners
    EXPECT_NEAR(sweep.mean_range_m, recorded.exact[k].mean_range_m, 1e-6 * sweep.mean_range_m);
    const auto exact = recorded.exact[k].analyse();
    EXPECT_GT(exact->pose.min(), kOracleDegenerateBelow);
    for (int i = 0; i < 6; ++i)
      EXPECT_NEAR(sweep.blocks->pose.values[i], exact->pose.values[i], 2e-3 * exact->pose.values[i]);
    for (int i = 0; i < 12; ++i)
      EXPECT_NEAR(sweep.blocks->two_pose->values[i], exact->two_pose->values[i], 5e-3 * exact->two_pose->values[i]);
  }
}

TEST(Oracle, LooksThroughTextureThatWouldHideAnyApron) {
  const World world = make_world(false, true);
  const RecordedSweeps recorded = record(world);
  const Oracle oracle = oracle_of(world, recorded);
  for (std::size_t k = 0; k < oracle.sweeps.size(); ++k) {
    EXPECT_LT(oracle.sweeps[k].blocks->pose.values[2], 1e-12);
    // The same returns with the texture's own normals: no direction is free any more.
    Sweep textured = recorded.exact[k];
    for (SurfacePoint& point : textured.points) {
      Eigen::Vector2d gradient;
      Texture().height_m(point.p_world.x(), point.p_world.y(), &gradient);
      point.n_world = Eigen::Vector3d(-gradient.x(), -gradient.y(), 1).normalized();
    }
    EXPECT_GT(textured.analyse()->pose.min(), kOracleDegenerateBelow);
  }
}

TEST(Oracle, LeavesOutWhatMoves) {
  World world = make_world(true);
  for (std::size_t s = 1; s < world.surfaces.size(); ++s) world.surfaces[s].moving = true;
  const RecordedSweeps recorded = record(world);
  for (const OracleSweep& sweep : oracle_of(world, recorded).sweeps) {
    ASSERT_TRUE(sweep.blocks);
    EXPECT_LT(sweep.blocks->pose.values[2], 1e-12);
    EXPECT_LT(sweep.static_returns, recorded.sweeps[0].size() / 2 + recorded.sweeps[0].size() / 4);
  }
}

TEST(Oracle, LeavesOutBeamsThatMeetAnotherObjectThanTheReturnsLabel) {
  const World world = make_world(true);
  RecordedSweeps recorded = record(world);
  const std::size_t n = recorded.labels[0].instance.size();
  for (std::size_t i = 0; i < n / 2; ++i) recorded.labels[0].instance[i] = 77;
  const Oracle oracle = oracle_of(world, recorded);
  EXPECT_GE(oracle.sweeps[0].disagreeing, n / 2);
  EXPECT_LT(oracle.sweeps[1].disagreeing, n / 200);
}

TEST(Oracle, AsksEveryKthReturnAndEveryChannel) {
  const World world = make_world(true);
  const RecordedSweeps recorded = record(world);
  const Oracle all = oracle_of(world, recorded), some = oracle_of(world, recorded, {.points_per_sweep = 1500});
  for (std::size_t k = 0; k < all.sweeps.size(); ++k) {
    EXPECT_LE(some.sweeps[k].points, 1500u);
    EXPECT_GT(some.sweeps[k].points, 500u);
    EXPECT_EQ(some.sweeps[k].mean_range_m, all.sweeps[k].mean_range_m);
    EXPECT_NEAR(*some.sweeps[k].lambda_pose(), *all.sweeps[k].lambda_pose(), 0.1 * *all.sweeps[k].lambda_pose());
  }
}

TEST(Oracle, IsTheSameAtAnyNumberOfThreads) {
  const World world = make_world(true);
  const RecordedSweeps recorded = record(world);
  const Oracle one = oracle_of(world, recorded), four = oracle_of(world, recorded, {.threads = 4});
  for (std::size_t k = 0; k < one.sweeps.size(); ++k) {
    EXPECT_EQ(one.sweeps[k].blocks->pose.values, four.sweeps[k].blocks->pose.values);
    EXPECT_EQ(one.sweeps[k].blocks->difference->values, four.sweeps[k].blocks->difference->values);
  }
}

TEST(Oracle, DoesNotKnowSweepsThatTheTruthDoesNotCover) {
  const World world = make_world(false);
  RecordedSweeps recorded = record(world);
  recorded.labels[1].begin = time_from_s(3);
  recorded.labels[1].end = time_from_s(3.1);
  const Oracle oracle = oracle_of(world, recorded);
  EXPECT_TRUE(oracle.sweeps[0].lambda_pose());
  EXPECT_FALSE(oracle.sweeps[1].lambda_pose());
}

TEST(Oracle, RefusesLabelsOfAnotherRecording) {
  const World world = make_world(false);
  RecordedSweeps recorded = record(world);
  recorded.labels[1].t_ns.pop_back();
  EXPECT_THROW(oracle_of(world, recorded), InputError);
  recorded.labels.pop_back();
  EXPECT_THROW(oracle_of(world, recorded), InputError);
}

}  // namespace
}  // namespace tarmac::metrics::tests
