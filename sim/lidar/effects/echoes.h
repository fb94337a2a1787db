/// What comes between a ray's hit and a reported point: arrays over the firings of a few columns, worked on by one
/// effect after the other. An effect is one function in one file, with random draws of its own name; the draw of a
/// firing has the firing's number in the recording, so that neither threads nor other effects change it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/random.h"
#include "scenes/scene.h"
#include "sim/lidar/profile.h"

namespace tarmac::sim::lidar {

/// Arrays of equal length in firing order: cycle after cycle, channel after channel.
struct Echoes {
  std::uint64_t first_firing = 0;  ///< number in the recording of firing 0 of the batch
  std::size_t channels = 1;
  /// Where these are the echoes of a few firings only: their numbers in the recording. Empty: one each of firings in a
  /// row, from first_firing on.
  std::vector<std::uint64_t> firings;
  std::vector<double> range_m;  ///< raw range from the sensor's datum; 0 = no echo
  std::vector<float> cos_incidence;
  std::vector<std::uint16_t> material;
  std::vector<float> signal;     ///< equivalent reflectance times cosine of incidence
  std::vector<float> intensity;  ///< 0 to 255

  std::size_t size() const { return range_m.size(); }
  void resize(std::size_t n);
  std::vector<float> draws;    ///< scratch for an effect's random numbers
  std::vector<float> scratch;  ///< for whatever else an effect keeps by firing
  /// Standard normals of the stream into `draws`, each at its firing's number.
  void draw(const core::RandomStream& stream);
};

/// signal = rho_eq(theta) cos(theta), monostatic, from the material (scenes::Material):
///   diffuse  rho_d (A + B sin tan), Oren-Nayar seen from the light: A = 1 - s^2/2/(s^2 + 0.33), B = 0.45 s^2/(s^2 +
///   0.09),
///            the factor capped at 5, where the model's slope statistics end
///   glossy   pi F0 D G1^2 / (4 cos^2), GGX with the half vector along the ray (Walter 2007)
///   retro    retro exp(-(theta / 30 deg)^4)
/// A pane's (transmission > 0) returns are its dirt and its glint; what lies behind it is not traced.
class Reflectance {
 public:
  explicit Reflectance(const std::vector<scenes::Material>& materials);
  void operator()(Echoes& echoes) const;
  /// The same for arrays of `count` hits.
  void signals(std::size_t count, const std::uint16_t* material, const float* cos_incidence, float* signal) const;

 private:
  struct Coefficients {
    float diffuse, a, b, alpha2, glossy, retro;
  };
  std::vector<Coefficients> materials_;
};

/// Drops what the receiver does not see. Amplitude over noise falls as
///   snr(r) = snr_0 (signal / 0.1) (r_10 / r)^p,   p = ln 8 / ln(r_80 / r_10),
/// which holds both ranges of the data sheet (10 % and 80 % targets, detected with probability 0.9); an echo is kept
/// when snr + n > threshold, n standard normal, so that its probability is Phi(snr - threshold).
class Detection {
 public:
  Detection(const Profile& profile, std::uint64_t seed, const char* stream);
  void operator()(Echoes& echoes) const;
  double snr(double signal, double range_m) const;
  double threshold() const { return threshold_; }

 private:
  core::RandomStream stream_;
  double threshold_, range_10_m_, exponent_, snr_0_;
  double range_step_m_;
  std::vector<float> falloff_;  // snr of signal 1 at multiples of range_step_m_
};

/// Gaussian, standard deviation by range as the profile has it, times `scale`.
class RangeNoise {
 public:
  RangeNoise(const Profile& profile, double scale, std::uint64_t seed, const char* stream);
  void operator()(Echoes& echoes) const;

 private:
  core::RandomStream stream_;
  std::vector<double> from_m_;
  std::vector<float> sigma_m_;
};

/// Gaussian, by range, brightness and incidence:
///   sigma^2 = sigma_sheet(r)^2 (1/2 + 1/2 0.8 / signal) + (smear r div tan(theta))^2,   all times scale^2
/// Half of the sheet's variance is the clock's, half the receiver's, which goes with one over signal over noise; so a
/// target of 80 % seen square has the sheet's sigma at every range. signal is the echo's equivalent reflectance times
/// cosine, div the beam's full width; the last term is where in its spot a slanted surface answers from.
class SnrNoise {
 public:
  static constexpr double reference_signal = 0.8;
  static constexpr double max_ratio = 100;   ///< of variances: the darkest echo that is detected at all
  static constexpr double max_tangent = 12;  ///< of the incidence: beyond 85 degrees the sheet's spot ends
  SnrNoise(const Profile& profile, double scale, double smear, std::uint64_t seed, const char* stream);
  void operator()(Echoes& echoes) const;
  double sigma_m(double range_m, double signal, double cos_incidence) const;

 private:
  core::RandomStream stream_;
  std::vector<double> from_m_, sigma_m_;
  double scale_, spread_;  // of the spot a metre of range
};

/// What bright echoes do to the receiver: a range error by brightness,
///   walk_m clamp(log10(signal / 0.2), -1, 1),
/// and where it clips (signal > saturation_signal; 0 = never) saturation_bias_m min(1, log10(signal / that) / 2) more,
/// with the intensity at its upper end.
struct Brightness {
  double walk_m = 0, saturation_signal = 0, saturation_bias_m = 0;
  bool saturates(float signal) const { return saturation_signal > 0 && signal > saturation_signal; }
  double bias_m(float signal) const;
  /// Moves the ranges and lifts what clips to a signal of full intensity.
  void operator()(Echoes& echoes) const;
};

/// A constant range error of each channel, drawn once a sensor. `channels`: whose firings a cycle holds, in their
/// order; empty: every channel's of the profile, one after the other.
class ChannelBias {
 public:
  ChannelBias(const Profile& profile, double scale, std::uint64_t seed, const char* stream,
              std::span<const std::uint32_t> channels = {});
  void operator()(Echoes& echoes) const;
  std::span<const double> bias_m() const { return bias_m_; }

 private:
  std::vector<double> bias_m_;
};

/// Rounds ranges to the sensor's step.
void quantise(double step_m, Echoes& echoes);

/// Calibrated reflectivity: up to 100 the signal in percent, above it logarithmic to 255 at 100 times a white
/// Lambertian target; with `noise`, 5 % and one count of Gaussian noise; whole numbers.
class Intensity {
 public:
  Intensity(bool noise, std::uint64_t seed, const char* stream);
  void operator()(Echoes& echoes) const;

 private:
  core::RandomStream stream_;
  bool noise_;
};

}  // namespace tarmac::sim::lidar
