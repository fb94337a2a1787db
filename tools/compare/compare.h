/// Two folders -> what `tarmac compare` shows.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "reports/compare.h"

namespace tarmac::tools {

struct CompareSettings {
  std::filesystem::path a, b;
  std::string estimator_a, estimator_b;  ///< both or none; none: each estimator against its namesake
  std::vector<std::string> metrics;      ///< empty: all
  std::string case_name;                 ///< empty: all
  bool drives = true;                    ///< false: rows only, series are not read
};

/// Throws InputError: a folder with nothing in it, an estimator, metric or case that neither has, nothing in common.
reports::CompareInput compare_folders(const CompareSettings& settings, const core::Progress& progress);

}  // namespace tarmac::tools
