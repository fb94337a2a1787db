#include "estimators/window/breaks.h"

namespace tarmac::estimators {
namespace {

/// Changes of first_block_at in (low, high], where it never falls.
void find(const core::ParametricTrajectory& trajectory, core::Time low, int block_low, core::Time high, int block_high,
          std::vector<core::Time>& found) {
  if (block_low == block_high) return;
  if (high - low <= core::Duration(1)) {
    found.push_back(high);
    return;
  }
  const core::Time middle = low + (high - low) / 2;
  const int block = trajectory.first_block_at(middle);
  find(trajectory, low, block_low, middle, block, found);
  find(trajectory, middle, block, high, block_high, found);
}

}  // namespace

std::vector<core::Time> breaks(const core::ParametricTrajectory& trajectory) {
  const core::Time begin = trajectory.begin(), end = trajectory.end();
  std::vector<core::Time> found = {begin};
  find(trajectory, begin, trajectory.first_block_at(begin), end, trajectory.first_block_at(end), found);
  if (found.back() != end) found.push_back(end);
  return found;
}

}  // namespace tarmac::estimators
