#include "sim/lidar/beam_options.h"

#include <fmt/format.h>

namespace tarmac::sim::lidar {

void BeamOptions::visit(core::OptionVisitor& v) {
  v("rays", rays, "rays that a beam's footprint is made of: 1 (a line), 3 or 7", {.at_least = 1, .at_most = 7});
  v.choice("footprint", footprint, {"adaptive", "full"},
           "adaptive traces the outer rays only where the surface may end or bend inside the footprint");
  v.choice("returns", returns, {"strongest", "first", "last", "dual"},
           "which of a beam's echoes are points; dual = the strongest and the last");
  v("pulse_length_ns", pulse_length_ns, "echoes closer than half of its way become one; 0 = the profile's",
    {.at_least = 0, .at_most = 1000});
  v("glass", glass, "panes let light through and mirror it");
  v("ghosts", ghosts, "what panes mirror comes back too (only with glass)");
  v("pane_flatness_deg", pane_flatness_deg, "how far panes are from flat: the width of their glint (only with glass)",
    {.at_least = 0, .at_most = 5});
  v("halo", halo, "very bright targets within 30 m show in the beams beside theirs");
  v("saturation", saturation, "very bright targets clip the receiver: full intensity, a range error");
  v("saturation_signal", saturation_signal, "equivalent reflectance from which on it clips", {.above = 0});
  v("saturation_bias_m", saturation_bias_m, "range error of a target 100 times as bright as that",
    {.at_least = -1, .at_most = 1});
  v("range_walk_m", range_walk_m, "range error by brightness: this at ten times 20 % reflectance, minus it at a tenth",
    {.at_least = -1, .at_most = 1});
  v.choice("range_noise", range_noise, {"sheet", "snr"},
           "sheet = by range alone; snr = also by brightness and incidence, the sheet's on an 80 % target seen square");
  v("spot_smear", spot_smear, "share of the spot's depth on a slanted surface that is noise (only with snr)",
    {.at_least = 0, .at_most = 1});
  v("false_alarms_per_shot", false_alarms_per_shot, "share of firings that see what is not there; 0.0001 in full sun",
    {.at_least = 0, .at_most = 1});
}

bool BeamOptions::any() const {
  return rays > 1 || returns != "strongest" || glass || halo || saturation || range_walk_m != 0 ||
         range_noise != "sheet" || false_alarms_per_shot > 0;
}

namespace {

/// An option that the other ones leave without effect is a mistake, unless it says what it says by default.
template <class Value>
void refuse_idle(const core::ConfigNode& node, bool used, const char* name, const Value& value, const Value& by_default,
                 const char* what_uses_it) {
  if (!used && value != by_default)
    node.fail_at(name, fmt::format("has no effect here: {}; take it away or add that", what_uses_it));
}

void check_idle(const core::ConfigNode& node, const BeamOptions& o, const Profile& profile) {
  const BeamOptions usual;
  if (o.halo && profile.by_prism())
    node.fail_at("halo",
                 fmt::format("has no effect here: {} has one beam behind its prisms, none beside it: take it away",
                             profile.name));
  if (profile.by_prism() && o.rays > 1 && node.child("footprint").present() && o.footprint == "adaptive")
    node.fail_at("footprint",
                 fmt::format("has no effect here: the beams of {} lie beside each other in no order, all rays are "
                             "traced: take it away or say `full`",
                             profile.name));
  const bool wide = o.rays > 1, several = wide || o.glass || o.halo;
  refuse_idle(node, wide, "footprint", o.footprint, usual.footprint, "a beam of one ray is a line (rays: 3 or 7)");
  refuse_idle(node, several || o.false_alarms_per_shot > 0, "returns", o.returns, usual.returns,
              "a beam has one echo at most (rays: 3 or 7, glass, halo or false_alarms_per_shot give more)");
  refuse_idle(node, several, "pulse_length_ns", o.pulse_length_ns, usual.pulse_length_ns,
              "a beam has one echo at most, there is nothing to tell apart (rays: 3 or 7, glass or halo)");
  refuse_idle(node, o.glass, "ghosts", o.ghosts, usual.ghosts, "only with glass");
  refuse_idle(node, o.glass, "pane_flatness_deg", o.pane_flatness_deg, usual.pane_flatness_deg, "only with glass");
  refuse_idle(node, o.saturation, "saturation_signal", o.saturation_signal, usual.saturation_signal,
              "only with saturation");
  refuse_idle(node, o.saturation, "saturation_bias_m", o.saturation_bias_m, usual.saturation_bias_m,
              "only with saturation");
  refuse_idle(node, o.range_noise == "snr", "spot_smear", o.spot_smear, usual.spot_smear, "only with range_noise: snr");
}

}  // namespace

void complete_beam(const core::ConfigNode& node, BeamOptions& options, const Profile& profile) {
  if (options.rays != 1 && options.rays != 3 && options.rays != 7)
    node.fail_at("rays", fmt::format("{} is no footprint; 1, 3 or 7 rays are", options.rays));
  const bool needs_width = options.rays > 1 || options.glass || options.halo || options.range_noise == "snr";
  if (needs_width && profile.divergence_mrad.empty())
    node.fail(
        fmt::format("needs the width of the beams, and the profile of {} has no divergence_mrad: add "
                    "`divergence_mrad: [HORIZONTAL, VERTICAL]`, or take away rays, glass, halo and range_noise",
                    profile.name));
  check_idle(node, options, profile);
  if (profile.by_prism() && options.rays > 1) options.footprint = "full";
}

}  // namespace tarmac::sim::lidar
