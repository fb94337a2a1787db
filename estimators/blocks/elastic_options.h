/// Options of CT-ICP's front end, as ct-icp and all that sample and search like it declare them.
#pragma once

#include <cstdint>

#include "core/options.h"

namespace tarmac::estimators {

/// Which points are used (elastic_sampler.h).
struct ElasticSamplingOptions {
  std::int64_t random_seed = 0;
  double min_range_m = 0, max_range_m = 100;
  int startup_sweeps = 20;
  double sample_cell_m = 0.5, startup_sample_cell_m = 0.2;
  double keypoint_cell_m = 1.5, startup_keypoint_cell_m = 1.0;

  void visit(core::OptionVisitor& v) {
    v("random_seed", random_seed, "of the choice of one point a cell");
    v("min_range_m", min_range_m, "points at or below this range are left out", {.at_least = 0});
    v("max_range_m", max_range_m, "points at or beyond this range are left out", {.above = 0});
    v("startup_sweeps", startup_sweeps, "number of first sweeps under the start-up values", {.at_least = 0});
    v("sample_cell_m", sample_cell_m, "one random point of each such cell goes on to keypoints and map",
      {.at_least = 0.01});
    v("startup_sample_cell_m", startup_sample_cell_m, "the same during start-up", {.at_least = 0.01});
    v("keypoint_cell_m", keypoint_cell_m, "one of those of each such cell is a keypoint", {.at_least = 0.01});
    v("startup_keypoint_cell_m", startup_keypoint_cell_m, "the same during start-up", {.at_least = 0.01});
  }
};

/// Which map points a plane is fitted to (plane_association.h).
struct NeighbourOptions {
  int max_neighbours = 20, min_neighbours = 20;
  int voxel_reach = 1, startup_voxel_reach = 2;

  void visit(core::OptionVisitor& v) {
    v("max_neighbours", max_neighbours, "map points that a plane is fitted to, at most",
      {.at_least = 3, .at_most = 64});
    v("min_neighbours", min_neighbours, "keypoints with fewer are left out", {.at_least = 3, .at_most = 64});
    v("voxel_reach", voxel_reach, "voxels searched each way", {.at_least = 1, .at_most = 8});
    v("startup_voxel_reach", startup_voxel_reach, "the same during start-up", {.at_least = 1, .at_most = 8});
  }
};

}  // namespace tarmac::estimators
