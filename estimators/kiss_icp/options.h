/// What KISS-ICP and rigid-icp can be told. Defaults are the publication's.
#pragma once

#include "core/options.h"

namespace tarmac::estimators {

struct RigidIcpOptions {
  double max_range_m = 100;
  double min_range_m = 0;
  double voxel_size_m = 1;
  int max_points_per_voxel = 20;
  double initial_threshold_m = 2;
  double min_motion_m = 0.1;
  double fixed_threshold_m = 0;
  int max_iterations = 500;
  double convergence = 1e-4;

  void visit(core::OptionVisitor& v) {
    v("max_range_m", max_range_m, "points at or beyond this range are left out, and the map ends there", {.above = 0});
    v("min_range_m", min_range_m, "points at or below this range are left out", {.at_least = 0});
    v("voxel_size_m", voxel_size_m, "edge of a map voxel; sampling cells are 0.5 and 1.5 times as large", {.above = 0});
    v("max_points_per_voxel", max_points_per_voxel, "points that a map voxel holds at most",
      {.at_least = 1, .at_most = 1000});
    v("initial_threshold_m", initial_threshold_m, "model deviation that the adaptive threshold starts from",
      {.above = 0});
    v("min_motion_m", min_motion_m, "smaller model deviations leave the threshold as it is", {.at_least = 0});
    v("fixed_threshold_m", fixed_threshold_m, "in place of the adaptive threshold; 0: adaptive", {.at_least = 0});
    v("max_iterations", max_iterations, "of the registration of one sweep", {.at_least = 1});
    v("convergence", convergence, "norm of an update (m and rad mixed) that ends the iterations", {.above = 0});
  }
};

struct KissIcpOptions : RigidIcpOptions {
  bool deskew = true;

  void visit(core::OptionVisitor& v) {
    RigidIcpOptions::visit(v);
    v("deskew", deskew, "move every point to the sweep's end by the previous sweep's motion");
  }
};

}  // namespace tarmac::estimators
