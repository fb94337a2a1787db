#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sim/faults/fault_options.h"
#include "sim/imu/imu_model.h"
#include "sim/lidar/profile_file.h"
#include "sim/rig_options.h"
#include "sim/simulate.h"

namespace tarmac::sim {
namespace {

using namespace core;

std::string timing_text(const lidar::Profile& p) {
  if (p.by_encoder())
    return fmt::format("columns fired at fixed angles; modes (columns x Hz): {}, default {}", fmt::join(p.modes, ", "),
                       p.default_mode);
  if (p.by_prism())
    return fmt::format(
        "a pulse every {} us through wedges of {} and {} degrees (index {}) at {} and {} Hz; {} to {} frames a second, "
        "default {}",
        p.cycle_us, p.prism_wedge_deg[0], p.prism_wedge_deg[1], p.prism_refractive_index, p.prism_hz[0], p.prism_hz[1],
        p.min_rate_hz, p.max_rate_hz, p.default_rate_hz);
  return fmt::format("a firing cycle every {} us{}; {} to {} Hz, default {} Hz", p.cycle_us,
                     p.states.empty() ? "" : fmt::format(", in {} states by turns", p.states.size()), p.min_rate_hz,
                     p.max_rate_hz, p.default_rate_hz);
}

std::string noise_text(const lidar::Profile& p) {
  std::string text;
  for (std::size_t k = 0; k < p.sigma_m.size(); ++k)
    text += fmt::format("{}{} m from {} m", k > 0 ? ", " : "", p.sigma_m[k], p.sigma_from_m[k]);
  return text;
}

bool has_origins(const lidar::Profile& p) {
  return !p.origin_forward_m.empty() || !p.origin_left_m.empty() || !p.origin_up_m.empty();
}

/// Firing times of a channel in each state.
std::string firing_text(const lidar::Profile& p, std::size_t c) {
  if (p.states.empty()) return fmt::format("{:9.3f}", p.firing_us[c]);
  std::string text;
  for (const lidar::AzimuthState& state : p.states)
    text +=
        state.firing_us[c] == lidar::AzimuthState::silent ? "         -" : fmt::format(" {:9.3f}", state.firing_us[c]);
  return text.substr(1);
}

std::string channel_table_text(const lidar::Profile& p) {
  const auto origin = [](const std::vector<double>& values, std::size_t c) { return values.empty() ? 0 : values[c]; };
  std::string text = "  channel  ring  elevation_deg  azimuth_offset_cw_deg  firing_us";
  for (std::size_t k = 1; k < p.states.size(); ++k) text += fmt::format("   state {} ", k);
  text += has_origins(p) ? "  origin forward, left, up [m]\n" : "\n";
  for (std::size_t c = 0; c < p.channels(); ++c) {
    text += fmt::format("  {:7}  {:4}  {:13.4f}  {:21.4f}  {}", c, static_cast<int>(p.ring[c]), p.elevation_deg[c],
                        p.azimuth_offset_cw_deg[c], firing_text(p, c));
    if (has_origins(p))
      text += fmt::format("  {:8.4f} {:8.4f} {:8.4f}", origin(p.origin_forward_m, c), origin(p.origin_left_m, c),
                          origin(p.origin_up_m, c));
    text += "\n";
  }
  return text;
}

}  // namespace

std::vector<CatalogueEntry> lidar_catalogue() {
  std::vector<CatalogueEntry> entries;
  for (const std::string& name : lidar::profile_names()) entries.push_back({name, lidar::profile(name).summary});
  return entries;
}

std::string describe_lidar(const std::string& name) {
  const lidar::Profile p = lidar::is_profile_path(name) ? lidar::load_profile(name) : lidar::profile(name);
  std::string text = fmt::format("{}: {}\n", p.name, p.summary);
  text += fmt::format("  timing      {}\n", timing_text(p));
  if (p.by_prism())
    text += "  sweep       a frame of fixed length; the pattern never repeats\n";
  else
    text += fmt::format("  sweep       begins at azimuth {} deg (clockwise from sensor +x), turns clockwise\n",
                        p.azimuth_start_deg);
  text += fmt::format("  range       {} to {} m, step {} m; {} m on 10 %, {} m on 80 % reflectance\n", p.min_range_m,
                      p.max_range_m, p.range_step_m, p.range_10_percent_m, p.range_80_percent_m);
  text += fmt::format("  noise       {} (1 sigma); constant per channel {} m\n", noise_text(p), p.channel_bias_sigma_m);
  text += fmt::format("  beams from  a circle of radius {} m, {} m above the sensor frame{}\n", p.beam_origin_radius_m,
                      p.beam_origin_height_m, has_origins(p) ? ", and from there as below" : "");
  if (!p.column_window.empty())
    text += fmt::format("  columns     {} to {} only\n", p.column_window[0], p.column_window[1]);
  text += fmt::format("  source      {}\n\n", p.source);
  return text + channel_table_text(p);
}

std::vector<CatalogueEntry> imu_catalogue() {
  std::vector<CatalogueEntry> entries;
  for (const ImuModel& model : imu_models())
    entries.push_back({std::string(model.name), fmt::format("{} ({})", model.title, model.grade)});
  return entries;
}

std::string describe_imu(const std::string& name) {
  return describe_imu_model(imu_model(name));
}

std::vector<OptionDescription> describe_rig_options() {
  RigOptions options;
  options.has_imu = options.body.sized = true;
  return describe_options(options);
}

std::vector<OptionDescription> describe_fault_options() {
  return describe_options(faults::FaultOptions());
}

}  // namespace tarmac::sim
