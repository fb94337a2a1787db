#include "sim/lidar/profile.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "core/config.h"
#include "core/error.h"
#include "sim/lidar/prism.h"

namespace tarmac::sim::lidar {
namespace {

using core::ConfigNode;
using core::InputError;

void check_needed(const ConfigNode& node, const Profile& p) {
  const auto needed = [&](const char* name, bool there, const char* what) {
    if (!there) node.fail_at(name, fmt::format("is missing: {}", what));
  };
  needed("timing", !p.timing.empty(), "encoder, clock or prism");
  needed("elevation_deg", p.channels() > 0, "one value a channel");
  needed("azimuth_offset_cw_deg", !p.azimuth_offset_cw_deg.empty(), "one value a channel");
  needed("max_range_m", p.max_range_m > 0, "the farthest range that is reported");
  needed("range_step_m", p.range_step_m > 0, "the least significant bit of a range");
  needed("range_10_percent_m", p.range_10_percent_m > 0, "the range at which a 10 % target is seen");
  needed("range_80_percent_m", p.range_80_percent_m > 0, "the range at which an 80 % target is seen");
  needed("threshold_snr", p.threshold_snr > 0, "amplitude over noise at which half of the echoes are detected");
  needed("sigma_from_m", !p.sigma_from_m.empty(), "ranges at which sigma_m changes, from 0 on");
  needed("sigma_m", !p.sigma_m.empty(), "range noise from each of sigma_from_m on");
  if (p.by_encoder())
    needed("modes", !p.modes.empty(), "a sensor with timing: encoder has at least one, such as 1024x10");
  else
    needed("cycle_us", p.cycle_us > 0,
           p.by_prism() ? "the time from one pulse to the next"
                        : "a sensor with timing: clock fires all its channels once in that time");
  if (!p.by_prism()) return;
  needed("prism_wedge_deg", !p.prism_wedge_deg.empty(), "the angles of the two wedges");
  needed("prism_hz", !p.prism_hz.empty(), "revolutions a second of the two wedges, negative for the other way round");
}

std::vector<double> rings_by_elevation(const std::vector<double>& elevation_deg) {
  std::vector<std::size_t> order(elevation_deg.size());
  for (std::size_t c = 0; c < order.size(); ++c) order[c] = c;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return elevation_deg[a] < elevation_deg[b]; });
  std::vector<double> ring(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) ring[order[k]] = static_cast<double>(k);
  return ring;
}

void check_channels(const ConfigNode& node, const Profile& p) {
  for (const ChannelColumn& column : channel_columns()) {
    const std::vector<double>& values = p.*column.values;
    const bool optional = std::string_view(column.name).starts_with("origin_");
    const bool by_state = column.values == &Profile::firing_us && !p.states.empty();
    if (by_state && !values.empty())
      node.fail_at(column.name, "stands beside states, each of which has its own firing_us; remove one");
    if (values.size() != p.channels() && !((optional || by_state) && values.empty()))
      node.fail_at(column.name, fmt::format("has {} values; {} were expected", values.size(), p.channels()));
  }
  for (std::size_t c = 1; c < p.firing_us.size(); ++c)
    if (p.firing_us[c] < p.firing_us[c - 1])
      node.fail_at("firing_us",
                   fmt::format("channel {} fires at {} us, before channel {} at {} us: list the channels in "
                               "firing order",
                               c, p.firing_us[c], c - 1, p.firing_us[c - 1]));
  std::vector<double> rings = p.ring;
  std::sort(rings.begin(), rings.end());
  const auto twice = std::adjacent_find(rings.begin(), rings.end());
  if (twice != rings.end()) node.fail_at("ring", fmt::format("{} stands twice; every channel has its own", *twice));
  for (const double ring : rings)
    if (ring != std::floor(ring)) node.fail_at("ring", fmt::format("{} must be a whole number", ring));
}

void check_firing(const ConfigNode& node, const std::vector<double>& firing_us, double cycle_us,
                  const std::string& when) {
  const auto [first, last] = std::minmax_element(firing_us.begin(), firing_us.end());
  if (*last - *first >= cycle_us)
    node.fail_at("firing_us", fmt::format("the channels take {} us to fire, and the next cycle begins after {} us{}",
                                          *last - *first, cycle_us, when));
}

