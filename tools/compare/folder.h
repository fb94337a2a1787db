/// What lies in a folder that is compared: the store of a sweep, or runs of `tarmac run`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "metrics/evaluation.h"

namespace tarmac::tools {

/// One estimator on one drive.
struct ComparedRun {
  std::string case_name;  ///< what is the same over seeds; of a recording from outside "recording <hash>"
  std::uint64_t seed = 0;
  std::string estimator;
  std::string status = "ok", message;
  std::string recording_hash;    ///< empty: unknown
  std::filesystem::path folder;  ///< of its evaluation.json
  std::vector<metrics::Row> rows;
};

struct ComparedFolder {
  std::filesystem::path path;
  std::string build;                           ///< "0.1.0 697e83c234a6"; several are separated by commas
  std::string provenance_json;                 ///< of the first run that has one
  std::vector<std::string> cases, estimators;  ///< all that are there or planned, whatever was asked for
  std::vector<ComparedRun> runs;
  std::size_t unfinished = 0;  ///< cells of a store that have no outcome yet
};

/// Of a folder's runs those that are wanted; empty: all.
struct FolderFilter {
  std::string case_name, estimator;
  std::vector<std::string> metrics;

  /// Without names all that tell of the method; those that describe the drive only by name.
  bool wants(const std::string& metric) const;
};

/// Throws InputError when there is nothing to read: neither store nor run, or an estimator without evaluation.
ComparedFolder read_compared_folder(const std::filesystem::path& path, const FolderFilter& filter,
                                    const core::Progress& progress);

}  // namespace tarmac::tools
