#include "metrics/controls.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/error.h"

namespace tarmac::metrics {

using namespace core;

namespace {

constexpr Duration kClosestSamples{100'000};

bool is_default(const KnownError& e) {
  return e.C_right.matrix() == SE3::Identity().matrix() && e.yaw_rate_error_rad_s == 0 && e.speed_scale == 1 &&
         (e.shifted_sweep < 0 || e.shift == Duration(0));
}

/// The truth with its error, as a function of time.
class FaultyMotion {
 public:
  FaultyMotion(const Trajectory& truth, const KnownError& error, Time start)
      : truth_(truth), error_(error), start_(start), p_start_(truth.pose(start).translation()) {}

  SE3 pose(Time t, std::int64_t sweep) const {
    const Time asked = sweep == error_.shifted_sweep ? t + error_.shift : t;
    if (!truth_.covers(asked))
      throw InputError(
          fmt::format("truth-with-known-error: sweep {} shifted by {} ns leaves the truth's span; shift "
                      "another sweep or by less",
                      sweep, error_.shift.count()));
    SE3 T = truth_.pose(asked);
    const Eigen::Matrix3d turn = so3::exp(Eigen::Vector3d(0, 0, error_.yaw_rate_error_rad_s * to_s(t - start_)));
    T.translation() = p_start_ + turn * (error_.speed_scale * (T.translation() - p_start_));
    T.linear() = turn * T.linear();
    return T * error_.C_right;
  }

 private:
  const Trajectory& truth_;
  const KnownError& error_;
  Time start_;
  Eigen::Vector3d p_start_;
};

std::vector<Time> sample_times(const LidarSweep& sweep) {
  std::vector<Time> stamps{sweep.begin};
  for (std::size_t i = 0; i < sweep.size(); ++i)
    if (sweep.time(i) > sweep.begin && sweep.time(i) < sweep.end) stamps.push_back(sweep.time(i));
  std::sort(stamps.begin(), stamps.end());
  stamps.push_back(sweep.end);
  std::vector<Time> times{sweep.begin};
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    if (stamps[i] - times.back() < kClosestSamples && i + 1 < stamps.size()) continue;
    // The last one of a burst too: it must not lie on the long way to the next burst.
    if (stamps[i] - stamps[i - 1] >= kClosestSamples && stamps[i - 1] > times.back()) times.push_back(stamps[i - 1]);
    if (stamps[i] > times.back()) times.push_back(stamps[i]);
  }
  return times;
}

}  // namespace

Estimate make_control(const sim::truth::GroundTruth& truth, const SweepSource& sweeps, const KnownError& error) {
  Estimate estimate;
  estimate.estimator = is_default(error) ? "truth-replay" : "truth-with-known-error";
  estimate.gravity_aligned = true;
  std::optional<FaultyMotion> motion;
  for (std::size_t i = 0; i < sweeps.count; ++i) {
    const LidarSweep sweep = sweeps.sweep(i);
    SweepResult result{sweep.index, sweep.begin, sweep.end, sweep.end, SweepStatus::lost, SE3::Identity()};
    if (truth.motion->covers(sweep.begin) && truth.motion->covers(sweep.end)) {
      if (!motion) motion.emplace(*truth.motion, error, sweep.end);
      const std::vector<Time> times = sample_times(sweep);
      std::vector<SE3> poses;
      for (const Time t : times) poses.push_back(motion->pose(t, sweep.index));
      result.status = SweepStatus::ok;
      result.T_map_body = poses.back();
      estimate.causal.append(Segment::sampled(SegmentModel::sampled_screw, times, poses));
    }
    estimate.sweeps.push_back(result);
  }
  return estimate;
}

Estimate make_control(const sim::truth::GroundTruth& truth, const Recording& recording, const KnownError& error) {
  return make_control(truth, sweeps_of(recording), error);
}

}  // namespace tarmac::metrics
