/// What is known of a scanning LiDAR, as data: profiles/NAME.yaml, one file a sensor, or a file of the user's.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/options.h"

namespace tarmac::sim::lidar {

/// When the channels fire in one of the states that a clock-driven head goes through, cycle after cycle.
struct AzimuthState {
  static constexpr double silent = -1;  ///< in place of a time: the channel does not fire in this state
  std::vector<double> firing_us;        ///< one value a channel
  void visit(core::OptionVisitor& v);
};

/// Angles: azimuth is clockwise seen from above, 0 = sensor +x (forward); elevation is positive up.
/// Sensor frame: x forward, y left, z up. Channels stand in firing order (with `states`: in any).
struct Profile {
  std::string name;
  std::string summary;
  std::string source;
  /// "encoder": columns at fixed angles. "clock": a firing cycle every cycle_us. "prism": a pulse every cycle_us
  /// through two turning wedges (prism.h); a sweep is a frame of fixed length, which repeats nothing.
  std::string timing;
  std::vector<std::string> modes;  ///< of encoder timing: COLUMNSxRATE
  std::string default_mode;
  double default_rate_hz = 10, min_rate_hz = 5, max_rate_hz = 20;  ///< of clock timing
  double cycle_us = 0;
  std::vector<AzimuthState> states;  ///< of clock timing: cycle n is in state n mod their number; empty: firing_us
  std::vector<double> prism_wedge_deg, prism_hz, prism_start_deg;  ///< of prism timing: first wedge, second wedge
  double prism_refractive_index = 1.51;
  std::vector<double> column_window;  ///< of encoder timing: {first, last} column that is fired; empty: all
  double azimuth_start_deg = 180;
  double beam_origin_radius_m = 0, beam_origin_height_m = 0, range_offset_m = 0;
  double min_range_m = 0, max_range_m = 0, range_step_m = 0;
  double range_10_percent_m = 0, range_80_percent_m = 0;
  double threshold_snr = 0;
  std::vector<double> sigma_from_m, sigma_m;
  double channel_bias_sigma_m = 0;
  std::vector<double>
      divergence_mrad;  ///< full width of a beam at half its intensity, horizontal and vertical; or none
  double pulse_length_ns = 5;
  std::vector<double> elevation_deg, azimuth_offset_cw_deg, firing_us, ring;  ///< one value a channel
  /// One value a channel, or none: where its beam starts, from the head's circle, along and left of the beam's own
  /// heading, and up.
  std::vector<double> origin_forward_m, origin_left_m, origin_up_m;

  void visit(core::OptionVisitor& v);
  std::size_t channels() const { return elevation_deg.size(); }
  bool by_encoder() const { return timing == "encoder"; }
  bool by_prism() const { return timing == "prism"; }
  double sigma_at_m(double range_m) const;
};

/// The values of a channel that stand in a table of their own (`channels: table.csv`) or in the profile.
struct ChannelColumn {
  const char* name;
  std::vector<double> Profile::*values;
};
std::span<const ChannelColumn> channel_columns();

struct EmbeddedProfile {
  const char* name;
  const char* yaml;
};
/// The files under profiles/, as they were when the library was built.
std::span<const EmbeddedProfile> embedded_profiles();

/// Fills in what may be left out (firing_us: all at once; ring: counted from the lowest beam; default_mode where there
/// is one mode only) and throws InputError (file, line, field) for a sensor that could not be: missing fields, tables
/// of unequal length, channels out of firing order, cycles that overlap, rings that stand twice, modes that are none,
/// states in which nothing fires, wedges that let no light out.
/// @param node  the block that was read, for the errors
void complete(const core::ConfigNode& node, Profile& profile);

/// Throws InputError as complete() does, or when the text is no profile.
Profile parse_profile(const std::string& name, const std::string& yaml);
std::vector<std::string> profile_names();
/// Throws InputError listing what there is, with did-you-mean.
const Profile& profile(const std::string& name);

/// How a sensor is run: columns a revolution (encoder timing; 0 for clock timing) and revolutions a second.
struct Mode {
  int columns = 0;
  double rate_hz = 10;
};
/// "1024x10"; throws InputError when the text is no mode.
Mode parse_mode(const std::string& text);
/// Fills in the sensor's default where 0 is given. Throws InputError listing the modes when the sensor has no such one.
Mode mode_of(const Profile& profile, int columns, double rate_hz);
/// "1024x10"
std::string name_of(const Profile& profile, const Mode& mode);

}  // namespace tarmac::sim::lidar
