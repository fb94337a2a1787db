#include "sim/lidar/prism.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/error.h"

namespace tarmac::sim::lidar {
namespace {

using Eigen::Vector3d;

/// The direction behind a face whose normal points against the light; NaN where the light is reflected.
Vector3d refracted(const Vector3d& d, const Vector3d& normal, double ratio) {
  const double c = -normal.dot(d);
  return ratio * d + (ratio * c - std::sqrt(1 - ratio * ratio * (1 - c * c))) * normal;
}

}  // namespace

Prism::Prism(const Profile& p) : index_(p.prism_refractive_index), wedges_() {
  for (std::size_t i = 0; i < 2; ++i) {
    const double slant = p.prism_wedge_deg[i] * std::numbers::pi / 180;
    wedges_[i] = {p.prism_hz[i], p.prism_start_deg[i] / 360, std::cos(slant), std::sin(slant)};
  }
  // Only the angle between the wedges matters; extremes lie where they lean the same way or against each other.
  for (const double apart : {0.0, 0.125, 0.25, 0.375, 0.5})
    if (!(behind({0, apart}).x() > 0))
      throw core::InputError(
          fmt::format("wedges of {} and {} degrees with a refractive index of {} let no light out forwards where they "
                      "stand {} degrees apart; make them thinner",
                      p.prism_wedge_deg[0], p.prism_wedge_deg[1], index_, 360 * apart));
}

Vector3d Prism::direction(double t_ns) const {
  std::array<double, 2> turns;
  for (std::size_t i = 0; i < 2; ++i) turns[i] = wedges_[i].start_turns + wedges_[i].hz * (1e-9 * t_ns);
  return behind(turns);
}

Vector3d Prism::behind(const std::array<double, 2>& turns) const {
  const Vector3d square(-1, 0, 0);
  Vector3d d(1, 0, 0);
  for (std::size_t i = 0; i < 2; ++i) {
    const double angle = 2 * std::numbers::pi * (turns[i] - std::floor(turns[i]));
    const Vector3d slanted(-wedges_[i].cos_slant, -wedges_[i].sin_slant * std::cos(angle),
                           -wedges_[i].sin_slant * std::sin(angle));
    d = refracted(refracted(d, slanted, 1 / index_), square, index_);
  }
  return d.normalized();
}

}  // namespace tarmac::sim::lidar
