// Apart from evaluate.cpp: this alone needs the truth's labels from disk.
#include "metrics/evaluate.h"

namespace tarmac::metrics {

Evaluation evaluate(const core::Estimate& estimate, const core::Recording& recording,
                    const sim::truth::GroundTruth* truth, const core::RunTiming* timing,
                    const EvaluateSettings& settings, const DiagnosticsSource* diagnostics, const Oracle* oracle) {
  std::vector<sim::truth::PointLabels> labels;
  if (truth) labels = labels_of(recording, *truth);
  return evaluate({estimate, sweeps_of(recording), truth, &labels, timing, diagnostics, oracle}, settings);
}

}  // namespace tarmac::metrics
