// Ground along a line, and meshes that follow a ground.
#include "scenes/paving/strips.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>

#include "core/random.h"
#include "scenes/paving/ground_painter.h"
#include "scenes/paving/section_ground.h"
#include "tests/scenes/solids.h"
#include "tests/support/numeric.h"

namespace tarmac::scenes {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using tests::numeric_jacobian;

CentreLine bent_line() {
  StartOptions start;
  start.x_m = -80;
  start.y_m = 10;
  start.heading_deg = 15;
  PathPiece straight, bend;
  straight.straight_m = 90;
  bend.turn_deg = 80;
  bend.radius_m = 60;
  bend.blend_m = 20;
  return CentreLine(start, {straight, bend, straight});
}

SectionSpec bumpy_section() {
  SectionSpec spec;
  spec.across = RoundedProfile({{-40, 0}, {-25, 0, 0.5}, {-20, -0.4, 0.5}, {-10, -0.1, 0.4}, {0, 0, 0.8}, {15, -0.2}});
  spec.along = RoundedProfile({{0, 0}, {40, 0, 4}, {110, -4, 4}, {300, -4}});
  spec.slope = {0.004, -0.002};
  spec.undulation_mm = 8;
  return spec;
}

TEST(RoundedProfile, GradeAndCurvatureAreTheDerivatives) {
  const RoundedProfile profile({{0, 1}, {10, 1.5, 0.7}, {20, 1.2, 2}, {25, 3}});
  for (double u = -5; u < 32; u += 0.37) {
    using One = Eigen::Matrix<double, 1, 1>;
    const auto z = [&](const One& v) { return One(profile.at(v[0]).z_m); };
    const auto grade = [&](const One& v) { return One(profile.at(v[0]).grade); };
    EXPECT_NEAR((numeric_jacobian<1, 1>(z, One(u), 1e-4)[0]), profile.at(u).grade, 1e-7);
    EXPECT_NEAR((numeric_jacobian<1, 1>(grade, One(u), 1e-4)[0]), profile.at(u).curvature_per_m, 1e-7);
  }
}

TEST(RoundedProfile, FollowsItsPolylineAwayFromTheBreaksAndBendsAsItsRoundingSays) {
  const double w = 4.5, grade = 0.06;
  const RoundedProfile profile({{-50, 0}, {0, 0, w}, {100, -100 * grade, w}, {150, -100 * grade}});
  EXPECT_NEAR(profile.at(-200).z_m, 0, 1e-12);
  EXPECT_NEAR(profile.at(50).z_m, -50 * grade, 2 * grade * w * std::exp(-50 / w));
  EXPECT_NEAR(profile.at(400).z_m, -100 * grade, 1e-12);
  EXPECT_NEAR(profile.at(1e5).grade, 0, 1e-15) << "no overflow far away";
  double most = 0;
  for (double u = -40; u < 60; u += 0.01) most = std::max(most, std::abs(profile.at(u).curvature_per_m));
  EXPECT_NEAR(1 / most, 4 * w / grade, 0.01);
}

TEST(RoundedProfile, RefusesPointsThatAreNoPolyline) {
  EXPECT_THROW(RoundedProfile({{0, 0}}), std::invalid_argument);
  EXPECT_THROW(RoundedProfile({{0, 0}, {0, 1}}), std::invalid_argument);
  EXPECT_THROW(RoundedProfile({{0, 0}, {1, 1, 0}, {2, 0}}), std::invalid_argument);
}

TEST(CentreLine, ProjectUndoesPlaceOnTheBendAndBeyondBothEnds) {
  const CentreLine line = bent_line();
  const core::RandomStream random(3, "test/centre_line");
  for (std::uint64_t k = 0; k < 300; ++k) {
    const double s = (line.length_m() + 60) * random.uniform(k, 0) - 30, d = 80 * random.uniform(k, 1) - 40;
    const CentreLine::Place place = line.project(line.place(s, d));
    EXPECT_NEAR(place.s_m, s, 1e-8);
    EXPECT_NEAR(place.d_m, d, 1e-8);
  }
  EXPECT_THROW(CentreLine(StartOptions{}, {PathPiece{.straight_m = 0, .turn_deg = 10, .radius_m = 5, .blend_m = 20}}),
               std::invalid_argument);
}

/// A hairpin whose end, gone on, passes its own begin: the nearest sample of the line is on the other branch there, and
/// a kilometre out there is none.
TEST(CentreLine, ProjectFindsTheStraightBeyondTheEndsHoweverFarAndBesideAnotherBranch) {
  StartOptions start;
  start.x_m = 30;
  start.y_m = -20;
  start.heading_deg = 40;
  const PathPiece leg{.straight_m = 60}, bend{.straight_m = 0, .turn_deg = 180, .radius_m = 30, .blend_m = 20},
      shorter{.straight_m = 20};
  const CentreLine line(start, {leg, bend, shorter});
  const double length_m = line.length_m();
  double apart_m = (line.at(length_m).p_m - line.at(0).p_m).dot(line.at(0).left);
  ASSERT_GT(apart_m, 50);
  for (const double beyond_m : {5.0, 25.0, 39.0, 70.0, 200.0, 1000.0, 20000.0}) {
    // Nearer to the last leg gone on than to the first one.
    for (const double d_m : {-20.0, 0.0, 0.45 * apart_m}) {
      const CentreLine::Place place = line.project(line.place(length_m + beyond_m, d_m));
      EXPECT_NEAR(place.s_m, length_m + beyond_m, 1e-6) << beyond_m << " " << d_m;
      EXPECT_NEAR(place.d_m, d_m, 1e-6) << beyond_m << " " << d_m;
      EXPECT_EQ(place.foot.curvature_per_m, 0);
    }
    const CentreLine::Place before = line.project(line.place(-beyond_m, 0.45 * apart_m));
    EXPECT_NEAR(before.s_m, -beyond_m, 1e-6);
    EXPECT_NEAR(before.d_m, 0.45 * apart_m, 1e-6);
  }
}

TEST(SectionGround, GradientAndHessianMatchCentralDifferencesOnABend) {
  const SectionGround ground(bent_line(), bumpy_section(), 2);
  const core::RandomStream random(1, "test/section_ground");
  for (std::uint64_t k = 0; k < 300; ++k) {
    const Vector2d p =
        ground.line().place(ground.line().length_m() * random.uniform(k, 0), 70 * random.uniform(k, 1) - 40);
    Vector2d gradient;
    Vector3d hessian;
    ground.height_m(p.x(), p.y(), &gradient, &hessian);
    const auto height = [&](const Vector2d& q) { return Eigen::Matrix<double, 1, 1>(ground.height_m(q.x(), q.y())); };
    EXPECT_LT((numeric_jacobian<1, 2>(height, p, 1e-4).transpose() - gradient).norm(), 1e-7);
    const auto slope = [&](const Vector2d& q) {
      Vector2d g;
      ground.height_m(q.x(), q.y(), &g);
      return g;
    };
    Eigen::Matrix2d expected;
    expected << hessian[0], hessian[1], hessian[1], hessian[2];
    EXPECT_LT((numeric_jacobian<2, 2>(slope, p, 1e-4) - expected).norm(), 1e-6);
  }
}

TEST(ChordSteps, AreAsLongAsTheCurvatureAllowsAndEndWithoutASliver) {
  const double sagitta = 0.0005;
  const auto curvature = [](double u) { return u < 10 ? 0.0 : 0.01; };
  const std::vector<double> u = chord_steps(0, 30.05, curvature, sagitta, 4);
  EXPECT_EQ(u.front(), 0);
  EXPECT_EQ(u.back(), 30.05);
  const double allowed = std::sqrt(8 * sagitta / 0.01);
  for (std::size_t k = 1; k < u.size(); ++k) {
    const double step = u[k] - u[k - 1];
    EXPECT_LE(step, (u[k] > 10 ? allowed : 4.0) + 1e-9);
    EXPECT_GT(step, 0.45 * allowed);
  }
  EXPECT_LT(u.size(), 2 * 30 / allowed);
}

/// Largest upright distance between facets and ground, at points inside each facet.
double worst_facet_m(const Mesh& mesh, const Ground& ground) {
  double worst = 0;
  for (const auto& triangle : mesh.triangles) {
    Vector3d p[3];
    for (std::size_t k = 0; k < 3; ++k) p[k] = mesh.vertices[triangle[k]].cast<double>();
    for (const Vector3d& w : {Vector3d(1, 1, 1), Vector3d(1, 1, 0), Vector3d(0, 1, 1), Vector3d(1, 0, 1)}) {
      const Vector3d q = (w[0] * p[0] + w[1] * p[1] + w[2] * p[2]) / w.sum();
      worst = std::max(worst, std::abs(q.z() - ground.height_m(q.x(), q.y())));
    }
  }
  return worst;
}

double area_in_plan_m2(const Mesh& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3d p = mesh.vertices[a].cast<double>(), q = mesh.vertices[b].cast<double>(),
                   r = mesh.vertices[c].cast<double>();
    area += 0.5 * (q - p).cross(r - p).z();
  }
  return area;
}

