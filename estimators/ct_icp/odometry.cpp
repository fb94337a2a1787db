#include "estimators/ct_icp/odometry.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "estimators/blocks/stopwatch.h"

namespace tarmac::estimators {

using core::SE3;
using core::SegmentModel;

CtOdometry::CtOdometry(const CtIcpOptions& options, const SE3& T_body_lidar)
    : options_(options),
      T_body_lidar_(T_body_lidar),
      sampler_(options.random_seed),
      map_(options.map_voxel_m, options.map_max_points_per_voxel, options.map_min_distance_m) {}

CtOdometry::Step CtOdometry::add(const core::LidarSweep& sweep) {
  Step step;
  Stopwatch stopwatch(step.stages_ms);
  step.span = SweepSpan(sweep);
  const Poses predicted = predict();
  step.motion = step.predicted = segment(step.span, predicted);
  sampler_.thin_out(sweep, {options_.min_range_m, options_.max_range_m,
                            startup() ? options_.startup_sample_cell_m : options_.sample_cell_m});
  stopwatch.lap("sampling");

  register_sweep(sweep, step);
  stopwatch.lap("icp");

  if (step.lost) {
    caution_.fail();
  } else {
    update_map(sweep, step);
  }
  stopwatch.lap("map");
  // Before there is a map, a sweep too poor to start one leaves no trace.
  if (!step.lost || sweeps_ > 0) remember(step.motion);
  return step;
}

CtOdometry::Poses CtOdometry::predict() const {
  if (sweeps_ == 0) return {};
  const Poses at_end{last_.end, last_.end};
  if (sweeps_ == 1 || options_.initialisation == "none") return at_end;
  const auto moved_on = [](const SE3& last, const SE3& before) {
    return core::se3::normalized(last * before.inverse() * last);
  };
  const bool from_begin = options_.begin_prediction == "previous-begin" && sweeps_ > 2;
  return {from_begin ? moved_on(last_.begin, before_.begin) : last_.end, moved_on(last_.end, before_.end)};
}

core::Segment CtOdometry::segment(const SweepSpan& span, const Poses& poses) const {
  if (sweeps_ < 2 || !span.elastic()) return core::Segment::hold(span.begin(), span.end(), poses.end);
  const SegmentModel model =
      options_.trajectory == "screw" ? SegmentModel::two_pose_screw : SegmentModel::two_pose_slerp;
  return core::Segment::two_pose(model, span.begin(), poses.begin, span.end(), poses.end);
}

Regularisers CtOdometry::regularisers() const {
  return {.beta_location = options_.beta_location,
          .beta_constant_velocity = options_.beta_constant_velocity,
          .beta_small_velocity = options_.beta_small_velocity,
          .beta_orientation = options_.beta_orientation,
          .T_previous_begin = last_.begin,
          .T_previous_end = last_.end,
          .quirk = options_.gauss_newton_quirk};
}

void CtOdometry::collect_keypoints(const core::LidarSweep& sweep, const SweepSpan& span) {
  keypoints_.clear();
  for (const std::uint32_t i : sampler_.keypoints()) {
    keypoints_.push_back({T_body_lidar_ * sweep.point(i), span.alpha(sweep.t_ns[i]), i});
  }
}

void CtOdometry::register_sweep(const core::LidarSweep& sweep, Step& step) {
  Effort effort = Effort::from(options_, startup());
  if (sweeps_ == 0) {
    // The first sweep starts the map where it stands.
    registration_.clear();
    sampler_.choose_keypoints(effort.keypoint_cell_m);
    collect_keypoints(sweep, step.span);
    step.lost = static_cast<int>(keypoints_.size()) < options_.min_residuals;
    return;
  }
  step.regularised = step.motion.poses.size() == 2 && sweeps_ >= options_.regularise_from_sweep;
  step.regularisers = regularisers();
  while (options_.robust && effort.level < caution_.level()) effort.raise(options_);
  Verdict verdict = attempt(sweep, effort, step);
  while (options_.robust && verdict != Verdict::good && step.attempts < options_.robust_attempts) {
    effort.raise(options_);
    verdict = attempt(sweep, effort, step);
  }
  if (verdict == Verdict::wrong) {
    step.lost = true;
    step.motion = step.predicted;
  }
}

Verdict CtOdometry::attempt(const core::LidarSweep& sweep, const Effort& effort, Step& step) {
  ++step.attempts;
  step.level = effort.level;
  step.settings = effort.settings;
  sampler_.choose_keypoints(effort.keypoint_cell_m);
  collect_keypoints(sweep, step.span);
  step.registration = registration_.align(map_, effort.settings, keypoints_, T_body_lidar_.translation(),
                                          step.regularised ? &step.regularisers : nullptr, step.predicted);
  step.motion = step.registration.motion;
  step.size = MotionSize::of(step.motion.poses.front(), step.motion.poses.back(), last_.end);
  const Verdict verdict = judge(options_, step.registration, step.size, effort.level);
  if (verdict != Verdict::good || startup() || !wants_overlap(options_, step.size)) return verdict;
  place_sample(sweep, step.span, step.motion);
  return judge(options_, MapOverlap::of(map_, placed_map_m_));
}

void CtOdometry::place_sample(const core::LidarSweep& sweep, const SweepSpan& span, const core::Segment& motion) {
  const SegmentSampler at(motion);
  const std::vector<std::uint32_t>& sample = sampler_.sample();
  placed_map_m_.resize(sample.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sample.size(), 512), [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k) {
      const std::uint32_t i = sample[k];
      placed_map_m_[k] = at.pose(span.alpha(sweep.t_ns[i])) * (T_body_lidar_ * sweep.point(i));
    }
  });
}

void CtOdometry::update_map(const core::LidarSweep& sweep, Step& step) {
  map_.remove_far(step.motion.poses.back().translation(), options_.map_radius_m);
  step.inserted = sweeps_ == 0 || caution_.admit(options_, step.size, step.attempts);
  if (!step.inserted) return;
  place_sample(sweep, step.span, step.motion);
  for (const Eigen::Vector3d& p : placed_map_m_) map_.add(p);
}

void CtOdometry::remember(const core::Segment& motion) {
  before_ = last_;
  // A held pose tells nothing of the sweep's begin; the last end stands in for it.
  last_ = {motion.poses.size() == 2 ? motion.poses.front() : (sweeps_ == 0 ? motion.poses.front() : last_.end),
           motion.poses.back()};
  ++sweeps_;
}

}  // namespace tarmac::estimators
