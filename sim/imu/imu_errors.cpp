#include "sim/imu/imu_errors.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/random.h"
#include "sim/imu/low_pass.h"

namespace tarmac::sim {

namespace {

using namespace core;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Standard normals of one stream in order, drawn in blocks.
class Normals {
 public:
  Normals(std::uint64_t seed, const std::string& name) : stream_(seed, name) {}
  double next() {
    if (at_ == block_.size()) {
      block_.resize(4096);
      stream_.normals(first_, block_);
      first_ += block_.size();
      at_ = 0;
    }
    return static_cast<double>(block_[at_++]);
  }

 private:
  RandomStream stream_;
  std::vector<float> block_;
  std::uint64_t first_ = 0;
  std::size_t at_ = 0;
};

/// White noise of the density's, as a mean over the interval or behind a low-pass filter.
class WhiteNoise {
 public:
  WhiteNoise(double density, const ImuTiming& timing, std::uint64_t seed, const std::string& name)
      : normals_(seed, name), sigma_(density * std::sqrt(timing.rate_hz)) {
    if (timing.low_pass_hz <= 0) return;
    const LowPass filter(timing.low_pass_hz);
    Phi_ = filter.transition(1 / timing.rate_hz);
    step_ = density * Eigen::Matrix2d(filter.noise(1 / timing.rate_hz).llt().matrixL());
    const RandomStream start(seed, name + "_start");
    z_ = density *
         filter.stationary().diagonal().cwiseSqrt().cwiseProduct(Eigen::Vector2d(start.normal(0), start.normal(1)));
    filtered_ = true;
  }
  double next() {
    if (!filtered_) return sigma_ * normals_.next();
    const double a = normals_.next(), b = normals_.next();
    z_ = Phi_ * z_ + step_ * Eigen::Vector2d(a, b);
    return z_[0];
  }

 private:
  Normals normals_;
  double sigma_;
  bool filtered_ = false;
  Eigen::Matrix2d Phi_, step_;
  Eigen::Vector2d z_;
};

/// b <- exp(-dt / tau) b + sigma sqrt(1 - exp(-2 dt / tau)) n.
class GaussMarkov {
 public:
  GaussMarkov(double sigma, double tau_s, double interval_s, std::uint64_t seed, const std::string& name)
      : normals_(seed, name),
        keep_(std::exp(-interval_s / tau_s)),
        step_(sigma * std::sqrt(-std::expm1(-2 * interval_s / tau_s))),
        b_(sigma * RandomStream(seed, name + "_start").normal(0)) {}
  double next() { return b_ = keep_ * b_ + step_ * normals_.next(); }

 private:
  Normals normals_;
  double keep_, step_, b_;
};

class RandomWalk {
 public:
  RandomWalk(double density, double interval_s, std::uint64_t seed, const std::string& name)
      : normals_(seed, name), step_(density * std::sqrt(interval_s)) {}
  double next() { return b_ += step_ * normals_.next(); }

 private:
  Normals normals_;
  double step_, b_ = 0;
};

/// Clips at the range, then rounds to the step; the outermost step is the last that the range holds.
class Converter {
 public:
  Converter(const TriadModel& model, const ImuErrorOptions& options)
      : range_(options.saturation ? model.range : 0), lsb_(options.quantisation ? model.lsb : 0) {
    if (range_ > 0 && lsb_ > 0) last_code_ = std::floor(range_ / lsb_ * (1 + 1e-12));
  }
  double operator()(double value, std::size_t& saturated) const {
    if (range_ > 0 && std::abs(value) > range_) {
      ++saturated;
      value = std::copysign(range_, value);
    }
    if (lsb_ <= 0) return value;
    const double code = std::round(value / lsb_);
    return lsb_ * (last_code_ > 0 ? std::clamp(code, -last_code_, last_code_) : code);
  }

 private:
  double range_, lsb_, last_code_ = 0;
};

/// Diagonal: scale; beside it: misalignment.
Matrix3d draw_matrix(const TriadModel& model, const ImuErrorOptions& options, std::uint64_t seed,
                     const std::string& name) {
  const RandomStream scale(seed, name + "/scale"), misalignment(seed, name + "/misalignment");
  Matrix3d matrix = Matrix3d::Identity();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      const auto draw = static_cast<std::uint64_t>(3 * r + c);
      if (r == c && options.scale) matrix(r, c) += model.scale_sigma * scale.normal(draw);
      if (r != c && options.misalignment) matrix(r, c) += model.misalignment_sigma_rad * misalignment.normal(draw);
    }
  }
  return matrix;
}

Matrix3d draw_g_sensitivity(double sigma, std::uint64_t seed, const std::string& name) {
  const RandomStream stream(seed, name + "/g_sensitivity");
  Matrix3d matrix;
  for (int k = 0; k < 9; ++k) matrix(k / 3, k % 3) = sigma * stream.normal(static_cast<std::uint64_t>(k));
  return matrix;
}

struct Effects {
  const ImuErrorOptions& options;
  const ImuTiming& timing;
  std::uint64_t seed;
  std::size_t bias_every;
};

