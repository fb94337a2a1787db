#include "metrics/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tarmac::metrics {

namespace {
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return kNaN;
  std::sort(values.begin(), values.end());
  const double place = q * static_cast<double>(values.size() - 1);
  const std::size_t below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

double mean(const std::vector<double>& values) {
  if (values.empty()) return kNaN;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double rms(const std::vector<double>& values) {
  if (values.empty()) return kNaN;
  const double sum = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

template <int kMantissaBits>
std::uint64_t SquaredHistogram<kMantissaBits>::total() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0});
}

template <int kMantissaBits>
double SquaredHistogram<kMantissaBits>::magnitude(std::size_t bin) {
  if (bin == 0) return 0;
  const std::size_t octave = (bin - 1) / kPerOctave, step = (bin - 1) % kPerOctave;
  const double mantissa = 1 + (static_cast<double>(step) + 0.5) / static_cast<double>(kPerOctave);
  return std::sqrt(std::ldexp(mantissa, kLowestExponent + static_cast<int>(octave)));
}

template <int kMantissaBits>
double SquaredHistogram<kMantissaBits>::quantile(double q) const {
  const std::uint64_t n = total();
  if (n == 0) return kNaN;
  const auto rank = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(q * static_cast<double>(n))));
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    seen += counts_[i];
    if (seen >= rank) return magnitude(i);
  }
  return magnitude(kBins - 1);
}

template class SquaredHistogram<6>;
template class SquaredHistogram<10>;

}  // namespace tarmac::metrics
