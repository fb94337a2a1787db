/// Runs one estimator over one recording: the loop that every method shares.
#pragma once

#include <functional>

#include "core/progress.h"
#include "estimators/estimator.h"

namespace tarmac::estimators {

/// Takes a sweep's diagnostics as soon as they are there: in full they are too large to be kept for a whole run.
using DiagnosticsSink = std::function<void(const core::SweepDiagnostics&)>;

struct RunResult {
  core::Estimate estimate;
  std::vector<core::SweepDiagnostics> diagnostics;  ///< empty where a sink took them
  core::RunTiming timing;
  std::vector<std::string> log;  ///< what was unusual: dropped points, sweeps out of order, empty sweeps
};

/// Defined outcomes of bad data: non-finite points are dropped (counted in the log); a sweep that then has none is
/// `empty` (for a method that needs LiDAR); a sweep that begins before its predecessor's end is dropped as
/// `out_of_order`; an IMU sample that is not finite or not later than its predecessor is dropped; an estimator whose
/// sensors are absent ends with RunStatus::not_initialised; one that throws, or returns a pose that is not finite or a
/// motion that overlaps the last one's, ends with RunStatus::failed and keeps what it gave until then. Of several IMUs
/// the first is used; several LiDARs come merged, or each, as the method wants (EstimatorEntry::raw_lidars). Bad
/// options throw InputError; whatever `progress` throws ends the run. A sweep's time includes that of the IMU samples
/// since the one before, and leaves out reading, decoding, the sink and the stages that serve the diagnostics alone:
/// what an instrument costs is not the method's. (Of the processor time their share is taken to be that of the wall
/// time.)
RunResult run_estimator(const core::Recording& recording, const EstimatorEntry& entry, const core::ConfigNode& options,
                        const EstimatorContext& context, const core::Progress& progress,
                        const DiagnosticsSink& sink = {});

}  // namespace tarmac::estimators
