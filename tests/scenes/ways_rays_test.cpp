// Rays: no hole in the ground or in the tunnels' walls, and surfaces where they should be.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "core/random.h"
#include "scenes/baggage_tunnel/layout.h"
#include "scenes/registry.h"
#include "scenes/road_tunnel/layout.h"
#include "scenes/runway/layout.h"
#include "scenes/taxiway/section.h"
#include "sim/raycast/tracer.h"
#include "tests/scenes/support.h"

namespace tarmac::scenes {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using sim::raycast::Hits;
using sim::raycast::Rays;
using tests::follows_ground;

class Traced {
 public:
  explicit Traced(const std::string& yaml) : scene_(without_relief(yaml)), tracer_(scene_, {}) {}
  const Scene& scene() const { return *scene_; }
  Hits from(const Vector3d& origin, const std::vector<Vector3d>& directions) const {
    const sim::raycast::SweepTracer sweep = tracer_.sweep(core::Time(), core::Time(), origin, 1000);
    const Vector3d o = origin - sweep.base();
    Rays rays;
    rays.resize(directions.size());
    std::vector<std::uint32_t> order((directions.size() + 15) / 16 * 16, sim::raycast::SweepTracer::no_ray);
    for (std::size_t k = 0; k < directions.size(); ++k) {
      rays.ox[k] = o.x(), rays.oy[k] = o.y(), rays.oz[k] = o.z();
      rays.dx[k] = directions[k].x(), rays.dy[k] = directions[k].y(), rays.dz[k] = directions[k].z();
      rays.t_ns[k] = 0;
      order[k] = static_cast<std::uint32_t>(k);
    }
    Hits hits;
    sweep.trace(rays, order, hits);
    return hits;
  }