void check_states(const ConfigNode& node, const Profile& p) {
  std::vector<bool> fires(p.channels(), false);
  double last_us = -std::numeric_limits<double>::infinity();  // of the state before, in this one's time
  const auto check_state = [&](std::size_t k, bool again) {
    const std::vector<ConfigNode> items = node.child("states").items();
    const ConfigNode& state = k < items.size() ? items[k] : node;
    const std::vector<double>& firing_us = p.states[k].firing_us;
    if (firing_us.size() != p.channels())
      state.fail_at("firing_us", fmt::format("has {} values; {} were expected (-1 where a channel is silent)",
                                             firing_us.size(), p.channels()));
    std::vector<double> shots;
    for (std::size_t c = 0; c < p.channels(); ++c) {
      if (firing_us[c] == AzimuthState::silent) continue;
      if (firing_us[c] < 0)
        state.fail_at("firing_us", fmt::format("channel {}: {} us; a time from 0 on was expected, or -1 where the "
                                               "channel is silent",
                                               c, firing_us[c]));
      fires[c] = true;
      shots.push_back(firing_us[c]);
    }
    if (shots.empty()) state.fail_at("firing_us", "no channel fires in this state");
    check_firing(state, shots, p.cycle_us, "");
    const auto [first, last] = std::minmax_element(shots.begin(), shots.end());
    if (*first <= last_us - p.cycle_us)
      state.fail_at("firing_us",
                    fmt::format("begins at {} us, before the state before it has ended (at {} us of this one's time)",
                                *first, last_us - p.cycle_us));
    last_us = again ? last_us : *last;
  };
  for (std::size_t k = 0; k < p.states.size(); ++k) check_state(k, false);
  check_state(0, true);
  const auto never = std::find(fires.begin(), fires.end(), false);
  if (never != fires.end())
    node.fail_at("states", fmt::format("channel {} fires in none of them", never - fires.begin()));
}

void check_encoder_timing(const ConfigNode& node, const Profile& p) {
  bool known = false;
  for (const std::string& text : p.modes) {
    Mode mode;
    try {
      mode = parse_mode(text);
    } catch (const InputError& error) {
      node.fail_at("modes", error.what());
    }
    check_firing(node, p.firing_us, 1e6 / (mode.columns * mode.rate_hz), fmt::format(" in mode {}", text));
    known = known || text == p.default_mode;
    if (p.column_window.empty()) continue;
    const bool whole = p.column_window.size() == 2 && p.column_window[0] == std::floor(p.column_window[0]) &&
                       p.column_window[1] == std::floor(p.column_window[1]);
    if (!whole || std::max(p.column_window[0], p.column_window[1]) >= mode.columns)
      node.fail_at("column_window",
                   fmt::format("must be [first, last] column, each from 0 to {} in mode {}", mode.columns - 1, text));
  }
  if (!known)
    node.fail_at("default_mode", fmt::format("'{}' is not one of modes: {}", p.default_mode, fmt::join(p.modes, ", ")));
}

void check_prism_timing(const ConfigNode& node, const Profile& p) {
  const auto pair = [&](const char* name, const std::vector<double>& values) {
    if (values.size() != 2)
      node.fail_at(name, fmt::format("has {} values; one for each of the two wedges was expected", values.size()));
  };
  pair("prism_wedge_deg", p.prism_wedge_deg);
  pair("prism_hz", p.prism_hz);
  pair("prism_start_deg", p.prism_start_deg);
  if (p.channels() != 1 || p.elevation_deg[0] != 0 || p.azimuth_offset_cw_deg[0] != 0 || p.firing_us[0] != 0)
    node.fail_at("elevation_deg",
                 "a sensor with timing: prism has one channel, along the wedges' axis: [0], with "
                 "azimuth_offset_cw_deg: [0] and firing_us: [0]");
  try {
    Prism check(p);
  } catch (const InputError& error) {
    node.fail_at("prism_wedge_deg", error.what());
  }
}

