/// What a path and its speeds are told, by a drive or by an actor.
#pragma once

#include <vector>

#include "core/options.h"

namespace tarmac::scenes {

struct StartOptions {
  double x_m = 0, y_m = 0, heading_deg = 0, speed_m_s = 0;
  void visit(core::OptionVisitor& v);
};

/// One piece of the path: either a straight or a turn.
struct PathPiece {
  double straight_m = 0;
  double turn_deg = 0;
  double radius_m = 8;
  double blend_m = 4;
  void visit(core::OptionVisitor& v);
};

/// One change of speed. It begins at a time or a distance, or ends at a distance; -1 = not given; with none of the
/// three it begins `wait_s` after the change before it ended.
struct SpeedEvent {
  double to_m_s = 0;
  double peak_m_s2 = 1;
  double at_s = -1;
  double at_m = -1;
  double by_m = -1;
  double wait_s = 0;
  double onset_s = 0;   ///< 0: the acceleration swells and fades over the whole change
  double abs_m_s2 = 0;  ///< ripple of anti-lock brakes
  double abs_hz = 6;
  void visit(core::OptionVisitor& v);
};

struct JitterOptions {
  double speed_fraction_rms = 0.015;
  double min_wavelength_m = 15;
  double max_wavelength_m = 90;
  void visit(core::OptionVisitor& v);
};

struct WanderOptions {
  double lateral_rms_m = 0.06;
  double min_wavelength_m = 22;
  double max_wavelength_m = 70;
  void visit(core::OptionVisitor& v);
};

/// What a SpeedProfile is made from.
struct SpeedPlan {
  double start_m_s = 0;  ///< speed at t = 0
  double rest_s = 3;     ///< time before the first change of speed
  std::vector<SpeedEvent> events;
  double stop_peak_m_s2 = 1.2;  ///< deceleration of the stop at the end of the path; 0: no stop
};

}  // namespace tarmac::scenes
