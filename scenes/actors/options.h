/// One entry of `actors:` in a scenario's `scene:` block.
#pragma once

#include <string>
#include <vector>

#include "core/config.h"
#include "core/options.h"
#include "scenes/paths/path_options.h"

namespace tarmac::scenes {

/// A place to pass, optionally at a time.
struct WayPoint {
  double x_m = 0, y_m = 0;
  double at_s = -1;  ///< -1: whenever the speeds lead there
  void visit(core::OptionVisitor& v);
};

struct ActorOptions {
  std::string kind = "vehicle";  ///< one of actor_kinds()
  std::string name;              ///< after reading never empty: the kind and its number in the list
  std::string type;              ///< aircraft, or equipment; after reading never empty where the kind has types

  StartOptions start;
  std::vector<PathPiece> path;
  std::vector<WayPoint> way_points;  ///< instead of start and path
  double corner_radius_m = 8;        ///< of the turns at way points
  double rest_s = 0;
  std::vector<SpeedEvent> speed;
  double stop_peak_m_s2 = 0.8;

  // pushback
  std::string tractor = "pushback-tractor", towbar = "towbar";
  // baggage-train
  int carts = 4;
  // marshaller
  double arms_raised_from_s = -1, arms_raised_until_s = -1, beckon_hz = 0.8;
  // controls
  Eigen::Vector3d position_m{0, 0, 0}, velocity_m_s{0, 0, 0}, acceleration_m_s2{0, 0, 0}, size_m{1, 1, 1};
  double heading_deg = 0, turn_deg_s = 0, turn_deg_s2 = 0;

  void visit(core::OptionVisitor& v);
};

struct ActorKind {
  const char* name;
  const char* summary;
  const char* default_type;  ///< nullptr: the kind has no types
  double max_speed_m_s;
  double max_acceleration_m_s2;
};
const std::vector<ActorKind>& actor_kinds();
const ActorKind& actor_kind(const std::string& name);

/// `node` is the list. Throws InputError with file and line.
std::vector<ActorOptions> read_actor_options(const core::ConfigNode& node);

}  // namespace tarmac::scenes
