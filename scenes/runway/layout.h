/// Where things are at the runway crossing. The runway runs along x with its centre line at y = 0, the taxiway along y
/// at x = 0. Distances in metres.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "scenes/paving/section_ground.h"
#include "scenes/runway/options.h"
#include "scenes/taxiway/section.h"

namespace tarmac::scenes {

struct Rectangle {
  Eigen::Vector2d low_m, high_m;
};

struct RunwayLayout {
  explicit RunwayLayout(const RunwayOptions& options);

  double half_m, shoulder_m;  ///< runway: edge, and outer edge of its shoulder
  double west_m, east_m;      ///< ends of its pavement
  double threshold_m;         ///< x of the threshold
  TaxiwaySection taxiway;
  double south_m, north_m;    ///< ends of the taxiway
  double fillet_m;            ///< radius
  double hold_m;              ///< distance of the holding positions
  double road_y_m;            ///< middle of the road
  double road_half_m = 4;     ///< half its width
  double road_reach_m = 150;  ///< it runs from -reach to reach
  bool has_road;
  Rectangle field;  ///< all of the ground

  /// All pavement but the fillets: runway, taxiway south and north of it, road west and east of the taxiway.
  std::vector<Rectangle> pavements() const;
  /// Corners where taxiway and runway meet, with the direction along the runway and along the taxiway.
  struct Corner {
    Eigen::Vector2d at_m, along_runway, along_taxiway;
  };
  std::vector<Corner> corners() const;
};

std::shared_ptr<const SectionGround> runway_ground(const RunwayOptions& options, std::uint64_t seed);

}  // namespace tarmac::scenes
