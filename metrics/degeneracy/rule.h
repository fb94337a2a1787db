/// When a sweep is called degenerate: absolute thresholds on scaled eigenvalues, tied to the noise of normals.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "metrics/degeneracy/information.h"

namespace tarmac::metrics {

enum class DegeneracyClass : std::uint8_t { ok = 0, weak = 1, degenerate = 2, unknown = 3 };
const char* name_of(DegeneracyClass c);

/// Thresholds on the smallest scaled eigenvalue. Normals with noise s [rad] an axis give a direction that nothing holds
/// an eigenvalue of s^2 (s^2/12 in the difference's Schur complement), so thresholds keep a factor of 4 above that.
struct DegeneracyRule {
  double degenerate_below = 0;
  double weak_below = 0;
  double hysteresis = 2;  ///< a worse class is left only above this many times its threshold

  /// For the 6-DOF block and the mean's Schur complement: max(1e-3, 4 s^2), weak below 1e-2.
  static DegeneracyRule pose(double normal_noise_rad = 0);
  /// For the difference's Schur complement: max(5e-5, s^2/3), weak below 5e-4.
  static DegeneracyRule difference(double normal_noise_rad = 0);
};

/// One sweep after the other; an unknown sweep forgets what was before.
class Classifier {
 public:
  explicit Classifier(const DegeneracyRule& rule) : rule_(rule) {}
  DegeneracyClass operator()(const std::optional<double>& lambda_min);

 private:
  DegeneracyRule rule_;
  DegeneracyClass last_ = DegeneracyClass::unknown;
};

/// Directions of xi in the body's axes, in its order: x forward, y left, z up.
inline constexpr std::array<const char*, 6> kDirectionNames{"along-track", "cross-track", "height",
                                                            "roll",        "pitch",       "yaw"};

/// How much of each direction lies in the weak subspace: the diagonal of the projector onto the eigenvectors whose
/// eigenvalue is below `limit`, or, when none is, at most twice the smallest. 1 = wholly. A subspace, since single
/// eigenvectors of a repeated eigenvalue are arbitrary.
core::Vector6 weak_shares(const Spectrum& spectrum, double limit);

/// "along-track", or several joined by " + ": every direction of which at least half lies in the subspace; the largest
/// when there is none.
std::string weak_directions(const core::Vector6& shares);

}  // namespace tarmac::metrics
