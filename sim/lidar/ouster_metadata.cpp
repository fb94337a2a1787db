#include "sim/lidar/ouster_metadata.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace tarmac::sim::lidar {
namespace {

using core::ConfigNode;
using core::InputError;

constexpr const char* usual_modes[] = {"512x10", "1024x10", "2048x10", "512x20", "1024x20"};

/// What is read of the metadata, by the names it has there.
struct Beams {
  std::vector<double> beam_altitude_angles, beam_azimuth_angles, beam_to_lidar_transform;
  double lidar_origin_to_beam_origin_mm = -1;
  void visit(core::OptionVisitor& v) {
    v("beam_altitude_angles", beam_altitude_angles, "", {.at_least = -90, .at_most = 90});
    v("beam_azimuth_angles", beam_azimuth_angles, "", {.at_least = -180, .at_most = 180});
    v("beam_to_lidar_transform", beam_to_lidar_transform, "");
    v("lidar_origin_to_beam_origin_mm", lidar_origin_to_beam_origin_mm, "", {.at_least = 0, .at_most = 1000});
  }
};
struct Mount {
  std::vector<double> lidar_to_sensor_transform;
  void visit(core::OptionVisitor& v) { v("lidar_to_sensor_transform", lidar_to_sensor_transform, ""); }
};
struct DataFormat {
  std::vector<double> column_window, pixel_shift_by_row;
  int columns_per_frame = 0, pixels_per_column = 0;
  std::string udp_profile_lidar;
  void visit(core::OptionVisitor& v) {
    v("column_window", column_window, "", {.at_least = 0});
    v("pixel_shift_by_row", pixel_shift_by_row, "");
    v("columns_per_frame", columns_per_frame, "", {.above = 0});
    v("pixels_per_column", pixels_per_column, "", {.above = 0});
    v("udp_profile_lidar", udp_profile_lidar, "");
  }
};
struct Config {
  std::string lidar_mode;
  void visit(core::OptionVisitor& v) { v("lidar_mode", lidar_mode, ""); }
};
struct Product {
  std::string prod_line;
  void visit(core::OptionVisitor& v) { v("prod_line", prod_line, ""); }
};

/// One part of the metadata: a block of its own in the nested layout, the file's top level in the flat one.
template <class Part>
struct Read {
  ConfigNode node;
  Part part;
  Read(const ConfigNode& root, const char* nested, const char* flat) : node(root.child(nested)) {
    if (!node.is_block()) node = flat ? root.child(flat) : root;  // old firmware answers "error: ..." to what it lacks
    if (node.is_block()) node.read(part, node.keys());
  }
};

/// Range and noise of a product line, as in the profiles and data sheets that `source` names.
struct Optics {
  const char* source;
  double min_range_m, max_range_m, range_10_percent_m, range_80_percent_m;
  std::vector<double> sigma_from_m, sigma_m;
  double divergence_mrad;  ///< full width at half maximum
};

struct Metadata {
  ConfigNode root;
  Read<Beams> beams;
  Read<Mount> mount;
  Read<DataFormat> format;
  Read<Config> config;
  Read<Product> product;

  explicit Metadata(const std::filesystem::path& file)
      : root(ConfigNode::load(file.string())),
        beams(block(root), "beam_intrinsics", nullptr),
        mount(root, "lidar_intrinsics", nullptr),
        format(root, "lidar_data_format", "data_format"),
        config(root, "config_params", nullptr),
        product(root, "sensor_info", nullptr) {}

