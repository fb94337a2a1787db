/// Resampling of a series whose neighbours are alike.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace tarmac::metrics {

struct BootstrapSettings {
  std::size_t replicates = 400;
  std::size_t block = 10;  ///< items that stay together: sweeps of one second
};

/// Moving-block bootstrap: each replicate draws blocks of consecutive items, with replacement, until it has n or a few
/// more. `draws[r][i]` is how often item i occurs in replicate r. The draws are named: the same every time.
/// Source: Kunsch 1989, The Jackknife and the Bootstrap for General Stationary Observations.
std::vector<std::vector<int>> block_bootstrap(std::size_t n, const BootstrapSettings& settings, std::string_view name);

/// A value, the standard deviation of its replicates, and the interval of 95 % between their quantiles.
struct Bootstrapped {
  double value = 0, sigma = 0, low = 0, high = 0;
  /// How many standard deviations the value is off 0; 0 where nothing varies.
  double z() const { return sigma > 0 ? value / sigma : 0; }
};
/// NaN among the replicates are left out.
Bootstrapped bootstrapped(double value, std::vector<double> replicates);

}  // namespace tarmac::metrics
