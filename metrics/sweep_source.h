/// Where metrics get a LiDAR's sweeps and a method's diagnostics from: a file, or memory.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "core/diagnostics.h"
#include "core/measurements.h"
#include "core/recording.h"
#include "core/rig.h"
#include "sim/truth/ground_truth.h"

namespace tarmac::metrics {

struct SweepSource {
  std::size_t count = 0;
  std::function<core::LidarSweep(std::size_t)> sweep;  ///< the i-th; may be called from several threads
  core::Rig rig;                                       ///< nominal
  std::size_t lidar = 0;                               ///< index into rig.lidars
  /// Of sweeps merged from several LiDARs (core/merged_sweeps.h): their nominal poses on the body. `rig` then has one
  /// LiDAR, whose frame is the body's; the truth's rig has them all. Empty: sweeps of one LiDAR.
  std::vector<core::SE3> T_body_lidars = {};

  bool merged() const { return !T_body_lidars.empty(); }
  /// By sensor of a merged sweep: what carries its points, in the nominal body frame, to where it truly saw them.
  std::vector<core::SE3> true_mountings(const core::Rig& truth) const;
};

/// Where metrics get what the method recorded of each sweep: a file, or memory.
struct DiagnosticsSource {
  std::size_t count = 0;
  std::function<core::SweepDiagnostics(std::size_t)> sweep;  ///< the i-th; may be called from several threads
};

/// Keeps a reference to the reader.
DiagnosticsSource diagnostics_of(const core::DiagnosticsReader& reader);
/// Keeps a reference to the sweeps.
DiagnosticsSource diagnostics_of(const std::vector<core::SweepDiagnostics>& sweeps);

/// Those of the recording's LiDAR; of several LiDARs merged, as estimators are given them. Keeps a reference to the
/// recording.
SweepSource sweeps_of(const core::Recording& recording);
/// The labels that go with sweeps_of(recording), from the truth's folder.
std::vector<sim::truth::PointLabels> labels_of(const core::Recording& recording, const sim::truth::GroundTruth& truth);

}  // namespace tarmac::metrics