  static const ConfigNode& block(const ConfigNode& root) {
    if (!root.is_block()) root.fail("is no Ouster metadata: a JSON object was expected");
    return root;
  }
  bool is_line(const char* name) const { return product.part.prod_line.starts_with(name); }
};

double usual_beam_origin_mm(const Metadata& metadata) {
  return metadata.is_line("OS-0") ? 27.67 : metadata.is_line("OS-2") ? 13.762 : 15.806;
}
double usual_height_mm(const Metadata& metadata) {
  return metadata.is_line("OS-2") ? 74.296 : 36.18;
}

void check_transform(const ConfigNode& node, const char* name, const std::vector<double>& T) {
  if (T.size() != 16) node.fail_at(name, fmt::format("has {} values; 16 were expected, row by row", T.size()));
  if (T[12] != 0 || T[13] != 0 || T[14] != 0 || T[15] != 1) node.fail_at(name, "the last row must be 0, 0, 0, 1");
}

void read_channels(const Metadata& metadata, Profile& p) {
  const ConfigNode& node = metadata.beams.node;
  const std::vector<double>&altitude = metadata.beams.part.beam_altitude_angles,
        &azimuth = metadata.beams.part.beam_azimuth_angles;
  if (altitude.empty()) node.fail_at("beam_altitude_angles", "is missing: one angle a beam");
  if (azimuth.size() != altitude.size())
    node.fail_at("beam_azimuth_angles",
                 fmt::format("has {} values; beam_altitude_angles has {}", azimuth.size(), altitude.size()));
  const DataFormat& format = metadata.format.part;
  if (format.pixels_per_column > 0 && static_cast<std::size_t>(format.pixels_per_column) != altitude.size())
    metadata.format.node.fail_at("pixels_per_column", fmt::format("is {}, and there are {} beam angles",
                                                                  format.pixels_per_column, altitude.size()));
  if (!format.pixel_shift_by_row.empty() && format.pixel_shift_by_row.size() != altitude.size())
    metadata.format.node.fail_at("pixel_shift_by_row", fmt::format("has {} values, and there are {} beam angles",
                                                                   format.pixel_shift_by_row.size(), altitude.size()));
  for (std::size_t i = 0; i < altitude.size(); ++i) {
    if (altitude[i] == 0 && azimuth[i] == 0) continue;
    p.elevation_deg.push_back(altitude[i]);
    p.azimuth_offset_cw_deg.push_back(azimuth[i]);
    p.firing_us.push_back(0);
    p.ring.push_back(static_cast<double>(altitude.size() - 1 - i));
  }
  if (p.channels() == 0) node.fail_at("beam_altitude_angles", "all angles are 0: the sensor was not calibrated");
}

void read_origin(const Metadata& metadata, Profile& p) {
  const Beams& beams = metadata.beams.part;
  double forward_mm = beams.lidar_origin_to_beam_origin_mm, up_mm = 0;
  if (!beams.beam_to_lidar_transform.empty()) {
    const std::vector<double>& T = beams.beam_to_lidar_transform;
    check_transform(metadata.beams.node, "beam_to_lidar_transform", T);
    const bool only_shifted = T[0] == 1 && T[5] == 1 && T[10] == 1 && T[1] == 0 && T[2] == 0 && T[4] == 0 &&
                              T[6] == 0 && T[8] == 0 && T[9] == 0 && T[7] == 0 && T[3] >= 0;
    if (!only_shifted)
      metadata.beams.node.fail_at("beam_to_lidar_transform", "must be a shift forward and up, without a turn");
    forward_mm = T[3];
    up_mm = T[11];
  } else if (forward_mm < 0) {
    forward_mm = usual_beam_origin_mm(metadata);
    p.source += fmt::format("; beam origin not told: {} mm as usual", forward_mm);
  }
  p.beam_origin_radius_m = forward_mm / 1000;
  p.range_offset_m = std::hypot(forward_mm, up_mm) / 1000;

  std::vector<double> T = metadata.mount.part.lidar_to_sensor_transform;
  if (T.empty()) {
    T = {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, usual_height_mm(metadata), 0, 0, 0, 1};
    p.source += fmt::format("; sensor frame not told: turned by 180 degrees, {} mm below, as usual", T[11]);
  }
  check_transform(metadata.mount.node, "lidar_to_sensor_transform", T);
  const bool turn_about_z = T[2] == 0 && T[6] == 0 && T[8] == 0 && T[9] == 0 && T[10] == 1 && T[0] == T[5] &&
                            T[1] == -T[4] && std::abs(std::hypot(T[0], T[4]) - 1) < 1e-9;
  if (!turn_about_z || T[3] != 0 || T[7] != 0)
    metadata.mount.node.fail_at("lidar_to_sensor_transform", "must be a turn about z and a height");
  const double turn_deg = std::atan2(T[4], T[0]) * 180 / std::numbers::pi;
  p.azimuth_start_deg = turn_deg > 0 ? 360 - turn_deg : -turn_deg;  // encoder 0 looks along the LiDAR frame's x
  p.beam_origin_height_m = (T[11] + up_mm) / 1000;
}

void read_modes(const Metadata& metadata, Profile& p) {
  const std::string& text = metadata.config.part.lidar_mode;
  if (text.empty()) metadata.config.node.fail_at("lidar_mode", "is missing: such as 1024x10");
  Mode mode;
  try {
    mode = parse_mode(text);
  } catch (const InputError& error) {
    metadata.config.node.fail_at("lidar_mode", error.what());
  }
  const DataFormat& format = metadata.format.part;
  if (format.columns_per_frame > 0 && format.columns_per_frame != mode.columns)
    metadata.format.node.fail_at("columns_per_frame",
                                 fmt::format("is {}, and lidar_mode says {}", format.columns_per_frame, text));
  const std::vector<double>& window = format.column_window;
  if (!window.empty() && (window.size() != 2 || std::max(window[0], window[1]) >= mode.columns))
    metadata.format.node.fail_at("column_window",
                                 fmt::format("must be [first, last] column, each from 0 to {}", mode.columns - 1));
  p.timing = "encoder";
  p.default_mode = text;
  const bool whole = window.empty() || (window[0] == 0 && window[1] == mode.columns - 1);
  if (!whole) {
    p.column_window = window;
    p.modes = {text};
    return;
  }
  p.modes.assign(std::begin(usual_modes), std::end(usual_modes));
  if (std::find(p.modes.begin(), p.modes.end(), text) == p.modes.end()) p.modes.push_back(text);
}

void read_beams(const Metadata& metadata, Profile& p) {
  p.source = fmt::format("Ouster metadata of a {}",
                         metadata.product.part.prod_line.empty() ? "sensor" : metadata.product.part.prod_line);
  read_modes(metadata, p);
  read_channels(metadata, p);
  read_origin(metadata, p);
  const bool low_rate = metadata.format.part.udp_profile_lidar.find("RNG15") != std::string::npos;
  p.range_step_m = low_rate ? 0.008 : 0.001;
}

// The revisions differ in their beam origin: OS1 12.163 mm (generation 1), 15.806 (revisions 5 and 6), 16.721 (7); OS0
// 27.67 (5 and 6), 27.116 (7).
Optics optics_of(const Metadata& metadata, const Profile& p) {
  const double origin_mm = p.beam_origin_radius_m * 1000;
  if (metadata.is_line("OS-1")) {
    if (origin_mm < 14) return {"OS1 generation 1", 0.8, 120, 40, 120, {0, 20, 40}, {0.015, 0.03, 0.1}, 2.27};
    const Profile& like = profile(origin_mm < 16.3 ? "ouster-os1-64-gen2" : "ouster-os1-128-rev7");
    return {origin_mm < 16.3 ? "OS1 revisions 5 and 6" : "OS1 revision 7",
            like.min_range_m,
            like.max_range_m,
            like.range_10_percent_m,
            like.range_80_percent_m,
            like.sigma_from_m,
            like.sigma_m,
            3.14};
  }
  if (metadata.is_line("OS-0"))
    return {"OS0 revision 7", origin_mm > 27.4 ? 0.3 : 0.5, 100, 35, 75, {0, 10, 30}, {0.008, 0.02, 0.04}, 6.1};
  throw InputError(
      fmt::format("{}: range and noise of '{}' are not known here; write a profile that says them, with `channels: {}`",
                  metadata.root.file(), metadata.product.part.prod_line,
                  std::filesystem::path(metadata.root.file()).filename().string()));
}

}  // namespace

void read_ouster_beams(const std::filesystem::path& file, Profile& profile) {
  read_beams(Metadata(file), profile);
}

Profile ouster_profile(const std::filesystem::path& file) {
  const Metadata metadata(file);
  Profile p;
  p.name = file.stem().string();
  read_beams(metadata, p);
  const Optics optics = optics_of(metadata, p);
  p.summary = fmt::format("{} channels, from Ouster metadata", p.channels());
  p.source += fmt::format("; range and noise of {}", optics.source);
  p.min_range_m = optics.min_range_m;
  p.max_range_m = optics.max_range_m;
  p.range_10_percent_m = optics.range_10_percent_m;
  p.range_80_percent_m = optics.range_80_percent_m;
  p.threshold_snr = 5.5;
  p.sigma_from_m = optics.sigma_from_m;
  p.sigma_m = optics.sigma_m;
  p.channel_bias_sigma_m = 0.003;
  p.divergence_mrad = {optics.divergence_mrad, optics.divergence_mrad};
  complete(metadata.beams.node, p);
  return p;
}

}  // namespace tarmac::sim::lidar