void check_clock_timing(const ConfigNode& node, const Profile& p) {
  if (p.states.empty())
    check_firing(node, p.firing_us, p.cycle_us, "");
  else
    check_states(node, p);
  if (!p.modes.empty())
    node.fail_at("modes", fmt::format("belong to timing: encoder; with timing: {} give min/max_rate_hz", p.timing));
  if (!p.column_window.empty()) node.fail_at("column_window", "belongs to timing: encoder");
  if (!(p.min_rate_hz <= p.default_rate_hz && p.default_rate_hz <= p.max_rate_hz))
    node.fail_at("default_rate_hz", fmt::format("{} Hz does not lie between min_rate_hz ({}) and max_rate_hz ({})",
                                                p.default_rate_hz, p.min_rate_hz, p.max_rate_hz));
  if (p.cycle_us * p.max_rate_hz > 1e6 / 16)
    node.fail_at("cycle_us", fmt::format("leaves fewer than 16 cycles in a revolution at {} Hz", p.max_rate_hz));
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

std::span<const ChannelColumn> channel_columns() {
  static constexpr ChannelColumn columns[] = {{"elevation_deg", &Profile::elevation_deg},
                                              {"azimuth_offset_cw_deg", &Profile::azimuth_offset_cw_deg},
                                              {"firing_us", &Profile::firing_us},
                                              {"ring", &Profile::ring},
                                              {"origin_forward_m", &Profile::origin_forward_m},
                                              {"origin_left_m", &Profile::origin_left_m},
                                              {"origin_up_m", &Profile::origin_up_m}};
  return columns;
}

Mode parse_mode(const std::string& text) {
  Mode mode;
  const std::size_t cross = text.find('x');
  const char* const end = text.data() + text.size();
  const bool good = cross != std::string::npos &&
                    std::from_chars(text.data(), text.data() + cross, mode.columns).ptr == text.data() + cross &&
                    std::from_chars(text.data() + cross + 1, end, mode.rate_hz).ptr == end && mode.columns >= 16 &&
                    mode.columns <= 65536 && mode.rate_hz > 0 && mode.rate_hz <= 1000;
  if (!good)
    throw InputError(
        fmt::format("'{}' is no mode; COLUMNSxRATE was expected, such as 1024x10 (16 columns or more)", text));
  return mode;
}

void complete(const ConfigNode& node, Profile& p) {
  if (p.firing_us.empty() && p.states.empty()) p.firing_us.assign(p.channels(), 0.0);
  if (p.by_prism() && p.prism_start_deg.empty()) p.prism_start_deg = {0, 0};
  if (p.ring.empty()) p.ring = rings_by_elevation(p.elevation_deg);
  if (p.default_mode.empty() && p.modes.size() == 1) p.default_mode = p.modes.front();
  check_needed(node, p);
  check_channels(node, p);
  if (!p.by_prism()) {
    if (!p.prism_wedge_deg.empty() || !p.prism_hz.empty() || !p.prism_start_deg.empty())
      node.fail_at("timing", fmt::format("is {}, and wedges belong to timing: prism", p.timing));
  } else {
    check_prism_timing(node, p);
  }
  if (!p.states.empty() && p.timing != "clock") node.fail_at("states", "belong to timing: clock");
  if (p.by_encoder())
    check_encoder_timing(node, p);
  else
    check_clock_timing(node, p);
  if (p.sigma_m.size() != p.sigma_from_m.size())
    node.fail_at("sigma_m", fmt::format("has {} values; {} were expected", p.sigma_m.size(), p.sigma_from_m.size()));
  if (p.sigma_from_m.front() != 0) node.fail_at("sigma_from_m", "must begin with 0");
  if (!std::is_sorted(p.sigma_from_m.begin(), p.sigma_from_m.end())) node.fail_at("sigma_from_m", "must ascend");
  if (!p.divergence_mrad.empty() && p.divergence_mrad.size() != 2)
    node.fail_at("divergence_mrad",
                 fmt::format("has {} values; [horizontal, vertical] was expected", p.divergence_mrad.size()));
  if (!(p.min_range_m < p.max_range_m)) node.fail_at("max_range_m", "must be above min_range_m");
  if (!(p.range_10_percent_m < p.range_80_percent_m))
    node.fail_at("range_80_percent_m", "must be above range_10_percent_m");
}

void AzimuthState::visit(core::OptionVisitor& v) {
  v("firing_us", firing_us, "firing instant of each channel inside the cycle; -1 = silent in this state",
    {.at_least = -1});
}

void Profile::visit(core::OptionVisitor& v) {
  v("summary", summary, "one line about the sensor");
  v("source", source, "where the numbers come from");
  v.choice("timing", timing, {"encoder", "clock", "prism"},
           "columns at fixed angles, firing cycles at fixed times, or pulses through two turning wedges");
  v("modes", modes, "COLUMNSxRATE (timing: encoder)");
  v("default_mode", default_mode, "one of modes");
  v("default_rate_hz", default_rate_hz, "revolutions (timing: clock) or frames (timing: prism) a second", {.above = 0});
  v("min_rate_hz", min_rate_hz, "slowest spin (timing: clock) or frame rate (timing: prism)", {.above = 0});
  v("max_rate_hz", max_rate_hz, "fastest spin (timing: clock) or frame rate (timing: prism)", {.above = 0});
  v("cycle_us", cycle_us, "from one firing cycle (timing: clock) or pulse (timing: prism) to the next",
    {.at_least = 0});
  v.list("states", states, "firing times by state, where they differ from cycle to cycle (timing: clock); [] = one");
  v("prism_wedge_deg", prism_wedge_deg, "angles of the first and the second wedge (timing: prism)",
    {.above = -60, .below = 60});
  v("prism_hz", prism_hz, "revolutions a second of the wedges, negative: the other way round (timing: prism)");
  v("prism_start_deg", prism_start_deg, "where the wedges stand at the recording's begin; [] = 0 (timing: prism)");
  v("prism_refractive_index", prism_refractive_index, "of the wedges (timing: prism)", {.above = 1, .at_most = 4});
  v("column_window", column_window, "[first, last] column that is fired, through 0 where first is larger; [] = all",
    {.at_least = 0});
  v("azimuth_start_deg", azimuth_start_deg, "where a sweep begins, clockwise from sensor +x",
    {.at_least = 0, .below = 360});
  v("beam_origin_radius_m", beam_origin_radius_m, "circle about the spin axis on which beams start", {.at_least = 0});
  v("beam_origin_height_m", beam_origin_height_m, "of that circle above the sensor frame's origin");
  v("range_offset_m", range_offset_m, "what a raw range counts beyond the way from the beam's origin");
  v("min_range_m", min_range_m, "nearer echoes are not reported", {.at_least = 0});
  v("max_range_m", max_range_m, "farther echoes are not reported", {.above = 0});
  v("range_step_m", range_step_m, "least significant bit of a range", {.above = 0});
  v("range_10_percent_m", range_10_percent_m, "range of a 10 % target at 0.9 probability of detection", {.above = 0});
  v("range_80_percent_m", range_80_percent_m, "the same of an 80 % target", {.above = 0});
  v("threshold_snr", threshold_snr, "amplitude over noise at which half of the echoes are detected", {.above = 0});
  v("sigma_from_m", sigma_from_m, "ranges at which sigma_m changes", {.at_least = 0});
  v("sigma_m", sigma_m, "range noise, one standard deviation", {.at_least = 0});
  v("channel_bias_sigma_m", channel_bias_sigma_m, "spread of the constant range errors of channels", {.at_least = 0});
  v("divergence_mrad", divergence_mrad,
    "[horizontal, vertical] full width of a beam at half its intensity; [] = unknown", {.above = 0, .at_most = 100});
  v("pulse_length_ns", pulse_length_ns, "of the laser's pulse: echoes closer than half of its way become one",
    {.above = 0, .at_most = 1000});
  v("elevation_deg", elevation_deg, "of each channel, positive up", {.at_least = -90, .at_most = 90});
  v("azimuth_offset_cw_deg", azimuth_offset_cw_deg, "of each channel, clockwise", {.at_least = -180, .at_most = 180});
  v("firing_us", firing_us, "firing instant of each channel inside the cycle, ascending; [] with states",
    {.at_least = 0});
  v("ring", ring, "of each channel, counted from the lowest", {.at_least = 0, .at_most = 65535});
  v("origin_forward_m", origin_forward_m, "of each channel's beam, along its heading from the circle; [] = 0");
  v("origin_left_m", origin_left_m, "the same, left of its heading; [] = 0");
  v("origin_up_m", origin_up_m, "the same, upwards; [] = 0");
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
  complete(node, result);
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
      throw InputError(
          fmt::format("{} makes sweeps at {} to {} Hz, not at {}", p.name, p.min_rate_hz, p.max_rate_hz, rate));
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
