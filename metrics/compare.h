/// Two estimators on the same seeds: is the difference more than chance?
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "metrics/evaluation.h"
#include "metrics/registry.h"

namespace tarmac::metrics {

enum class Difference : std::uint8_t {
  lower,            ///< a is lower than b: the interval lies below 1
  higher,           ///< a is higher than b
  not_significant,  ///< the interval holds 1
  too_few,          ///< fewer than kLeastPairs seeds where both have a value above 0
};
const char* name_of(Difference difference);

/// Of one metric, over the seeds where both estimators have a value above 0. Noise multiplies errors rather than adds
/// to them, so the difference of logarithms is what is averaged: ratio = exp(mean log(a / b)), with Student's interval.
/// The same scenario and seed give both the same recording: what a hard seed does to both cancels.
struct PairedComparison {
  std::string a, b;  ///< estimators
  std::string metric;
  std::size_t pairs = 0;
  std::size_t a_lower = 0;   ///< seeds on which a's value is lower
  std::size_t b_lower = 0;   ///< and b's: ties, to within rounding, are neither's
  double ratio = 1;          ///< of a to b, geometric mean
  double low = 0, high = 0;  ///< 95 % interval of the ratio; 0 and infinity when too few
  double p = 1;              ///< two-sided, of the hypothesis ratio = 1
  double p_adjusted = 1;     ///< by judge_by_holm: below the significance exactly when the difference is claimed
  Difference difference = Difference::too_few;
};

/// `a` and `b` in pairs, one a seed; a pair with a value that is not above 0 (or not finite) is left out. Throws
/// std::invalid_argument when they differ in length. `significance`: below this p a difference is called one. A mean
/// logarithm within kLogRounding of 0 is no difference, however well the seeds agree on it.
PairedComparison compare_paired(const std::vector<double>& a, const std::vector<double>& b, double significance = 0.05);

/// Judges comparisons that are read together, so that the chance of any false claim among them is `significance` at
/// most (Holm 1979): the smallest p counts times n, the next times n - 1 and so on, never less than the one before.
/// Those with too few pairs are not among the n, nor are those that are the same on every seed, to within rounding
/// (the test cannot claim them, whatever the level).
void judge_by_holm(std::span<PairedComparison> comparisons, double significance = 0.05);

/// The same comparison told of b against a.
PairedComparison turned_around(const PairedComparison& comparison);

/// Which way of a metric is the better one. The registry says it of errors; shares covered, detectors' scores and the
/// real-time factor are better when higher; lengths, shares of degenerate sweeps and eigenvalues are neither.
enum class Better : std::uint8_t { lower, higher, neither };
Better better_of(const MetricEntry& metric);

/// True of what tells of the drive and not of the method: the true path's length, the oracle's shares and its smallest
/// eigenvalue, of which neither way is better. They change with what is scored, which the coverage says; a comparison
/// of methods leaves them out, unless asked for them by name.
bool describes_drive(const MetricEntry& metric);

/// Every pair of estimators by one metric's headline row (causal, or final for a batch method); runs that are not ok
/// are left out. With more than one pair of estimators `significance` is shared out by Holm's rule, which holds the
/// chance of any false claim at 5 %. Pairs come in the order of the estimators' first appearance.
std::vector<PairedComparison> compare_all(const std::vector<const Evaluation*>& evaluations, const std::string& metric);

/// "ct-icp's deskew_error_rms_m is 0.82 times kiss-icp's (95 % interval 0.79 to 0.86, lower on 5 of 5 seeds)" or
/// "... do not differ significantly (ratio ..., n seeds)".
std::string in_words(const PairedComparison& comparison);

}  // namespace tarmac::metrics
