#include "tools/tarmac/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "core/error.h"
#include "tools/tarmac/child.h"
#include "tools/tarmac/outcome.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;

std::optional<std::uint64_t> seed_of(const fs::path& folder) {
  const std::string name = folder.filename().string();
  if (!name.starts_with("seed-")) return std::nullopt;
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(name.data() + 5, name.data() + name.size(), seed);
  if (error != std::errc() || end != name.data() + name.size()) return std::nullopt;
  return seed;
}

bool is_run(const fs::path& folder) {
  return fs::is_regular_file(folder / "provenance.json");
}

}  // namespace

std::vector<fs::path> scenario_folders() {
  std::vector<fs::path> folders = {"scenarios"};
  // build/<preset>/tarmac: the project's folder lies two levels above the program.
  for (fs::path up = program_folder(); up.has_relative_path(); up = up.parent_path()) {
    if (fs::is_regular_file(up / "CMakePresets.json") && fs::is_directory(up / "scenarios")) {
      folders.push_back(up / "scenarios");
      break;
    }
  }
  return folders;
}

std::vector<RunFolder> runs_below(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw core::InputError(fmt::format("{}: there is no such folder", folder.string()));
  if (is_run(folder)) return {RunFolder{folder}};
  std::vector<std::pair<std::uint64_t, RunFolder>> runs;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const auto seed = seed_of(entry.path());
    if (seed && is_run(entry.path())) runs.push_back({*seed, RunFolder{entry.path()}});
  }
  if (runs.empty()) {
    throw core::InputError(
        fmt::format("{}: holds no finished run (no provenance.json here or in seed-N folders); "
                    "make one with `tarmac run` or `tarmac estimate`",
                    folder.string()));
  }
  std::sort(runs.begin(), runs.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<RunFolder> sorted;
  for (auto& [seed, run] : runs) sorted.push_back(std::move(run));
  return sorted;
}

fs::path recording_of(const fs::path& from) {
  if (fs::is_regular_file(from / "manifest.json")) return from;
  if (fs::is_directory(from / "recording")) return from / "recording";
  throw core::InputError(
      fmt::format("{}: is no recording and no folder of a run (no manifest.json, no recording/)", from.string()));
}

std::vector<fs::path> estimator_folders(const RunFolder& run) {
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(run.root)) {
    if (entry.is_directory() && has_outcome(entry.path()) && entry.path().extension() != ".part") {
      folders.push_back(entry.path());
    }
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

std::string without_folders(std::string text, const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders) {
    const std::string name = folder.string() + "/";
    if (folder.empty()) continue;
    for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos;) text.erase(at, name.size());
  }
  return text;
}

void link_latest(const fs::path& folder) {
  const fs::path absolute = fs::absolute(folder).lexically_normal();
  const fs::path target = absolute.has_filename() ? absolute : absolute.parent_path();
  const fs::path link = target.parent_path() / "latest";
  std::error_code error;
  const auto status = fs::symlink_status(link, error);
  if (fs::exists(status) && !fs::is_symlink(status)) return;
  fs::remove(link, error);
  fs::create_directory_symlink(target.filename(), link, error);
}

}  // namespace tarmac::tools
