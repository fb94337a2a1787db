/// Where along the drive two methods differ: the series of paired runs, read from their evaluations.
#pragma once

#include <vector>

#include "core/progress.h"
#include "reports/compare.h"
#include "tools/compare/pairing.h"

namespace tarmac::tools {

/// The most methods on cases that a page carries series of.
inline constexpr std::size_t kMostDrives = 24;

/// One for each pair of methods that has series: those with the largest significant change first. Runs whose evaluation
/// is not there any more (a store may be passed on without its files) are added to `missing`.
std::vector<reports::CompareDrive> compare_drives(const Pairing& pairing, std::size_t most,
                                                  const core::Progress& progress,
                                                  std::vector<reports::CompareMissing>& missing);

}  // namespace tarmac::tools