bool faces_up(const Mesh& mesh) {
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3d p = mesh.vertices[a].cast<double>();
    if ((mesh.vertices[b].cast<double>() - p).cross(mesh.vertices[c].cast<double>() - p).z() <= 0) return false;
  }
  return true;
}

TEST(StripMesher, FacetsStayWithinHalfAMillimetreWithNoMoreCellsThanThatNeeds) {
  const SectionGround ground(bent_line(), bumpy_section(), 2);
  const auto mesh = [&](double sagitta_m) {
    MeshBuilder b("strip");
    const MeshTolerance tolerance{.sagitta_m = sagitta_m};
    StripMesher(ground, ground.line(), 0, ground.line().length_m(), -30, 12, tolerance).band(b, -30, 12);
    return std::move(b).build();
  };
  const Mesh fine = mesh(MeshTolerance{}.sagitta_m), coarse = mesh(0.01);
  EXPECT_LT(worst_facet_m(fine, ground), 0.0005);
  EXPECT_GT(worst_facet_m(fine, ground), 0.0001) << "cells are finer than needed";
  EXPECT_GT(worst_facet_m(coarse, ground), 0.0005) << "the tolerance decides";
  EXPECT_LT(coarse.triangles.size(), fine.triangles.size() / 4);
  EXPECT_TRUE(faces_up(fine));
  // A strip of width w along a bend of angle a covers (length - d_middle a) w.
  const double turned = 80 * std::numbers::pi / 180;
  EXPECT_NEAR(area_in_plan_m2(fine), 42 * (ground.line().length_m() + 9 * turned), 0.3);
}

