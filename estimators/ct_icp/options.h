/// What CT-ICP can be told. A profile sets all defaults; options given beside it override single ones.
#pragma once

#include <string>

#include "estimators/blocks/elastic_options.h"

namespace tarmac::estimators {

/// Numbers whose source is a profile have no default of their own here: set_profile fills them.
struct CtIcpOptions : ElasticSamplingOptions, NeighbourOptions {
  std::string profile = "icra-2022";

  std::string trajectory = "slerp";
  int max_residuals = 0;
  int min_residuals = 100;

  double map_voxel_m = 1.0;
  int map_max_points_per_voxel = 20;
  double map_min_distance_m = 0.1;
  double map_radius_m = 100;
  double insertion_max_rotation_deg = 0;
  int insertion_max_skipped = 5;

  double search_radius_m = 0;
  std::string plane_point = "nearest";
  double planarity_weight = 1, neighbourhood_weight = 0;
  double planarity_power = 2;
  double max_plane_distance_m = 0.3;
  double neighbourhood_distance_m = 0.3;

  std::string solver = "gauss-newton";
  std::string loss = "standard";
  double loss_scale_m = 0.1;
  double loss_tolerance = 0.05;
  int max_iterations = 5, startup_min_iterations = 15;
  int ceres_max_iterations = 1;
  double convergence_m = 1e-4, convergence_deg = 0.0057;

  std::string initialisation = "constant-velocity";
  std::string begin_prediction = "previous-end";
  int regularise_from_sweep = 2;
  double beta_location = 0.001, beta_constant_velocity = 0.001, beta_small_velocity = 0, beta_orientation = 0;
  bool gauss_newton_quirk = false;

  double max_translation_m = 5, max_rotation_deg = 30;
  bool robust = false;
  int robust_attempts = 6, robust_rotation_attempts = 2;
  double robust_max_translation_m = 1, robust_max_rotation_deg = 3;
  bool robust_checks_map = true;
  double robust_max_empty_ratio = 0.1, robust_min_half_full_ratio = 0.7;
  int robust_max_voxel_reach = 3;

  /// Sets everything to a profile's values.
  void set_profile(const std::string& name) {
    *this = CtIcpOptions();
    profile = name;
    if (name == "master") set_master();
  }

  void visit(core::OptionVisitor& v) {
    const std::string before = profile;
    v.choice(
        "profile", profile, {"icra-2022", "master"},
        "whose defaults: the paper's (tag icra_2022, default configuration) or upstream master's (d467813, driving "
        "configuration); changes the defaults of the options below");
    if (profile != before) set_profile(std::string(profile));
    visit_sampling(v);
    visit_map(v);
    visit_association(v);
    visit_solver(v);
    visit_motion(v);
    visit_validity(v);
  }

 private:
  /// Defaults above are the paper's; here is what master's driving configuration has otherwise.
  void set_master() {
    max_residuals = 900;
    map_voxel_m = 0.8;
    map_max_points_per_voxel = 30;
    insertion_max_rotation_deg = 3;
    startup_voxel_reach = 1;
    search_radius_m = 0.75;
    planarity_weight = 0.9;
    neighbourhood_weight = 0.1;
    max_plane_distance_m = 0;
    solver = "ceres";
    loss = "cauchy";
    ceres_max_iterations = 5;
    convergence_m = 0.01;
    convergence_deg = 0.1;
    begin_prediction = "previous-begin";
    regularise_from_sweep = 1;
    robust_checks_map = false;
  }

  void visit_sampling(core::OptionVisitor& v) {
    v.choice("trajectory", trajectory, {"slerp", "screw"},
             "how the pose runs from a sweep's begin to its end: slerp of rotation and lerp of translation, or at a "
             "constant twist");
    ElasticSamplingOptions::visit(v);
    v("max_residuals", max_residuals, "residuals beyond this number are left out; 0: no limit", {.at_least = 0});
    v("min_residuals", min_residuals, "with fewer keypoints or residuals a sweep is lost", {.at_least = 12});
  }

  void visit_map(core::OptionVisitor& v) {
    v("map_voxel_m", map_voxel_m, "edge of a map voxel", {.at_least = 0.01});
    v("map_max_points_per_voxel", map_max_points_per_voxel, "points that a map voxel holds at most",
      {.at_least = 1, .at_most = 1000});
    v("map_min_distance_m", map_min_distance_m, "points nearer than this to another of their voxel are not added",
      {.at_least = 0});
    v("map_radius_m", map_radius_m, "voxels farther than this are dropped", {.above = 0});
    v("insertion_max_rotation_deg", insertion_max_rotation_deg,
      "a sweep that turned more within itself is not added to the map; 0: no limit", {.at_least = 0});
    v("insertion_max_skipped", insertion_max_skipped, "unless more than so many in a row were not added",
      {.at_least = 0});
  }

