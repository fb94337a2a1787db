#include "sim/rig_options.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/error.h"
#include "sim/lidar/profile_file.h"

namespace tarmac::sim {

using namespace core;

LidarOptions::LidarOptions() {
  T_body_lidar.translation().z() = 1.9;
}

void LidarOptions::visit(OptionVisitor& v) {
  v("model", model,
    "the sensor: a name of `tarmac list sensors`, or the path of a profile (.yaml) or of Ouster metadata (.json)");
  v("columns", columns,
    "firings of each channel a revolution; 0 = the model's default (always 0 where a clock fires them)",
    {.at_least = 0});
  v("sweep_rate_hz", sweep_rate_hz, "revolutions a second; 0 = the model's default", {.at_least = 0});
  v("T_body_lidar", T_body_lidar, "pose of the sensor frame in the body frame (x forward, y left, z up)");
  v.group("noise", noise, "errors of the measurement");
  v.group("spin", spin, "how unevenly the head turns");
  v.group("beam", beam, "what a beam is beyond a line with one echo");
  v("column_times", column_times,
    "fire the columns at recorded times: the path of a plain folder or of a CSV file sweep,column,t_ns");
  v.list("replay", replay, "the same, written out");
  if (own_profile) v.group("profile", profile, "a sensor of the scenario's own, written out; `model` is then its name");
}

void RigOptions::visit(OptionVisitor& v) {
  v.group("lidar", lidar, "a spinning LiDAR");
  if (has_imu) v.group("imu", imu, "an IMU; without this block the rig carries none");
  v("gravity_m_s2", gravity_m_s2, "magnitude of gravity", {.above = 0});
  v.group("body", body, "the vehicle that the sensors stand on, as far as they see it");
}

namespace {

std::filesystem::path path_of(const ConfigNode& node, const std::string& text) {
  if (node.given_by_set()) return text;
  return std::filesystem::path(node.file()).parent_path() / text;  // an absolute one stays as it is
}

// An error of the file that a line of the scenario names tells both places.
template <class Read>
auto from_file(const ConfigNode& node, const Read& read) {
  try {
    return read();
  } catch (const InputError& error) {
    node.fail(error.what());
  }
}

void read_sensor(const ConfigNode& node, LidarOptions& lidar) {
  const ConfigNode model = node.child("model");
  if (lidar.own_profile) {
    lidar.profile.name = lidar.model;
    lidar::complete(node.child("profile"), lidar.profile);
  } else if (lidar::is_profile_path(lidar.model)) {
    lidar.profile = from_file(model, [&] { return lidar::load_profile(path_of(model, lidar.model)); });
    lidar.model = lidar.profile.name;
    lidar.own_profile = true;
  } else {
    try {
      lidar.profile = lidar::profile(lidar.model);
    } catch (const InputError& error) {
      node.fail_at("model", error.what());
    }
  }
}

void read_mode(const ConfigNode& node, LidarOptions& lidar) {
  try {
    const lidar::Mode mode = lidar::mode_of(lidar.profile, lidar.columns, lidar.sweep_rate_hz);
    lidar.columns = mode.columns;
    lidar.sweep_rate_hz = mode.rate_hz;
  } catch (const InputError& error) {
    node.fail(error.what());
  }
}

void read_column_times(const ConfigNode& node, LidarOptions& lidar) {
  if (lidar.column_times.empty()) return;
  const ConfigNode times = node.child("column_times");
  if (!lidar.replay.empty()) times.fail("stands beside replay; give one of them");
  if (!lidar.profile.by_encoder()) return;  // firing_table says why not
  const lidar::FiringTable firing(lidar.profile, {lidar.columns, lidar.sweep_rate_hz});
  lidar.replay = from_file(times, [&] {
    return lidar::load_column_times(path_of(times, lidar.column_times),
                                    static_cast<std::size_t>(firing.sweep(0).cycles));
  });
  lidar.column_times.clear();
}

}  // namespace

RigOptions read_rig(const ConfigNode& rig) {
  RigOptions options;
  options.has_imu = rig.child("imu").present();
  const ConfigNode lidar = rig.child("lidar");
  options.lidar.own_profile = lidar.child("profile").present();
  rig.read(options);
  read_sensor(lidar, options.lidar);
  read_mode(lidar, options.lidar);
  read_column_times(lidar, options.lidar);
  lidar::check_beam(lidar.child("beam"), options.lidar.beam, options.lidar.profile);
  lidar::check_body(rig.child("body"), options.body, options.lidar.T_body_lidar);
  try {
    firing_table(options, 1);
  } catch (const InputError& error) {
    lidar.fail(error.what());
  }
  if (options.has_imu && options.imu.rate_hz > imu_model(options.imu.model).max_rate_hz)
    rig.child("imu").fail_at("rate_hz", fmt::format("{} Hz is more than {} gives; at most {} Hz", options.imu.rate_hz,
                                                    options.imu.model, imu_model(options.imu.model).max_rate_hz));
  return options;
}

lidar::FiringTable firing_table(const RigOptions& options, std::uint64_t seed) {
  const LidarOptions& lidar = options.lidar;
  if (!lidar.column_times.empty() && !lidar.profile.by_encoder())
    throw InputError(
        fmt::format("column_times: {} fires by the clock: recorded times say nothing about where its head "
                    "was; a sensor with timing: encoder is needed",
                    lidar.model));
  return {lidar.profile,
          {lidar.columns, lidar.sweep_rate_hz},
          lidar::SpinJitter(lidar.spin, seed, "lidar0/spin"),
          lidar.replay};
}

Rig data_sheet(const RigOptions& options) {
  const lidar::Profile& profile = options.lidar.profile;
  LidarSheet lidar;
  lidar.model = options.lidar.model;
  lidar.T_body_lidar = options.lidar.T_body_lidar;
  lidar.sweep_rate_hz = options.lidar.sweep_rate_hz;
  lidar.min_range_m = profile.min_range_m;
  lidar.max_range_m = profile.max_range_m;
  Rig rig;
  rig.gravity_m_s2 = options.gravity_m_s2;
  rig.lidars.push_back(lidar);
  if (options.has_imu) rig.imus.push_back(imu_sheet(options.imu));
  return rig;
}

}  // namespace tarmac::sim
