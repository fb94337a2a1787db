#include "sim/lidar/profile.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "core/config.h"
#include "core/error.h"

namespace tarmac::sim::lidar {
namespace {

using core::ConfigNode;
using core::InputError;

Mode parse_mode(const std::string& text) {
  Mode mode;
  const std::size_t cross = text.find('x');
  const char* const end = text.data() + text.size();
  const bool good = cross != std::string::npos &&
                    std::from_chars(text.data(), text.data() + cross, mode.columns).ptr == text.data() + cross &&
                    std::from_chars(text.data() + cross + 1, end, mode.rate_hz).ptr == end && mode.columns > 0 &&
                    mode.rate_hz > 0;
  if (!good) throw InputError(fmt::format("'{}' is no mode; COLUMNSxRATE was expected, such as 1024x10", text));
  return mode;
}

void check(const ConfigNode& node, const Profile& p) {
  const auto same_length = [&](const char* name, const std::vector<double>& column, std::size_t n) {
    if (column.size() != n) node.fail_at(name, fmt::format("has {} values; {} were expected", column.size(), n));
  };
  if (p.elevation_deg.empty()) node.fail("elevation_deg is missing: one value a channel");
  same_length("azimuth_offset_cw_deg", p.azimuth_offset_cw_deg, p.channels());
  same_length("firing_us", p.firing_us, p.channels());
  same_length("ring", p.ring, p.channels());
  same_length("sigma_m", p.sigma_m, p.sigma_from_m.size());
  if (p.sigma_m.empty() || p.sigma_from_m.front() != 0) node.fail_at("sigma_from_m", "must begin with 0");
  if (!std::is_sorted(p.sigma_from_m.begin(), p.sigma_from_m.end())) node.fail_at("sigma_from_m", "must ascend");
  if (!(p.min_range_m < p.max_range_m)) node.fail_at("max_range_m", "must be above min_range_m");
  if (!(p.range_10_percent_m < p.range_80_percent_m))
    node.fail_at("range_80_percent_m", "must be above range_10_percent_m");
  if (p.by_encoder() && p.modes.empty()) node.fail_at("modes", "is empty; a sensor with timing: encoder needs one");
  if (!p.by_encoder() && !(p.cycle_us > 0)) node.fail_at("cycle_us", "must be above 0 with timing: clock");
  for (const std::string& mode : p.modes) parse_mode(mode);
}

const std::vector<Profile>& all_profiles() {
  static const std::vector<Profile> profiles = [] {
    std::vector<Profile> result;
    for (const EmbeddedProfile& file : embedded_profiles()) result.push_back(parse_profile(file.name, file.yaml));
    return result;
  }();
  return profiles;
}

}  // namespace

void Profile::visit(core::OptionVisitor& v) {
  v("summary", summary, "one line about the sensor");
  v("source", source, "where the numbers come from");
  v.choice("timing", timing, {"encoder", "clock"}, "columns at fixed angles, or firing cycles at fixed times");
  v("modes", modes, "COLUMNSxRATE (timing: encoder)");
  v("default_mode", default_mode, "one of modes");
  v("default_rate_hz", default_rate_hz, "revolutions a second (timing: clock)", {.above = 0});
  v("min_rate_hz", min_rate_hz, "slowest spin (timing: clock)", {.above = 0});
  v("max_rate_hz", max_rate_hz, "fastest spin (timing: clock)", {.above = 0});
  v("cycle_us", cycle_us, "from one firing cycle to the next (timing: clock)", {.at_least = 0});
  v("azimuth_start_deg", azimuth_start_deg, "where a sweep begins, clockwise from sensor +x",
    {.at_least = 0, .below = 360});
  v("beam_origin_radius_m", beam_origin_radius_m, "circle about the spin axis on which beams start", {.at_least = 0});
  v("beam_origin_height_m", beam_origin_height_m, "of that circle above the sensor frame's origin");
  v("min_range_m", min_range_m, "nearer echoes are not reported", {.at_least = 0});
  v("max_range_m", max_range_m, "farther echoes are not reported", {.above = 0});
  v("range_step_m", range_step_m, "least significant bit of a range", {.above = 0});
  v("range_10_percent_m", range_10_percent_m, "range of a 10 % target at 0.9 probability of detection", {.above = 0});
  v("range_80_percent_m", range_80_percent_m, "the same of an 80 % target", {.above = 0});
  v("threshold_snr", threshold_snr, "amplitude over noise at which half of the echoes are detected", {.above = 0});
  v("sigma_from_m", sigma_from_m, "ranges at which sigma_m changes", {.at_least = 0});
  v("sigma_m", sigma_m, "range noise, one standard deviation", {.at_least = 0});
  v("channel_bias_sigma_m", channel_bias_sigma_m, "spread of the constant range errors of channels", {.at_least = 0});
  v("elevation_deg", elevation_deg, "of each channel, positive up", {.at_least = -90, .at_most = 90});
  v("azimuth_offset_cw_deg", azimuth_offset_cw_deg, "of each channel, clockwise");
  v("firing_us", firing_us, "firing instant of each channel inside the cycle, ascending", {.at_least = 0});
  v("ring", ring, "of each channel, counted from the lowest", {.at_least = 0, .at_most = 65535});
}

double Profile::sigma_at_m(double range_m) const {
  const auto next = std::upper_bound(sigma_from_m.begin(), sigma_from_m.end(), range_m);
  return sigma_m[static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, next - sigma_from_m.begin() - 1))];
}

