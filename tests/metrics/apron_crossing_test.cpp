// The shipped scenario apron-crossing is what it says, by the oracle; and the pavement's texture does not change that.
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "core/recording.h"
#include "metrics/degeneracy/oracle.h"
#include "scenarios/scenario.h"
#include "scenes/registry.h"
#include "sim/simulate.h"
#include "sim/truth/motion.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::metrics::tests {
namespace {

using namespace core;

/// Half of the columns, for the test's sake, and none of the draws that would give the twins other returns.
Oracle oracle_of(const std::vector<scenarios::Override>& changes, const std::filesystem::path& folder) {
  std::vector<scenarios::Override> overrides{{"rig.lidar.columns", "512"},
                                             {"rig.lidar.noise.range_scale", "0"},
                                             {"rig.lidar.noise.channel_bias_scale", "0"},
                                             {"rig.lidar.noise.quantisation", "false"},
                                             {"rig.lidar.noise.dropout", "false"}};
  overrides.insert(overrides.end(), changes.begin(), changes.end());
  const scenarios::Scenario scenario =
      scenarios::load_scenario(std::filesystem::path(TARMAC_SCENARIOS) / "apron-crossing.yaml", overrides);
  sim::SimulationInput input;
  input.scenario_name = scenario.name;
  input.duration = scenario.duration();
  input.scene = std::make_shared<const scenes::Scene>(scenes::make_scene(scenario.scene, input.seed));
  input.motion = sim::truth::make_motion(scenario.motion, scenario.duration(), input.scene->ground, input.seed);
  input.rig = scenario.rig;
  input.resolved_motion = sim::truth::resolve_motion(scenario.motion);
  sim::simulate(input, {.threads = 2}, folder / "recording", folder / "truth", [](double, const std::string&) {});

  const Recording recording = Recording::open(folder / "recording");
  sim::truth::GroundTruth truth;
  truth.motion = input.motion;
  truth.rig = recording.rig();
  truth.folder = folder / "truth";
  const sim::raycast::Tracer tracer(input.scene, {.threads = 2});
  return make_oracle(sweeps_of(recording), truth, truth.labels(), tracer, {.threads = 2});
}

/// A class that differs between the twins, and how far from the threshold the eigenvalues are then.
void count_flip(double a, double b, double threshold, std::size_t& flips, double& farthest) {
  if ((a < threshold) == (b < threshold)) return;
  ++flips;
  for (const double lambda : {a, b}) farthest = std::max({farthest, lambda / threshold, threshold / lambda});
}

TEST(ApronCrossing, IsDegenerateOnItsWayOutAndInAndTextureDoesNotChangeAnySweepsClass) {
  const tarmac::tests::TemporaryFolder folder;
  const Oracle rough = oracle_of({}, folder / "rough");
  const Oracle smooth = oracle_of({{"scene.relief_rms_mm", "0"}, {"scene.joint_depth_mm", "0"}}, folder / "smooth");
  ASSERT_EQ(rough.sweeps.size(), smooth.sweeps.size());
  std::size_t degenerate = 0, difference = 0, returns = 0, disagreeing = 0, flips = 0;
  double farthest = 1;
  for (std::size_t k = 0; k < rough.sweeps.size(); ++k) {
    const OracleSweep &a = rough.sweeps[k], &b = smooth.sweeps[k];
    ASSERT_TRUE(a.blocks && b.blocks);
    degenerate += *a.lambda_pose() < kOracleDegenerateBelow;
    difference += *a.lambda_difference() < kOracleShearDegenerateBelow;
    count_flip(*a.lambda_pose(), *b.lambda_pose(), kOracleDegenerateBelow, flips, farthest);
    count_flip(*a.lambda_difference(), *b.lambda_difference(), kOracleShearDegenerateBelow, flips, farthest);
    returns += a.points;
    disagreeing += a.disagreeing;
  }
  const double share = 100.0 * static_cast<double>(degenerate) / static_cast<double>(rough.sweeps.size());
  std::cout << share << " % of " << rough.sweeps.size() << " sweeps are degenerate, motion in the sweep in "
            << difference << "; " << disagreeing << " of " << returns << " beams met another object; " << flips
            << " classes differ, at eigenvalues within a factor of " << farthest << " of the threshold\n";
  EXPECT_GT(share, 20);
  EXPECT_LT(share, 80);
  EXPECT_EQ(flips, 0u);
  EXPECT_LT(disagreeing, returns / 200);
  // Out on the apron at the start and at the end, at the stand in between.
  EXPECT_LT(*rough.sweeps.front().lambda_pose(), kOracleDegenerateBelow / 2);
  EXPECT_LT(*rough.sweeps.back().lambda_pose(), kOracleDegenerateBelow / 2);
  EXPECT_GT(*rough.sweeps[rough.sweeps.size() / 2].lambda_pose(), 2 * kOracleDegenerateBelow);
  // What is free out there: both horizontal translations and the yaw.
  EXPECT_EQ(weak_directions(weak_shares(rough.sweeps.front().blocks->pose, kOracleDegenerateBelow)),
            "along-track + cross-track + yaw");
}

}  // namespace
}  // namespace tarmac::metrics::tests
