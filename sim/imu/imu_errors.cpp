#include "sim/imu/imu_errors.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
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

/// Biases, noise and conversion of one axis, sample by sample.
class AxisErrors {
 public:
  AxisErrors(const TriadModel& model, const ImuErrorOptions& options, const ImuTiming& timing, std::uint64_t seed,
             const std::string& name)
      : convert_(model, options) {
    const double interval_s = 1 / timing.rate_hz;
    if (options.white_noise && model.noise_density > 0)
      white_.emplace(model.noise_density, timing, seed, name + "/white_noise");
    if (options.bias_instability && model.bias_sigma > 0)
      instability_.emplace(model.bias_sigma, model.bias_tau_s, interval_s, seed, name + "/bias_instability");
    if (options.bias_walk && model.random_walk > 0)
      walk_.emplace(model.random_walk, interval_s, seed, name + "/bias_walk");
    if (options.turn_on_bias) turn_on_ = model.turn_on_sigma * RandomStream(seed, name + "/turn_on_bias").normal(0);
  }

  double turn_on() const { return turn_on_; }
  /// Returns the bias that the sample had.
  double add_to(double& value, std::size_t& saturated) {
    double bias = turn_on_;
    if (instability_) bias += instability_->next();
    if (walk_) bias += walk_->next();
    value += bias;
    if (white_) value += white_->next();
    value = convert_(value, saturated);
    return bias;
  }

 private:
  std::optional<WhiteNoise> white_;
  std::optional<GaussMarkov> instability_;
  std::optional<RandomWalk> walk_;
  double turn_on_ = 0;
  Converter convert_;
};

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

struct ImuErrorModel::State {
  std::array<AxisErrors, 3> gyro, accel;
};

ImuErrorModel::ImuErrorModel(const ImuModel& model, const ImuErrorOptions& options, const ImuTiming& timing,
                             std::uint64_t seed, const std::string& name, std::size_t bias_every) {
  const auto axis = [&](const TriadModel& triad, const char* kind, int k) {
    return AxisErrors(triad, options, timing, seed, fmt::format("{}/{}_{}", name, kind, "xyz"[k]));
  };
  state_ = std::make_unique<State>(
      State{{axis(model.gyro, "gyro", 0), axis(model.gyro, "gyro", 1), axis(model.gyro, "gyro", 2)},
            {axis(model.accel, "accel", 0), axis(model.accel, "accel", 1), axis(model.accel, "accel", 2)}});
  realised_.bias_every = bias_every;
  realised_.gyro.matrix = draw_matrix(model.gyro, options, seed, name + "/gyro");
  realised_.accel.matrix = draw_matrix(model.accel, options, seed, name + "/accel");
  if (options.g_sensitivity)
    realised_.gyro.g_sensitivity = draw_g_sensitivity(model.g_sensitivity_sigma, seed, name + "/gyro");
  for (int k = 0; k < 3; ++k) {
    realised_.gyro.turn_on_bias[k] = state_->gyro[static_cast<std::size_t>(k)].turn_on();
    realised_.accel.turn_on_bias[k] = state_->accel[static_cast<std::size_t>(k)].turn_on();
  }
}

ImuErrorModel::~ImuErrorModel() = default;

void ImuErrorModel::add_to(ImuSample& s) {
  s.gyro_rad_s = realised_.gyro.matrix * s.gyro_rad_s + realised_.gyro.g_sensitivity * s.accel_m_s2;
  s.accel_m_s2 = realised_.accel.matrix * s.accel_m_s2;
  Vector3d gyro_bias, accel_bias;
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    gyro_bias[k] = state_->gyro[axis].add_to(s.gyro_rad_s[k], realised_.gyro.saturated);
    accel_bias[k] = state_->accel[axis].add_to(s.accel_m_s2[k], realised_.accel.saturated);
  }
  if (count_++ % realised_.bias_every != 0) return;
  realised_.bias_t.push_back(s.t);
  realised_.gyro.bias.push_back(gyro_bias);
  realised_.accel.bias.push_back(accel_bias);
}

RealisedImuErrors add_imu_errors(std::vector<ImuSample>& samples, const ImuModel& model, const ImuErrorOptions& options,
                                 const ImuTiming& timing, std::uint64_t seed, const std::string& name,
                                 std::size_t bias_every) {
  ImuErrorModel errors(model, options, timing, seed, name, bias_every);
  for (ImuSample& sample : samples) errors.add_to(sample);
  return errors.realised();
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