Profile parse_profile(const std::string& name, const std::string& yaml) {
  const ConfigNode node = ConfigNode::parse(yaml, "sim/lidar/profiles/" + name + ".yaml");
  Profile result;
  result.name = name;
  node.read(result);
  check(node, result);
  return result;
}

std::vector<std::string> profile_names() {
  std::vector<std::string> names;
  for (const Profile& p : all_profiles()) names.push_back(p.name);
  return names;
}

const Profile& profile(const std::string& name) {
  for (const Profile& p : all_profiles())
    if (p.name == name) return p;
  const std::string guess = core::did_you_mean(name, profile_names());
  throw InputError(fmt::format("unknown LiDAR '{}'{}; there are: {}", name,
                               guess.empty() ? "" : fmt::format(", did you mean '{}'?", guess),
                               fmt::join(profile_names(), ", ")));
}

Mode mode_of(const Profile& p, int columns, double rate_hz) {
  if (!p.by_encoder()) {
    const double rate = rate_hz > 0 ? rate_hz : p.default_rate_hz;
    if (columns != 0)
      throw InputError(
          fmt::format("{} fires by the clock: its columns follow from sweep_rate_hz; leave columns out", p.name));
    if (rate < p.min_rate_hz || rate > p.max_rate_hz)
      throw InputError(fmt::format("{} turns at {} to {} Hz, not at {}", p.name, p.min_rate_hz, p.max_rate_hz, rate));
    return {0, rate};
  }
  Mode wanted = parse_mode(p.default_mode);
  if (columns != 0) wanted.columns = columns;
  if (rate_hz > 0) wanted.rate_hz = rate_hz;
  for (const std::string& text : p.modes) {
    const Mode mode = parse_mode(text);
    if (mode.columns == wanted.columns && mode.rate_hz == wanted.rate_hz) return mode;
  }
  throw InputError(fmt::format("{} has no mode of {} columns at {} Hz; its modes are (columns x Hz): {}", p.name,
                               wanted.columns, wanted.rate_hz, fmt::join(p.modes, ", ")));
}

std::string name_of(const Profile& p, const Mode& mode) {
  return p.by_encoder() ? fmt::format("{}x{}", mode.columns, mode.rate_hz) : fmt::format("{} Hz", mode.rate_hz);
}

}  // namespace tarmac::sim::lidar
