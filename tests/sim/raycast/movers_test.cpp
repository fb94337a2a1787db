// Moving actors against closed forms, and what would be seen if they were frozen.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numeric>

#include "core/random.h"
#include "scenes/actors/actors.h"
#include "scenes/materials/materials.h"
#include "sim/raycast/pose_track.h"
#include "sim/raycast/scene_frames.h"
#include "sim/raycast/tracer.h"
#include "tests/sim/support/motions.h"
#include "tests/sim/support/shapes.h"

namespace tarmac::sim::raycast {
namespace {

using core::SE3;
using core::Time;
using core::time_from_s;
using Eigen::Vector3d;

constexpr double period_s = 0.1;
constexpr double begin_s = 2.3;

scenes::Scene cast(const std::string& actors) {
  scenes::Scene scene;
  scene.materials = scenes::materials();
  scenes::add_actors(core::ConfigNode::parse("kind: none\nactors:\n" + actors, "test.yaml"), scene);
  return scene;
}

/// What an actor would be if it stood still from the sweep's begin on.
class Frozen final : public scenes::ActorMotion {
 public:
  Frozen(std::shared_ptr<const scenes::ActorMotion> motion, Time when) : pose_(motion->T_world_actor(when)) {}
  SE3 T_world_actor(Time) const override { return pose_; }
  double acceleration_bound_m_s2(Time, Time, double) const override { return 0; }

