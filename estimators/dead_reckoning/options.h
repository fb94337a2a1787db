/// What dead-reckoning can be told, and whoever else starts from a rest.
#pragma once

#include "core/options.h"

namespace tarmac::estimators {

struct RestOptions {
  double rest_window_s = 1;
  double rest_within_s = 3;
  double rest_accel_spread_m_s2 = 0.5;
  double rest_gyro_rad_s = 0.05;

  void visit(core::OptionVisitor& v) {
    v("rest_window_s", rest_window_s, "length of the rest from which attitude and biases are taken", {.above = 0});
    v("rest_within_s", rest_within_s, "the rest must come this soon after the first sample", {.above = 0});
    v("rest_accel_spread_m_s2", rest_accel_spread_m_s2,
      "specific force spreads no more than this about its mean at rest", {.above = 0});
    v("rest_gyro_rad_s", rest_gyro_rad_s, "the mean rate is no more than this at rest: above, it is no bias",
      {.above = 0});
  }
};

struct DeadReckoningOptions : RestOptions {
  double max_gap_periods = 4;

  void visit(core::OptionVisitor& v) {
    RestOptions::visit(v);
    v("max_gap_periods", max_gap_periods, "a longer hole in the samples makes the sweeps that it touches `lost`",
      {.at_least = 1});
  }
};

}  // namespace tarmac::estimators
