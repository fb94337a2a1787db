#include "scenes/paths/planar_path.h"

#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "scenes/paths/quadrature.h"
#include "scenes/paths/smooth_step.h"

namespace tarmac::scenes {

namespace {
constexpr double node_spacing_m = 0.05;
}  // namespace

PlanarPath::PlanarPath(const StartOptions& start, std::span<const PathPiece> pieces, const Waves& wander,
                       std::vector<Problem>& problems)
    : heading_wander_(wander.derivative()), x0_m_(start.x_m), y0_m_(start.y_m) {
  segments_.push_back({0, radians(start.heading_deg), 0, 0, 1});
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const PathPiece& piece = pieces[i];
    if ((piece.straight_m != 0) == (piece.turn_deg != 0)) {
      problems.push_back({i, "give either straight_m or turn_deg, not both and not none"});
      continue;
    }
    if (piece.straight_m != 0) {
      if (piece.radius_m != PathPiece{}.radius_m || piece.blend_m != PathPiece{}.blend_m)
        problems.push_back({i, "radius_m and blend_m are of turns, and this is a straight: take them away"});
      append(piece.straight_m, 0);
      continue;
    }
    const double curvature = (piece.turn_deg > 0 ? 1 : -1) / piece.radius_m;
    const double arc_m = std::abs(radians(piece.turn_deg)) * piece.radius_m - piece.blend_m;
    if (arc_m < 0) {
      problems.push_back({i, fmt::format("blend_m: {} m do not fit into a turn of {} deg at {} m: at most {:.2f} m",
                                         piece.blend_m, piece.turn_deg, piece.radius_m, arc_m + piece.blend_m)});
      continue;
    }
    append(piece.blend_m, curvature);
    append(arc_m, 0);
    append(piece.blend_m, -curvature);
  }
}

void PlanarPath::append(double length_m, double curvature_change) {
  Segment& now = segments_.back();
  // The open end so far is a straight or an arc without change; give it this piece's blend.
  now.change = curvature_change;
  now.blend_m = length_m;
  length_m_ += length_m;
  const double heading = now.heading + (now.curvature + curvature_change / 2) * length_m;
  segments_.push_back({length_m_, heading, now.curvature + curvature_change, 0, 1});
  // A blend out of a turn ends with rounding noise where there should be a straight.
  if (std::abs(segments_.back().curvature) < 1e-12) segments_.back().curvature = 0;
}

const PlanarPath::Segment& PlanarPath::segment(double s_m) const {
  auto it = std::upper_bound(segments_.begin(), segments_.end(), s_m,
                             [](double s, const Segment& segment) { return s < segment.s_m; });
  return it == segments_.begin() ? *it : *std::prev(it);
}

double PlanarPath::heading_value(double s_m) const {
  const Segment& now = segment(s_m);
  const double ds = s_m - now.s_m;
  double heading = now.heading + now.curvature * ds;
  if (now.change != 0) heading += now.change * now.blend_m * smooth_step_integral(ds / now.blend_m);
  return heading + heading_wander_.value(s_m);
}

Jet PlanarPath::heading(double s_m) const {
  const Segment& now = segment(s_m);
  const double ds = s_m - now.s_m;
  Jet heading{now.heading + now.curvature * ds, now.curvature, 0, 0};
  if (now.change != 0) {
    const double l = now.blend_m, u = ds / l;
    const Jet h = smooth_step(u);
    heading = heading + now.change * Jet{l * smooth_step_integral(u), h.f, h.d1 / l, h.d2 / (l * l)};
  }
  return heading + heading_wander_.at(s_m);
}

Jet PlanarPath::curvature(double s_m) const {
  const Segment& now = segment(s_m);
  Jet curvature{now.curvature};
  if (now.change != 0) {
    const double l = now.blend_m;
    const Jet h = smooth_step((s_m - now.s_m) / l);
    curvature = curvature + now.change * Jet{h.f, h.d1 / l, h.d2 / (l * l), h.d3 / (l * l * l)};
  }
  return curvature + heading_wander_.derivative().at(s_m);
}

namespace {
/// Displacement between two distances, by quadrature of the unit tangent.
template <class Heading>
Eigen::Vector2d displacement(const Heading& heading, double from_m, double to_m) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int j = 0; j < 3; ++j) {
    const double psi = heading(from_m + Gauss3::node[j] * (to_m - from_m));
    sum += Gauss3::weight[j] * Eigen::Vector2d(std::cos(psi), std::sin(psi));
  }
  return (to_m - from_m) * sum;
}
}  // namespace

void PlanarPath::tabulate(double s_max_m) {
  const auto intervals = static_cast<std::size_t>(std::ceil(std::max(0.0, s_max_m) / node_spacing_m));
  nodes_.assign(1, {x0_m_, y0_m_});
  nodes_.reserve(intervals + 1);
  const auto psi = [this](double s) { return heading_value(s); };
  for (std::size_t k = 0; k < intervals; ++k) {
    const double from = static_cast<double>(k) * node_spacing_m, to = static_cast<double>(k + 1) * node_spacing_m;
    const Eigen::Vector2d step = displacement(psi, from, to);
    nodes_.push_back({nodes_.back().x_m + step.x(), nodes_.back().y_m + step.y()});
  }
}

PlanarPath::Point PlanarPath::at(double s_m) const {
  const auto wanted = static_cast<std::size_t>(std::max(0.0, s_m / node_spacing_m));
  const std::size_t k = std::min(wanted, nodes_.size() - 1);
  const double from = static_cast<double>(k) * node_spacing_m;
  const Eigen::Vector2d step = displacement([this](double s) { return heading_value(s); }, from, s_m);
  return {nodes_[k].x_m + step.x(), nodes_[k].y_m + step.y(), heading(s_m)};
}

}  // namespace tarmac::scenes
