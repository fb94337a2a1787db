/// Firing times of a recorded sensor's columns, to be fired at again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/options.h"

namespace tarmac::sim::lidar {

/// One recorded sweep: its begin [ns], and when each column fired [ns from the begin], ascending.
struct ReplayedSweep {
  std::int64_t begin_ns = 0;
  std::vector<double> column_ns;  ///< whole numbers
  void visit(core::OptionVisitor& v);
};

/// Reads column times from
///   a folder of the plain format (docs/formats.md): the distinct times of a sweep's points are those of its columns;
///   a CSV file with the header `sweep,column,t_ns`: one line a column, sweeps and columns counted from 0, in order.
/// The clock is moved so that the first sweep begins at 0. `columns` is how many columns the sensor fires in a sweep.
/// Throws InputError (file, line) when a sweep has another number of columns (one without any return leaves no time in
/// a plain folder), times do not ascend, or sweeps overlap.
std::vector<ReplayedSweep> load_column_times(const std::filesystem::path& path, std::size_t columns);
/// The same checks on times that came otherwise. Throws InputError saying what is wrong.
void check_column_times(const std::vector<ReplayedSweep>& sweeps, std::size_t columns);

}  // namespace tarmac::sim::lidar
