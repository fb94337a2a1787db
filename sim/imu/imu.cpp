#include "sim/imu/imu.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/random.h"

namespace tarmac::sim {

namespace {

using namespace core;
using Eigen::Vector3d;

struct Reading {
  Vector3d gyro_rad_s = Vector3d::Zero(), accel_m_s2 = Vector3d::Zero();
};

/// What a perfect IMU at T_body_imu feels at one instant.
Reading reading_at(const SmoothTrajectory& motion, const SE3& T_body_imu, double gravity_m_s2, Time t) {
  const Kinematics k = motion.at(t);
  const Vector3d up(0, 0, gravity_m_s2), arm = T_body_imu.translation();
  const Vector3d force_body = k.T_world_body.linear().transpose() * (k.a_world + up) + k.alpha_body.cross(arm) +
                              k.omega_body.cross(k.omega_body.cross(arm));
  const Eigen::Matrix3d R_imu_body = T_body_imu.linear().transpose();
  return {R_imu_body * k.omega_body, R_imu_body * force_body};
}

// Gauss-Legendre with four nodes, in [0, 1].
constexpr std::array<double, 4> gauss_node{0.069431844202973712388, 0.33000947820757186760, 0.66999052179242813240,
                                           0.93056815579702628761};
constexpr std::array<double, 4> gauss_weight{0.17392742256872692869, 0.32607257743127307131, 0.32607257743127307131,
                                             0.17392742256872692869};

/// Parts of at most 2.5 ms: four nodes then give the mean of a 200 Hz line to 1e-5 of its amplitude.
constexpr std::int64_t max_part_ns = 2'500'000;

Reading mean_over(const SmoothTrajectory& motion, const SE3& T_body_imu, double gravity_m_s2, Time begin, Time end) {
  const std::int64_t span_ns = (end - begin).count(), parts = (span_ns + max_part_ns - 1) / max_part_ns;
  const double part_ns = static_cast<double>(span_ns) / static_cast<double>(parts);
  Reading mean;
  for (std::int64_t p = 0; p < parts; ++p) {
    for (std::size_t j = 0; j < gauss_node.size(); ++j) {
      const Duration since(std::llround((static_cast<double>(p) + gauss_node[j]) * part_ns));
      const Reading r = reading_at(motion, T_body_imu, gravity_m_s2, begin + since);
      const double weight = gauss_weight[j] / static_cast<double>(parts);
      mean.gyro_rad_s += weight * r.gyro_rad_s;
      mean.accel_m_s2 += weight * r.accel_m_s2;
    }
  }
  return mean;
}

Time stamp(Time begin, std::int64_t k, double rate_hz) {
  return begin + Duration(std::llround(static_cast<double>(k) * 1e9 / rate_hz));
}

/// One axis of one triad; draw k belongs to sample k.
class AxisErrors {
 public:
  AxisErrors(const TriadModel& model, double interval_s, std::uint64_t seed, const std::string& name)
      : noise_(seed, name + "/noise"),
        walk_(seed, name + "/bias_walk"),
        noise_sigma_(model.noise_density / std::sqrt(interval_s)),
        walk_sigma_(model.random_walk * std::sqrt(interval_s)),
        range_(model.range),
        bias_(model.turn_on_sigma * RandomStream(seed, name + "/turn_on_bias").normal(0)) {}

  double apply(std::uint64_t k, double value) {
    if (walk_sigma_ > 0) bias_ += walk_sigma_ * walk_.normal(k);
    if (noise_sigma_ > 0) value += noise_sigma_ * noise_.normal(k);
    value += bias_;
    return range_ > 0 ? std::clamp(value, -range_, range_) : value;
  }

