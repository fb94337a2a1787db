/// What a real IMU makes of the true rate and force:
///   gyro  = Q(sat( (I + S + M) omega + G f + b0 + b_gm(t) + b_rw(t) + w(t) ))
///   accel = Q(sat( (I + S + M) f           + b0 + b_gm(t) + b_rw(t) + w(t) ))
/// S scale, M misalignment, G g-sensitivity, b0 turn-on bias: constant over a run. b_gm: first-order Gauss-Markov,
/// started in its stationary state; b_rw: random walk; w: white noise; sat: clipping at the range; Q: rounding to the
/// step. Noise behind a low-pass filter is what the filter leaves of white noise, exactly, at the samples' instants.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/measurements.h"
#include "core/options.h"
#include "sim/imu/imu_model.h"

namespace tarmac::sim {

/// One effect a switch: the scenario's `rig.imu.errors:` block.
struct ImuErrorOptions {
  bool white_noise = true;
  bool turn_on_bias = true;
  bool bias_instability = true;
  bool bias_walk = false;  ///< the unbounded twin of bias_instability: usually one of the two
  bool scale = true;
  bool misalignment = true;
  bool g_sensitivity = true;
  bool saturation = true;
  bool quantisation = true;
  void visit(core::OptionVisitor& v);
  static ImuErrorOptions none();
};

/// How samples come about.
struct ImuTiming {
  double rate_hz = 200;
  double low_pass_hz = 0;  ///< cutoff; 0: means over the interval, or points
};

/// The errors of one run, for truth/. Biases [rad/s], [m/s^2].
struct RealisedTriad {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();     ///< I + S + M
  Eigen::Matrix3d g_sensitivity = Eigen::Matrix3d::Zero();  ///< [rad/s per m/s^2]; zero for accelerometers
  Eigen::Vector3d turn_on_bias = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> bias;  ///< b0 + b_gm + b_rw, of every `bias_every`-th sample
  std::size_t saturated = 0;          ///< axis samples that were clipped
};
struct RealisedImuErrors {
  std::size_t bias_every = 1;
  std::vector<core::Time> bias_t;
  RealisedTriad gyro, accel;
};

/// The errors of one device, put on sample after sample: memory does not grow with the run but for the biases.
class ImuErrorModel {
 public:
  /// As add_imu_errors.
  ImuErrorModel(const ImuModel& model, const ImuErrorOptions& options, const ImuTiming& timing, std::uint64_t seed,
                const std::string& name, std::size_t bias_every = 1);
  ~ImuErrorModel();
  void add_to(core::ImuSample& sample);                            ///< the next one
  const RealisedImuErrors& realised() const { return realised_; }  ///< so far

 private:
  struct State;
  std::unique_ptr<State> state_;
  RealisedImuErrors realised_;
  std::size_t count_ = 0;
};

/// Draws are named `name`/..., one stream an effect and axis: another IMU's, or another effect's, never move them.
/// Biases are kept of every `bias_every`-th sample, from the first on.
RealisedImuErrors add_imu_errors(std::vector<core::ImuSample>& samples, const ImuModel& model,
                                 const ImuErrorOptions& options, const ImuTiming& timing, std::uint64_t seed,
                                 const std::string& name, std::size_t bias_every = 1);

/// The text of truth/imu<k>_errors.json.
std::string errors_as_json(const RealisedImuErrors& errors);

}  // namespace tarmac::sim
