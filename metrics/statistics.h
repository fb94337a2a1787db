/// Small statistics that metrics share.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace tarmac::metrics {

/// Quantile q in [0, 1] of finite values, linear between order statistics (Hyndman and Fan's type 7); NaN when empty.
double quantile(std::vector<double> values, double q);
double mean(const std::vector<double>& values);  ///< NaN when empty
/// Root mean square; NaN when empty.
double rms(const std::vector<double>& values);

/// Counts of non-negative magnitudes e, kept by e^2 in bins of equal relative width: exponent and top mantissa bits of
/// e^2 as a float. Counts are integers, so that adding up in any order gives the same quantiles. A bin is as wide as
/// 2^-(kMantissaBits+1) of e; magnitudes below 1e-12 count as 0, above 1e6 as 1e6.
template <int kMantissaBits>
class SquaredHistogram {
 public:
  SquaredHistogram() : counts_(kBins, 0) {}
  void add(double e_squared) { ++counts_[bin(e_squared)]; }
  void add(const SquaredHistogram& other) {
    for (std::size_t i = 0; i < kBins; ++i) counts_[i] += other.counts_[i];
  }
  std::uint64_t total() const;
  /// The magnitude e that a share q of all are not larger than (nearest rank); NaN when empty.
  double quantile(double q) const;

 private:
  static constexpr int kLowestExponent = -80, kHighestExponent = 40;  // of e^2: e from 9e-13 to 1e6
  static constexpr std::size_t kPerOctave = std::size_t{1} << kMantissaBits;
  static constexpr std::size_t kBins = (kHighestExponent - kLowestExponent) * kPerOctave + 1;
  static std::size_t bin(double e_squared) {
    const std::int64_t bits = std::bit_cast<std::int32_t>(static_cast<float>(e_squared)) >> (23 - kMantissaBits);
    const std::int64_t k = bits - (std::int64_t{kLowestExponent + 127} << kMantissaBits) + 1;
    return k < 1 ? 0 : k >= static_cast<std::int64_t>(kBins) ? kBins - 1 : static_cast<std::size_t>(k);
  }
  static double magnitude(std::size_t bin);
  std::vector<std::uint32_t> counts_;  // [0]: zero and below the lowest exponent
};

extern template class SquaredHistogram<6>;
extern template class SquaredHistogram<10>;

}  // namespace tarmac::metrics
