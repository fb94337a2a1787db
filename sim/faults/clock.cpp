#include "sim/faults/clock.h"

namespace tarmac::sim::faults {

using namespace core;

FaultyClock::FaultyClock(double offset_ms, double drift_ppm)
    : offset_(duration_from_s(1e-3 * offset_ms)), drift_(1e-6 * drift_ppm) {}

Time FaultyClock::operator()(Time t) const {
  return t + offset_ + Duration(std::llround(drift_ * static_cast<double>(t.time_since_epoch().count())));
}

}  // namespace tarmac::sim::faults
