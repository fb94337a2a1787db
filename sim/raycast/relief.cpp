#include "sim/raycast/relief.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tarmac::sim::raycast {
namespace {

constexpr double tolerance_m = 20e-6;   // of height
constexpr double grazing_cosine = 0.01;
constexpr int max_iterations = 24;

// Where f is known to be positive (above the relief) and not positive (in it); rays run from above to below.
struct Bracket {
  double above = -std::numeric_limits<double>::infinity();
  double below = std::numeric_limits<double>::infinity();
  void narrow(double t, double f) { (f > 0 ? above : below) = t; }
  bool closed() const { return std::isfinite(above) && std::isfinite(below) && above < below; }
  bool holds(double t) const { return t > std::min(above, below) && t < std::max(above, below); }
};

double shaded_cosine(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal, const Eigen::Vector2d& gradient) {
  const Eigen::Vector3d n = (normal - Eigen::Vector3d(gradient.x(), gradient.y(), 0)).normalized();
  // A facet that faces away is hidden by its crest in truth; the visible ones are seen no flatter than this.
  return std::clamp(-n.dot(direction), 0.25 * -normal.dot(direction), 1.0);
}

}  // namespace

ReliefHit meet_relief(const scenes::Relief& relief, const Eigen::Vector3d& p_macro_world,
                      const Eigen::Vector3d& direction, const Eigen::Vector3d& normal, double t_macro_m) {
  const double nd = normal.dot(direction);
  ReliefHit hit{t_macro_m, -nd};
  if (nd > -grazing_cosine) return hit;
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Bracket bracket;
  double s = 0;  // t - t_macro
  for (int i = 0; i < max_iterations; ++i) {
    const double h = relief.height_m(p_macro_world.x() + s * direction.x(), p_macro_world.y() + s * direction.y(), &gradient);
    const double f = s * nd - h;
    if (std::abs(f) < tolerance_m) break;
    bracket.narrow(s, f);
    const double slope = nd - gradient.x() * direction.x() - gradient.y() * direction.y();
    // The height field's own slope may turn the ray's approach round; the macro slope never does.
    double next = s - f / (slope < 0.25 * nd ? slope : nd);
    if (bracket.closed() && !bracket.holds(next)) next = 0.5 * (bracket.above + bracket.below);
    s = next;
  }
  hit.t_m = t_macro_m + s;
  hit.cos_incidence = shaded_cosine(direction, normal, gradient);
  return hit;
}

}  // namespace tarmac::sim::raycast
