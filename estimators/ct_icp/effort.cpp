#include "estimators/ct_icp/effort.h"

#include <algorithm>
#include <numbers>

namespace tarmac::estimators {
namespace {

constexpr double kDeg = std::numbers::pi / 180;

double angle_deg(const core::SE3& a, const core::SE3& b) {
  return core::so3::angle_rad(a.linear().transpose() * b.linear()) / kDeg;
}

AssociationSettings association_settings(const CtIcpOptions& options, bool startup) {
  AssociationSettings a;
  a.search.max_points = options.max_neighbours;
  a.search.reach = startup ? options.startup_voxel_reach : options.voxel_reach;
  if (options.search_radius_m > 0) a.search.radius_m = options.search_radius_m;
  a.min_neighbours = options.min_neighbours;
  a.farthest_plane_point = options.plane_point == "farthest";
  a.planarity_weight = options.planarity_weight;
  a.neighbourhood_weight = options.neighbourhood_weight;
  a.planarity_power = options.planarity_power;
  a.neighbourhood_distance_m = options.neighbourhood_distance_m;
  a.max_plane_distance_m = options.max_plane_distance_m;
  a.max_residuals = options.max_residuals;
  return a;
}

bool turned_more_than(const MotionSize& size, double limit_deg) {
  return size.within_deg > limit_deg || size.since_last_deg > limit_deg;
}

}  // namespace

Effort Effort::from(const CtIcpOptions& options, bool startup) {
  Effort effort;
  effort.keypoint_cell_m = startup ? options.startup_keypoint_cell_m : options.keypoint_cell_m;
  ElasticSettings& s = effort.settings;
  s.association = association_settings(options, startup);
  s.loss = {loss_named(options.loss), options.loss_scale_m, options.loss_tolerance};
  s.use_ceres = options.solver == "ceres";
  s.ceres_max_iterations = options.ceres_max_iterations;
  s.max_iterations =
      startup ? std::max(options.max_iterations, options.startup_min_iterations) : options.max_iterations;
  s.min_residuals = options.min_residuals;
  s.convergence_m = options.convergence_m;
  s.convergence_rad = options.convergence_deg * kDeg;
  return effort;
}

void Effort::raise(const CtIcpOptions& options) {
  ElasticSettings& s = settings;
  AssociationSettings& a = s.association;
  ++level;
  a.search.reach = std::max(a.search.reach, std::min(a.search.reach + 1, options.robust_max_voxel_reach));
  a.max_residuals *= 2;
  a.max_plane_distance_m *= 1.5;
  s.loss.scale *= 1.2;
  s.ceres_max_iterations += 30;
  s.max_iterations = std::max(s.max_iterations, std::min(s.max_iterations + 20, 50));
  s.convergence_rad = std::max(s.convergence_rad / 10, 1e-5 * kDeg);
  s.convergence_m = std::max(s.convergence_m / 10, 1e-4);
  keypoint_cell_m = std::max(keypoint_cell_m / 1.5, std::min(options.sample_cell_m, options.startup_sample_cell_m));
}

MotionSize MotionSize::of(const core::SE3& begin, const core::SE3& end, const core::SE3& previous_end) {
  return {.within_m = (end.translation() - begin.translation()).norm(),
          .within_deg = angle_deg(begin, end),
          .since_last_deg = angle_deg(previous_end, end),
          .jump_m = (begin.translation() - previous_end.translation()).norm()};
}

Verdict judge(const CtIcpOptions& options, const ElasticResult& result, const MotionSize& size, int level) {
  if (!result.solved) return Verdict::wrong;
  if (size.within_m > options.max_translation_m || turned_more_than(size, options.max_rotation_deg)) {
    return Verdict::wrong;
  }
  if (!options.robust) return Verdict::good;
  if (size.within_m > options.robust_max_translation_m) return Verdict::doubtful;
  const bool wants_effort = level == 0 && options.robust_rotation_attempts > 0;
  return wants_effort && turned_more_than(size, options.robust_max_rotation_deg) ? Verdict::doubtful : Verdict::good;
}

MapOverlap MapOverlap::of(const VoxelMap& map, const std::vector<Eigen::Vector3d>& points_map) {
  int empty = 0, half_full = 0, all = 0;
  for (const Eigen::Vector3d& p : points_map) {
    if (!has_voxel(p, map.voxel_size_m())) continue;
    const int count = map.points_in(voxel_of(p, map.voxel_size_m())).count;
    ++all;
    empty += count == 0 ? 1 : 0;
    half_full += 2 * count > map.max_points() ? 1 : 0;
  }
  if (all == 0) return {.empty = 1, .half_full = 0};
  return {.empty = static_cast<double>(empty) / all, .half_full = static_cast<double>(half_full) / all};
}

bool wants_overlap(const CtIcpOptions& options, const MotionSize& size) {
  // Standing still, the share of well-filled voxels says how far one sees and nothing of the registration.
  return options.robust && options.robust_checks_map &&
         (size.jump_m > 0.1 || size.within_m > 0.1 || size.since_last_deg > 0.1);
}

Verdict judge(const CtIcpOptions& options, const MapOverlap& overlap) {
  return overlap.empty > options.robust_max_empty_ratio || overlap.half_full < options.robust_min_half_full_ratio
             ? Verdict::doubtful
             : Verdict::good;
}

bool Caution::admit(const CtIcpOptions& options, const MotionSize& size, int attempts) {
  bool add = true;
  if (options.robust) {
    const bool turned = turned_more_than(size, options.robust_max_rotation_deg);
    suspects_ = attempts >= options.robust_attempts ? suspects_ + 1 : 0;
    add = !turned || suspects_ > 5;
    level_ = turned || attempts > 1 ? 1 : 0;
  } else if (options.insertion_max_rotation_deg > 0 && size.within_deg > options.insertion_max_rotation_deg) {
    add = skipped_ > options.insertion_max_skipped;
  }
  skipped_ = add ? 0 : skipped_ + 1;
  return add;
}

}  // namespace tarmac::estimators
