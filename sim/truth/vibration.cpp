#include "sim/truth/vibration.h"

#include <cmath>
#include <numbers>

#include "core/random.h"

namespace tarmac::sim::truth {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;
constexpr double sideways = 0.6;  ///< forward and left shake against the vertical one

/// Orders of the firing frequency, and their accelerations against the first: -6 dB an octave above it.
constexpr double engine_order[] = {0.25, 1, 2, 3};
constexpr double engine_share[] = {0.25, 1, 0.5, 1.0 / 3};

constexpr int rolling_lines = 8;
constexpr double rolling_min_cycles_per_m = 1.5, rolling_max_cycles_per_m = 12, rolling_speed_m_s = 5;

/// Amplitudes that give one line the rms of acceleration and angular rate at angular frequency w.
std::array<double, 6> amplitudes(double rms_m_s2, double rms_rad_s, double w) {
  const double shift = std::numbers::sqrt2 * rms_m_s2 / (w * w), turn = std::numbers::sqrt2 * rms_rad_s / w;
  return {sideways * shift, sideways * shift, shift, turn, turn, turn};
}

}  // namespace

Vibration::Vibration(const VibrationOptions& options, std::uint64_t seed) {
  const auto add = [&](double per_s, double per_m, const std::array<double, 6>& amplitude,
                       const core::RandomStream& random, int k) {
    Line line{per_s, per_m, {}, {}};
    for (int axis = 0; axis < 6; ++axis) {
      const double phase = two_pi * random.uniform(k, static_cast<std::uint32_t>(axis) + 1);
      line.sine[axis] = amplitude[axis] * std::cos(phase);
      line.cosine[axis] = amplitude[axis] * std::sin(phase);
    }
    lines_.push_back(line);
  };
  const core::RandomStream engine(seed, "motion/engine"), rolling(seed, "motion/rolling");
  double power = 0;
  for (const double share : engine_share) power += share * share;
  for (int k = 0; k < 4; ++k) {
    const double order = engine_order[k], share = engine_share[k] / std::sqrt(power);
    const double idle_hz = order * options.idle_hz;
    add(idle_hz, order * options.engine_hz_per_m_s,
        amplitudes(share * options.engine_rms_m_s2, share * radians(options.engine_rms_deg_s), two_pi * idle_hz),
        engine, k);
  }
  const double share = 1 / std::sqrt(static_cast<double>(rolling_lines));
  for (int k = 0; k < rolling_lines; ++k) {
    const double place = (k + rolling.uniform(k, 0)) / rolling_lines;
    const double per_m =
        rolling_min_cycles_per_m * std::pow(rolling_max_cycles_per_m / rolling_min_cycles_per_m, place);
    add(0, per_m,
        amplitudes(share * options.rolling_rms_m_s2, share * radians(options.rolling_rms_deg_s),
                   two_pi * per_m * rolling_speed_m_s),
        rolling, k);
  }
}

Vibration::Shake Vibration::at(double t_s, const Jet& s) const {
  std::array<Jet, 6> sum{};
  for (const Line& line : lines_) {
    const Jet angle = two_pi * (line.cycles_per_m * s + line.cycles_per_s * Jet{t_s, 1, 0, 0});
    const SinCos wave = sin_cos(angle);
    for (int axis = 0; axis < 6; ++axis)
      sum[axis] = sum[axis] + line.sine[axis] * wave.sin + line.cosine[axis] * wave.cos;
  }
  return {{sum[0], sum[1], sum[2]}, {sum[3], sum[4], sum[5]}};
}

}  // namespace tarmac::sim::truth
