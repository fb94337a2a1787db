/// Where things are at the road tunnel, and its ground. The road runs along x; the tunnel's middle is x = 0.
#pragma once

#include "scenes/paving/paving.h"
#include "scenes/paving/profile.h"
#include "scenes/road_tunnel/options.h"
#include "scenes/scene.h"

namespace tarmac::scenes {

struct RoadTunnelLayout {
  explicit RoadTunnelLayout(const RoadTunnelOptions& options);

  double half_m;                    ///< half the width between the walls
  double height_m;                  ///< of the box
  double portal_m;                  ///< x of the eastern portal
  double depth_m;                   ///< of the road below the land, inside
  double ramp_foot_m, ramp_head_m;  ///< x where the ramp would begin and end without rounding
  double wall_end_m;                ///< the retaining walls end here
  double road_end_m;                ///< the road, and the land
  double rounding_m;                ///< of the grade's changes (RoundedProfile)
  double land_half_m = 110;         ///< the land reaches from -this to this along y
  double wall_m = 0.4, roof_m = 0.9, parapet_m = 0.9;
  double taxiway_half_m = 11.5, taxiway_shoulder_m = 19;
};

/// What wheels follow: the road between the walls, the land beyond them. h = ramps(x) beside(y) + waves(x, y), with
/// beside = 1 between the walls and 0 behind them; the fall between lies inside the walls. C-infinity. Above the tunnel
/// it is the road, not the land on the roof (land_m).
class RoadTunnelGround final : public Ground {
 public:
  RoadTunnelGround(const RoadTunnelOptions& options, std::uint64_t seed);
  double height_m(double x_m, double y_m, Eigen::Vector2d* gradient = nullptr,
                  Eigen::Vector3d* hessian = nullptr) const override;
  /// The land as if there were no road.
  const Ground& land() const { return waves_; }
  const RoadTunnelLayout& layout() const { return layout_; }

 private:
  RoadTunnelLayout layout_;
  RoundedProfile ramps_;
  WavyGround waves_;
};

}  // namespace tarmac::scenes
