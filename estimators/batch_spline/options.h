/// What batch-spline can be told.
#pragma once

#include <string>

#include "estimators/composed/options.h"

namespace tarmac::estimators {

struct BatchSplineOptions {
  std::string odometry = "auto";
  int order = 4;
  double knot_spacing_s = 0.025;
  double process_translation = 4, process_rotation = 0.5;
  SamplingSettings sampling;
  MapSettings map;
  LidarSettings lidar;
  ImuSettings imu;
  double bias_spacing_s = 5;
  int rounds = 8;
  double convergence_m = 0.001;
  int solver_iterations = 4;
  std::string solver = "banded";

  BatchSplineOptions() {
    map.kind = "distributions";
    map.voxel_m = 0.8;
    map.max_points_per_voxel = 1000;
    lidar.residual = "point-to-distribution";
    imu.use = "auto";
    imu.free_gravity = true;
  }

  void visit(core::OptionVisitor& v) {
    static const std::vector<std::string> starts = [] {
      std::vector<std::string> names{"auto"};
      names.insert(names.end(), ComposedOptions::profiles().begin(), ComposedOptions::profiles().end());
      return names;
    }();
    v.choice("odometry", odometry, starts,
             "profile of composed that the batch starts from; auto: spline-50ms-imu, or spline-50ms without an IMU");
    v("order", order, "of the spline: 4 is cubic", {.at_least = 4, .at_most = 6});
    v("knot_spacing_s", knot_spacing_s, "of its knots", {.at_least = 0.002, .at_most = 10});
    v("process_translation", process_translation, "prior: spectral density of white noise on acceleration [m^2/s^3]",
      {.above = 0});
    v("process_rotation", process_rotation, "the same of rotation [rad^2/s^3]", {.above = 0});
    v.group("sampling", sampling, "which points are used");
    v.group("map", map, "what sweeps are registered against: made of all of them, anew every round");
    v.group("lidar", lidar, "residuals of points");
    v.group("imu", imu, "residuals of the IMU; use: auto takes all that there is");
    v("bias_spacing_s", bias_spacing_s, "of the knots of the IMU's biases", {.at_least = 0.1});
    v("rounds", rounds, "maps made and solved against, at most", {.at_least = 1, .at_most = 1000});
    v("convergence_m", convergence_m, "a round that moves no sweep's end by more is the last", {.above = 0});
    v("solver_iterations", solver_iterations, "steps of the solver a round, at most", {.at_least = 1});
    v.choice("solver", solver, {"banded", "ceres"}, "Levenberg-Marquardt on banded normal equations, or Ceres");
  }
};

}  // namespace tarmac::estimators
