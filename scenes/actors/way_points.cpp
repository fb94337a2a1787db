// Way points to a path: straights joined by turns.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/actors/course.h"

namespace tarmac::scenes {
namespace {

using Eigen::Vector2d;

constexpr double straight_enough_rad = 1e-4;
constexpr double same_place_m = 1e-3;

struct Corner {
  std::size_t point;  ///< index of the way point that it rounds
  Vector2d at;
  double turn_rad = 0;
  double tangent = 0;  ///< way from the turn's begin to the corner, for a radius of 1
  double arc = 0;      ///< length of the turn, for a radius of 1
  double radius_m = 0;
};

/// A turn of radius 1; shapes of turns scale with their radius.
PathPiece unit_turn(double turn_rad) {
  const double length = std::abs(turn_rad);
  return {.straight_m = 0,
          .turn_deg = turn_rad * 180 / std::numbers::pi,
          .radius_m = 1,
          .blend_m = std::min(0.5 * length, 0.8)};
}

PathPiece scaled(PathPiece piece, double radius_m) {
  piece.radius_m *= radius_m;
  piece.blend_m *= radius_m;
  return piece;
}

void shape(Corner& corner) {
  std::vector<PlanarPath::Problem> problems;
  const PathPiece piece = unit_turn(corner.turn_rad);
  PlanarPath turn({}, std::span(&piece, 1), {}, problems);
  turn.tabulate(turn.length_m());
  const PlanarPath::Point end = turn.at(turn.length_m());
  corner.arc = turn.length_m();
  corner.tangent = end.x_m - end.y_m / std::tan(corner.turn_rad);
}

double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2 * std::numbers::pi);
}

/// Way points without repeated places; the first and the last have no turn.
std::vector<Corner> corners_of(const core::ConfigNode& node, const std::vector<WayPoint>& points) {
  std::vector<Corner> corners;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2d p(points[i].x_m, points[i].y_m);
    if (corners.empty() || (p - corners.back().at).norm() > same_place_m) corners.push_back({.point = i, .at = p});
  }
  if (corners.size() < 2) node.fail_at("way_points", "at least two different places are needed");
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    const Vector2d in = corners[k].at - corners[k - 1].at, out = corners[k + 1].at - corners[k].at;
    corners[k].turn_rad = wrapped(std::atan2(out.y(), out.x()) - std::atan2(in.y(), in.x()));
    if (std::abs(corners[k].turn_rad) > 2.8)
      node.child("way_points")
          .items()[corners[k].point]
          .fail(fmt::format("the way turns by {:.0f} degrees here; at most 160 are possible: put a point beside it",
                            corners[k].turn_rad * 180 / std::numbers::pi));
    if (std::abs(corners[k].turn_rad) > straight_enough_rad) shape(corners[k]);
  }
  return corners;
}

/// Turns shrink where two of them do not fit between their corners.
void fit(const core::ConfigNode& node, std::vector<Corner>& corners, double radius_m) {
  for (Corner& corner : corners) corner.radius_m = radius_m;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    Corner &a = corners[k], &b = corners[k + 1];
    const double room = (b.at - a.at).norm(), need = radius_m * (a.tangent + b.tangent);
    if (need <= room) continue;
    const double fits = radius_m * room / need;
    if (fits < radius_m / 3)
      node.child("way_points")
          .items()[b.point]
          .fail(fmt::format("{:.2f} m from the point before leave no room for turns of {:.1f} m radius; {:.2f} m are "
                            "needed: move the "
                            "points apart or lower corner_radius_m",
                            room, radius_m, need));
    a.radius_m = std::min(a.radius_m, fits);
    b.radius_m = std::min(b.radius_m, fits);
  }
}

}  // namespace

RoundedPath round_corners(const core::ConfigNode& node, const std::vector<WayPoint>& points, double radius_m) {
  std::vector<Corner> corners = corners_of(node, points);
  fit(node, corners, radius_m);
  RoundedPath path;
  const Vector2d first = corners[1].at - corners[0].at;
  path.start = {.x_m = corners[0].at.x(),
                .y_m = corners[0].at.y(),
                .heading_deg = std::atan2(first.y(), first.x()) * 180 / std::numbers::pi};
  std::vector<double> corner_s_m{0};
  double s_m = 0, used_m = 0;  // used: what the turn before takes of this straight
  for (std::size_t k = 1; k < corners.size(); ++k) {
    const Corner& corner = corners[k];
    const double tangent_m = corner.radius_m * corner.tangent;
    const double straight_m = (corner.at - corners[k - 1].at).norm() - used_m - tangent_m;
    if (straight_m > 1e-9) {
      path.pieces.push_back({.straight_m = straight_m});
      s_m += straight_m;
    }
    const double arc_m = corner.radius_m * corner.arc;
    corner_s_m.push_back(s_m + arc_m / 2);
    if (arc_m > 0) path.pieces.push_back(scaled(unit_turn(corner.turn_rad), corner.radius_m));
    s_m += arc_m;
    used_m = tangent_m;
  }
  for (std::size_t i = 0, k = 0; i < points.size(); ++i) {
    if (k + 1 < corners.size() && corners[k + 1].point == i) ++k;
    path.s_m.push_back(corner_s_m[k]);
  }
  return path;
}

}  // namespace tarmac::scenes
