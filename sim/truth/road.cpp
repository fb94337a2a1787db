#include "sim/truth/road.h"

#include <Eigen/Core>
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

using Lanes = Eigen::Array4d;  ///< waves are summed four at a time

constexpr double odd(int n) {
  return n == 0 ? 1 : -odd(n - 1) / (2 * n * (2 * n + 1));
}
constexpr double even(int n) {
  return n == 0 ? 1 : -even(n - 1) / (2 * n * (2 * n - 1));
}

/// Taylor coefficients of sin x / x and cos x by x^2.
constexpr int terms = 11;
struct Series {
  std::array<double, terms> sine{}, cosine{};
  constexpr Series() {
    for (int n = 0; n < terms; ++n) sine[n] = odd(n), cosine[n] = even(n);
  }
};
constexpr Series series;

/// Sine and cosine of 2 pi y. y is reduced exactly; half the angle goes through its Taylor series (|angle| <= pi/2:
/// error below 1e-15) and is doubled.
inline void sin_cos_cycles(const Lanes& y, Lanes& s, Lanes& c) {
  constexpr double round_to_integer = 6755399441055744.0;  // 1.5 * 2^52
  const Lanes whole = (y + round_to_integer) - round_to_integer;
  const Lanes x = std::numbers::pi * (y - whole), q = x * x;
  Lanes sh = Lanes::Constant(series.sine[terms - 1]), ch = Lanes::Constant(series.cosine[terms - 1]);
  for (int n = terms - 2; n >= 0; --n) {
    sh = sh * q + series.sine[n];
    ch = ch * q + series.cosine[n];
  }
  sh *= x;
  s = 2 * sh * ch;
  c = 1 - 2 * sh * sh;
}

}  // namespace

Road::Road(const RoadOptions& options, double wheelbase_m, double track_m, std::uint64_t seed,
           const std::vector<BumpOptions>& bumps)
    : wheelbase_m_(wheelbase_m),
      track_m_(track_m),
      bumps_(bumps, options.contact_m),
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
  // at() takes four at a time: fill up with waves of no height.
  for (auto* column : {&cycles_per_m_, &sine_[0], &sine_[1], &sine_[2], &cosine_[0], &cosine_[1], &cosine_[2]}) {
    column->resize((column->size() + 3) / 4 * 4, 0.0);
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
  struct LanesJet {
    Lanes f = Lanes::Zero(), d1 = Lanes::Zero(), d2 = Lanes::Zero();
  };
  std::array<LanesJet, 3> lanes;
  for (std::size_t i = 0; i < cycles_per_m_.size(); i += 4) {
    const Lanes n = Eigen::Map<const Lanes>(&cycles_per_m_[i]), w = two_pi * n;
    Lanes s, c;
    sin_cos_cycles(n * s_m, s, c);
    for (int mode = 0; mode < 3; ++mode) {
      const Lanes a = Eigen::Map<const Lanes>(&sine_[mode][i]), b = Eigen::Map<const Lanes>(&cosine_[mode][i]);
      const Lanes value = a * s + b * c;
      lanes[mode].f += value;
      lanes[mode].d1 += w * (a * c - b * s);
      lanes[mode].d2 -= w * w * value;
    }
  }
  std::array<Jet, 3> sum;
  for (int mode = 0; mode < 3; ++mode) sum[mode] = {lanes[mode].f.sum(), lanes[mode].d1.sum(), lanes[mode].d2.sum(), 0};
  if (joint_spacing_m_ > 0) {
    const Jet rear = joint(s_m), front = joint(s_m + wheelbase_m_);
    sum[heave] = sum[heave] + 0.5 * (rear + front);
    sum[pitch] = sum[pitch] + (1 / wheelbase_m_) * (rear - front);
  }
  if (!bumps_.empty()) add_bumps(s_m, sum);
  return sum;
}

void Road::add_bumps(double s_m, std::array<Jet, 3>& sum) const {
  const Bumps::Heights rear = bumps_.at(s_m), front = bumps_.at(s_m + wheelbase_m_);
  const Jet rear_mean = 0.5 * (rear.left_m + rear.right_m), front_mean = 0.5 * (front.left_m + front.right_m);
  sum[heave] = sum[heave] + 0.5 * (rear_mean + front_mean);
  sum[pitch] = sum[pitch] + (1 / wheelbase_m_) * (rear_mean - front_mean);
  sum[roll] = sum[roll] + (1 / (2 * track_m_)) * (front.left_m - front.right_m + rear.left_m - rear.right_m);
}

}  // namespace tarmac::sim::truth
