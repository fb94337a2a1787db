/// A motion that follows recorded poses.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/trajectory.h"
#include "sim/truth/path_file.h"

namespace tarmac::sim::truth {

struct RecordedOptions {
  std::string file;                ///< empty when `poses` holds the path
  std::vector<std::string> poses;  ///< lines of a TUM file
  core::SE3 T_world_path = core::SE3::Identity();
  double rest_s = 0, ease_s = 0;
  double max_gap_s = 3, max_speed_m_s = 40, max_acceleration_m_s2 = 60, max_rate_deg_s = 720;
  void visit(core::OptionVisitor& v);
};

/// With the file's content in `poses`: what is resolved does not need the file any more.
RecordedOptions read_recorded_options(const core::ConfigNode& node);

/// Throws InputError with the path's file and line for gaps, jumps, and a path that is too short.
std::shared_ptr<const core::SmoothTrajectory> make_recorded(const core::ConfigNode& node, core::Duration duration);

/// Poses of any time between the first and the last.
///
/// Between times k and k + 1 stands the polynomial Q_k of degree 7 through the eight nearest poses, four on each side
/// where there are as many (order 8). Around every recorded time the two polynomials that meet there, both of which
/// have the recorded pose, are blended by smooth_step over a window that covers 30 to 48 % of the intervals on either
/// side, by a golden-section sequence: the result is infinitely differentiable, is a polynomial nowhere near the
/// recorded times, and the windows' ends, where pieces join, lie on no regular grid and at no sweep's boundary.
/// Quaternions are interpolated as 4-vectors of matching signs and projected on the unit sphere by their length:
/// smooth, and the same whatever frame the poses are given in. Derivatives are exact.
class PathInterpolation {
 public:
  /// At least 8 poses with increasing times.
  explicit PathInterpolation(const std::vector<RecordedPose>& poses);
  /// `t_s` from the first pose.
  core::Kinematics at(double t_s) const;

  static constexpr int points = 8;

 private:
  struct Piece {
    double begin_s, length_s;
    double centre_s, scale_s;                               ///< of the polynomial's argument
    std::array<std::array<double, points>, 7> coefficient;  ///< x, y, z, qx, qy, qz, qw
    double blend_until_s, blend_from_s;  ///< of the windows at its begin and end; what lies between is Q_k alone
  };
  std::vector<Piece> pieces_;
};

}  // namespace tarmac::sim::truth
