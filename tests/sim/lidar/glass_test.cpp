// Panes: dirt, glint, what stands behind, and mirror ghosts, against closed forms.
#include "sim/lidar/glass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/sim/lidar/beam_world.h"
#include "tests/support/constants.h"

namespace tarmac::sim::lidar {
namespace {

using Eigen::Vector3d;
using truth::ReturnKind;

using tests::rad;
const Mode kGlassMode{1024, 10};

/// Fresnel by the angles outside and inside: sines and tangents, where the code has cosines and the index.
struct Face {
  double s, p;
};
Face face_of(double angle_deg) {
  const double out = std::max(1e-4, angle_deg * rad), in = std::asin(std::sin(out) / 1.52);
  return {std::pow(std::sin(out - in) / std::sin(out + in), 2), std::pow(std::tan(out - in) / std::tan(out + in), 2)};
}

TEST(Pane, SharesAreFresnelsOfTwoFaces) {
  // Angle and reflectance of one face of n = 1.52, unpolarised, to three digits.
  const double table[][2] = {{0, .043},  {30, .044}, {45, .053}, {60, .092},
                             {70, .175}, {75, .257}, {80, .391}, {85, .615}};
  const auto pane_of = [](double face) { return 2 * face / (1 + face); };
  for (const auto& [angle_deg, reflected] : table) {
    const Face face = face_of(angle_deg);
    EXPECT_NEAR((face.s + face.p) / 2, reflected, 6e-4) << angle_deg;
    const PaneShares clear = clear_pane(std::cos(angle_deg * rad));
    EXPECT_NEAR(clear.reflected, (pane_of(face.s) + pane_of(face.p)) / 2, 1e-6) << angle_deg;
    EXPECT_NEAR(clear.reflected + clear.transmitted, 1, 1e-12);
    // The clear pane's material has the face's reflectance and the pane's transmission.
    const scenes::Material clear_glass = pane(std::pow(0.52 / 2.52, 2), clear_pane(1).transmitted);
    const PaneShares material = pane_shares(clear_glass, std::cos(angle_deg * rad));
    EXPECT_NEAR(material.reflected, clear.reflected, 1e-12);
    EXPECT_NEAR(material.transmitted, clear.transmitted, 1e-12);
  }
}

TEST(Pane, CoatedGlassKeepsItsOwnSharesSquareOnAndMirrorsAllAtGrazing) {
  const scenes::Material coated = pane(0.2, 0.3);
  EXPECT_NEAR(pane_shares(coated, 1).reflected, 0.4 / 1.2, 1e-12);
  EXPECT_NEAR(pane_shares(coated, 1).transmitted, 0.3, 1e-12);
  for (double c = 1; c > 0.02; c -= 0.02) {
    const PaneShares s = pane_shares(coated, c);
    EXPECT_LE(s.reflected + s.transmitted, 1);
    EXPECT_GT(s.reflected, 0);
  }
  EXPECT_GT(pane_shares(coated, 1e-4).reflected, 0.99);
}

BeamOptions glazed(const std::string& returns, bool ghosts) {
  BeamOptions beam;
  beam.glass = true;
  beam.ghosts = ghosts;
  beam.returns = returns;
  return beam;
}

/// A pane at x = 10 m, a white wall behind it at 14 m, one behind the sensor at x = -5 m.
scenes::Scene room(bool behind, bool mirrored) {
  scenes::Scene scene = tests::empty_scene();
  scene.materials = {tests::grey(1.0), pane()};
  add_wall(scene, 10, -6, 6, 3, 1, scenes::Label::glass);
  if (behind) add_wall(scene, 14, -40, 40, 20, 0);
  if (mirrored) add_wall(scene, -5, -40, 40, 20, 0);
  return scene;
}

/// Through the pane, and not so square on that it shines.
bool slanted(const Vector3d& d) {
  const double cosine = d.x();
  return cosine > 0.8 && cosine < std::cos(8 * rad) && std::abs(10 * d.y() / d.x()) < 5.5 &&
         std::abs(10 * d.z() / d.x()) < 2.7;
}

TEST(Glass, WhatStandsBehindComesThroughTwice) {
  const SimulatedSweep s =
      simulator_of(kSensor, kGlassMode, room(true, false), asking(glazed("last", true)), no_noise()).sweep(0);
  const scenes::Material coated = pane();
  std::size_t seen = 0;
  for (std::size_t i = 0; i < s.sweep.size(); ++i) {
    const Vector3d p = s.sweep.point(i);
    if (!slanted(p.normalized())) continue;
    ++seen;
    EXPECT_EQ(s.kind[i], ReturnKind::transmitted);
    EXPECT_EQ(s.instance[i], 1u);
    EXPECT_NEAR(p.x(), 14, 1e-4);
    const double cosine = static_cast<double>(s.cos_incidence[i]), T = pane_shares(coated, cosine).transmitted;
    EXPECT_NEAR(s.sweep.intensity[i], 100 * cosine * T * T, 0.51);
  }
  EXPECT_GT(seen, 1000u);
}

TEST(Glass, MirrorGhostStandsBehindThePaneWhereTheImageIs) {
  const SimulatedSweep s =
      simulator_of(kSensor, kGlassMode, room(false, true), asking(glazed("last", true)), no_noise()).sweep(0);
  const scenes::Material coated = pane();
  std::size_t seen = 0;
  for (std::size_t i = 0; i < s.sweep.size(); ++i) {
    const Vector3d p = s.sweep.point(i);
    if (!slanted(p.normalized())) continue;
    ++seen;
    EXPECT_EQ(s.kind[i], ReturnKind::ghost);
    EXPECT_EQ(s.instance[i], 1u);
    EXPECT_NEAR(p.x(), 25, 1e-3);  // the wall at -5, mirrored at 10
    const double cosine = static_cast<double>(s.cos_incidence[i]), R = pane_shares(coated, cosine).reflected;
    EXPECT_NEAR(s.sweep.intensity[i], 100 * cosine * R * R, 0.51);
  }
  EXPECT_GT(seen, 1000u);
}

TEST(Glass, DirtTransmittedAndGhostAreEchoesOfOneBeam) {
  BeamOptions first = glazed("first", true);
  const SimulatedSweep near = simulator_of(kSensor, kGlassMode, room(true, true), asking(first), no_noise()).sweep(0);
  const SimulatedSweep far =
      simulator_of(kSensor, kGlassMode, room(true, true), asking(glazed("last", true)), no_noise()).sweep(0);
  const SimulatedSweep strongest =
      simulator_of(kSensor, kGlassMode, room(true, true), asking(glazed("strongest", true)), no_noise()).sweep(0);
  // The beam's direction: a point's depends on its range where the origin of the beams is not the sensor's.
  const auto kinds = [](const SimulatedSweep& s) {
    std::map<std::pair<std::uint16_t, std::int32_t>, ReturnKind> kind_of_beam;
    for (std::size_t i = 0; i < s.sweep.size(); ++i) kind_of_beam[{s.sweep.ring[i], s.sweep.t_ns[i]}] = s.kind[i];
    EXPECT_EQ(kind_of_beam.size(), s.sweep.size()) << "one echo a beam";
    return kind_of_beam;
  };
  const auto first_kinds = kinds(near), last_kinds = kinds(far), strongest_kinds = kinds(strongest);
  std::size_t beams = 0;
  for (std::size_t i = 0; i < near.sweep.size(); ++i) {
    if (!slanted(near.sweep.point(i).normalized())) continue;
    ++beams;
    const std::pair beam{near.sweep.ring[i], near.sweep.t_ns[i]};
    EXPECT_EQ(first_kinds.at(beam), ReturnKind::dirt);
    EXPECT_EQ(last_kinds.at(beam), ReturnKind::ghost);
    // T^2 = 0.09 of a wall at 14 m against R^2 = 0.11 of one at 25 m, which is farther.
    EXPECT_EQ(strongest_kinds.at(beam), ReturnKind::transmitted);
  }
  EXPECT_GT(beams, 1000u);
}

TEST(Glass, WithoutGhostsAndWithoutGlassOptionNothingIsMirrored) {
  const auto count_kind = [](const BeamOptions& beam, ReturnKind kind) {
    const SimulatedSweep s = simulator_of(kSensor, kGlassMode, room(true, true), asking(beam), no_noise()).sweep(0);
    return std::count(s.kind.begin(), s.kind.end(), kind);
  };
  EXPECT_EQ(count_kind(glazed("last", false), ReturnKind::ghost), 0);
  EXPECT_GT(count_kind(glazed("last", false), ReturnKind::transmitted), 1000);
  BeamOptions off;
  off.returns = "last";
  EXPECT_EQ(count_kind(off, ReturnKind::transmitted), 0);
  EXPECT_EQ(count_kind(off, ReturnKind::ghost), 0);
}

TEST(Glass, ShinesWhereItIsSeenSquareOn) {
  const SimulatedSweep s =
      simulator_of(kSensor, kGlassMode, room(true, false), asking(glazed("strongest", true)), no_noise()).sweep(0);
  std::size_t glints = 0;
  for (std::size_t i = 0; i < s.sweep.size(); ++i) {
    if (s.kind[i] != ReturnKind::glint) continue;
    ++glints;
    // There the lobe, F0 alpha^2 / (4 theta^4), falls below the dirt's 0.5 %; alpha = 3.8 mrad with bow and beam width.
    EXPECT_LT(std::acos(s.sweep.point(i).normalized().x()), 7 * rad);
    EXPECT_NEAR(s.sweep.point(i).x(), 10, 1e-4);
  }
  EXPECT_GT(glints, 0u);
}

TEST(Glass, SecondPaneWeakensAgain) {
  scenes::Scene scene = tests::empty_scene();
  scene.materials = {tests::grey(1.0), pane(0.043, 0.918)};
  add_wall(scene, 10, -6, 6, 3, 1, scenes::Label::glass);
  add_wall(scene, 10.02, -6, 6, 3, 1, scenes::Label::glass);
  add_wall(scene, 14, -40, 40, 20, 0);
  const SimulatedSweep s = simulator_of(kSensor, kGlassMode, scene, asking(glazed("last", false)), no_noise()).sweep(0);
  const scenes::Material clear = pane(0.043, 0.918);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < s.sweep.size(); ++i) {
    if (!slanted(s.sweep.point(i).normalized())) continue;
    ++seen;
    const double cosine = static_cast<double>(s.cos_incidence[i]), T = pane_shares(clear, cosine).transmitted;
    EXPECT_NEAR(s.sweep.intensity[i], 100 * cosine * std::pow(T, 4), 0.51);
    EXPECT_NEAR(s.sweep.point(i).x(), 14, 1e-4);
  }
  EXPECT_GT(seen, 1000u);
}

}  // namespace
}  // namespace tarmac::sim::lidar
