/// Estimate x ground truth -> Evaluation.
#pragma once

#include "core/diagnostics.h"
#include "core/estimate.h"
#include "core/recording.h"
#include "metrics/evaluation.h"
#include "sim/truth/ground_truth.h"

namespace tarmac::metrics {

struct EvaluateSettings {
  int threads = 1;
  std::size_t map_points = 150000;  ///< size of the map sample for pictures
  int phase_bins = 32;
};

/// All metrics. `recording` gives the points, `truth` where they were; `timing` may be nullptr.
Evaluation evaluate(const core::Estimate& estimate, const core::Recording& recording,
                    const sim::truth::GroundTruth& truth, const core::RunTiming* timing,
                    const EvaluateSettings& settings);

}  // namespace tarmac::metrics
