/// What a beam is beyond a line: `rig.lidar.beam:`. The defaults are a line with one echo, as sensors are idealised.
#pragma once

#include <string>

#include "core/config.h"
#include "core/options.h"
#include "sim/lidar/profile.h"

namespace tarmac::sim::lidar {

struct BeamOptions {
  int rays = 1;                        ///< in a footprint: 1, 3 or 7
  std::string footprint = "adaptive";  ///< or "full"
  std::string returns = "strongest";   ///< or "first", "last", "dual"
  double pulse_length_ns = 0;          ///< 0: the profile's
  bool glass = false;
  bool ghosts = true;  ///< of panes; only with `glass`
  double pane_flatness_deg = 0.2;
  bool halo = false;
  bool saturation = false;
  double saturation_signal = 20;
  double saturation_bias_m = 0.03;
  double range_walk_m = 0;
  std::string range_noise = "sheet";  ///< or "snr"
  double spot_smear = 0.12;
  double false_alarms_per_shot = 0;

  void visit(core::OptionVisitor& v);
  /// Anything at all is asked for.
  bool any() const;
  bool dual() const { return returns == "dual"; }
};

/// Says `full` where that is how footprints are traced anyway (behind prisms). Throws InputError at `node` (the block)
/// for a number of rays that is none of 1, 3 and 7, where the sensor's profile does not say how wide its beams are, and
/// for options that have no effect beside the others or with this sensor.
void complete_beam(const core::ConfigNode& node, BeamOptions& options, const Profile& profile);

}  // namespace tarmac::sim::lidar
