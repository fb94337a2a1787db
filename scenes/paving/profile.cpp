#include "scenes/paving/profile.h"

#include <cmath>
#include <stdexcept>

namespace tarmac::scenes {

RoundedProfile::RoundedProfile(const std::vector<Point>& points) {
  if (points.size() < 2) throw std::invalid_argument("RoundedProfile: needs at least two points");
  const auto grade = [&](std::size_t k) {
    const double length_m = points[k + 1].u_m - points[k].u_m;
    if (!(length_m > 0)) throw std::invalid_argument("RoundedProfile: points must have increasing u");
    return (points[k + 1].z_m - points[k].z_m) / length_m;
  };
  u0_m_ = points[0].u_m;
  z0_m_ = points[0].z_m;
  grade0_ = grade(0);
  for (std::size_t k = 1; k + 1 < points.size(); ++k) {
    if (!(points[k].rounding_m > 0)) throw std::invalid_argument("RoundedProfile: a rounding must be above 0");
    breaks_.push_back({points[k].u_m, grade(k) - grade(k - 1), points[k].rounding_m});
  }
}

RoundedProfile::Value RoundedProfile::at(double u_m) const {
  Value value{z0_m_ + grade0_ * (u_m - u0_m_), grade0_, 0};
  for (const Break& b : breaks_) {
    const double q = (u_m - b.u_m) / b.rounding_m;
    // exp of a negative argument only: nothing overflows, and far away nothing is left of the rounding.
    const double e = std::exp(-std::abs(q)), below = 1 / (1 + e), above = e / (1 + e);
    value.z_m += b.grade_change * b.rounding_m * (std::max(q, 0.0) + std::log1p(e));
    value.grade += b.grade_change * (q > 0 ? below : above);
    value.curvature_per_m += b.grade_change / b.rounding_m * below * above;
  }
  return value;
}

}  // namespace tarmac::scenes
