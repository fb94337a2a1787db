/// IMUs by name: what their data sheets say of noise, biases and ranges.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tarmac::sim {

/// One triad. In SI units: [rad/s] for gyroscopes, [m/s^2] for accelerometers.
struct TriadModel {
  double noise_density = 0;           ///< white noise [unit/sqrt(Hz)]: N of the Allan variance N^2 / tau
  double bias_sigma = 0;              ///< bias instability as a first-order Gauss-Markov process: its sigma [unit] ...
  double bias_tau_s = 0;              ///< ... and correlation time
  double random_walk = 0;             ///< bias_sigma sqrt(2 / tau): the walk that is the same over short times
                                      ///< [unit/s/sqrt(Hz)]
  double turn_on_sigma = 0;           ///< of the bias at the begin of a run [unit]
  double scale_sigma = 0;             ///< of each axis' scale error
  double misalignment_sigma_rad = 0;  ///< of each axis against each other
  double range = 0;                   ///< saturates beyond +-range [unit]; 0 = never
  double lsb = 0;                     ///< values are multiples of it [unit]; 0 = exact
};

struct ImuModel {
  std::string_view name;  ///< kebab-case
  std::string_view title;
  std::string_view grade;
  double max_rate_hz = 0;  ///< slower outputs average over their longer interval
  TriadModel gyro, accel;
  double g_sensitivity_sigma = 0;  ///< of each gyroscope axis to each axis of force [rad/s per m/s^2]
};

/// All of them, from consumer grade to navigation grade.
std::span<const ImuModel> imu_models();
/// Throws InputError with did-you-mean for an unknown name.
const ImuModel& imu_model(const std::string& name);
/// The data sheet as text, for `tarmac describe`.
std::string describe_imu_model(const ImuModel& model);

}  // namespace tarmac::sim
