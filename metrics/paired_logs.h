/// Ratios of paired values, by their logarithms: what comparisons and gates share.
#pragma once

#include <cstddef>
#include <vector>

namespace tarmac::metrics {

/// With fewer pairs a comparison claims nothing: Student's interval of two is wider than any difference worth a word.
inline constexpr std::size_t kLeastPairs = 3;
/// Logarithms nearer to each other than this differ by rounding alone.
inline constexpr double kLogRounding = 1e-12;

/// log(a / b) of the pairs of which both values are above 0 and finite. Throws std::invalid_argument when the lists
/// differ in length.
std::vector<double> log_ratios(const std::vector<double>& a, const std::vector<double>& b);

/// Of logarithms, or of any other values.
struct LogSummary {
  std::size_t n = 0;
  double mean = 0;   ///< 0 when empty
  double sd = 0;     ///< with n - 1; 0 below two values
  double error = 0;  ///< of the mean: sd / sqrt(n)
};
LogSummary summarise(const std::vector<double>& values);

/// Student's t with `n` - 1 degrees of freedom, n >= 2: the quantile, and the chance of a value above t.
double student_quantile(std::size_t n, double probability);
double student_above(std::size_t n, double t);

}  // namespace tarmac::metrics