 private:
  SE3 pose_;
};

scenes::Scene frozen(scenes::Scene scene, Time when) {
  for (scenes::Actor& actor : scene.actors) actor.motion = std::make_shared<Frozen>(actor.motion, when);
  return scene;
}

/// A spinning sensor of 32 channels that drives at 5 m/s: one turn, each column at its own time.
Rays spin(const Vector3d& from_base) {
  constexpr std::size_t columns = 1024, channels = 32;
  Rays rays;
  rays.resize(columns * channels);
  for (std::size_t k = 0; k < columns; ++k) {
    const double share = static_cast<double>(k) / columns, azimuth = -2 * M_PI * share, t_s = period_s * share;
    for (std::size_t c = 0; c < channels; ++c) {
      const std::size_t i = k * channels + c;
      const double elevation = 0.5 * (static_cast<double>(c) / (channels - 1) - 0.5);
      rays.ox[i] = from_base.x() + 5 * t_s, rays.oy[i] = from_base.y(), rays.oz[i] = from_base.z();
      rays.dx[i] = std::cos(elevation) * std::cos(azimuth);
      rays.dy[i] = std::cos(elevation) * std::sin(azimuth);
      rays.dz[i] = std::sin(elevation);
      rays.t_ns[i] = static_cast<std::int32_t>(std::llround(t_s * 1e9)) + static_cast<std::int32_t>(50 * c);
    }
  }
  return rays;
}

struct Shots {
  Rays rays;
  Hits hits;
  Vector3d base;
  Vector3d origin(std::size_t i) const { return base + Vector3d(rays.ox[i], rays.oy[i], rays.oz[i]); }
  Vector3d direction(std::size_t i) const { return {rays.dx[i], rays.dy[i], rays.dz[i]}; }
  Time time(std::size_t i) const { return time_from_s(begin_s) + core::Duration(rays.t_ns[i]); }
};

Shots turn_around(const scenes::Scene& scene, const Vector3d& origin) {
  const Tracer tracer(std::make_shared<scenes::Scene>(scene), {});
  const SweepTracer sweep = tracer.sweep(time_from_s(begin_s), time_from_s(begin_s + period_s), origin, 150);
  Shots shots{spin(origin - sweep.base()), {}, sweep.base()};
  std::vector<std::uint32_t> order(shots.rays.size());
  std::iota(order.begin(), order.end(), 0u);
  sweep.trace(shots.rays, order, shots.hits);
  return shots;
}

struct Errors {
  double largest_m = 0, sum_m = 0;
  std::size_t count = 0;
  void add(double error_m) {
    largest_m = std::max(largest_m, std::abs(error_m));
    sum_m += std::abs(error_m);
    ++count;
  }
  double mean_m() const { return sum_m / static_cast<double>(count); }
};

const char* const plane =
    "  - {kind: accelerating-plane, position_m: [32, 2, 1], velocity_m_s: [-8, 2, 0], acceleration_m_s2: [2, -3, 1], "
    "heading_deg: 195, size_m: [0.3, 30, 20]}\n";

Vector3d plane_at(double t) {
  return Vector3d(32, 2, 1) + t * Vector3d(-8, 2, 0) + 0.5 * t * t * Vector3d(2, -3, 1);
}

/// Perpendicular distance of the points on the plate's front from the plane where it is at each point's own time.
Errors plane_errors(const Shots& shots) {
  const Vector3d n(std::cos(195 * M_PI / 180), std::sin(195 * M_PI / 180), 0);
  Errors errors;
  for (std::size_t i = 0; i < shots.hits.size(); ++i) {
    if (shots.hits.instance[i] == Hits::nothing) continue;
    if (n.dot(Vector3d(shots.hits.nx[i], shots.hits.ny[i], shots.hits.nz[i])) < 0.99) continue;  // an edge of the plate
    const Vector3d p = shots.origin(i) + shots.hits.t_m[i] * shots.direction(i);
    errors.add(n.dot(p - plane_at(core::to_s(shots.time(i)))));
  }
  return errors;
}

TEST(Movers, AcceleratingPlaneIsMetWithinAMicrometreWhereItIsAtEachRaysTime) {
  const scenes::Scene scene = cast(plane);
  const Errors moving = plane_errors(turn_around(scene, {0, 0, 1.5}));
  const Errors still = plane_errors(turn_around(frozen(scene, time_from_s(begin_s)), {0, 0, 1.5}));
  std::cout << "accelerating plane, " << moving.count << " rays: largest error " << 1e6 * moving.largest_m
            << " um; frozen at the sweep's begin: mean " << still.mean_m() << " m, largest " << still.largest_m
            << " m\n";
  EXPECT_GT(moving.count, 1000u);
  EXPECT_LT(moving.largest_m, 2e-6);
  EXPECT_GT(still.mean_m(), 0.05) << "freezing it must show";
}

/// Nearest positive meeting of a ray with a box about the origin of T, in double; not a number when it misses.
double meet_box(const SE3& T, const Vector3d& half, const Vector3d& o, const Vector3d& d) {
  const Vector3d p = T.inverse() * o, v = T.linear().transpose() * d;
  double in = -1e9, out = 1e9;
  for (int k = 0; k < 3; ++k) {
    const double a = (-half[k] - p[k]) / v[k], b = (half[k] - p[k]) / v[k];
    in = std::max(in, std::min(a, b));
    out = std::min(out, std::max(a, b));
  }
  return in < out && in > 0 ? in : std::nan("");
}

const char* const box =
    "  - {kind: turning-box, position_m: [9, -1, 1.5], velocity_m_s: [-1, 2, 0.5], acceleration_m_s2: [0.5, 0, 0], "
    "size_m: "
    "[4, 2, 3], heading_deg: 30, turn_deg_s: 60, turn_deg_s2: 30}\n";

SE3 box_at(double t) {
  SE3 T = SE3::Identity();
  T.linear() = Eigen::AngleAxisd((30 + 60 * t + 15 * t * t) * M_PI / 180, Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Vector3d(9, -1, 1.5) + t * Vector3d(-1, 2, 0.5) + 0.5 * t * t * Vector3d(0.5, 0, 0);
  return T;
}

struct BoxErrors {
  Errors range;
  std::size_t silhouette = 0;  ///< rays that only one of the two answers meets it with
};

BoxErrors box_errors(const Shots& shots) {
  BoxErrors errors;
  for (std::size_t i = 0; i < shots.hits.size(); ++i) {
    const double expected =
        meet_box(box_at(core::to_s(shots.time(i))), {2, 1, 1.5}, shots.origin(i), shots.direction(i));
    const bool met = shots.hits.instance[i] != Hits::nothing;
    if (met != std::isfinite(expected))
      ++errors.silhouette;
    else if (met)
      errors.range.add(shots.hits.t_m[i] - expected);
  }
  return errors;
}

TEST(Movers, TurningBoxIsMetWithinAMillimetreAtItsOwnOrientationAndSilhouette) {
  const scenes::Scene scene = cast(box);
  const BoxErrors moving = box_errors(turn_around(scene, {0, 0, 1.5}));
  const BoxErrors still = box_errors(turn_around(frozen(scene, time_from_s(begin_s)), {0, 0, 1.5}));
  std::cout << "turning box, " << moving.range.count << " rays: largest error " << 1e6 * moving.range.largest_m
            << " um, " << moving.silhouette << " rays decided otherwise; frozen: mean " << still.range.mean_m()
            << " m, largest " << still.range.largest_m << " m, " << still.silhouette << " rays decided otherwise\n";
  EXPECT_GT(moving.range.count, 500u);
  EXPECT_LT(moving.range.largest_m, 1e-3);
  EXPECT_LE(moving.silhouette, 2u);
  EXPECT_GT(still.range.mean_m(), 0.02);
  EXPECT_GT(still.silhouette, 20u);
}

// The same scene with everything standing where it is at that instant knows no culling: both must meet the same.
TEST(Movers, NoneIsMissedByLookingOnlyWhereItCanBe) {
  const core::RandomStream random(2, "test/movers");
  std::string actors;
  for (std::uint64_t k = 0; k < 40; ++k) {
    const double r = 1.2 + 25 * random.uniform(k, 0), a = 2 * M_PI * random.uniform(k, 1);
    actors += "  - {kind: turning-box, position_m: [" + std::to_string(r * std::cos(a)) + ", " +
              std::to_string(r * std::sin(a)) + ", " + std::to_string(8 * random.uniform(k, 2) - 3) +
              "], velocity_m_s: [" + std::to_string(4 * random.uniform(k, 3) - 2) + ", 3, -1], size_m: [" +
              std::to_string(0.3 + 3 * random.uniform(k, 4)) + ", 0.6, " +
              std::to_string(0.2 + 2 * random.uniform(k, 5)) +
              "], turn_deg_s: " + std::to_string(200 * random.uniform(k, 6) - 100) + "}\n";
  }
  const scenes::Scene moving = cast(actors);
  const std::int32_t t_ns = 43'210'987;
  const Time when = time_from_s(begin_s) + core::Duration(t_ns);
  scenes::Scene standing = moving;
  standing.actors.clear();
  for (scenes::Instance& instance : standing.instances) {
    instance.T_parent_mesh =
        moving.actors[static_cast<std::size_t>(instance.actor)].motion->T_world_actor(when) * instance.T_parent_mesh;
    instance.actor = -1;
  }
  Rays rays;
  rays.resize(20'000);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vector3d d = Vector3d(random.normal(i, 0), random.normal(i, 1), random.normal(i, 2)).normalized();
    rays.dx[i] = d.x(), rays.dy[i] = d.y(), rays.dz[i] = d.z();
    rays.ox[i] = 0.3 * random.uniform(i, 3), rays.oy[i] = 0.3 * random.uniform(i, 4), rays.oz[i] = 0;
    rays.t_ns[i] = t_ns;
  }
  std::vector<std::uint32_t> order(rays.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto hits_in = [&](const scenes::Scene& scene) {
    const Tracer tracer(std::make_shared<scenes::Scene>(scene), {});
    Hits hits;
    tracer.sweep(time_from_s(begin_s), time_from_s(begin_s + period_s), Vector3d::Zero(), 150).trace(rays, order, hits);
    return hits;
  };
  const Hits a = hits_in(moving), b = hits_in(standing);
  std::size_t met = 0, otherwise = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    met += b.instance[i] != Hits::nothing;
    if (a.instance[i] != b.instance[i]) {
      ++otherwise;  // an edge, decided by single precision in another frame
    } else if (a.instance[i] != Hits::nothing) {
      EXPECT_NEAR(a.t_m[i], b.t_m[i], 1e-5);
    }
  }
  EXPECT_GT(met, 1000u);
  EXPECT_LE(otherwise, 2u) << "of " << met;
}

/// Shakes at 4 Hz: harder than anything that drives.
class Shaking final : public scenes::ActorMotion {
 public:
  SE3 T_world_actor(Time t) const override {
    SE3 T = SE3::Identity();
    const double phase = 8 * M_PI * core::to_s(t);
    T.linear() = core::so3::exp(Vector3d(0.02 * std::sin(phase), 0, 0.3 * std::cos(phase)));
    T.translation() = Vector3d(100, 0.02 * std::sin(phase), 0);
    return T;
  }
  double acceleration_bound_m_s2(Time, Time, double radius_m) const override {
    const double w = 8 * M_PI;
    return 0.02 * w * w + (0.33 * w * w + 0.33 * 0.33 * w * w) * radius_m;
  }
};

TEST(Movers, PosesBetweenTheKnotsAreWithinMicrometresOfTheMotion) {
  const Shaking motion;
  const double radius = 2;
  const int knots = motion_steps(motion.acceleration_bound_m_s2({}, {}, radius), core::duration_from_s(period_s));
  std::vector<SE3> poses;
  for (int k = 0; k < knots; ++k) poses.push_back(motion.T_world_actor(time_from_s(period_s * k / (knots - 1))));
  const PoseTrack track(poses, period_s * 1e9);
  double largest = 0;
  for (double t = 0; t <= period_s; t += 0.00037) {
    const Frame frame = track.at(t * 1e9);
    const SE3 exact = motion.T_world_actor(time_from_s(t));
    const Vector3d p = radius * Vector3d(0.5, -0.5, std::sqrt(0.5));
    largest = std::max(largest, (frame.R * p + frame.p - exact * p).norm());
  }
  std::cout << knots << " knots: largest error " << 1e6 * largest << " um\n";
  EXPECT_LT(largest, 5e-6);
}

}  // namespace
}  // namespace tarmac::sim::raycast
