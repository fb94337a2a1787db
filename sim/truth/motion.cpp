#include "sim/truth/motion.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "core/error.h"
#include "sim/truth/constant_twist.h"
#include "sim/truth/drive.h"
#include "sim/truth/drive_options.h"
#include "sim/truth/drone.h"
#include "sim/truth/function_class.h"
#include "sim/truth/handheld.h"
#include "sim/truth/handheld_options.h"
#include "sim/truth/recorded.h"
#include "sim/truth/towed.h"
#include "sim/truth/vehicles.h"

namespace tarmac::sim::truth {

namespace {

using namespace core;
using Motion = std::shared_ptr<const SmoothTrajectory>;

template <class Options>
Options read(const ConfigNode& node) {
  Options options;
  node.read(options, {"kind"});
  return options;
}

Motion make_twist(const ConfigNode& node, Duration duration, std::shared_ptr<const scenes::Ground>, std::uint64_t) {
  return make_constant_twist(read<ConstantTwistOptions>(node), duration);
}

Motion make_straight(const ConfigNode& node, Duration duration, std::shared_ptr<const scenes::Ground>, std::uint64_t) {
  const auto options = read<StraightOptions>(node);
  const Eigen::Vector3d v_body = options.start.linear().transpose() * options.v_world_m_s;
  return make_constant_twist({options.start, v_body, Eigen::Vector3d::Zero()}, duration);
}

Motion make_from_path(const ConfigNode& node, Duration duration, std::shared_ptr<const scenes::Ground>, std::uint64_t) {
  return make_recorded(node, duration);
}

Motion make_still(const ConfigNode& node, Duration duration, std::shared_ptr<const scenes::Ground>, std::uint64_t) {
  return make_constant_twist({.start = read<StillOptions>(node).start}, duration);
}

BodyBox van(const ConfigNode&) {
  return {};
}

BodyBox box_of_drive(const ConfigNode& node) {
  return vehicle_box(read_drive_options(node).vehicle);
}

/// A deck from the drawbar's hitch to behind the axle, with what stands on it.
BodyBox box_of_towed(const ConfigNode& node) {
  constexpr double rear_overhang_m = 0.9;
  return {.length_m = read_towed_options(node).links.back().length_m + rear_overhang_m,
          .width_m = 1.6,
          .rear_overhang_m = rear_overhang_m,
          .height_m = 2};
}

/// Somebody of 1.8 m who stands `ahead_m` from the device, whichever way it looks.
BodyBox box_of_handheld(const ConfigNode& node) {
  const HoldOptions hold = read_handheld_options(node).hold;
  const double around_m = hold.ahead_m + 0.2;
  return {.length_m = 2 * around_m,
          .width_m = 2 * around_m,
          .rear_overhang_m = around_m,
          .height_m = std::max(0.2, 1.8 - hold.height_m),
          .below_m = hold.height_m,
          .upright = true};
}

/// A multirotor with its rotors' circles.
BodyBox box_of_drone(const ConfigNode& node) {
  const double legs_m = read_drone_options(node).take_off.legs_m;
  return {.length_m = 1.1, .width_m = 1.1, .rear_overhang_m = 0.55, .height_m = 0.25, .below_m = legs_m};
}

/// The text of what `reader` makes of the block.
template <auto reader>
std::string resolve(const ConfigNode& node) {
  return write_options(reader(node), 2);
}

template <class Options>
std::vector<OptionDescription> describe() {
  return describe_options<Options>();
}

struct Kind {
  const char* name;
  const char* summary;
  Motion (*make)(const ConfigNode&, Duration, std::shared_ptr<const scenes::Ground>, std::uint64_t);
  std::string (*resolve)(const ConfigNode&);
  std::vector<OptionDescription> (*describe)();
  BodyBox (*box)(const ConfigNode&);
  const char* function_class;
};

/// A new kind of motion is one line here.
constexpr std::array kinds{
    Kind{"drive", "a road vehicle that follows a path, brakes, sways on its suspension and shakes", make_drive,
         resolve<read_drive_options>, describe<DriveOptions>, box_of_drive,
         "speeds and curvatures change by (1 + tanh(1/(1-u) - 1/u over 2))/2, infinitely differentiable and not "
         "analytic; "
         "sines of the distance for ripple, wander, road and tyres, and of the time for the engine; position by "
         "quadrature; heave, pitch and roll solve an oscillator's equation (degree 7 every ms)"},
    Kind{"towed", "a trailer behind a tug, the sensor on its last link", make_towed, resolve<read_towed_options>,
         describe<TowedOptions>, box_of_towed,
         "the tug as a drive; the links' headings solve the equation of axles that do not slip, over the distance "
         "(degree "
         "7 every 2 cm of it), and the place follows from them; heave, pitch and roll as a drive's"},
    Kind{"handheld", "a device in the hands of somebody who walks or runs", make_handheld,
         resolve<read_handheld_options>, describe<HandheldOptions>, box_of_handheld,
         "path and speed as a drive's; sines of the steps' phase, which is a sum of sines of the distance; strikes are "
         "damped sines that swell and end by the infinitely differentiable step; tremor and posture are sines of the "
         "time"},
    Kind{"drone", "a multirotor that takes off and follows a path in gusts", make_drone, resolve<read_drone_options>,
         describe<DroneOptions>, box_of_drone,
         "path and speed as a drive's, heights by the infinitely differentiable step; gusts and what the drone gives "
         "way "
         "to them are sines of the time; the attitude is that of the thrust: a quotient of these; rotors are sines"},
    Kind{"recorded", "poses of a TUM or CSV file, followed smoothly", make_from_path, resolve<read_recorded_options>,
         describe<RecordedOptions>, van,
         "polynomials of degree 7 through eight recorded poses each, blended around every recorded time by the "
         "infinitely "
         "differentiable step over windows whose ends lie on no regular grid; quaternions divided by their length"},
    Kind{"constant-twist", "one screw motion: a control", make_twist, resolve<read<ConstantTwistOptions>>,
         describe<ConstantTwistOptions>, van,
         "T(0) Exp(t xi): the class of two-pose screw interpolation, hence a control and not a judge"},
    Kind{"straight", "one velocity: a control", make_straight, resolve<read<StraightOptions>>,
         describe<StraightOptions>, van,
         "linear in time: the class of every interpolation, hence a control and not a judge"},
    Kind{"still", "no motion: a control", make_still, resolve<read<StillOptions>>, describe<StillOptions>, van,
         "constant: the class of every interpolation, hence a control and not a judge"},
};

const Kind* find(const std::string& name) {
  const auto it = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& kind) { return kind.name == name; });
  return it == kinds.end() ? nullptr : &*it;
}

