#include "metrics/diagnosis.h"

#include <fmt/format.h>

#include <cmath>

namespace tarmac::metrics {

namespace {

using Number = Finding::Number;
using Verdict = Finding::Verdict;

constexpr double kSigmas = 4;
constexpr double kLeastScale = 0.03;
constexpr double kLeastScaleModelled = 0.3;  // where the motion inside the sweep is the method's model, not measured
constexpr double kLeastShare = 0.3;          // of a stamp's step, of the acceleration, of a sweep's lag
constexpr double kLeastOffset_s = 1e-3;
constexpr double kLeastTrend_m = 5e-3;
constexpr double kLeastSpan = 0.05, kMostSpan = 3;  // of stamps, in sweeps: few returns make less, no jitter makes more
constexpr double kTellingOffset_s = 2e-3;           // a worse sigma leaves a millisecond untold

bool beyond(const Bootstrapped& x, double least) {
  return std::abs(x.value) >= least && std::abs(x.z()) >= kSigmas;
}

Number number(std::string name, const Bootstrapped& x, double unit, std::string unit_name) {
  return {std::move(name), unit * x.value, std::move(unit_name), unit * x.low, unit * x.high};
}
Number number(std::string name, double value, std::string unit_name) {
  return {std::move(name), value, std::move(unit_name), {}, {}};
}

std::string ms(const Bootstrapped& x) {
  return fmt::format("{:.2f} +- {:.2f} ms", 1e3 * x.value, 1e3 * x.sigma);
}

/// Times a factor: k over the stamps' span as a share of the sweep's true motion.
Bootstrapped times(Bootstrapped x, double factor) {
  return {factor * x.value, std::abs(factor) * x.sigma, factor * x.low, factor * x.high};
}

/// Two measurements of one thing by inverse variance.
Bootstrapped combined(const Bootstrapped& a, const Bootstrapped& b) {
  if (!(a.sigma > 0)) return b;
  if (!(b.sigma > 0)) return a;
  const double wa = 1 / (a.sigma * a.sigma), wb = 1 / (b.sigma * b.sigma), w = wa + wb;
  const double value = (wa * a.value + wb * b.value) / w, sigma = 1 / std::sqrt(w);
  return {value, sigma, value - 1.96 * sigma, value + 1.96 * sigma};
}

const char* const kNoResiduals =
    "The method recorded no point-to-surface residual (run it with --diagnostics full), or too few sweeps have any.";

/// k in words. Beyond the stamps' scale itself there are two values with a name.
std::string scale_words(double k, double period_k, const Evidence& e) {
  if (period_k > -1.4 && period_k < -0.5) {
    return e.held ? "Motion inside a sweep is not undone: the method holds one pose over it."
                  : "Motion inside a sweep is not undone, as if the stamps did not reach the method.";
  }
  if (k > 1.2)
    return fmt::format("Motion inside a sweep is undone backwards: stamps are reversed in time{}.",
                       e.stamps.descending_share > 0.5 ? ", and they fall from point to point in firing order" : "");
  return fmt::format("Motion inside a sweep is {} by {:.1f} %: stamps run {:.3g} times as fast as time.",
                     k > 0 ? "overdone" : "underdone", 100 * std::abs(k), 1 / (1 - k));
}

Finding stamp_scale(const Evidence& e) {
  Finding f{"stamp-scale", Verdict::cannot_be_told, kNoResiduals, {}};
  f.evidence.push_back(number("stamps' span over the sweep's duration", e.stamps.span_share, "1"));
  if (e.slopes)
    f.evidence.insert(f.evidence.begin(),
                      {number("motion overdone by, from translation", e.slopes->scale_translation, 100, "%"),
                       number("motion overdone by, from rotation", e.slopes->scale_rotation, 100, "%")});
  // No residual is needed to see a wrong unit, and a method that brings stamps to one span has none to show.
  if (e.stamps.span_share > 0 && (e.stamps.span_share < kLeastSpan || e.stamps.span_share > kMostSpan)) {
    f.verdict = Verdict::found;
    f.words =
        fmt::format("Stamps cover {:.3g} times the sweep's duration: they are in a wrong unit.", e.stamps.span_share);
    return f;
  }
  if (!e.slopes) return f;
  const Bootstrapped k = combined(e.slopes->scale_translation, e.slopes->scale_rotation);
  const double factor = e.slopes->span_s / (e.period_s > 0 ? e.period_s : 1);
  if (beyond(times(k, factor), e.slopes->inside ? kLeastScale : kLeastScaleModelled)) {
    f.verdict = Verdict::found;
    f.words = scale_words(k.value, factor * k.value, e);
  } else if (e.slopes->inside) {
    f.verdict = Verdict::nothing_found;
    f.words = "No part of the motion is left over or overdone.";
  } else if (e.held) {
    f.words = "The method holds one pose over a sweep: the motion inside it is not undone, whatever the stamps say.";
  } else {
    f.words =
        "The motion inside a sweep is the method's own model, spread over its stamps: a wrong scale or unit goes "
        "into it unseen. Stamps in reverse, or no motion at all, would show, and do not.";
  }
  return f;
}

Finding quantisation(const Evidence& e) {
  Finding f{"stamp-quantisation", Verdict::nothing_found, "", {}};
  f.evidence = {number("different stamps a sweep", e.stamps.distinct, "1"),
                number("step from stamp to stamp", 1e3 * e.stamps.gap_s, "ms"),
                number("turn of the head within one stamp, over that from stamp to stamp", e.stamps.turn_share, "1")};
  if (!e.stamps.quantised()) {
    f.words = "Points that share a stamp were fired together: stamps are as fine as the firing.";
    return f;
  }
  const std::string stamps =
      fmt::format("Stamps stand still for {:.3g} ms while the head turns on", 1e3 * e.stamps.gap_s);
  const bool has_saw = e.slopes && e.slopes->quantum_s.sigma > 0;
  if (has_saw) f.evidence.push_back(number("motion unseen within a stamp", e.slopes->quantum_s, 1e3, "ms"));
  if (has_saw && beyond(e.slopes->quantum_s, kLeastShare * e.stamps.gap_s)) {
    f.verdict = Verdict::found;
    f.words = fmt::format("{}: residuals make a saw-tooth of {} in each.", stamps, ms(e.slopes->quantum_s));
  } else {
    f.verdict = has_saw ? Verdict::nothing_found : Verdict::cannot_be_told;
    f.words = stamps + (has_saw ? "; residuals show no saw-tooth from it: the steps are too small to matter here."
                                : "; without residuals there is no telling whether it matters.");
  }
  return f;
}

Finding missing_acceleration(const Evidence& e) {
  Finding f{"missing-acceleration", Verdict::cannot_be_told, kNoResiduals, {}};
  if (!e.slopes) return f;
  const SlopeFit& s = *e.slopes;
  f.evidence = {number("acceleration left out inside the sweep, translation", s.omitted_translation, 100, "%"),
                number("acceleration left out inside the sweep, rotation", s.omitted_rotation, 100, "%"),
                number("motion inside the sweep lags, translation", s.lag_translation_s, 1e3, "ms"),
                number("motion inside the sweep lags, rotation", s.lag_rotation_s, 1e3, "ms")};
  const bool bent = beyond(s.omitted_translation, kLeastShare) || beyond(s.omitted_rotation, kLeastShare);
  const Bootstrapped& lag =
      std::abs(s.lag_translation_s.z()) > std::abs(s.lag_rotation_s.z()) ? s.lag_translation_s : s.lag_rotation_s;
  const bool late = !s.inside && beyond(lag, kLeastShare * e.period_s);
  f.verdict = bent || late ? Verdict::found : Verdict::nothing_found;
  if (late)
    f.words = fmt::format(
        "The motion by which points are placed lags by {} = {:.2f} sweeps, in proportion to its change: that of the "
        "sweep before stands in (constant velocity), or one pose for the whole sweep.",
        ms(lag), lag.value / e.period_s);
  else if (bent)
    f.words =
        "Residuals bend over the sweep in proportion to the acceleration: the motion inside the sweep leaves it out.";
  else
    f.words = "Residuals do not follow the acceleration.";
  return f;
}

Finding clock_offset(const Evidence& e) {
  Finding f{"clock-offset", Verdict::cannot_be_told, kNoResiduals, {}};
  if (!e.slopes) return f;
  const SlopeFit& s = *e.slopes;
  if (!s.inside) {
    f.words =
        "A constant offset of the LiDAR's clock only renames the instants for a method that takes its motion from the "
        "LiDAR: its residuals stay the same, and no plot over the point's time can show it. See time-lag.";
    return f;
  }
  f.evidence = {number("offset by rotation (slope over change of rate)", s.lag_rotation_s, 1e3, "ms"),
                number("slope over change of velocity", s.lag_translation_s, 1e3, "ms"),
                number("change of rate over a sweep, rms", s.rate_change_rms_rad_s * 57.29577951308232, "deg/s")};
  if (!(s.lag_rotation_s.sigma < kTellingOffset_s)) {
    f.words =
        fmt::format("The rate of turn changes too little to tell: the regression gives {}.", ms(s.lag_rotation_s));
    return f;
  }
  const bool found = beyond(s.lag_rotation_s, kLeastOffset_s);
  f.verdict = found ? Verdict::found : Verdict::nothing_found;
  f.words = fmt::format(
      "{}: the motion that the method measures inside the sweeps is {} against the points by {}, beyond the delay on "
      "the data sheet. (By rotation; velocity is corrected by the LiDAR itself and does not count.)",
      found ? "Clocks differ" : "No offset of clocks", s.lag_rotation_s.value > 0 ? "late" : "early",
      ms(s.lag_rotation_s));
  return f;
}

Finding time_lag(const Evidence& e) {
  Finding f{"time-lag", Verdict::cannot_be_told, "", {}};
  if (!e.has_truth) {
    f.words = "Only a comparison with the truth shows a lag of the whole trajectory, and there is none.";
    return f;
  }
  if (!e.lag) {
    f.words = "Speed and rate of turn hardly change, or too few sweeps are scored: any lag fits the truth alike.";
    return f;
  }
  f.evidence = {number("best lag of the estimate against the truth", e.lag->lag_s, 1e3, "ms"),
                number("ATE gained per lag", e.lag->ate_slope_m_s, "m/s")};
  const bool found = beyond(e.lag->lag_s, kLeastOffset_s);
  f.verdict = found ? Verdict::found : Verdict::nothing_found;
  f.words = fmt::format("The estimate {} the truth by {}{}", e.lag->lag_s.value > 0 ? "lags behind" : "runs ahead of",
                        ms(e.lag->lag_s),
                        found ? ": stamps of the sweeps are off by that much, or the method delays its poses."
                              : ", which is within chance or too little to matter.");
  return f;
}

Finding residual_trend(const Evidence& e) {
  static constexpr const char* kAxes[3] = {"forward", "left", "up"};
  Finding f{"residual-trend", Verdict::cannot_be_told, kNoResiduals, {}};
  if (!e.trend) return f;
  std::string what;
  for (int axis = 0; axis < 3; ++axis) {
    const Bootstrapped &slope = e.trend->slope_m[axis], &bend = e.trend->bend_m[axis];
    f.evidence.push_back(number(fmt::format("slope over the sweep, {}", kAxes[axis]), slope, 1e3, "mm"));
    f.evidence.push_back(number(fmt::format("bend over the sweep, {}", kAxes[axis]), bend, 1e3, "mm"));
    for (const auto& [name, x] : {std::pair{"slope", slope}, std::pair{"bend", bend}})
      if (beyond(x, kLeastTrend_m))
        what += fmt::format("{}{} {} of {:.1f} +- {:.1f} mm", what.empty() ? "" : ", ", kAxes[axis], name,
                            1e3 * x.value, 1e3 * x.sigma);
  }
  f.verdict = what.empty() ? Verdict::nothing_found : Verdict::found;
  f.words = what.empty() ? "Pooled over the drive, residuals neither slope nor bend over the sweep."
                         : "Pooled over the drive, points are displaced over the sweep: " + what + ".";
  return f;
}

Finding sum(const std::vector<Finding>& findings, const Evidence& e) {
  Finding f{"timing", Verdict::cannot_be_told, kNoResiduals, {}};
  f.evidence = {number("spread of residuals about their sweep", 1e3 * e.spread_m, "mm")};
  std::string topics;
  for (const Finding& one : findings)
    if (one.verdict == Verdict::found) topics += (topics.empty() ? "" : ", ") + one.topic;
  if (!topics.empty()) {
    f.verdict = Verdict::found;
    f.words = "Not noise alone: see " + topics + ".";
  } else if (e.slopes) {
    f.verdict = Verdict::nothing_found;
    f.words = fmt::format("Noise only, with a spread of {:.1f} mm about each sweep's fit.", 1e3 * e.spread_m);
  }
  return f;
}

/// A wrong scale, unit or step of stamps, counted from the sweep's begin, also moves the middle of the sweep and bends
/// it: what looks like an offset or a missing acceleration beside it may be nothing but that.
void set_aside(std::vector<Finding>& findings) {
  std::string first;
  for (const Finding& f : findings)
    if (f.verdict == Verdict::found && (f.topic == "stamp-scale" || f.topic == "stamp-quantisation"))
      first += (first.empty() ? "" : " and ") + f.topic;
  if (first.empty()) return;
  for (Finding& f : findings) {
    if (f.topic != "clock-offset" && f.topic != "missing-acceleration") continue;
    if (f.verdict != Verdict::found) continue;
    f.verdict = Verdict::cannot_be_told;
    f.words = fmt::format(
        "The figures say so, but {} by itself moves and bends the motion inside the sweep: mend that first.", first);
  }
}

}  // namespace

std::vector<Finding> diagnose(const Evidence& evidence) {
  std::vector<Finding> findings{stamp_scale(evidence),  quantisation(evidence), missing_acceleration(evidence),
                                clock_offset(evidence), time_lag(evidence),     residual_trend(evidence)};
  set_aside(findings);
  findings.push_back(sum(findings, evidence));
  return findings;
}

}  // namespace tarmac::metrics
