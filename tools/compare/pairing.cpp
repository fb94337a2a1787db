#include "tools/compare/pairing.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/error.h"
#include "tools/compare/rows.h"

namespace tarmac::tools {
namespace {

using reports::CompareMissing;
using BySeed = std::map<std::uint64_t, const ComparedRun*>;

/// Case, then name of the pair: the estimator's own where each stands against its namesake.
using Key = std::pair<std::string, std::string>;

std::map<Key, BySeed> keyed(const ComparedFolder& folder, const std::string& estimator) {
  std::map<Key, BySeed> out;
  for (const ComparedRun& run : folder.runs) {
    if (!estimator.empty() && run.estimator != estimator) continue;
    out[{run.case_name, estimator.empty() ? run.estimator : ""}][run.seed] = &run;
  }
  return out;
}

std::string list_of(const std::set<std::string>& names) {
  constexpr std::size_t kMost = 8;
  std::string text;
  std::size_t n = 0;
  for (const std::string& name : names) {
    if (n == kMost) return text + fmt::format(" and {} more", names.size() - kMost);
    text += (n++ ? ", " : "") + name;
  }
  return text.empty() ? "none" : text;
}

std::string what_is_there(const ComparedFolder& folder) {
  std::set<std::string> cases, estimators;
  std::vector<std::uint64_t> seeds;
  for (const ComparedRun& run : folder.runs) {
    cases.insert(run.case_name);
    estimators.insert(run.estimator);
    seeds.push_back(run.seed);
  }
  if (folder.runs.empty()) return "no finished run";
  return fmt::format("cases: {}; estimators: {}; seeds: {}", list_of(cases), list_of(estimators), seed_list(seeds));
}

std::vector<std::uint64_t> seeds_of(const BySeed& runs) {
  std::vector<std::uint64_t> seeds;
  for (const auto& [seed, run] : runs) seeds.push_back(seed);
  return seeds;
}

/// Cases and estimators that only one side has: a whole case as one line.
void add_only_in(const char* kind, const std::map<Key, BySeed>& here, const std::map<Key, BySeed>& there,
                 std::vector<CompareMissing>& missing) {
  std::set<std::string> cases_there;
  for (const auto& [key, runs] : there) cases_there.insert(key.first);
  std::map<std::string, CompareMissing> cases;
  for (const auto& [key, runs] : here) {
    if (there.contains(key)) continue;
    const std::string seeds = "seeds " + seed_list(seeds_of(runs));
    if (cases_there.contains(key.first)) {
      missing.push_back({kind, fmt::format("{} on case {}", key.second, key.first), seeds, runs.size()});
      continue;
    }
    CompareMissing& line = cases.try_emplace(key.first, CompareMissing{kind, "case " + key.first, "", 0}).first->second;
    line.detail += (line.detail.empty() ? "" : "; ") + (key.second.empty() ? "" : key.second + ", ") + seeds;
    line.count += runs.size();
  }
  for (auto& [name, line] : cases) missing.push_back(std::move(line));
}

std::string outcome(const ComparedRun& run) {
  return run.message.empty() ? run.status : fmt::format("{} ({})", run.status, run.message);
}

std::string name_of(const Key& key) {
  return key.second.empty() ? "case " + key.first : fmt::format("{} on case {}", key.second, key.first);
}

/// Seeds that only one side has, and runs without a result; one line for those that ended alike.
void add_unpaired_seeds(const Key& key, const BySeed& a, const BySeed& b, std::vector<CompareMissing>& missing) {
  std::map<std::pair<std::string, std::string>, std::vector<std::uint64_t>> lines;
  std::set<std::uint64_t> seeds;
  for (const auto& [seed, run] : a) seeds.insert(seed);
  for (const auto& [seed, run] : b) seeds.insert(seed);
  for (const std::uint64_t seed : seeds) {
    const auto in_a = a.find(seed), in_b = b.find(seed);
    if (in_a == a.end() || in_b == b.end()) {
      lines[{in_b == b.end() ? "only in A" : "only in B", ""}].push_back(seed);
      continue;
    }
    const ComparedRun &run_a = *in_a->second, &run_b = *in_b->second;
    const bool failed_a = run_a.status != "ok", failed_b = run_b.status != "ok";
    if (failed_a && failed_b) {
      const std::string how =
          outcome(run_a) == outcome(run_b) ? outcome(run_a) : "A: " + outcome(run_a) + ", B: " + outcome(run_b);
      lines[{"no result in both", how}].push_back(seed);
    } else if (failed_a || failed_b) {
      lines[{failed_a ? reports::kNoResultInA : reports::kNoResultInB, outcome(failed_a ? run_a : run_b)}].push_back(
          seed);
    }
  }
  for (const auto& [kind, which] : lines) {
    missing.push_back({kind.first, name_of(key),
                       fmt::format("{}seeds {}", kind.second.empty() ? "" : kind.second + ": ", seed_list(which)),
                       which.size()});
  }
}

PairedRuns paired(const Key& key, const BySeed& a, const BySeed& b) {
  PairedRuns out;
  out.case_name = key.first;
  for (const auto& [seed, run] : a) {
    const auto other = b.find(seed);
    if (other == b.end()) continue;
    out.estimator_a = run->estimator;
    out.estimator_b = other->second->estimator;
    if (run->status != "ok" || other->second->status != "ok") continue;
    out.seeds.push_back(seed);
    out.a.push_back(run);
    out.b.push_back(other->second);
  }
  return out;
}

/// A case and seed is one drive, whatever ran on it.
void compare_recordings(const ComparedFolder& a, const ComparedFolder& b, const std::set<std::string>& cases,
                        Pairing& into) {
  std::map<std::pair<std::string, std::uint64_t>, std::string> of_a, of_b;
  for (const ComparedRun& run : a.runs)
    if (std::string& hash = of_a[{run.case_name, run.seed}]; hash.empty()) hash = run.recording_hash;
  for (const ComparedRun& run : b.runs)
    if (std::string& hash = of_b[{run.case_name, run.seed}]; hash.empty()) hash = run.recording_hash;
  for (const auto& [drive, hash] : of_a) {
    const auto other = of_b.find(drive);
    if (other == of_b.end() || !cases.contains(drive.first)) continue;
    if (hash.empty() || other->second.empty()) {
      ++into.unknown_recordings;
    } else if (hash == other->second) {
      ++into.same_recordings;
    } else {
      ++into.different_recordings;
      into.different.push_back(fmt::format("{} seed {}", drive.first, drive.second));
    }
  }
}

}  // namespace

std::string seed_list(std::vector<std::uint64_t> seeds) {
  std::sort(seeds.begin(), seeds.end());
  seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());
  std::string text;
  for (std::size_t i = 0; i < seeds.size();) {
    std::size_t last = i;
    while (last + 1 < seeds.size() && seeds[last + 1] == seeds[last] + 1) ++last;
    text += text.empty() ? "" : ", ";
    if (last > i + 1)
      text += fmt::format("{}..{}", seeds[i], seeds[last]);
    else
      last = i, text += std::to_string(seeds[i]);
    i = last + 1;
  }
  return text.empty() ? "none" : text;
}

