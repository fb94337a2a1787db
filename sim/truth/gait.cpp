#include "sim/truth/gait.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "scenes/paths/smooth_step.h"

namespace tarmac::sim::truth {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;
enum Axis : int { forward, left, up, roll_axis, pitch_axis, yaw_axis };

/// Accelerations of the steps' harmonics against the first.
constexpr double harmonic_share[] = {1, 0.35, 0.15, 0.07};

constexpr double usual_speed = 1.4;  ///< against full_speed_m_s

/// smooth_step of an argument that depends on time.
Jet step_of(const Jet& u) {
  return chain(scenes::smooth_step(u.f), u);
}

}  // namespace

StepPhase::StepPhase(const GaitOptions& gait, std::uint64_t seed)
    : step_length_m_(gait.step_length_m),
      // Waves of many steps change a step's duration by what their slope is; one of three steps by a little less.
      drift_m_(Waves(gait.rate_jitter, 3 * gait.step_length_m, 40 * gait.step_length_m, 6,
                     core::RandomStream(seed, "motion/steps"))
                   .integral()) {}

Jet StepPhase::at(const Jet& s) const {
  return (1 / step_length_m_) * (s + chain(drift_m_.at(s.f), s));
}

Gait::Gait(const GaitOptions& gait, std::uint64_t seed)
    : full_speed_m_s_(gait.full_speed_m_s), uneven_(0.15, 5, 30, 4, core::RandomStream(seed, "motion/uneven_steps")) {
  const core::RandomStream random(seed, "motion/gait");
  const auto add = [&](double cycles, int axis, double amplitude) {
    const double phase = two_pi * random.uniform(tones_.size());
    Tone tone{cycles, {}, {}};
    tone.sine[static_cast<std::size_t>(axis)] = amplitude * std::cos(phase);
    tone.cosine[static_cast<std::size_t>(axis)] = amplitude * std::sin(phase);
    tones_.push_back(tone);
  };
  // An rms of both, this share of the power in the first.
  const auto amplitude = [](double rms_deg, double power) { return radians(rms_deg) * std::sqrt(2 * power); };
  for (int k = 1; k <= 4; ++k) {
    const double share = harmonic_share[k - 1] / (k * k);
    add(k, up, share * gait.vertical_m / 2);
    add(k, pitch_axis, share * amplitude(gait.pitch_rms_deg, 0.6));
  }
  add(0.5, pitch_axis, amplitude(gait.pitch_rms_deg, 0.4));
  add(0.5, roll_axis, amplitude(gait.roll_rms_deg, 0.8));
  add(1, roll_axis, amplitude(gait.roll_rms_deg, 0.2));
  add(0.5, yaw_axis, radians(gait.yaw_deg) / 2);
  add(0.5, left, gait.lateral_m / 2);
  const double steps_per_s = usual_speed * gait.full_speed_m_s / gait.step_length_m;
  add(1, forward, gait.surge_m_s / (two_pi * steps_per_s));
}

Jet Gait::share(const Jet& v_m_s) const {
  return step_of((1 / full_speed_m_s_) * v_m_s);
}

Swing Gait::at(const Jet& phase, const Jet& share) const {
  Swing swing;
  if (share.f == 0) return swing;
  for (const Tone& tone : tones_) {
    const SinCos wave = sin_cos(two_pi * tone.cycles * phase);
    for (std::size_t axis = 0; axis < 6; ++axis) {
      if (tone.sine[axis] == 0 && tone.cosine[axis] == 0) continue;
      swing[axis] = swing[axis] + tone.sine[axis] * wave.sin + tone.cosine[axis] * wave.cos;
    }
  }
  const Jet strength = share * (Jet{1} + chain(uneven_.at(phase.f), phase));
  for (Jet& axis : swing) axis = strength * axis;
  return swing;
}

namespace {
constexpr double swell_s = 0.015, fade_from_s = 0.35, over_s = 0.5;
constexpr double shove_back = 0.3;     ///< of the acceleration upward
constexpr double nod_per_m = 1 / 0.3;  ///< the device nods about a wrist 0.3 m behind it
}  // namespace

Strikes::Strikes(const GaitOptions& gait, std::uint64_t seed)
    : rate_(two_pi * gait.strike_hz), damping_(gait.strike_damping), peak_m_s2_(gait.strike_m_s2), seed_(seed) {
  double peak = 0;
  for (double t_s = 0; t_s < 0.1; t_s += 1e-5) peak = std::max(peak, std::abs(ringing(t_s).d2));
  scale_ = 1 / peak;
}

Jet Strikes::ringing(double since_s) const {
  if (since_s <= 0 || since_s >= over_s) return {};
  const Jet t{since_s, 1, 0, 0};
  const double decay = damping_ * rate_, e = scale_ * std::exp(-decay * since_s);
  const Jet fading{e, -decay * e, decay * decay * e, -decay * decay * decay * e};
  const Jet ring = fading * sin_cos(rate_ * t).sin;
  const Jet swollen = step_of((1 / swell_s) * t);
  const Jet left_over = step_of((1 / (over_s - fade_from_s)) * (Jet{over_s} - t));
  return swollen * left_over * ring;
}

void Strikes::add(double t_s, double share) {
  const core::RandomStream random(seed_, "motion/strikes");
  const double uneven = 1 + 0.15 * std::clamp(random.normal(times_s_.size()), -2.0, 2.0);
  times_s_.push_back(t_s);
  strengths_.push_back(peak_m_s2_ * share * uneven);
}

Swing Strikes::at(double t_s) const {
  Swing swing;
  auto strike = std::upper_bound(times_s_.begin(), times_s_.end(), t_s);
  while (strike != times_s_.begin() && t_s - *std::prev(strike) < over_s) {
    --strike;
    const Jet z = strengths_[static_cast<std::size_t>(strike - times_s_.begin())] * ringing(t_s - *strike);
    swing[up] = swing[up] + z;
    swing[forward] = swing[forward] - shove_back * z;
    swing[pitch_axis] = swing[pitch_axis] - nod_per_m * z;
  }
  return swing;
}

Unrest::Unrest(const HoldOptions& hold, std::uint64_t seed) {
  constexpr double tremor_rate = two_pi * 10;
  for (int axis = 0; axis < 6; ++axis) {
    const bool turns = axis >= roll_axis;
    const double tremor = turns ? radians(hold.tremor_deg) : hold.tremor_m_s2 / (tremor_rate * tremor_rate);
    const double posture = turns ? radians(hold.posture_deg) : hold.posture_m;
    const auto k = static_cast<std::size_t>(axis);
    tremor_[k] = Waves(tremor, 1 / 12.0, 1 / 8.0, 3, core::RandomStream(seed, fmt::format("motion/tremor{}", axis)));
    posture_[k] = Waves(posture, 3, 20, 4, core::RandomStream(seed, fmt::format("motion/posture{}", axis)));
  }
}

Swing Unrest::at(double t_s, const Jet& share) const {
  const Jet how_much = Jet{1.0 / 6} + (5.0 / 6) * share;
  Swing swing;
  for (std::size_t axis = 0; axis < 6; ++axis) swing[axis] = tremor_[axis].at(t_s) + how_much * posture_[axis].at(t_s);
  return swing;
}

}  // namespace tarmac::sim::truth
