// Sweep and gate files, which lie in folders of their own beside the scenarios.
#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "scenarios/sweep_file.h"

namespace tarmac::scenarios {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> folders_beside(const std::string& subfolder, const std::vector<fs::path>& scenario_folders) {
  std::vector<fs::path> folders;
  for (const fs::path& folder : scenario_folders) folders.push_back(folder / subfolder);
  return folders;
}

}  // namespace

std::vector<fs::path> list_beside_scenarios(const std::string& subfolder,
                                            const std::vector<fs::path>& scenario_folders) {
  return list_scenarios(folders_beside(subfolder, scenario_folders));
}

fs::path find_beside_scenarios(const std::string& name_or_path, const std::string& subfolder,
                               const std::vector<fs::path>& scenario_folders) {
  if (fs::is_regular_file(name_or_path)) return name_or_path;
  std::vector<std::string> names;
  for (const fs::path& file : list_beside_scenarios(subfolder, scenario_folders)) {
    if (file.stem() == name_or_path) return file;
    names.push_back(file.stem().string());
  }
  const std::string kind = subfolder.substr(0, subfolder.size() - (subfolder.ends_with("s") ? 1 : 0));
  const std::string guess = core::did_you_mean(fs::path(name_or_path).stem().string(), names);
  throw core::InputError(fmt::format("{}: there is no such {} file or name{}; `tarmac list {}` shows all", name_or_path,
                                     kind, guess.empty() ? "" : fmt::format("; did you mean '{}'?", guess), subfolder));
}

}  // namespace tarmac::scenarios