Pairing pair_runs(const ComparedFolder& a, const ComparedFolder& b, const PairingRule& rule) {
  const auto of_a = keyed(a, rule.estimator_a), of_b = keyed(b, rule.estimator_b);
  Pairing out;
  std::set<std::string> cases;
  add_only_in("only in A", of_a, of_b, out.missing);
  add_only_in("only in B", of_b, of_a, out.missing);
  bool common = false;
  for (const auto& [key, runs_a] : of_a) {
    const auto found = of_b.find(key);
    if (found == of_b.end()) continue;
    add_unpaired_seeds(key, runs_a, found->second, out.missing);
    PairedRuns pair = paired(key, runs_a, found->second);
    if (pair.estimator_a.empty()) continue;  // no seed in both
    common = true;
    cases.insert(key.first);
    if (pair.seeds.empty()) continue;
    add_rows(pair, rule.metrics, out);
    out.pairs.push_back(std::move(pair));
  }
  if (!common) {
    const auto wanted = [](const std::string& estimator) { return estimator.empty() ? "" : estimator + " of "; };
    throw core::InputError(
        fmt::format("compare: {}{} and {}{} have no case, estimator and seed in common.\n  A has {}\n  B has {}\n"
                    "Compare two estimators with --a and --b, or folders of the same scenarios and seeds",
                    wanted(rule.estimator_a), a.path.string(), wanted(rule.estimator_b), b.path.string(),
                    what_is_there(a), what_is_there(b)));
  }
  compare_recordings(a, b, cases, out);
  judge_rows(out.rows);
  return out;
}

}  // namespace tarmac::tools
