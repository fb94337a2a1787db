#include "sim/truth/road.h"

#include <cmath>
#include <numbers>

#include "core/random.h"

namespace tarmac::sim::truth {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;
constexpr double n_min = 0.01, n_max = 10;  ///< cycles/m: the range of interest on roads

/// Displacement density at 0.1 cycles/m [m^3]: geometric mean of the ISO 8608 class.
double density_at_tenth(const std::string& roughness) {
  if (roughness == "A") return 16e-6;
  if (roughness == "B") return 64e-6;
  if (roughness == "C") return 256e-6;
  return roughness == "D" ? 1024e-6 : 0;
}

double sinc(double x) {
  return std::abs(x) < 1e-9 ? 1 : std::sin(x) / x;
}

/// Sine and cosine of 2 pi y, without branches so that loops over it vectorise. y is reduced exactly; half the angle
/// goes through its Taylor series (|angle| <= pi/2: error below 1e-15) and is doubled.
inline void sin_cos_cycles(double y, double& s, double& c) {
  constexpr double round_to_integer = 6755399441055744.0;  // 1.5 * 2^52
  const double x = std::numbers::pi * (y - ((y + round_to_integer) - round_to_integer));
  const double q = x * x;
  const double sh =
      x * (1 + q * (-1.0 / 6 +
                    q * (1.0 / 120 +
                         q * (-1.0 / 5040 +
                              q * (1.0 / 362880 +
                                   q * (-1.0 / 39916800 +
                                        q * (1.0 / 6227020800.0 + q * (-1.0 / 1307674368000.0 +
                                                                       q * (1.0 / 355687428096000.0 +
                                                                            q * (-1.0 / 121645100408832000.0))))))))));
  const double ch =
      1 + q * (-0.5 + q * (1.0 / 24 +
                           q * (-1.0 / 720 +
                                q * (1.0 / 40320 + q * (-1.0 / 3628800 +
                                                        q * (1.0 / 479001600 +
                                                             q * (-1.0 / 87178291200.0 +
                                                                  q * (1.0 / 20922789888000.0 +
                                                                       q * (-1.0 / 6402373705728000.0 +
                                                                            q * (1.0 / 2432902008176640000.0))))))))));
  s = 2 * sh * ch;
  c = 1 - 2 * sh * sh;
}

}  // namespace

Road::Road(const RoadOptions& options, double wheelbase_m, double track_m, std::uint64_t seed)
    : wheelbase_m_(wheelbase_m),
      joint_spacing_m_(options.joint_spacing_m),
      joint_depth_m_(options.joint_depth_m),
      joint_length_m_(options.joint_length_m) {
  if (options.roughness != "none") add_waves(options, track_m, seed);
}

void Road::add_waves(const RoadOptions& options, double track_m, std::uint64_t seed) {
  const core::RandomStream random(seed, "motion/road");
  const double step = std::log(n_max / n_min) / options.waves;
  for (int k = 0; k < options.waves; ++k) {
    const double n = n_min * std::exp(step * (k + random.uniform(k, 0)));
    const double width = n_min * (std::exp(step * (k + 1)) - std::exp(step * k));
    const double density = density_at_tenth(options.roughness) * (0.1 / n) * (0.1 / n);
    const double amplitude = std::sqrt(2 * density * width) * sinc(std::numbers::pi * n * options.contact_m);
    const double common = std::exp(-1.5 * n * track_m), own = std::sqrt(1 - common * common);
    const double p = two_pi * random.uniform(k, 1), q = two_pi * random.uniform(k, 2);
    // left = A sin(x + p), right = A (common sin(x + p) + own sin(x + q)), x = 2 pi n s; as a sin x + b cos x.
    const double left[2] = {amplitude * std::cos(p), amplitude * std::sin(p)};
    const double right[2] = {amplitude * (common * std::cos(p) + own * std::cos(q)),
                             amplitude * (common * std::sin(p) + own * std::sin(q))};
    const double ahead = two_pi * n * wheelbase_m_, c = std::cos(ahead), s = std::sin(ahead);
    const auto front = [&](const double(&w)[2], int i) { return i == 0 ? w[0] * c - w[1] * s : w[0] * s + w[1] * c; };
    cycles_per_m_.push_back(n);
    for (int i = 0; i < 2; ++i) {
      auto& to = i == 0 ? sine_ : cosine_;
      const double front_mean = (front(left, i) + front(right, i)) / 2, rear_mean = (left[i] + right[i]) / 2;
      to[heave].push_back((front_mean + rear_mean) / 2);
      to[pitch].push_back((rear_mean - front_mean) / wheelbase_m_);
      to[roll].push_back((front(left, i) - front(right, i) + left[i] - right[i]) / (2 * track_m));
    }
  }
}

Jet Road::joint(double s_m) const {
  const double from_joint = s_m - joint_spacing_m_ * (std::floor(s_m / joint_spacing_m_) + 0.5);
  if (std::abs(from_joint) >= joint_length_m_ / 2) return {};
  const double k = std::numbers::pi / joint_length_m_, c = std::cos(k * from_joint), s = std::sin(k * from_joint);
  const double c2 = c * c;
  return -joint_depth_m_ * Jet{c2 * c2, -4 * k * c2 * c * s, k * k * (12 * c2 * s * s - 4 * c2 * c2), 0};
}

std::array<Jet, 3> Road::at(double s_m) const {
  std::array<Jet, 3> sum{};
  const std::size_t count = cycles_per_m_.size();
  for (std::size_t first = 0; first < count; first += 8) {
    const std::size_t size = std::min<std::size_t>(8, count - first);
    double s[8] = {}, c[8] = {}, k[8] = {};
    for (std::size_t i = 0; i < size; ++i) k[i] = cycles_per_m_[first + i];
    for (std::size_t i = 0; i < 8; ++i) sin_cos_cycles(k[i] * s_m, s[i], c[i]);
    for (int mode = 0; mode < 3; ++mode) {
      const double* a = sine_[mode].data() + first;
      const double* b = cosine_[mode].data() + first;
      for (std::size_t i = 0; i < size; ++i) {
        const double value = a[i] * s[i] + b[i] * c[i], w = two_pi * k[i];
        sum[mode].f += value;
        sum[mode].d1 += w * (a[i] * c[i] - b[i] * s[i]);
        sum[mode].d2 -= w * w * value;
      }
    }
  }
  if (joint_spacing_m_ > 0) {
    const Jet rear = joint(s_m), front = joint(s_m + wheelbase_m_);
    sum[heave] = sum[heave] + 0.5 * (rear + front);
    sum[pitch] = sum[pitch] + (1 / wheelbase_m_) * (rear - front);
  }
  return sum;
}

}  // namespace tarmac::sim::truth