TEST(StripMesher, NeighbouringBandsShareTheirEdge) {
  const SectionGround ground(bent_line(), bumpy_section(), 2);
  const StripMesher strips(ground, ground.line(), 0, ground.line().length_m(), -30, 12);
  const auto edge = [&](double from, double to, double at) {
    MeshBuilder b("band");
    strips.band(b, from, to);
    std::set<std::array<float, 3>> points;
    const Mesh mesh = std::move(b).build();
    for (const Eigen::Vector3f& p : mesh.vertices) {
      if (std::abs(ground.line().project(p.head<2>().cast<double>()).d_m - at) < 1e-3)
        points.insert({p.x(), p.y(), p.z()});
    }
    return points;
  };
  const auto right = edge(-30, -10, -10), left = edge(-10, 12, -10);
  EXPECT_EQ(right.size(), strips.stations_m().size());
  EXPECT_EQ(right, left);
}

TEST(StripMesher, WallsStandOnTheLineAndFaceTheSideAskedFor) {
  const SectionGround ground(CentreLine::straight(0, 0, 0, 50), {}, 1);
  const StripMesher strips(ground, ground.line(), 0, 50, -5, 5);
  for (const bool left : {true, false}) {
    MeshBuilder b("wall");
    strips.wall(b, 3, -0.1, 2, left);
    const Mesh mesh = std::move(b).build();
    for (const auto& [p, q, r] : mesh.triangles) {
      const Eigen::Vector3f n = (mesh.vertices[q] - mesh.vertices[p]).cross(mesh.vertices[r] - mesh.vertices[p]);
      EXPECT_GT((left ? 1 : -1) * n.y(), 0);
    }
    for (const Eigen::Vector3f& p : mesh.vertices) EXPECT_NEAR(p.y(), 3, 1e-6);
  }
  MeshBuilder b("ceiling");
  strips.ceiling(b, -5, 5, 4);
  EXPECT_NEAR(area_in_plan_m2(std::move(b).build()), -500, 1e-3);
}

TEST(GroundRegion, KeepsExactlyWhatTheFilterKeepsAndFacesUp) {
  const SectionGround ground(CentreLine::straight(0, 0, 20, 50), bumpy_section(), 2);
  MeshBuilder b("region");
  const auto outside = [](const Vector2d& low, const Vector2d& high) {
    const Vector2d p = 0.5 * (low + high);
    return !(p.x() > 3 && p.x() < 13.7 && p.y() > -2.5 && p.y() < 8.1);
  };
  add_ground_region(b, ground, {-20, -15}, {40, 21}, {}, outside, 0, {3, 13.7}, {-2.5, 8.1});
  const Mesh mesh = std::move(b).build();
  EXPECT_NEAR(area_in_plan_m2(mesh), 60 * 36 - 10.7 * 10.6, 0.01);
  EXPECT_LT(worst_facet_m(mesh, ground), 0.0005);
  EXPECT_TRUE(faces_up(mesh));
}

