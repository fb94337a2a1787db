#include "estimators/dead_reckoning/sample_chain.h"

#include <algorithm>

namespace tarmac::estimators {

using core::Duration;
using core::Time;

std::string no_usable_imu(const core::Rig& rig) {
  if (rig.imus.empty()) return "the rig has no IMU";
  if (!rig.calibrated) return "the recording has no calibration: the IMU's pose on the body is unknown";
  if (!(rig.imus[0].rate_hz > 0)) return "the IMU's data sheet gives no rate_hz";
  return {};
}

std::vector<ImuSpan> SampleChain::add(const core::ImuSample& sample) {
  std::vector<ImuSpan> added;
  const auto append = [&](const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& accel_m_s2, Time end, bool hole) {
    last_ = {last_.end, end, gyro_rad_s, accel_m_s2, hole};
    added.push_back(last_);
  };
  const Time middle = sample.t - delay_;
  const Time begin = middle - period_ / 2, end = middle + period_ / 2;
  if (begin - last_.end > period_ / 2) {
    const bool long_hole = static_cast<double>((begin - last_.end).count()) >
                           (max_gap_periods_ - 1) * static_cast<double>(period_.count());
    append((last_.gyro_rad_s + sample.gyro_rad_s) / 2, (last_.accel_m_s2 + sample.accel_m_s2) / 2, begin, long_hole);
  }
  if (end > last_.end) append(sample.gyro_rad_s, sample.accel_m_s2, end, false);
  return added;
}

Duration SampleChain::patience() const {
  return Duration(static_cast<std::int64_t>(max_gap_periods_ * static_cast<double>(period_.count()))) +
         std::max(Duration(0), delay_);
}

}  // namespace tarmac::estimators