 private:
  RandomStream noise_, walk_;
  double noise_sigma_, walk_sigma_, range_, bias_;
};

void check(const ImuOptions& options) {
  const ImuModel& model = imu_model(options.model);
  if (options.rate_hz > 0 && options.rate_hz <= model.max_rate_hz) return;
  throw InputError(fmt::format("imu.rate_hz: {} Hz, but {} gives above 0 and at most {} Hz", options.rate_hz,
                               model.name, model.max_rate_hz));
}

}  // namespace

void ImuOptions::visit(OptionVisitor& v) {
  std::vector<std::string> names;
  for (const ImuModel& known : imu_models()) names.emplace_back(known.name);
  v.choice("model", model, names, "which IMU: its noise, biases and ranges");
  v("rate_hz", rate_hz, "samples a second", {.above = 0, .at_most = 5000});
  v("T_body_imu", T_body_imu, "where it is mounted");
  v.choice("sampling", sampling, {"interval-mean", "point"},
           "a sample is the mean over its interval, as real devices do, or the value at its stamp");
  v("noise", noise, "white noise, biases and saturation (off: perfect samples)");
}

std::vector<ImuSample> ideal_imu(const SmoothTrajectory& motion, const ImuOptions& options, double gravity_m_s2,
                                 Time begin, Time end) {
  const bool point = options.sampling == "point";
  std::vector<ImuSample> samples;
  for (std::int64_t k = point ? 0 : 1; stamp(begin, k, options.rate_hz) <= end; ++k) {
    const Time t = stamp(begin, k, options.rate_hz), before = stamp(begin, k - 1, options.rate_hz);
    const Reading r = point ? reading_at(motion, options.T_body_imu, gravity_m_s2, t)
                            : mean_over(motion, options.T_body_imu, gravity_m_s2, before, t);
    samples.push_back({t, r.gyro_rad_s, r.accel_m_s2});
  }
  return samples;
}

void add_imu_errors(std::vector<ImuSample>& samples, const ImuModel& model, double rate_hz, std::uint64_t seed,
                    const std::string& name) {
  for (int axis = 0; axis < 3; ++axis) {
    const char letter = "xyz"[axis];
    AxisErrors gyro(model.gyro, 1 / rate_hz, seed, fmt::format("{}/gyro_{}", name, letter));
    AxisErrors accel(model.accel, 1 / rate_hz, seed, fmt::format("{}/accel_{}", name, letter));
    for (std::size_t k = 0; k < samples.size(); ++k) {
      samples[k].gyro_rad_s[axis] = gyro.apply(k, samples[k].gyro_rad_s[axis]);
      samples[k].accel_m_s2[axis] = accel.apply(k, samples[k].accel_m_s2[axis]);
    }
  }
}

std::vector<ImuSample> synthesize_imu(const SmoothTrajectory& motion, const ImuOptions& options, double gravity_m_s2,
                                      Time begin, Time end, std::uint64_t seed, const std::string& name) {
  check(options);
  std::vector<ImuSample> samples = ideal_imu(motion, options, gravity_m_s2, begin, end);
  if (options.noise) add_imu_errors(samples, imu_model(options.model), options.rate_hz, seed, name);
  return samples;
}

ImuSheet imu_sheet(const ImuOptions& options) {
  check(options);
  const ImuModel& model = imu_model(options.model);
  ImuSheet sheet;
  sheet.model = model.name;
  sheet.T_body_imu = options.T_body_imu;
  sheet.rate_hz = options.rate_hz;
  sheet.delay = options.sampling == "point" ? Duration(0) : duration_from_s(0.5 / options.rate_hz);
  sheet.gyro_noise_density_rad_s_rthz = model.gyro.noise_density;
  sheet.gyro_random_walk_rad_s2_rthz = model.gyro.random_walk;
  sheet.gyro_range_rad_s = model.gyro.range;
  sheet.accel_noise_density_m_s2_rthz = model.accel.noise_density;
  sheet.accel_random_walk_m_s3_rthz = model.accel.random_walk;
  sheet.accel_range_m_s2 = model.accel.range;
  return sheet;
}

}  // namespace tarmac::sim
