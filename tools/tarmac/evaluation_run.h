/// Scores every finished estimator of a run and keeps the result beside its estimate.
#pragma once

#include <vector>

#include "metrics/evaluation.h"
#include "tools/tarmac/console.h"
#include "tools/tarmac/layout.h"

namespace tarmac::tools {

/// Evaluates every estimator folder of the run; failed runs become evaluations with a status and no rows. Throws
/// InputError when the run has no truth.
std::vector<metrics::Evaluation> evaluate_run(const RunFolder& run, int threads, const Console& console);

/// What evaluate_run() left behind; throws InputError when an estimator's evaluation is missing.
std::vector<metrics::Evaluation> load_evaluations(const RunFolder& run);

}  // namespace tarmac::tools
