/// One row against one rule.
#pragma once

#include "metrics/compare.h"
#include "metrics/non_inferiority.h"
#include "metrics/registry.h"
#include "tools/gates/selection.h"

namespace tarmac::tools {

/// The rule in words: "median at most 0.5", "no worse than the baseline (margin 0 %)".
std::string words_of(const scenarios::GateRow& row);

/// Each fills value, baseline, change, verdict and reason of `row`; the runs are all as the row wants them. Against a
/// baseline, values of both signs are compared by their absolute values where lower is better: a lag has a sign, and
/// the nearer to 0 the better.
void judge_absolute(const scenarios::AbsoluteRule& rule, const TargetValues& values, reports::GateReportRow& row);
void judge_relative(const scenarios::RelativeRule& rule, const TargetValues& values, const SeedValues* baseline,
                    metrics::Better better, reports::GateReportRow& row);

/// The paired test, before Holm's rule has a say: p and pairs are set, and the verdict where it does not depend on p.
struct PairedRow {
  metrics::NonInferiority result;
  bool tested = false;  ///< false: `row` has its verdict and reason already
};
PairedRow test_paired(const scenarios::NonInferiorRule& rule, const TargetValues& values, const SeedValues* baseline,
                      double alpha, metrics::Better better, reports::GateReportRow& row);
/// The verdict once the adjusted p is known. `strictest_alpha`: the level that the detectable change is for.
void judge_paired(const scenarios::NonInferiorRule& rule, const PairedRow& paired, double alpha, double strictest_alpha,
                  double p_adjusted, bool lower_is_better, reports::GateReportRow& row);

}  // namespace tarmac::tools
