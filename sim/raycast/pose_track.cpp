#include "sim/raycast/pose_track.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tarmac::sim::raycast {

using Eigen::Vector3d;

PoseTrack::PoseTrack(const std::vector<core::SE3>& knots, double span_ns) {
  for (const core::SE3& T : knots) {
    Eigen::Vector4d q = Eigen::Quaterniond(T.linear()).coeffs();
    if (!knots_.empty() && q.dot(knots_.back().q) < 0) q = -q;  // the short way round
    knots_.push_back({T.translation(), q});
  }
  if (knots.size() > 1) knots_per_ns_ = static_cast<double>(knots.size() - 1) / span_ns;
}

Frame PoseTrack::at(double t_ns) const {
  if (still()) return {Eigen::Quaterniond(knots_.front().q).toRotationMatrix(), knots_.front().p};
  const auto last = static_cast<std::ptrdiff_t>(knots_.size()) - 1;
  const double place = t_ns * knots_per_ns_;
  // Four knots about the place; fewer where there are fewer.
  const std::ptrdiff_t count = std::min<std::ptrdiff_t>(4, last + 1);
  const auto first =
      std::clamp(static_cast<std::ptrdiff_t>(std::floor(place)) - 1, std::ptrdiff_t{0}, last + 1 - count);
  Vector3d p = Vector3d::Zero();
  Eigen::Vector4d q = Eigen::Vector4d::Zero();
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    double weight = 1;
    for (std::ptrdiff_t j = 0; j < count; ++j)
      if (j != i) weight *= (place - static_cast<double>(first + j)) / static_cast<double>(i - j);
    const Knot& knot = knots_[static_cast<std::size_t>(first + i)];
    p += weight * knot.p;
    q += weight * knot.q;
  }
  return {Eigen::Quaterniond(q.normalized()).toRotationMatrix(), p};
}

}  // namespace tarmac::sim::raycast
