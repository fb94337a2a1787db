#include "estimators/composed/options.h"

namespace tarmac::estimators {
namespace {

/// A profile's name is its model, its knots, and `-imu` and `-offset` where it has those.
struct Profile {
  const char* name;
  const char* model;
  const char* knots;
  double spacing_s;
  const char* imu;
  bool offset;
};

constexpr Profile kProfiles[] = {
    {"rigid", "rigid", "per-sweep", 0.1, "none", false},
    {"constant-velocity", "constant-velocity", "per-sweep", 0.1, "none", false},
    {"two-pose-slerp", "two-pose-slerp", "per-sweep", 0.1, "none", false},
    {"two-pose-screw", "two-pose-screw", "per-sweep", 0.1, "none", false},
    {"spline-100ms", "spline", "uniform", 0.1, "none", false},
    {"spline-50ms", "spline", "uniform", 0.05, "none", false},
    {"spline-25ms", "spline", "uniform", 0.025, "none", false},
    {"spline-per-sweep", "spline", "per-sweep", 0.1, "none", false},
    {"wnoa", "wnoa", "per-sweep", 0.1, "none", false},
    {"wnoj", "wnoj", "per-sweep", 0.1, "none", false},
    {"singer", "singer", "per-sweep", 0.1, "none", false},
    {"two-pose-slerp-imu", "two-pose-slerp", "per-sweep", 0.1, "gyro", false},
    {"two-pose-screw-imu", "two-pose-screw", "per-sweep", 0.1, "gyro", false},
    {"spline-100ms-imu", "spline", "uniform", 0.1, "gyro-accel", false},
    {"spline-50ms-imu", "spline", "uniform", 0.05, "gyro-accel", false},
    {"spline-25ms-imu", "spline", "uniform", 0.025, "gyro-accel", false},
    {"spline-nonuniform-imu", "spline", "imu-excitation", 0.1, "gyro-accel", false},
    {"wnoa-imu", "wnoa", "uniform", 0.05, "gyro-accel", false},
    {"wnoj-imu", "wnoj", "uniform", 0.05, "gyro-accel", false},
    {"singer-imu", "singer", "uniform", 0.05, "gyro-accel", false},
    {"spline-25ms-imu-offset", "spline", "uniform", 0.025, "gyro-accel", true},
    {"singer-imu-offset", "singer", "uniform", 0.05, "gyro-accel", true},
};

}  // namespace

const std::vector<std::string>& ComposedOptions::profiles() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Profile& profile : kProfiles) all.emplace_back(profile.name);
    return all;
  }();
  return names;
}

void ComposedOptions::set_profile(const std::string& name) {
  static_cast<WindowOdometrySettings&>(*this) = WindowOdometrySettings();
  profile = name;
  for (const Profile& p : kProfiles) {
    if (p.name != name) continue;
    motion.model = p.model;
    motion.knots = p.knots;
    motion.knot_spacing_s = p.spacing_s;
    imu.use = p.imu;
    imu.free_time_offset = p.offset;
  }
  if (motion.is_sweepwise()) window.sweeps = 1;
  if (motion.model == "wnoa" && imu.accel()) imu.accel_as_increments = true;
  // Jerk instead of acceleration drives these two.
  if (motion.model == "wnoj") {
    motion.process_translation = 400;
    motion.process_rotation = 50;
  }
  if (motion.model == "singer") {
    motion.process_translation = 4e4;
    motion.process_rotation = 5e3;
  }
}

}  // namespace tarmac::estimators
