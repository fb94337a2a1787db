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
  v("start_offset_ms", start_offset_ms, "when its first sweep begins, from the recording's begin",
    {.at_least = 0, .at_most = 1000});
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
  if (listed)
    v.list("lidars", lidars, "several LiDARs; estimators get one sweep for each of the first one's");
  else
    v.group("lidar", lidars[0], "a LiDAR; or `lidars:`, a list of such blocks");
  if (has_imu) v.group("imu", imu, "an IMU; without this block the rig carries none");
  v("gravity_m_s2", gravity_m_s2, "magnitude of gravity", {.above = 0});
  v.group("body", body, "the vehicle that the sensors stand on, as far as they see it");
}

namespace {

constexpr std::size_t most_lidars = 16;

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

/// Options that the ones beside them leave without effect.
void refuse_idle(const ConfigNode& node, const LidarOptions& lidar) {
  const lidar::SpinOptions usual;
  if (lidar.spin.rate_jitter == 0 && lidar.spin.correlation_s != usual.correlation_s)
    node.child("spin").fail_at("correlation_s", "has no effect here: only with rate_jitter; take it away or add that");
  const lidar::NoiseOptions& noise = lidar.noise;
  if (noise.range_scale == 0 && lidar.beam.range_noise == "snr")
    node.child("beam").fail_at("range_noise",
                               "has no effect here: noise.range_scale is 0; take it away or let there be noise");
}

void refuse_idle(const ConfigNode& node, const ImuOptions& imu) {
  if (imu.sampling != "low-pass" && imu.low_pass_hz != ImuOptions().low_pass_hz)
    node.fail_at(
        "low_pass_hz",
        fmt::format("has no effect here: sampling is {}; take it away or say `sampling: low-pass`", imu.sampling));
}

/// The blocks of the rig's LiDARs; one that is absent where the rig says nothing of any.
std::vector<ConfigNode> lidar_nodes(const ConfigNode& rig) {
  const ConfigNode list = rig.child("lidars");
  if (!list.present()) return {rig.child("lidar")};
  if (rig.child("lidar").present()) list.fail("stands beside lidar; give all LiDARs in one of them");
  std::vector<ConfigNode> nodes = list.items();
  if (nodes.empty()) list.fail("is empty; a rig has at least one LiDAR");
  if (nodes.size() > most_lidars) list.fail(fmt::format("has {} LiDARs; at most {}", nodes.size(), most_lidars));
  return nodes;
}

}  // namespace

RigOptions read_rig(const ConfigNode& rig) {
  RigOptions options;
  options.has_imu = rig.child("imu").present();
  options.body.sized = lidar::gives_size(rig.child("body"));
  options.listed = rig.child("lidars").present();
  const std::vector<ConfigNode> nodes = lidar_nodes(rig);
  options.lidars.resize(nodes.size());
  for (std::size_t k = 0; k < nodes.size(); ++k) options.lidars[k].own_profile = nodes[k].child("profile").present();
  rig.read(options);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    read_sensor(nodes[k], options.lidars[k]);
    read_mode(nodes[k], options.lidars[k]);
    read_column_times(nodes[k], options.lidars[k]);
    lidar::complete_beam(nodes[k].child("beam"), options.lidars[k].beam, options.lidars[k].profile);
    refuse_idle(nodes[k], options.lidars[k]);
    lidar::check_body(rig.child("body"), options.body, options.lidars[k].T_body_lidar);
    try {
      firing_table(options, 1, k);
    } catch (const InputError& error) {
      nodes[k].fail(error.what());
    }
  }
  if (options.has_imu) refuse_idle(rig.child("imu"), options.imu);
  if (options.has_imu && options.imu.rate_hz > imu_model(options.imu.model).max_rate_hz)
    rig.child("imu").fail_at("rate_hz", fmt::format("{} Hz is more than {} gives; at most {} Hz", options.imu.rate_hz,
                                                    options.imu.model, imu_model(options.imu.model).max_rate_hz));
  return options;
}

lidar::FiringTable firing_table(const RigOptions& options, std::uint64_t seed, std::size_t k) {
  const LidarOptions& lidar = options.lidars.at(k);
  if (!lidar.column_times.empty() && !lidar.profile.by_encoder())
    throw InputError(
        fmt::format("column_times: {} fires by the clock: recorded times say nothing about where its head "
                    "was; a sensor with timing: encoder is needed",
                    lidar.model));
  return {lidar.profile,
          {lidar.columns, lidar.sweep_rate_hz},
          lidar::SpinJitter(lidar.spin, seed, fmt::format("lidar{}/spin", k)),
          lidar.replay,
          duration_from_s(1e-3 * lidar.start_offset_ms)};
}

Rig data_sheet(const RigOptions& options) {
  Rig rig;
  rig.gravity_m_s2 = options.gravity_m_s2;
  for (const LidarOptions& lidar : options.lidars) {
    LidarSheet sheet;
    sheet.model = lidar.model;
    sheet.T_body_lidar = lidar.T_body_lidar;
    sheet.sweep_rate_hz = lidar.sweep_rate_hz;
    sheet.min_range_m = lidar.profile.min_range_m;
    sheet.max_range_m = lidar.profile.max_range_m;
    rig.lidars.push_back(sheet);
  }
  if (options.has_imu) rig.imus.push_back(imu_sheet(options.imu));
  return rig;
}

}  // namespace tarmac::sim
