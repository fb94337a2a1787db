/// IMU samples from an exact motion: mean angular rate and specific force over each sample's interval, then the errors.
///
/// With R, a, omega, alpha of the body, lever arm l and mounting R_body_imu, g_up = (0, 0, g):
///   rate  = R_body_imu^T omega
///   force = R_body_imu^T [ R^T (a + g_up) + alpha x l + omega x (omega x l) ]
/// A sample stamped t holds the means of both over [t - 1/rate, t], as a device does that integrates between outputs:
/// vibration faster than the rate averages out instead of aliasing into a bias. Or it holds the output at t of a
/// low-pass filter through which both went.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/lie.h"
#include "core/measurements.h"
#include "core/options.h"
#include "core/rig.h"
#include "core/trajectory.h"
#include "sim/imu/imu_errors.h"
#include "sim/imu/imu_model.h"

namespace tarmac::sim {

/// The scenario's `rig.imu:` block.
struct ImuOptions {
  std::string model = "adis16470";
  double rate_hz = 200;
  core::SE3 T_body_imu = core::SE3::Identity();
  std::string sampling = "interval-mean";
  double low_pass_hz = 50;
  bool noise = true;
  ImuErrorOptions errors;
  void visit(core::OptionVisitor& v);
};

/// Perfect samples within [begin, end]. Interval means and low-pass: stamps begin + k / rate, k >= 1; the filter starts
/// settled on its input at `begin`, as after a rest. Point samples: k >= 0. Throws core::OutOfSpan when the motion does
/// not cover the span.
std::vector<core::ImuSample> ideal_imu(const core::SmoothTrajectory& motion, const ImuOptions& options,
                                       double gravity_m_s2, core::Time begin, core::Time end);

/// The samples of synthesize_imu one after the other, without keeping them.
class ImuSynthesis {
 public:
  /// Keeps a reference to the motion. Throws as synthesize_imu.
  ImuSynthesis(const core::SmoothTrajectory& motion, const ImuOptions& options, double gravity_m_s2, core::Time begin,
               core::Time end, std::uint64_t seed, const std::string& name);
  ~ImuSynthesis();
  /// The next sample; nullopt when there is none left.
  std::optional<core::ImuSample> next();
  const RealisedImuErrors& errors() const;  ///< so far

 private:
  struct State;
  std::unique_ptr<State> state_;
};

struct SynthesizedImu {
  std::vector<core::ImuSample> samples;
  RealisedImuErrors errors;  ///< biases once a second
};

/// Ideal samples with the device's errors. `name` names the random draws: "imu0". Throws InputError for an unknown
/// model or a rate above the model's.
SynthesizedImu synthesize_imu(const core::SmoothTrajectory& motion, const ImuOptions& options, double gravity_m_s2,
                              core::Time begin, core::Time end, std::uint64_t seed, const std::string& name);

/// What the rig data sheet says of it. delay = stamp minus the middle of the averaged interval: half an interval; the
/// filter's group delay at low frequencies for low-pass; 0 for point samples. Densities are the model's, also when
/// `noise` is off; the random walk is the one that is equivalent to the bias instability over short times.
core::ImuSheet imu_sheet(const ImuOptions& options);

}  // namespace tarmac::sim
