/// Has something become worse by more than a margin? Paired values over seeds, new against baseline.
///
/// d_k = log(new_k / baseline_k), or log(baseline_k / new_k) where higher is better: above 0 is always worse. With mean
/// m and standard deviation s of the n values, and D = log(1 + margin):
///   lower and upper bound, each at level alpha:  m -+ t(1 - alpha; n - 1) s / sqrt(n)
///   p of "no worse than the margin":             P(T(n - 1) > (m - D) / (s / sqrt(n)))
///   fail: lower bound > D (the same as p < alpha); pass: upper bound <= D; else inconclusive.
///   power against a true change D + delta:       P(T'(n - 1, delta sqrt(n) / s) > t(1 - alpha; n - 1)), T' noncentral
/// Source: Walker and Nowacki 2011, Understanding Equivalence and Noninferiority Testing; power: Lehmann and Romano,
/// Testing Statistical Hypotheses, section 5.2.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace tarmac::metrics {

struct NonInferiorityRule {
  double margin = 0;    ///< as a share: 0.05 allows 5 % worse
  double alpha = 0.05;  ///< one-sided
  double power = 0.8;   ///< of the minimum detectable change
  bool lower_is_better = true;
};

enum class NonInferiorityVerdict : std::uint8_t { pass, fail, inconclusive };
const char* name_of(NonInferiorityVerdict verdict);

struct NonInferiority {
  std::size_t pairs = 0;            ///< that have a ratio; equal values have one (1), also below and at 0
  std::size_t worse = 0;            ///< pairs without a ratio (a value at or below 0) whose new value is the worse one
  std::size_t better = 0;           ///< likewise, the better one
  double log_mean = 0, log_sd = 0;  ///< of d
  double ratio = 1;                 ///< exp(log_mean): above 1 is worse
  double low = 0, high = std::numeric_limits<double>::infinity();  ///< of the ratio, each one-sided at alpha
  /// Two-sided 95 % interval of the ratio; 0 and infinity where it cannot be told.
  double ci_low = 0, ci_high = std::numeric_limits<double>::infinity();
  double p = 1;
  NonInferiorityVerdict verdict = NonInferiorityVerdict::inconclusive;
};

/// `now` and `baseline` in pairs, one a seed, all finite. Values that have no ratio and differ decide before the test
/// does: any that is worse fails, else any that is better leaves it inconclusive. Below two pairs it is inconclusive.
/// Throws std::invalid_argument: lists of different length, a value that is not finite, alpha or power outside (0, 1),
/// margin at or below -1.
NonInferiority test_non_inferiority(const std::vector<double>& now, const std::vector<double>& baseline,
                                    const NonInferiorityRule& rule);

/// Chance that the one-sided test at level alpha fails n pairs whose log ratio exceeds the margin by `delta` and has
/// standard deviation `sd`.
double power_of_paired_test(std::size_t n, double delta, double sd, double alpha);

/// The worsening, as a share, that the test sees with the wanted power: exp(D + delta) - 1. 0 beyond the margin when sd
/// is 0; infinity when n < 2.
double minimum_detectable_change(std::size_t n, double sd, const NonInferiorityRule& rule);

/// The smallest number of pairs that sees a worsening by `change` (a share, beyond the margin) with the wanted power.
/// Throws std::invalid_argument when `change` does not exceed the margin or would need more than a million pairs.
std::size_t pairs_needed(double change, double sd, const NonInferiorityRule& rule);

/// Holm 1979: adjusted p in the order given. A row is called out at level alpha when its adjusted p is below it; the
/// chance of calling out any row wrongly is then at most alpha, however the rows depend on one another.
std::vector<double> holm_adjusted(const std::vector<double>& p);

}  // namespace tarmac::metrics