/// Biases, noise and conversion of one axis; `value(k)` is the axis of sample k.
template <class Value>
void add_axis_errors(const TriadModel& model, const Effects& effects, const std::string& name, int axis,
                     std::size_t count, const Value& value, RealisedTriad& realised) {
  const ImuErrorOptions& options = effects.options;
  const double interval_s = 1 / effects.timing.rate_hz;
  std::optional<WhiteNoise> white;
  std::optional<GaussMarkov> instability;
  std::optional<RandomWalk> walk;
  if (options.white_noise && model.noise_density > 0)
    white.emplace(model.noise_density, effects.timing, effects.seed, name + "/white_noise");
  if (options.bias_instability && model.bias_sigma > 0)
    instability.emplace(model.bias_sigma, model.bias_tau_s, interval_s, effects.seed, name + "/bias_instability");
  if (options.bias_walk && model.random_walk > 0)
    walk.emplace(model.random_walk, interval_s, effects.seed, name + "/bias_walk");
  const double turn_on =
      options.turn_on_bias ? model.turn_on_sigma * RandomStream(effects.seed, name + "/turn_on_bias").normal(0) : 0;
  realised.turn_on_bias[axis] = turn_on;
  const Converter convert(model, options);
  for (std::size_t k = 0; k < count; ++k) {
    double bias = turn_on;
    if (instability) bias += instability->next();
    if (walk) bias += walk->next();
    if (k % effects.bias_every == 0) realised.bias[k / effects.bias_every][axis] = bias;
    double& v = value(k);
    v += bias;
    if (white) v += white->next();
    v = convert(v, realised.saturated);
  }
}

}  // namespace

void ImuErrorOptions::visit(OptionVisitor& v) {
  v("white_noise", white_noise, "noise of the sheet's density");
  v("turn_on_bias", turn_on_bias, "a constant, drawn once a run");
  v("bias_instability", bias_instability, "a bias that wanders and returns (first-order Gauss-Markov)");
  v("bias_walk", bias_walk, "a bias that walks without bound, as filters assume: usually instead of bias_instability");
  v("scale", scale, "scale factors, drawn once a run");
  v("misalignment", misalignment, "axes that are not square, drawn once a run");
  v("g_sensitivity", g_sensitivity, "rates that come of forces, drawn once a run");
  v("saturation", saturation, "clipping at the range");
  v("quantisation", quantisation, "rounding to the least significant bit");
}

ImuErrorOptions ImuErrorOptions::none() {
  return {false, false, false, false, false, false, false, false, false};
}

RealisedImuErrors add_imu_errors(std::vector<ImuSample>& samples, const ImuModel& model, const ImuErrorOptions& options,
                                 const ImuTiming& timing, std::uint64_t seed, const std::string& name,
                                 std::size_t bias_every) {
  RealisedImuErrors realised;
  realised.bias_every = bias_every;
  for (std::size_t k = 0; k < samples.size(); k += bias_every) realised.bias_t.push_back(samples[k].t);
  realised.gyro.bias.resize(realised.bias_t.size());
  realised.accel.bias.resize(realised.bias_t.size());
  realised.gyro.matrix = draw_matrix(model.gyro, options, seed, name + "/gyro");
  realised.accel.matrix = draw_matrix(model.accel, options, seed, name + "/accel");
  if (options.g_sensitivity)
    realised.gyro.g_sensitivity = draw_g_sensitivity(model.g_sensitivity_sigma, seed, name + "/gyro");
  for (ImuSample& s : samples) {
    s.gyro_rad_s = realised.gyro.matrix * s.gyro_rad_s + realised.gyro.g_sensitivity * s.accel_m_s2;
    s.accel_m_s2 = realised.accel.matrix * s.accel_m_s2;
  }
  const Effects effects{options, timing, seed, bias_every};
  for (int axis = 0; axis < 3; ++axis) {
    const char letter = "xyz"[axis];
    add_axis_errors(
        model.gyro, effects, fmt::format("{}/gyro_{}", name, letter), axis, samples.size(),
        [&](std::size_t k) -> double& { return samples[k].gyro_rad_s[axis]; }, realised.gyro);
    add_axis_errors(
        model.accel, effects, fmt::format("{}/accel_{}", name, letter), axis, samples.size(),
        [&](std::size_t k) -> double& { return samples[k].accel_m_s2[axis]; }, realised.accel);
  }
  return realised;
}

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
Json json_of(const Matrix3d& m) {
  return {json_of(Vector3d(m.row(0))), json_of(Vector3d(m.row(1))), json_of(Vector3d(m.row(2)))};
}
Json json_of(const std::vector<Vector3d>& series) {
  Json list = Json::array();
  for (const Vector3d& v : series) list.push_back(json_of(v));
  return list;
}

}  // namespace

std::string errors_as_json(const RealisedImuErrors& e) {
  Json t_ns = Json::array();
  for (const Time t : e.bias_t) t_ns.push_back(to_ns(t));
  const Json json = {
      {"gyro",
       {{"scale_and_misalignment", json_of(e.gyro.matrix)},
        {"g_sensitivity_rad_s_per_m_s2", json_of(e.gyro.g_sensitivity)},
        {"turn_on_bias_rad_s", json_of(e.gyro.turn_on_bias)},
        {"saturated_axis_samples", e.gyro.saturated}}},
      {"accel",
       {{"scale_and_misalignment", json_of(e.accel.matrix)},
        {"turn_on_bias_m_s2", json_of(e.accel.turn_on_bias)},
        {"saturated_axis_samples", e.accel.saturated}}},
      {"bias", {{"t_ns", t_ns}, {"gyro_rad_s", json_of(e.gyro.bias)}, {"accel_m_s2", json_of(e.accel.bias)}}}};
  return json.dump(1) + "\n";
}

}  // namespace tarmac::sim
