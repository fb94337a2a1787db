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
  const double place = t_ns * knots_per_ns_;
  const auto most = static_cast<double>(knots_.size() - 4);
  const double first = std::clamp(std::floor(place) - 1, 0.0, most);
  const Knot* knots = &knots_[static_cast<std::size_t>(first)];
  // Lagrange's cubic through the knots at -1, 0, 1 and 2.
  const double u = place - first - 1, a = u + 1, b = u - 1, c = u - 2;
  const double w0 = -u * b * c / 6, w1 = a * b * c / 2, w2 = -a * u * c / 2, w3 = a * u * b / 6;
  const Vector3d p = w0 * knots[0].p + w1 * knots[1].p + w2 * knots[2].p + w3 * knots[3].p;
  const Eigen::Vector4d q = w0 * knots[0].q + w1 * knots[1].q + w2 * knots[2].q + w3 * knots[3].q;
  return {Eigen::Quaterniond(q.normalized()).toRotationMatrix(), p};
}

}  // namespace tarmac::sim::raycast
