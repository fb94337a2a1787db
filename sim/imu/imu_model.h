/// IMUs by name: what their data sheets say of noise, biases and ranges.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tarmac::sim {

/// One triad. In SI units: [rad/s] for gyroscopes, [m/s^2] for accelerometers.
struct TriadModel {
  double noise_density = 0;  ///< white noise [unit/sqrt(Hz)]
  double random_walk = 0;    ///< of the bias [unit/s/sqrt(Hz)]
  double turn_on_sigma = 0;  ///< of the bias at the begin of a run [unit]
  double range = 0;          ///< saturates beyond +-range [unit]; 0 = never
};

struct ImuModel {
  std::string_view name;  ///< kebab-case
  std::string_view title;
  std::string_view grade;
  double max_rate_hz = 0;  ///< slower outputs average over their longer interval
  TriadModel gyro, accel;
};

/// All of them, from consumer grade to navigation grade.
std::span<const ImuModel> imu_models();
/// Throws InputError with did-you-mean for an unknown name.
const ImuModel& imu_model(const std::string& name);
/// The data sheet as text, for `tarmac describe`.
std::string describe_imu_model(const ImuModel& model);

}  // namespace tarmac::sim
