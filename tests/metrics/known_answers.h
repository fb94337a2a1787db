/// What each control must give on each truth, in every metric, by derivation.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "metrics/controls.h"
#include "tests/metrics/fabricate.h"

namespace tarmac::metrics::tests {

enum class TruthKind { straight, circle };

struct KnownAnswer {
  std::string name;
  Drive drive;
  KnownError error;
  std::map<std::string, double> rows;                ///< by metric
  std::map<std::string, std::vector<double>> phase;  ///< by series, one a column
};

KnownAnswer lever_arm(TruthKind kind);
KnownAnswer yaw_rate_error(TruthKind kind);
KnownAnswer shifted_sweep(TruthKind kind);
KnownAnswer speed_scale(TruthKind kind);

}  // namespace tarmac::metrics::tests
