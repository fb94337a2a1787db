#include "sim/raycast/relief.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tarmac::sim::raycast {
namespace {

constexpr double tolerance_m = 50e-6;  // of height
constexpr double grazing_cosine = 0.01;
constexpr int max_iterations = 40;

// Heights seen so far bound how far a ray can be from its macro hit: farther out it is above or in the relief for sure.
class Bracket {
 public:
  explicit Bracket(double nd) : nd_(nd) {}
  void add(double s, double f, double h) {
    highest_m_ = std::max(highest_m_, std::abs(h));
    if (f <= 0) {
      below_ = std::min(below_, s);
      if (above_ >= below_) above_ = -infinity;
    } else if (s < below_) {
      above_ = std::max(above_, s);
    }  // else: above the relief behind a crest that the ray has gone through; what counts is before it
  }
  /// `wanted` where it lies between the known sides, else a point that brings them together.
  double next(double wanted) {
    if (std::isfinite(above_) && std::isfinite(below_))
      return wanted > above_ && wanted < below_ ? wanted : 0.5 * (above_ + below_);
    if (wanted < below_) return wanted;
    retreat_ *= 2;
    return below_ + retreat_ * highest_m_ / nd_;  // nd < 0: backwards
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  double nd_;
  double above_ = -infinity, below_ = infinity;  // rays run from above the relief to below it
  double highest_m_ = 0;
  double retreat_ = 0.5;
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
  Bracket bracket(nd);
  double s = 0;  // t - t_macro
  for (int i = 0; i < max_iterations; ++i) {
    const double h =
        relief.height_m(p_macro_world.x() + s * direction.x(), p_macro_world.y() + s * direction.y(), &gradient);
    const double f = s * nd - h;
    if (std::abs(f) < tolerance_m) break;
    bracket.add(s, f, h);
    const double slope = nd - gradient.x() * direction.x() - gradient.y() * direction.y();
    // The height field's own slope may turn the ray's approach round; the macro slope never does.
    s = bracket.next(s - f / (slope < 0.25 * nd ? slope : nd));
  }
  hit.t_m = t_macro_m + s;
  hit.cos_incidence = shaded_cosine(direction, normal, gradient);
  return hit;
}

}  // namespace tarmac::sim::raycast