 private:
  static std::shared_ptr<const Scene> without_relief(const std::string& yaml) {
    Scene scene = make_scene(core::ConfigNode::parse(yaml, "scene.yaml"), 1);
    scene.relief.reset();
    return std::make_shared<const Scene>(std::move(scene));
  }
  std::shared_ptr<const Scene> scene_;
  sim::raycast::Tracer tracer_;
};

/// Uniform on the sphere.
std::vector<Vector3d> directions(std::size_t count, const char* name) {
  const core::RandomStream random(1, name);
  std::vector<Vector3d> list;
  for (std::uint64_t k = 0; k < count; ++k) {
    const double z = 2 * random.uniform(k, 0) - 1, a = 2 * std::numbers::pi * random.uniform(k, 1);
    list.emplace_back(std::sqrt(1 - z * z) * std::cos(a), std::sqrt(1 - z * z) * std::sin(a), z);
  }
  return list;
}

/// Distance from p along d to the inside of the box |y| < half, low < z < high, endless along x.
double to_box_m(const Vector3d& p, const Vector3d& d, double half, double low, double high) {
  const double side = d.y() == 0 ? 1e9 : ((d.y() > 0 ? half : -half) - p.y()) / d.y();
  const double upright = d.z() == 0 ? 1e9 : ((d.z() > 0 ? high : low) - p.z()) / d.z();
  return std::min(side, upright);
}

const std::string smooth = "kind: road-tunnel\nundulation_mm: 0\nwith_wall_lights: false\n";

TEST(RoadTunnel, EveryRayInsideTheSmoothBoxMeetsTheBoxWhereItIs) {
  const Traced traced(smooth);
  const RoadTunnelLayout l{RoadTunnelOptions{}};
  std::size_t inside = 0, through_a_portal = 0;
  // The road is level, to a tenth of a millimetre, where the ramps' rounding has died away.
  const double level_m = l.ramp_foot_m - 12 * l.rounding_m;
  for (const double x : {-31.0, 0.3, 24.0}) {
    const Vector3d p(x, 1.2, -l.depth_m + 2);
    const std::vector<Vector3d> d = directions(20000, "test/smooth");
    const Hits hits = traced.from(p, d);
    for (std::size_t k = 0; k < d.size(); ++k) {
      const double expected = to_box_m(p, d[k], l.half_m, -l.depth_m, -l.depth_m + l.height_m);
      const Vector3d q = p + expected * d[k];
      if (std::abs(q.x()) > l.portal_m) {
        ++through_a_portal;
        continue;
      }
      ASSERT_NE(hits.instance[k], Hits::nothing) << "a hole at " << q.transpose();
      if (std::abs(q.x()) > level_m) continue;
      const bool above_walkway = q.z() < -l.depth_m + 0.13 && std::abs(q.y()) > l.half_m - 0.76;
      if (above_walkway) continue;
      if (traced.scene().instances[hits.instance[k]].label == Label::marking) continue;  // paint is 1.2 mm thick
      ++inside;
      ASSERT_NEAR(hits.t_m[k], expected, 0.001) << "towards " << q.transpose();
    }
  }
  EXPECT_GT(inside, 40000U);
  EXPECT_GT(through_a_portal, 10U);
}

TEST(RoadTunnel, TheSmoothBoxIsTheSameEverywhereAlongItAndTheOneWithNichesIsNot) {
  const RoadTunnelLayout l{RoadTunnelOptions{}};
  const std::vector<Vector3d> all = directions(8000, "test/along");
  std::vector<Vector3d> d;  // towards what lies within 25 m on both sides
  for (const Vector3d& v : all) {
    if (std::abs(v.x()) < 0.9) d.push_back(v);
  }
  const auto different = [&](const Traced& traced) {
    const Hits a = traced.from({-27, -1, -l.depth_m + 2}, d), b = traced.from({6, -1, -l.depth_m + 2}, d);
    std::size_t count = 0;
    for (std::size_t k = 0; k < d.size(); ++k) {
      EXPECT_NE(a.instance[k], Hits::nothing);
      EXPECT_NE(b.instance[k], Hits::nothing);
      if (std::abs(a.t_m[k] - b.t_m[k]) > 0.01) ++count;
    }
    return count;
  };
  EXPECT_EQ(different(Traced(smooth)), 0U);
  EXPECT_GT(different(Traced(smooth + "niches: true\n")), d.size() / 100);
}

TEST(RoadTunnel, NichesAreRecessesWithoutHolesAtTheirSpacing) {
  const Traced traced(smooth + "niches: true\nniche_spacing_m: 50\n");
  const RoadTunnelLayout l{RoadTunnelOptions{}};
  // Level rays at right angles to the left wall, every 10 cm: those over a niche go deeper by its depth.
  std::vector<double> begins;
  bool deep_before = false;
  for (double x = -87.96; x < 88; x += 0.1) {
    const Hits hits = traced.from({x, 1, -l.depth_m + 0.6}, {Vector3d(0, 1, 0)});
    ASSERT_NE(hits.instance[0], Hits::nothing) << x;
    const double deeper = hits.t_m[0] - (l.half_m - 1);
    const bool deep = deeper > 0.01;
    if (deep) {
      EXPECT_NEAR(deeper, 1.2, 0.001);
    }
    if (deep && !deep_before) begins.push_back(x);
    deep_before = deep;
  }
  ASSERT_EQ(begins.size(), 4U);
  for (std::size_t k = 1; k < begins.size(); ++k) EXPECT_NEAR(begins[k] - begins[k - 1], 50, 0.11);
  for (const double x : {-75.0, -25.0, -24.0, 20.0}) {
    const Vector3d p(x, 2.5, -l.depth_m + 1.4);
    const std::vector<Vector3d> d = directions(20000, "test/niches");
    const Hits hits = traced.from(p, d);
    for (std::size_t k = 0; k < d.size(); ++k) {
      const Vector3d q = p + to_box_m(p, d[k], l.half_m, -l.depth_m, -l.depth_m + l.height_m) * d[k];
      if (std::abs(q.x()) > l.portal_m - 12) continue;
      ASSERT_NE(hits.instance[k], Hits::nothing) << "a hole at " << q.transpose();
      // A ray that enters a niche ends at its back or at its side: at most its depth, slanted, farther.
      ASSERT_LT(hits.t_m[k], (q - p).norm() + 4.1) << "out of the structure at " << q.transpose();
    }
  }
}

TEST(RoadTunnel, RampsHaveWallsThatNoRayPassesBelowTheLand) {
  const Traced traced(smooth);
  const RoadTunnelLayout l{RoadTunnelOptions{}};
  const RoadTunnelGround ground(RoadTunnelOptions{.undulation_mm = 0}, 1);
  for (const double x : {l.portal_m + 10, l.portal_m + 50, -l.portal_m - 80}) {
    const Vector3d p(x, 1, ground.height_m(x, 1) + 1);
    const std::vector<Vector3d> d = directions(20000, "test/ramps");
    const Hits hits = traced.from(p, d);
    for (std::size_t k = 0; k < d.size(); ++k) {
      if (d[k].z() > -0.12) continue;  // steeper than the ramp: nothing leads out
      ASSERT_NE(hits.instance[k], Hits::nothing) << x << ": " << d[k].transpose();
      ASSERT_LT(hits.t_m[k], 60);
    }
  }
}

TEST(Taxiway, GroundHasNoHolesAroundABend) {
  const Traced traced("kind: taxiway\nshape: curve\nlength_m: 400\ngrass_m: 60\n");
  TaxiwayOptions options;
  options.shape = "curve";
  options.length_m = 400;
  const TaxiwayLayout layout(options);
  const double left = layout.section().shoulder_m + 60, right = layout.taxiways_d_m().back() - left;
  const core::RandomStream random(1, "test/bend");
  int inside_the_bend = 0;
  for (std::uint64_t k = 0; k < 4000; ++k) {
    const Vector2d p =
        layout.line().place(10 + 380 * random.uniform(k, 0), right + 2 + (left - right - 4) * random.uniform(k, 1));
    const CentreLine::Place place = layout.line().project(p);
    if (place.s_m < 5 || place.s_m > 395 || place.d_m > left - 1) continue;  // across the bend's centre
    if (place.d_m > layout.section().outer_m) ++inside_the_bend;
    const Vector3d above(p.x(), p.y(), traced.scene().ground->height_m(p.x(), p.y()) + 20);
    const Hits hits = traced.from(above, {Vector3d(0, 0, -1)});
    ASSERT_NE(hits.instance[0], Hits::nothing) << "s " << place.s_m << ", d " << place.d_m;
    if (follows_ground(traced.scene().instances[hits.instance[0]].label)) {
      ASSERT_NEAR(hits.t_m[0], 20, 0.003);
    }
  }
  EXPECT_GT(inside_the_bend, 300);
}

TEST(RunwayCrossing, GroundHasNoHolesBetweenItsPieces) {
  const Traced traced("kind: runway-crossing\n");
  const RunwayLayout l{RunwayOptions{}};
  const core::RandomStream random(1, "test/crossing");
  for (std::uint64_t k = 0; k < 6000; ++k) {
    const Vector2d p(240 * random.uniform(k, 0) - 120, 400 * random.uniform(k, 1) - 200);
    const Vector3d above(p.x(), p.y(), traced.scene().ground->height_m(p.x(), p.y()) + 20);
    const Hits hits = traced.from(above, {Vector3d(0, 0, -1)});
    ASSERT_NE(hits.instance[0], Hits::nothing) << p.transpose();
    if (follows_ground(traced.scene().instances[hits.instance[0]].label)) {
      ASSERT_NEAR(hits.t_m[0], 20, 0.003) << p.transpose();
    }
  }
  // Pavement on the inner side of a fillet's arc, grass beyond it.
  const double r = l.fillet_m;
  for (const RunwayLayout::Corner& corner : l.corners()) {
    const Vector2d centre = corner.at_m + r * (corner.along_runway + corner.along_taxiway);
    for (const double off : {-0.4, 0.4}) {
      const Vector2d p = centre - (r + off) * (corner.along_runway + corner.along_taxiway).normalized();
      const Vector3d above(p.x(), p.y(), traced.scene().ground->height_m(p.x(), p.y()) + 5);
      const Hits hits = traced.from(above, {Vector3d(0, 0, -1)});
      const Label label = traced.scene().instances[hits.instance[0]].label;
      EXPECT_EQ(label, off > 0 ? Label::pavement : Label::terrain) << p.transpose();
    }
  }
}

TEST(BaggageTunnel, IsClosedAllAround) {
  const Traced traced("kind: baggage-tunnel\n");
  const BaggageTunnelLayout l{BaggageTunnelOptions{}};
  const Ground& ground = *traced.scene().ground;
  const std::vector<Vector3d> d = directions(6000, "test/baggage");
  for (double s = -60; s < l.line.length_m() - 1; s += 6.7) {
    const Vector2d at = l.line.at(s).p_m;
    const Vector3d p(at.x(), at.y(), ground.height_m(at.x(), at.y()) + 1.5);
    const Hits hits = traced.from(p, d);
    for (std::size_t k = 0; k < d.size(); ++k)
      ASSERT_NE(hits.instance[k], Hits::nothing) << "from " << p.transpose() << " towards " << d[k].transpose();
  }
}

TEST(BaggageTunnel, WithoutAHallADoorClosesItsWesternEnd) {
  const Traced traced("kind: baggage-tunnel\nwith_hall: false\nwith_junction: false\n");
  const std::vector<Vector3d> d = directions(20000, "test/door");
  const Hits hits = traced.from({5, 0, 1.5}, d);
  for (std::size_t k = 0; k < d.size(); ++k) ASSERT_NE(hits.instance[k], Hits::nothing) << d[k].transpose();
  const Hits west = traced.from({5, 0, 1.5}, {Vector3d(-1, 0, 0)});
  EXPECT_NEAR(west.t_m[0], 5, 0.05);
}

}  // namespace
}  // namespace tarmac::scenes
