/// Where along the drive two methods, or two builds of one, differ: series over time of the same seeds in pairs.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "metrics/evaluation.h"

namespace tarmac::metrics {

/// The same series of the same seed, in A and in B.
struct SeriesPair {
  const Series* a = nullptr;
  const Series* b = nullptr;
};

/// B against A. Neighbouring sweeps err alike, so samples are averaged over blocks of x first (about a second of time),
/// and a block's mean of B - A is what is averaged over the seeds, with Student's interval. `level` is the significance
/// over the number of blocks (Bonferroni 1936), which makes the intervals hold all together: where one excludes 0, B
/// differs from A there. A sign-flip test would need no normal block means, but n seeds know 2^n patterns of signs only
/// and cannot go below 2^(1 - n): never below 5 % with five seeds.
struct SeriesComparison {
  std::string name, x_label, y_label;
  std::size_t pairs = 0;
  std::vector<double> x, a, b;  ///< medians over the seeds, on the first pair's grid; NaN where no seed has a value
  std::vector<double> block_x;  ///< middles of the blocks
  /// Mean of B - A in each block, and its interval; NaN where fewer than kLeastPairs seeds have both.
  std::vector<double> difference, low, high;
  double block_length = 1;
  double level = 0.05;  ///< two-sided, of one block

  /// Neighbouring blocks whose interval excludes 0 on the same side.
  struct Stretch {
    double from = 0, to = 0;
    double difference = 0;  ///< mean over its blocks: above 0, B is higher
  };
  std::vector<Stretch> stretches;
};

/// Series of one name, one pair a seed. Where both of a pair have the same x, samples count that both have; otherwise
/// each block takes what each has. Differences below 1e-9 of the series' largest value are rounding, and no stretch.
/// Throws std::invalid_argument when there is no pair or a series is missing.
SeriesComparison compare_series(std::span<const SeriesPair> pairs, double block_length = 1, double significance = 0.05);

}  // namespace tarmac::metrics
