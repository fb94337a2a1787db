/// Sums of a few sines with seeded phases: the ripple of the speed, the wander of the heading.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/random.h"
#include "scenes/paths/jet.h"

namespace tarmac::scenes {

/// sum of a_k sin(k_k x + phase_k), with derivatives by x.
class Waves {
 public:
  struct Wave {
    double amplitude, wavenumber, phase;
  };

  Waves() = default;
  /// `count` waves of equal amplitude, together of the given rms, wavelengths spread from `shortest` to `longest` in
  /// equal ratios and each moved a little by its draw.
  Waves(double rms, double shortest, double longest, int count, const core::RandomStream& random) {
    const double amplitude = rms * std::sqrt(2.0 / count);
    for (int k = 0; k < count; ++k) {
      const double place = (k + random.uniform(k, 0)) / count;
      const double wavelength = shortest * std::pow(longest / shortest, place);
      waves_.push_back({amplitude, 2 * std::numbers::pi / wavelength, 2 * std::numbers::pi * random.uniform(k, 1)});
    }
  }

  const std::vector<Wave>& waves() const { return waves_; }
  /// Each amplitude divided by its wavenumber and each phase moved by a quarter wave: the integral, up to a constant.
  Waves integral() const {
    Waves result;
    for (const Wave& w : waves_) {
      result.waves_.push_back({w.amplitude / w.wavenumber, w.wavenumber, w.phase - std::numbers::pi / 2});
    }
    return result;
  }
  /// Each amplitude times its wavenumber and each phase moved by a quarter wave: the derivative.
  Waves derivative() const {
    Waves result;
    for (const Wave& w : waves_) {
      result.waves_.push_back({w.amplitude * w.wavenumber, w.wavenumber, w.phase + std::numbers::pi / 2});
    }
    return result;
  }

  double value(double x) const {
    double sum = 0;
    for (const Wave& w : waves_) sum += w.amplitude * std::sin(w.wavenumber * x + w.phase);
    return sum;
  }
  Jet at(double x) const {
    Jet sum;
    for (const Wave& w : waves_) {
      const double angle = w.wavenumber * x + w.phase, s = std::sin(angle), c = std::cos(angle), k = w.wavenumber;
      sum = sum + w.amplitude * Jet{s, k * c, -k * k * s, -k * k * k * c};
    }
    return sum;
  }

 private:
  std::vector<Wave> waves_;
};

}  // namespace tarmac::scenes
