/// What composed can be told: a profile that sets everything, and every single choice beside it.
#pragma once

#include <string>
#include <vector>

#include "estimators/window_odometry/settings.h"

namespace tarmac::estimators {

/// Settings of a window odometry under a profile's name. The front end (sampling, map, residuals, weights, solver) is
/// the same in all profiles: what differs is the motion model, its knots, and whether the IMU has a say.
struct ComposedOptions : WindowOdometrySettings {
  std::string profile = "wnoa";

  ComposedOptions() { set_profile("wnoa"); }
  static const std::vector<std::string>& profiles();
  /// Sets everything to a profile's values.
  void set_profile(const std::string& name);

  void visit(core::OptionVisitor& v) {
    const std::string before = profile;
    v.choice("profile", profile, profiles(),
             "trajectory model, knots and sensors; changes the defaults of everything below");
    if (profile != before) set_profile(std::string(profile));
    visit_groups(v);
  }
};

}  // namespace tarmac::estimators
