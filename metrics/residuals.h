/// The instrument "residual versus point time": from what a method recorded of its residuals to figures and findings.
#pragma once

#include <vector>

#include "metrics/diagnosis.h"
#include "metrics/evaluate.h"
#include "metrics/row_set.h"

namespace tarmac::metrics {

/// Reads the diagnostics once, a sweep at a time, on `settings.threads` threads; the same bytes at any number. Puts the
/// rows residual_* and stamp_quantum_ms, appends the series that evaluate.h lists, and returns the evidence but for the
/// lag.
Evidence examine_residuals(const EvaluationInput& input, const EvaluateSettings& settings, RowSet& rows,
                           std::vector<Series>& series);

}  // namespace tarmac::metrics
