/// Paint that aprons have in common.
#pragma once

#include <string>
#include <vector>

#include "scenes/apron/stand_frame.h"
#include "scenes/paving/pavement.h"

namespace tarmac::scenes {

/// Yellow with a black outline on both sides, as on concrete.
void paint_lead_in_line(Painter& p, const std::vector<Eigen::Vector2d>& line, double width_m);
/// Digits only. Readable by who looks north (sign 1) or south (sign -1); `low_left` as that reader sees it.
void paint_number(Painter& p, const std::string& text, const Eigen::Vector2d& low_left, double height_m,
                  double sign = 1);
/// A box filled with diagonals, in the painter's current paint and layer.
void paint_hatch(Painter& p, const Eigen::Vector2d& low, const Eigen::Vector2d& high, double pitch_m);
/// Paint of one stand, in its frame.
struct StandPaint {
  StandFrame frame;
  double half_width_m = 21, length_m = 40;  ///< of the envelope; length from the nose backwards
  double nose_gear_m = 5.5;                 ///< where the stop bar lies, behind the nose
  double taxilane_m = 90;                   ///< from the nose back to the taxilane's centre line
  double lead_in_radius_m = 22;
  double lead_in_from = 1;  ///< side from which the lead-in line comes, along the stand's x
  std::string number;       ///< digits
};
/// Lead-in line, stop bars, number, restraint line around the envelope, staging boxes at its right edge.
void paint_stand(Painter& p, const StandPaint& stand);
/// A road of two lanes along x: edges, dashed centre line, and blocks along the edges where aircraft cross.
void paint_road(Painter& p, double centre_y, double west, double east, double lane_width_m,
                const std::vector<double>& crossings_x_m);
/// Edges and dashed centre line of a road of two lanes along y.
void paint_cross_road(Painter& p, double centre_x, double south, double north, double lane_width_m);

}  // namespace tarmac::scenes
