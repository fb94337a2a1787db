/// Where things lie: the folders of a run, the scenarios, and what a path on the command line stands for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tarmac::tools {

/// DIR of one run (one seed).
struct RunFolder {
  std::filesystem::path root;
  std::filesystem::path recording() const { return root / "recording"; }
  std::filesystem::path truth() const { return root / "truth"; }
  std::filesystem::path scenario() const { return root / "scenario.yaml"; }
  std::filesystem::path provenance() const { return root / "provenance.json"; }
  std::filesystem::path report() const { return root / "report.html"; }
};

/// Folders in which scenarios are looked up by name: ./scenarios, and the one that came with the program.
std::vector<std::filesystem::path> scenario_folders();

/// The runs below DIR: DIR itself, or its seed-N folders in order of N. Throws InputError when there is none.
std::vector<RunFolder> runs_below(const std::filesystem::path& folder);

/// The recording that a path means: itself, or that of a run. Throws InputError when it is neither.
std::filesystem::path recording_of(const std::filesystem::path& from);

/// Estimator folders of a run that hold a finished outcome, sorted by name.
std::vector<std::filesystem::path> estimator_folders(const RunFolder& run);

/// The text without the names of these folders (and the slash behind them): the same words wherever things lie.
std::string without_folders(std::string text, const std::vector<std::filesystem::path>& folders);

/// Points the link `latest` beside `folder` at it. A `latest` that is no link is left alone.
void link_latest(const std::filesystem::path& folder);

}  // namespace tarmac::tools
