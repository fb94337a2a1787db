#include "sim/imu/imu.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "sim/imu/low_pass.h"

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

/// Runs both triads through the low-pass filter, from a settled start.
class Filtered {
 public:
  Filtered(const SmoothTrajectory& motion, const ImuOptions& options, double gravity_m_s2, Time begin)
      : motion_(motion), options_(options), gravity_m_s2_(gravity_m_s2), filter_(options.low_pass_hz), t_(begin) {
    const Reading r = at(begin);
    state_.setZero();
    state_.row(0) << r.gyro_rad_s.transpose(), r.accel_m_s2.transpose();
  }
  /// The filter's output at t, which is later than all before.
  Reading advance_to(Time t) {
    const auto longest_ns = std::min<std::int64_t>(max_part_ns, duration_from_s(filter_.time_constant_s()).count());
    const std::int64_t span_ns = (t - t_).count(), parts = (span_ns + longest_ns - 1) / longest_ns;
    const double part_ns = static_cast<double>(span_ns) / static_cast<double>(parts);
    for (std::int64_t p = 0; p < parts; ++p) advance(static_cast<double>(p) * part_ns, part_ns);
    t_ = t;
    return {state_.row(0).head<3>().transpose(), state_.row(0).tail<3>().transpose()};
  }

 private:
  Reading at(Time t) const { return reading_at(motion_, options_.T_body_imu, gravity_m_s2_, t); }
  /// z(h) = Phi(h) z + integral of Phi(h - u) (0, w^2) x(u) du.
  void advance(double since_ns, double part_ns) {
    const double h_s = 1e-9 * part_ns;
    state_ = (filter_.transition(h_s) * state_).eval();
    for (std::size_t j = 0; j < gauss_node.size(); ++j) {
      const Reading r = at(t_ + Duration(std::llround(since_ns + gauss_node[j] * part_ns)));
      Eigen::Matrix<double, 1, 6> x;
      x << r.gyro_rad_s.transpose(), r.accel_m_s2.transpose();
      state_ += gauss_weight[j] * h_s * filter_.impulse((1 - gauss_node[j]) * h_s) * x;
    }
  }

  const SmoothTrajectory& motion_;
  const ImuOptions& options_;
  double gravity_m_s2_;
  LowPass filter_;
  Time t_;
  Eigen::Matrix<double, 2, 6> state_;  // output and its rate, of each axis
};

/// Perfect samples, one after the other.
class IdealImu {
 public:
  IdealImu(const SmoothTrajectory& motion, const ImuOptions& options, double gravity_m_s2, Time begin, Time end)
      : motion_(motion),
        options_(options),
        gravity_m_s2_(gravity_m_s2),
        begin_(begin),
        end_(end),
        point_(options.sampling == "point"),
        k_(point_ ? 0 : 1) {
    if (options.sampling == "low-pass") filtered_.emplace(motion, options_, gravity_m_s2, begin);
  }
  IdealImu(const IdealImu&) = delete;
  IdealImu& operator=(const IdealImu&) = delete;

  std::optional<ImuSample> next() {
    const Time t = stamp(begin_, k_, options_.rate_hz), before = stamp(begin_, k_ - 1, options_.rate_hz);
    if (t > end_) return std::nullopt;
    ++k_;
    const Reading r = point_      ? reading_at(motion_, options_.T_body_imu, gravity_m_s2_, t)
                      : filtered_ ? filtered_->advance_to(t)
                                  : mean_over(motion_, options_.T_body_imu, gravity_m_s2_, before, t);
    return ImuSample{t, r.gyro_rad_s, r.accel_m_s2};
  }

 private:
  const SmoothTrajectory& motion_;
  ImuOptions options_;
  double gravity_m_s2_;
  Time begin_, end_;
  bool point_;
  std::int64_t k_;
  std::optional<Filtered> filtered_;
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
  v.choice("sampling", sampling, {"interval-mean", "low-pass", "point"},
           "a sample is the mean over its interval or the output of a low-pass filter, as real devices give, or the "
           "value at its stamp");
  v("low_pass_hz", low_pass_hz, "with low-pass: cutoff (-3 dB) of the second-order Butterworth filter",
    {.above = 0, .at_most = 2000});
  v("noise", noise, "all errors that are on below (off: perfect samples)");
  v.group("errors", errors, "which errors the device has");
}

std::vector<ImuSample> ideal_imu(const SmoothTrajectory& motion, const ImuOptions& options, double gravity_m_s2,
                                 Time begin, Time end) {
  IdealImu ideal(motion, options, gravity_m_s2, begin, end);
  std::vector<ImuSample> samples;
  while (const std::optional<ImuSample> sample = ideal.next()) samples.push_back(*sample);
  return samples;
}

struct ImuSynthesis::State {
  IdealImu ideal;
  ImuErrorModel errors;
};

ImuSynthesis::ImuSynthesis(const SmoothTrajectory& motion, const ImuOptions& options, double gravity_m_s2, Time begin,
                           Time end, std::uint64_t seed, const std::string& name) {
  check(options);
  const ImuTiming timing{options.rate_hz, options.sampling == "low-pass" ? options.low_pass_hz : 0};
  const auto every_second = static_cast<std::size_t>(std::max(1.0, std::round(options.rate_hz)));
  state_.reset(new State{{motion, options, gravity_m_s2, begin, end},
                         {imu_model(options.model), options.noise ? options.errors : ImuErrorOptions::none(), timing,
                          seed, name, every_second}});
}

ImuSynthesis::~ImuSynthesis() = default;

std::optional<ImuSample> ImuSynthesis::next() {
  std::optional<ImuSample> sample = state_->ideal.next();
  if (sample) state_->errors.add_to(*sample);
  return sample;
}

const RealisedImuErrors& ImuSynthesis::errors() const {
  return state_->errors.realised();
}

SynthesizedImu synthesize_imu(const SmoothTrajectory& motion, const ImuOptions& options, double gravity_m_s2,
                              Time begin, Time end, std::uint64_t seed, const std::string& name) {
  ImuSynthesis synthesis(motion, options, gravity_m_s2, begin, end, seed, name);
  SynthesizedImu out;
  while (const std::optional<ImuSample> sample = synthesis.next()) out.samples.push_back(*sample);
  out.errors = synthesis.errors();
  return out;
}

ImuSheet imu_sheet(const ImuOptions& options) {
  check(options);
  const ImuModel& model = imu_model(options.model);
  ImuSheet sheet;
  sheet.model = model.name;
  sheet.T_body_imu = options.T_body_imu;
  sheet.rate_hz = options.rate_hz;
  sheet.delay = options.sampling == "point"      ? Duration(0)
                : options.sampling == "low-pass" ? duration_from_s(LowPass(options.low_pass_hz).group_delay_s())
                                                 : duration_from_s(0.5 / options.rate_hz);
  sheet.gyro_noise_density_rad_s_rthz = model.gyro.noise_density;
  sheet.gyro_random_walk_rad_s2_rthz = model.gyro.random_walk;
  sheet.gyro_range_rad_s = model.gyro.range;
  sheet.accel_noise_density_m_s2_rthz = model.accel.noise_density;
  sheet.accel_random_walk_m_s3_rthz = model.accel.random_walk;
  sheet.accel_range_m_s2 = model.accel.range;
  return sheet;
}

}  // namespace tarmac::sim
