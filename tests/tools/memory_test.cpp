// Memory does not grow with the drive: what is simulated is written as it comes, and what the motion's table holds is
// dropped and made again.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/files.h"
#include "core/recording.h"
#include "tools/tarmac/child.h"

namespace tarmac::tools {
namespace {

/// Few beams and a fast IMU: what grows with time would show beside what a sweep takes.
constexpr const char* kScenario = R"(name: long-drive
why: memory
surprise: growth
duration_s: 60
scene: {kind: bare, pavement_m: 300}
motion:
  kind: drive
  rest_s: 3
  start: {x_m: 0, y_m: -30}
  path: [{turn_deg: 18000, radius_m: 30}]
  speed: [{to_m_s: 5, peak_m_s2: 2}]
rig:
  lidar:
    model: few-beams
    profile:
      timing: encoder
      modes: [64x10]
      max_range_m: 100
      range_step_m: 0.002
      range_10_percent_m: 50
      range_80_percent_m: 100
      threshold_snr: 5.5
      sigma_from_m: [0]
      sigma_m: [0.02]
      elevation_deg: [-15, -5, 5]
      azimuth_offset_cw_deg: [0, 0, 0]
  imu: {model: adis16470, rate_hz: 400}
)";

double peak_mb(const PrivateFolder& folder, double duration_s) {
  ChildRequest request;
  request.command = {
      (program_folder() / "tarmac").string(),  "simulate", "long.yaml", "-o", "run", "--jobs", "2", "--set",
      fmt::format("duration_s={}", duration_s)};
  request.working_folder = folder.path();
  request.log_file = folder.path() / "log.txt";
  request.limits.wall_s = 600;
  const ChildResult result = run_child(request);
  EXPECT_TRUE(result.ok()) << core::read_file(request.log_file);
  const core::Recording recording = core::Recording::open(folder.path() / "run" / "recording");
  EXPECT_NEAR(static_cast<double>(recording.sweep_count()), 10 * duration_s, 1);
  std::printf("%.0f s of drive: peak %.1f MB, %.1f s of wall time\n", duration_s, result.peak_memory_mb, result.wall_s);
  return result.peak_memory_mb;
}

TEST(Memory, StaysFlatOverALongDrive) {
  const PrivateFolder folder;
  core::write_file(folder.path() / "long.yaml", kScenario);
  // From 66 s on the motion's table is as large as it gets.
  const double short_mb = peak_mb(folder, 90), long_mb = peak_mb(folder, 300);
  // A few hundred bytes a sweep and a second remain, 1.3 MB; how threads share the heap makes as much again, or twice.
  // The suspension's whole table would be 40 MB more, the text of the trajectory 24 MB.
  EXPECT_LT(long_mb - short_mb, 8);
}

}  // namespace
}  // namespace tarmac::tools
