/// Poses of what moves, at any time of a sweep.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/lie.h"

namespace tarmac::sim::raycast {

struct Frame {
  Eigen::Matrix3d R;
  Eigen::Vector3d p;
};

inline Frame frame_of(const core::SE3& T) {
  return {T.linear(), T.translation()};
}

/// Poses over a sweep from knots at equidistant times: cubics through the four nearest knots, of the position and of
/// the quaternion. Where straight lines between the knots are within 0.2 mm (motion_steps), cubics are within
/// micrometres.
class PoseTrack {
 public:
  /// One knot: it stands still. Otherwise at least four, the first at 0 and the last at `span_ns`.
  PoseTrack(const std::vector<core::SE3>& knots, double span_ns);
  Frame at(double t_ns) const;
  bool still() const { return knots_.size() == 1; }

 private:
  struct Knot {
    Eigen::Vector3d p;
    Eigen::Vector4d q;
  };
  std::vector<Knot> knots_;
  double knots_per_ns_ = 0;
};

}  // namespace tarmac::sim::raycast
