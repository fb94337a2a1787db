/// Where the ground part of a motion goes: a path and the speeds along it, and the vehicle's rear axle on it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "core/config.h"
#include "sim/truth/drive_options.h"
#include "sim/truth/paths.h"

namespace tarmac::sim::truth {

/// An axle over ground, with derivatives by time.
struct Planar {
  Jet s;                  ///< [m] distance along the path, for what depends on the distance driven
  Jet x_m, y_m, heading;  ///< all three derivatives
  Jet v_m_s;              ///< speed over ground, where the heading points; two derivatives
  SinCos direction;       ///< of heading
};

/// Everything about a vehicle's motion that needs no suspension.
class Course {
 public:
  virtual ~Course() = default;
  virtual Planar at(double t_s) const = 0;
};

/// The parts of a course, for motions that need more of them than Course tells.
struct CoursePlan {
  PlanarPath path;
  SpeedProfile speed;
  Waves ripple;  ///< b(S) of SpeedProfile [m]
};

/// Reads nothing: `options` are those of `node`, which is asked only where to point when they do not fit together.
/// The path is tabulated to where the vehicle is `beyond_s` after the end.
CoursePlan plan_course(const core::ConfigNode& node, const CourseOptions& options, double end_s, double beyond_s,
                       std::uint64_t seed);

/// The rear axle follows the plan and does not slip: it moves where the vehicle points.
std::unique_ptr<const Course> make_axle_course(CoursePlan plan);
Planar axle_at(const CoursePlan& plan, double t_s);

/// Fails at the item of a list, or at the list when the item is not in the file.
[[noreturn]] void fail_at_item(const core::ConfigNode& node, const char* list, std::size_t index,
                               const std::string& message);

}  // namespace tarmac::sim::truth
