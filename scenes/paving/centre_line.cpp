#include "scenes/paving/centre_line.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tarmac::scenes {

using Eigen::Vector2d;

namespace {

PlanarPath make_path(const StartOptions& start, const std::vector<PathPiece>& pieces) {
  std::vector<PlanarPath::Problem> problems;
  PlanarPath path(start, pieces, Waves(), problems);
  if (!problems.empty()) throw std::invalid_argument("CentreLine: " + problems.front().message);
  path.tabulate(path.length_m() + 1);
  return path;
}

CentreLine::Point point_of(const PlanarPath& path, double s_m) {
  const PlanarPath::Point at = path.at(s_m);
  const double c = std::cos(at.heading.f), s = std::sin(at.heading.f);
  return {{at.x_m, at.y_m}, {c, s}, {-s, c}, at.heading.f, at.heading.d1, at.heading.d2};
}

CentreLine::Point moved_straight(CentreLine::Point point, double by_m) {
  point.p_m += by_m * point.tangent;
  point.curvature_per_m = point.curvature_change_per_m2 = 0;
  return point;
}

}  // namespace

CentreLine::CentreLine(const StartOptions& start, const std::vector<PathPiece>& pieces)
    : path_(make_path(start, pieces)) {
  length_m_ = path_.length_m();
  is_straight_ = std::all_of(pieces.begin(), pieces.end(), [](const PathPiece& piece) { return piece.turn_deg == 0; });
  first_ = point_of(path_, 0);
  last_ = point_of(path_, length_m_);
  for (double s = 0; s < length_m_ + sample_m; s += sample_m) samples_.push_back(at(s).p_m);
}

CentreLine CentreLine::straight(double x_m, double y_m, double heading_deg, double length_m) {
  StartOptions start;
  start.x_m = x_m;
  start.y_m = y_m;
  start.heading_deg = heading_deg;
  PathPiece piece;
  piece.straight_m = length_m;
  return CentreLine(start, {piece});
}

CentreLine::Point CentreLine::at(double s_m) const {
  if (is_straight_ || s_m <= 0) return moved_straight(first_, s_m);
  if (s_m >= length_m_) return moved_straight(last_, s_m - length_m_);
  return point_of(path_, s_m);
}

Vector2d CentreLine::place(double s_m, double d_m) const {
  const Point point = at(s_m);
  return point.p_m + d_m * point.left;
}

std::vector<Vector2d> CentreLine::offset_line(double s0_m, double s1_m, double d_m, double step_m) const {
  const int n = std::max(1, static_cast<int>(std::ceil(std::abs(s1_m - s0_m) / step_m - 1e-9)));
  std::vector<Vector2d> line;
  for (int k = 0; k <= n; ++k) line.push_back(place(s0_m + (s1_m - s0_m) * k / n, d_m));
  return line;
}

CentreLine::Place CentreLine::project(const Vector2d& p_m) const {
  const double before = (p_m - first_.p_m).dot(first_.tangent);
  if (is_straight_) return {before, (p_m - first_.p_m).dot(first_.left), moved_straight(first_, before)};
  std::size_t nearest = 0;
  double least = (p_m - samples_[0]).squaredNorm();
  for (std::size_t k = 1; k < samples_.size(); ++k) {
    const double distance = (p_m - samples_[k]).squaredNorm();
    if (distance < least) least = distance, nearest = k;
  }
  // Newton on (p - c(s)) . t(s) = 0, whose derivative is -(1 - kappa d).
  double s = sample_m * static_cast<double>(nearest);
  Point foot = at(s);
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Vector2d from = p_m - foot.p_m;
    const double stretch = std::max(1 - foot.curvature_per_m * from.dot(foot.left), 0.2);
    const double step = std::clamp(from.dot(foot.tangent) / stretch, -2 * sample_m, 2 * sample_m);
    s += step;
    foot = at(s);
    if (std::abs(step) < 1e-11) break;
  }
  Place place{s, (p_m - foot.p_m).dot(foot.left), foot};
  // Beyond the ends the line goes on straight: far out, and beside another branch, the search begins at the wrong
  // place.
  double distance = (p_m - foot.p_m).norm();
  const auto go_on = [&](const Point& end, double end_s_m, double beyond_m, bool is_beyond) {
    const double d_m = (p_m - end.p_m).dot(end.left);
    if (!is_beyond || std::abs(d_m) > distance - 1e-9) return;
    distance = std::abs(d_m);
    place = {end_s_m + beyond_m, d_m, moved_straight(end, beyond_m)};
  };
  go_on(first_, 0, before, before < 0);
  const double behind = (p_m - last_.p_m).dot(last_.tangent);
  go_on(last_, length_m_, behind, behind > 0);
  return place;
}

}  // namespace tarmac::scenes
