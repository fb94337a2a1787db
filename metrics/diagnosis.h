/// A first diagnosis in words: what the residuals, the stamps and the lag say of timing, and what they cannot say.
#pragma once

#include <optional>
#include <vector>

#include "metrics/evaluation.h"
#include "metrics/lag.h"
#include "metrics/residual_phase.h"
#include "metrics/residual_slope.h"
#include "metrics/stamps.h"

namespace tarmac::metrics {

/// What the diagnosis goes by. `slopes` and `trend` are absent where the method wrote no residuals, `lag` without truth
/// or where the motion does not show it; the reasons go into the words.
struct Evidence {
  StampFacts stamps;
  std::optional<PhaseTrend> trend;
  std::optional<SlopeFit> slopes;
  std::optional<LagFit> lag;
  bool has_truth = false;
  bool held = false;      ///< the estimate holds one pose over a sweep
  double period_s = 0.1;  ///< median time from sweep to sweep
  double spread_m = 0;    ///< of residuals about their sweep's fit
};

/// Topics, in this order: stamp-scale (scale, unit, reversal, or a motion that is not undone), stamp-quantisation,
/// missing-acceleration, clock-offset, time-lag, residual-trend, timing (the sum of it: noise only, or not).
///
/// Something is found when it is at least 4 standard deviations (bootstrap over sweeps) and at least as large as to
/// matter: 3 % of the motion (30 % where the motion inside the sweep is the
/// method's model and not measured: smaller shares are the model's), 0.3 of a stamp's step, 0.3 of the acceleration or
/// of a sweep's lag, 1 ms, 5 mm. The rate of false alarms that this gives is measured (README.md).
std::vector<Finding> diagnose(const Evidence& evidence);

}  // namespace tarmac::metrics
