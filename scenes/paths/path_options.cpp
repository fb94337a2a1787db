#include "scenes/paths/path_options.h"

namespace tarmac::scenes {

void StartOptions::visit(core::OptionVisitor& v) {
  v("x_m", x_m, "world position where the path begins (of a vehicle: under its rear axle)");
  v("y_m", y_m, "world position where the path begins (of a vehicle: under its rear axle)");
  v("heading_deg", heading_deg, "heading of the path from east, counter-clockwise");
  v("speed_m_s", speed_m_s, "speed at t = 0", {.at_least = 0, .at_most = 40});
}

void PathPiece::visit(core::OptionVisitor& v) {
  v("straight_m", straight_m, "length of a straight (0: this piece is a turn)", {.at_least = 0});
  v("turn_deg", turn_deg, "heading change of a turn, left positive (0: this piece is a straight)");
  v("radius_m", radius_m, "radius of the turn where it is tightest", {.above = 0.5});
  v("blend_m", blend_m, "length over which the curvature grows at the turn's begin, and shrinks at its end",
    {.above = 0});
}

void SpeedEvent::visit(core::OptionVisitor& v) {
  v("to_m_s", to_m_s, "the new speed", {.at_least = 0, .at_most = 40});
  v("peak_m_s2", peak_m_s2, "acceleration, or deceleration, at its peak", {.above = 0, .at_most = 12});
  v("at_s", at_s, "time at which the change begins (-1: not given)", {.at_least = -1});
  v("at_m", at_m, "distance along the path at which the change begins (-1: not given)", {.at_least = -1});
  v("by_m", by_m, "distance along the path at which the change is complete (-1: not given)", {.at_least = -1});
  v("wait_s", wait_s, "without at_s, at_m, by_m: time between the end of the change before and this one's begin",
    {.at_least = 0});
  v("onset_s", onset_s,
    "time in which the acceleration comes up to its peak, and in which it goes again (0: it swells and fades over the "
    "whole change)",
    {.at_least = 0, .at_most = 5});
  v("abs_m_s2", abs_m_s2, "ripple of the acceleration by anti-lock brakes, or by wheels that spin",
    {.at_least = 0, .at_most = 3});
  v("abs_hz", abs_hz, "frequency of that ripple", {.at_least = 2, .at_most = 12});
}

void JitterOptions::visit(core::OptionVisitor& v) {
  v("speed_fraction_rms", speed_fraction_rms, "ripple of the speed, as a share of it", {.at_least = 0, .at_most = 0.1});
  v("min_wavelength_m", min_wavelength_m, "shortest wave of the ripple", {.above = 1});
  v("max_wavelength_m", max_wavelength_m, "longest wave of the ripple", {.above = 1});
}

void WanderOptions::visit(core::OptionVisitor& v) {
  v("lateral_rms_m", lateral_rms_m, "sideways wander of a human driver about the path", {.at_least = 0, .at_most = 1});
  v("min_wavelength_m", min_wavelength_m, "shortest wave of the wander", {.above = 5});
  v("max_wavelength_m", max_wavelength_m, "longest wave of the wander", {.above = 5});
}

}  // namespace tarmac::scenes
