/// What steam-lo and steam-lio can be told: a profile of the publication's configurations, and every choice beside it.
#pragma once

#include <string>

#include "estimators/window_odometry/settings.h"

namespace tarmac::estimators {

/// Values of the published configurations: `kitti` (a car), `newer-college` (handheld, small rooms).
struct SteamLoOptions : WindowOdometrySettings {
  std::string profile = "kitti";

  SteamLoOptions() { set_profile("kitti"); }
  void set_profile(const std::string& name);
  void visit(core::OptionVisitor& v);
};

/// `boreas` (a car), `newer-college`; `newer-college-singer`: Singer's prior and the accelerometer sample by sample.
struct SteamLioOptions : WindowOdometrySettings {
  std::string profile = "boreas";

  SteamLioOptions() { set_profile("boreas"); }
  void set_profile(const std::string& name);
  void visit(core::OptionVisitor& v);
};

}  // namespace tarmac::estimators
