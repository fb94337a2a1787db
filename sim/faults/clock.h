/// A sensor's clock that is not the recording's.
#pragma once

#include "core/time.h"

namespace tarmac::sim::faults {

/// stamp = t + offset + drift (t - recording's begin), to the nearest ns.
class FaultyClock {
 public:
  FaultyClock(double offset_ms, double drift_ppm);
  core::Time operator()(core::Time t) const;

 private:
  core::Duration offset_;
  double drift_;
};

}  // namespace tarmac::sim::faults
