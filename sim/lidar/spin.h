/// How evenly a head turns.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/options.h"
#include "core/random.h"

namespace tarmac::sim::lidar {

/// Off by default: the head then turns evenly and its encoder is exact. Real heads show 0.001 to 0.003 for
/// rate_jitter and 0.01 degrees for encoder_step_deg.
struct SpinOptions {
  double rate_jitter = 0;
  double correlation_s = 0.5;
  double encoder_step_deg = 0;
  void visit(core::OptionVisitor& v);
};

/// A stationary error of the spin rate, share e(t) of it: standard deviation rate_jitter, correlation
/// exp(-|dt| / correlation_s). It is a sum of `waves` cosines with drawn phases whose frequencies divide the spectrum
/// of that correlation, 1 / (1 + (2 pi f tau)^2), into equal parts (one frequency drawn in each), hence a closed form
/// that can be asked at any instant, in any order:
///   e(t) = A sum cos(w_i t + phi_i),  A = rate_jitter sqrt(2 / waves)
/// Its integral from 0 is what displaces the head. |e| stays below rate_jitter sqrt(2 waves) < 1.
class SpinJitter {
 public:
  static constexpr int waves = 32;
  SpinJitter(const SpinOptions& options, std::uint64_t seed, const std::string& stream_name);

  bool on() const { return on_; }
  bool encoder_errs() const { return encoder_step_rad_ != 0; }
  /// Integral of e from 0 to t [s]: by how much time a head that turns by t + lead_s(t) is ahead of an even one.
  double lead_s(double t_s) const;
  double rate_error(double t_s) const;  ///< e(t)
  double largest_rate_error() const { return amplitude_ * waves; }
  /// Error of the encoder at firing cycle n, uniform over one step [rad]; 0 where there is none.
  double encoder_error_rad(std::int64_t cycle) const;

 private:
  struct Wave {
    double w_rad_s, phase_rad, sine_of_phase;
  };
  bool on_;
  double amplitude_, encoder_step_rad_;
  std::vector<Wave> waves_;
  core::RandomStream encoder_;
};

}  // namespace tarmac::sim::lidar