TEST(Fillet, AndItsRestFillTheSquareOnEitherHand) {
  const SectionGround ground(CentreLine::straight(0, 0, 0, 50), bumpy_section(), 2);
  const double r = 25, step = 2;
  for (const Vector2d& side : {Vector2d(1, 1), Vector2d(-1, 1), Vector2d(1, -1), Vector2d(-1, -1)}) {
    MeshBuilder fillet("fillet"), rest("rest");
    add_fillet(fillet, ground, {3, -2}, {side.x(), 0}, {0, side.y()}, r);
    add_fillet_rest(rest, ground, {3, -2}, {side.x(), 0}, {0, side.y()}, r);
    const Mesh a = std::move(fillet).build(), b = std::move(rest).build();
    EXPECT_TRUE(faces_up(a));
    EXPECT_TRUE(faces_up(b));
    EXPECT_NEAR(area_in_plan_m2(a) + area_in_plan_m2(b), r * r, 1e-3);
    EXPECT_NEAR(area_in_plan_m2(a), r * r * (1 - std::numbers::pi / 4), r * std::numbers::pi / 2 * step * step / 8 / r);
    EXPECT_LT(worst_facet_m(a, ground), 0.0005);
    EXPECT_LT(worst_facet_m(b, ground), 0.0005);
  }
}

TEST(Swept, IsAClosedBarOfItsSectionsVolume) {
  const SectionGround ground(bent_line(), SectionSpec{}, 2);
  for (const auto& outline : {rectangle_outline(2, 0, 2.5, 0.3), rectangle_outline(-2.5, 0, -2, 0.3)}) {
    MeshBuilder b("bar");
    add_swept(b, ground, ground.line(), 0, ground.line().length_m(), outline, 0.5);
    const Mesh mesh = std::move(b).build();
    const auto parts = tests::parts_of(mesh);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_TRUE(tests::is_closed(mesh, parts[0]));
    const double d = 0.5 * (outline[0].x() + outline[2].x()), turned = 80 * std::numbers::pi / 180;
    EXPECT_NEAR(tests::volume_m3(mesh, parts[0]), 0.5 * 0.3 * (ground.line().length_m() - d * turned), 0.01);
  }
}

TEST(GroundPainter, PaintLiesAMillimetreOverTheGroundAndKeepsItsWidth) {
  const SectionGround ground(bent_line(), bumpy_section(), 2);
  GroundPainter p(ground);
  p.use(MaterialId::paint_white_marking).layer(1).line(ground.line().offset_line(20, 250, 4, 1), 0.3);
  const Mesh mesh = std::move(p).build();
  EXPECT_TRUE(faces_up(mesh));
  const double turned = 80 * std::numbers::pi / 180;
  EXPECT_NEAR(area_in_plan_m2(mesh), 0.3 * (230 - 4 * turned), 0.05);
  for (const Eigen::Vector3f& q : mesh.vertices) ASSERT_NEAR(q.z() - ground.height_m(q.x(), q.y()), 0.0016, 2e-5);
}

TEST(GroundPainter, TextReadsFromWhereItsReaderStands) {
  const SectionGround ground(CentreLine::straight(0, 0, 0, 1), SectionSpec{}, 1);
  GroundPainter p(ground);
  p.text("1", {10, 5}, 0, 8);  // read by who looks east: its two bars lie to the right, in the south
  double south = 1e9, north = -1e9, west = 1e9, east = -1e9;
  const Mesh mesh = std::move(p).build();
  for (const Eigen::Vector3f& q : mesh.vertices) {
    south = std::min<double>(south, q.y());
    north = std::max<double>(north, q.y());
    west = std::min<double>(west, q.x());
    east = std::max<double>(east, q.x());
  }
  EXPECT_TRUE(faces_up(mesh));
  EXPECT_NEAR(west, 10, 1e-5);
  EXPECT_NEAR(east, 18, 1e-5);
  EXPECT_NEAR(south, 5 - 0.55 * 8 / 2, 1e-5);
  EXPECT_LT(north, 5);
  EXPECT_THROW(GroundPainter(ground).text("?", {0, 0}, 0, 1), std::invalid_argument);
}

}  // namespace
}  // namespace tarmac::scenes
