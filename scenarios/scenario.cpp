#include "scenarios/scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/error.h"

namespace tarmac::scenarios {
namespace {

constexpr std::uint64_t kMaxSeeds = 10000;

struct TopLevel {
  Scenario& scenario;
  void visit(core::OptionVisitor& v) {
    v("name", scenario.name, "kebab-case name, the same as the file's");
    v("why", scenario.why, "the reason why the question is asked");
    v("surprise", scenario.surprise, "what result would be a surprise");
    v("seed", scenario.seed, "seed of all random draws when the command line gives none", {.at_least = 0});
    v("duration_s", scenario.duration_s, "length of the drive", {.above = 0, .at_most = 36000});
    v.group("truth", scenario.truth, "what of the truth is stored that could be computed again");
  }
};

std::uint64_t parse_seed(const std::string& text, const std::string& whole) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) {
    throw core::InputError(fmt::format("--seed {}: expected a whole number such as 7, or a range such as 1..5", whole));
  }
  return seed;
}

}  // namespace

void TruthOptions::visit(core::OptionVisitor& v) {
  v("per_point", per_point, "store every point's true range, normal and incidence beside its label");
}

bool is_kebab(const std::string& name) {
  return !name.empty() && name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos &&
         name.front() != '-' && name.back() != '-';
}

Override parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw core::InputError(fmt::format("--set {}: expected key=value, such as motion.cruise_m_s=5", text));
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

Scenario load_scenario(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  Scenario scenario;
  scenario.node = core::ConfigNode::load(file.string());
  for (const auto& [key, value] : overrides) scenario.node.set(key, value);
  if (!scenario.node.is_block()) scenario.node.fail("a scenario is a block of `key: value` lines");
  TopLevel top{scenario};
  scenario.node.read(top, {"scene", "motion", "rig", "faults", "estimators"});
  if (!is_kebab(scenario.name)) {
    scenario.node.fail_at("name", fmt::format("'{}' must be a name in kebab-case, such as stand-turn", scenario.name));
  }
  if (scenario.duration_s <= 0) scenario.node.fail_at("duration_s", "is missing; expected a number above 0");
  for (auto [block, name] :
       {std::pair{&scenario.scene, "scene"}, std::pair{&scenario.motion, "motion"}, std::pair{&scenario.rig, "rig"},
        std::pair{&scenario.faults, "faults"}, std::pair{&scenario.estimators, "estimators"}}) {
    *block = scenario.node.child(name);
    const bool needed = block != &scenario.faults && block != &scenario.estimators;
    if (needed && !block->present()) scenario.node.fail_at(name, "is missing; a scenario needs scene, motion and rig");
    if (block->present() && !block->is_block()) block->fail("must be a block of `key: value` lines");
  }
  return scenario;
}

std::vector<std::filesystem::path> list_scenarios(const std::vector<std::filesystem::path>& folders) {
  std::vector<std::filesystem::path> files;
  for (const auto& folder : folders) {
    if (!std::filesystem::is_directory(folder)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.is_regular_file() && entry.path().extension() == ".yaml") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.filename() < b.filename(); });
  files.erase(std::unique(files.begin(), files.end(),
                          [](const auto& a, const auto& b) { return a.filename() == b.filename(); }),
              files.end());
  return files;
}

std::filesystem::path find_scenario(const std::string& name_or_path,
                                    const std::vector<std::filesystem::path>& folders) {
  if (std::filesystem::is_regular_file(name_or_path)) return name_or_path;
  std::vector<std::string> names;
  for (const auto& file : list_scenarios(folders)) {
    if (file.stem() == name_or_path) return file;
    names.push_back(file.stem().string());
  }
  const std::string guess = core::did_you_mean(std::filesystem::path(name_or_path).stem().string(), names);
  throw core::InputError(fmt::format("{}: there is no such scenario file or name{}; `tarmac list scenarios` shows all",
                                     name_or_path, guess.empty() ? "" : fmt::format("; did you mean '{}'?", guess)));
}

std::vector<std::uint64_t> parse_seeds(const std::string& text) {
  const std::size_t dots = text.find("..");
  const std::uint64_t first = parse_seed(text.substr(0, dots), text);
  const std::uint64_t last = dots == std::string::npos ? first : parse_seed(text.substr(dots + 2), text);
  if (last < first || last - first >= kMaxSeeds) {
    throw core::InputError(fmt::format("--seed {}: the range must ascend and hold at most {} seeds", text, kMaxSeeds));
  }
  std::vector<std::uint64_t> seeds;
  for (std::uint64_t seed = first; seed <= last; ++seed) seeds.push_back(seed);
  return seeds;
}

}  // namespace tarmac::scenarios
