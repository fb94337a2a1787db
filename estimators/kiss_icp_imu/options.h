/// What kiss-icp-imu can be told: what KISS-ICP can, and how the IMU is used.
#pragma once

#include "estimators/dead_reckoning/options.h"
#include "estimators/kiss_icp/options.h"

namespace tarmac::estimators {

struct KissIcpImuOptions : RigidIcpOptions {
  RestOptions rest;
  double velocity_gain = 0.5;
  double max_gap_periods = 4;

  void visit(core::OptionVisitor& v) {
    RigidIcpOptions::visit(v);
    rest.visit(v);
    v("velocity_gain", velocity_gain,
      "share of the velocity error, as the registration shows it, that is corrected at once; 1 follows its noise",
      {.above = 0, .at_most = 1});
    v("max_gap_periods", max_gap_periods, "a longer hole in the IMU's samples is crossed at constant velocity",
      {.at_least = 1});
  }
};

}  // namespace tarmac::estimators