std::string unknown(const std::string& name) {
  const std::string near = did_you_mean(name, motion_kinds());
  return fmt::format("there is no motion '{}'{}; there are {}", name,
                     near.empty() ? "" : fmt::format(" (did you mean {}?)", near), fmt::join(motion_kinds(), ", "));
}

const Kind& kind_of(const ConfigNode& node) {
  const std::string name = node.child("kind").scalar("kind");
  const Kind* kind = find(name);
  if (!kind) node.fail_at("kind", unknown(name));
  return *kind;
}

const Kind& kind_named(const std::string& name) {
  const Kind* kind = find(name);
  if (!kind) throw InputError(unknown(name));
  return *kind;
}

}  // namespace

std::shared_ptr<const SmoothTrajectory> make_motion(const ConfigNode& node, Duration duration,
                                                    std::shared_ptr<const scenes::Ground> ground, std::uint64_t seed) {
  const Kind& kind = kind_of(node);
  if (duration <= Duration::zero()) throw InputError("a motion needs a duration above 0 s");
  return kind.make(node, duration, std::move(ground), seed);
}

std::string resolve_motion(const ConfigNode& node) {
  const Kind& kind = kind_of(node);
  return fmt::format("  kind: {}\n{}", kind.name, kind.resolve(node));
}

BodyBox body_box(const ConfigNode& node) {
  return kind_of(node).box(node);
}

std::vector<std::string> motion_kinds() {
  std::vector<std::string> names;
  for (const Kind& kind : kinds) names.emplace_back(kind.name);
  return names;
}

std::string motion_summary(const std::string& kind) {
  return kind_named(kind).summary;
}

std::vector<OptionDescription> describe_motion(const std::string& kind) {
  return kind_named(kind).describe();
}

std::string motion_function_class(const std::string& kind) {
  return kind_named(kind).function_class;
}

}  // namespace tarmac::sim::truth