  void visit_association(core::OptionVisitor& v) {
    NeighbourOptions::visit(v);
    v("search_radius_m", search_radius_m, "neighbours farther than this are left out; 0: no limit", {.at_least = 0});
    v.choice("plane_point", plane_point, {"nearest", "farthest"},
             "which of the neighbours the plane goes through; farthest is what upstream's master does by accident");
    v("planarity_weight", planarity_weight, "A of w = A a2D^power + B exp(-|q - p| / (d k)), A + B taken as 1",
      {.at_least = 0});
    v("neighbourhood_weight", neighbourhood_weight, "B of the same", {.at_least = 0});
    v("planarity_power", planarity_power, "power of a2D in the same", {.at_least = 0});
    v("neighbourhood_distance_m", neighbourhood_distance_m, "d of the same; k is min_neighbours", {.above = 0});
    v("max_plane_distance_m", max_plane_distance_m, "keypoints farther off their plane are left out; 0: no limit",
      {.at_least = 0});
  }

  void visit_solver(core::OptionVisitor& v) {
    v.choice("solver", solver, {"gauss-newton", "ceres"}, "gauss-newton takes one step an association");
    v.choice("loss", loss, {"standard", "cauchy", "huber", "tolerant", "truncated"},
             "robust loss of the weighted residuals; never of the regularisers");
    v("loss_scale_m", loss_scale_m, "scale of the loss", {.above = 0});
    v("loss_tolerance", loss_tolerance, "of loss tolerant: squared residuals below count little", {.at_least = 0});
    v("max_iterations", max_iterations, "associations a sweep", {.at_least = 1});
    v("startup_min_iterations", startup_min_iterations, "allow at least so many during start-up", {.at_least = 1});
    v("ceres_max_iterations", ceres_max_iterations, "steps of ceres an association", {.at_least = 1});
    v("convergence_m", convergence_m, "an iteration that moves begin and end by less than this together...",
      {.above = 0});
    v("convergence_deg", convergence_deg, "...and turns them by less than this together is the last", {.above = 0});
  }

  void visit_motion(core::OptionVisitor& v) {
    v.choice("initialisation", initialisation, {"constant-velocity", "none"},
             "where the iterations start: the motion between the two sweeps before once more, or at the last end");
    v.choice("begin_prediction", begin_prediction, {"previous-end", "previous-begin"},
             "what a sweep's begin is predicted from: the last end, or the last begin moved on");
    v("regularise_from_sweep", regularise_from_sweep, "first sweep (from 0) with regularisers", {.at_least = 1});
    v("beta_location", beta_location, "weight of begin - last end (per residual, [1])", {.at_least = 0});
    v("beta_constant_velocity", beta_constant_velocity, "weight of the displacement's change since the last sweep",
      {.at_least = 0});
    v("beta_small_velocity", beta_small_velocity, "weight of the displacement", {.at_least = 0});
    v("beta_orientation", beta_orientation, "weight of 1 - (q_begin . q_last_end)^2", {.at_least = 0});
    v("gauss_newton_quirk", gauss_newton_quirk,
      "for comparison only: the regularisers as master's gauss-newton has them (begin drawn to this sweep's end, "
      "no cross block of the velocity)");
  }

  void visit_validity(core::OptionVisitor& v) {
    v("max_translation_m", max_translation_m, "a sweep that moved more within itself is lost", {.above = 0});
    v("max_rotation_deg", max_rotation_deg, "a sweep that turned more, within itself or since the last, is lost",
      {.above = 0, .at_most = 180});
    v("robust", robust, "test registrations more strictly and try again with more effort");
    v("robust_attempts", robust_attempts, "attempts a sweep", {.at_least = 1});
    v("robust_rotation_attempts", robust_rotation_attempts, "effort that a large rotation is given at most",
      {.at_least = 0});
    v("robust_max_translation_m", robust_max_translation_m, "moving more within a sweep calls for another attempt",
      {.above = 0});
    v("robust_max_rotation_deg", robust_max_rotation_deg,
      "turning more calls for an attempt with more effort, and keeps the sweep out of the map", {.above = 0});
    v("robust_checks_map", robust_checks_map, "test how many points fall into empty and well-filled voxels");
    v("robust_max_empty_ratio", robust_max_empty_ratio, "share of points in empty voxels that passes", {.above = 0});
    v("robust_min_half_full_ratio", robust_min_half_full_ratio, "share of points in half-full voxels that passes",
      {.at_least = 0, .at_most = 1});
    v("robust_max_voxel_reach", robust_max_voxel_reach, "voxels searched each way at most, growing by one an attempt",
      {.at_least = 1, .at_most = 8});
  }
};

}  // namespace tarmac::estimators
