/// Does a method's own information tell when the geometry gives out? Its verdict a sweep against the oracle's.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "metrics/degeneracy/rule.h"

namespace tarmac::metrics {

/// One sweep that both speak of.
struct DetectorSample {
  double t_s = 0;                                   ///< the sweep's end
  std::optional<double> oracle_lambda;              ///< empty: the oracle does not know
  std::optional<double> lambda;                     ///< the method's smallest eigenvalue; empty: it has none
  DegeneracyClass flag = DegeneracyClass::unknown;  ///< the method's class, by the rule and its hysteresis
};

/// k of n with the 95 % interval of Wilson 1927 (n = 0: no value).
struct Proportion {
  std::size_t k = 0, n = 0;
  std::optional<double> value() const;
  double low() const;
  double high() const;
};

/// Per sweep: those whose oracle eigenvalue is within a factor of 2 of the threshold are left out and counted, as are
/// those that either does not know. Sweeps follow one another closely, so their intervals are too narrow: events count
/// independent cases. An oracle event is at least 5 consecutive sweeps with the eigenvalue below the threshold, found
/// when the method flags any of them; a flagged event is at least 5 consecutive flagged sweeps, right when it touches
/// an oracle's degenerate sweep, and left out when it touches none but one that is left out.
struct DetectorScores {
  std::size_t near_threshold = 0, unknown = 0, scored = 0, positives = 0;  ///< sweeps
  Proportion precision, recall;
  std::optional<double> f1;
  /// Probability that the eigenvalue of a degenerate sweep is the smaller one of a pair (ties count half): what a
  /// detector could reach with a threshold of its own. 0.5 = knows nothing.
  std::optional<double> auc;
  Proportion event_precision, event_recall;
  /// From the first flag of the flagged stretch to the oracle's onset, one an event that is found and begins after the
  /// recording; above 0 the flag comes first. Flags count from the end of the oracle's event before.
  std::vector<double> lead_s;
};

inline constexpr std::size_t kEventSweeps = 5;
inline constexpr double kNearThreshold = 2;  ///< factor

/// `samples` in order of time.
DetectorScores score_detector(std::span<const DetectorSample> samples, double oracle_threshold);

}  // namespace tarmac::metrics
