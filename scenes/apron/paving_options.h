/// What every apron scene lets a scenario say of its pavement.
#pragma once

#include "core/options.h"
#include "scenes/paving/paving.h"

namespace tarmac::scenes {

struct PavingOptions {
  double slab_size_m = 7.5;
  double crossfall_percent = 0.5;
  double undulation_mm = 24;
  double slab_tilt_mm = 2;
  double relief_rms_mm = 2;
  double joint_depth_mm = 3;

  void visit(core::OptionVisitor& v) {
    v("slab_size_m", slab_size_m, "edge of a concrete slab", {.at_least = 4, .at_most = 15});
    v("crossfall_percent", crossfall_percent, "fall of the pavement towards the south", {.at_least = -2, .at_most = 2});
    v("undulation_mm", undulation_mm, "amplitude of the longest wave of the pavement's base",
      {.at_least = 0, .at_most = 200});
    v("slab_tilt_mm", slab_tilt_mm, "standard deviation of a slab corner about the base",
      {.at_least = 0, .at_most = 10});
    v("relief_rms_mm", relief_rms_mm, "texture of the pavement, root mean square", {.at_least = 0, .at_most = 10});
    v("joint_depth_mm", joint_depth_mm, "mean depth of the joint grooves", {.at_least = 0, .at_most = 20});
  }

  /// Slabs from `low_m` (outwards to a whole number of slabs from the origin) to `high_m`, in cells of 1.25 m: within
  /// 0.5 mm of the default base, which is smooth enough.
  PavingSpec spec(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m, const char* stream) const {
    PavingSpec spec;
    spec.low_m = slab_size_m * (low_m / slab_size_m).array().floor().matrix();
    spec.high_m = high_m;
    spec.slab_size_m = slab_size_m;
    spec.crossfall_percent = crossfall_percent;
    spec.undulation_mm = undulation_mm;
    spec.slab_tilt_mm = slab_tilt_mm;
    spec.relief_rms_mm = relief_rms_mm;
    spec.joint_depth_mm = joint_depth_mm;
    spec.cell_m = 1.25;
    spec.stream = stream;
    return spec;
  }
};

}  // namespace tarmac::scenes
