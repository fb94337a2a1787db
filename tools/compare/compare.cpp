#include "tools/compare/compare.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/config.h"
#include "core/error.h"
#include "metrics/registry.h"
#include "tools/compare/drives.h"
#include "tools/compare/folder.h"
#include "tools/compare/pairing.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;

/// The part of a progress bar that a piece of work has.
core::Progress part(const core::Progress& whole, double from, double to) {
  return [whole, from, to](double fraction, const std::string& note) {
    if (whole) whole(from + (to - from) * fraction, note);
  };
}

[[noreturn]] void not_there(const char* what, const std::string& name, const std::string& where,
                            const std::vector<std::string>& names) {
  const std::string guess = core::did_you_mean(name, names);
  std::string list;
  for (const std::string& one : names) list += (list.empty() ? "" : ", ") + one;
  throw core::InputError(fmt::format("compare: {} has no {} '{}'{}; there are: {}", where, what, name,
                                     guess.empty() ? "" : fmt::format(" (did you mean '{}'?)", guess),
                                     list.empty() ? "none" : list));
}

void check_is_there(const char* what, const std::string& name, const ComparedFolder& folder,
                    const std::vector<std::string>& names) {
  if (name.empty() || std::find(names.begin(), names.end(), name) != names.end()) return;
  not_there(what, name, folder.path.string(), names);
}

/// A metric is known when the registry or any run has it: a newer build's metrics are as good.
void check_metrics(const ComparedFolder& a, const ComparedFolder& b, const std::vector<std::string>& wanted) {
  for (const std::string& name : wanted) {
    if (metrics::find_metric(name)) continue;
    std::vector<std::string> names;
    for (const auto& entry : metrics::metrics()) names.push_back(entry.name);
    for (const ComparedFolder* folder : {&a, &b})
      for (const ComparedRun& run : folder->runs)
        for (const metrics::Row& row : run.rows)
          if (std::find(names.begin(), names.end(), row.metric) == names.end()) names.push_back(row.metric);
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw core::InputError(
          fmt::format("compare: --metrics: there is no metric '{}'{}; `tarmac list metrics` names all", name,
                      core::did_you_mean(name, names).empty()
                          ? ""
                          : fmt::format(" (did you mean '{}'?)", core::did_you_mean(name, names))));
  }
}

/// The last parts of two paths from where they differ: "main/out" and "branch/out".
std::pair<std::string, std::string> short_names(const fs::path& a, const fs::path& b) {
  const auto parts = [](const fs::path& path) {
    std::vector<std::string> list;
    for (const fs::path& part : fs::absolute(path).lexically_normal())
      if (!part.empty() && part != "/") list.push_back(part.string());
    return list;
  };
  const std::vector<std::string> of_a = parts(a), of_b = parts(b);
  std::string name_a, name_b;
  for (std::size_t k = 1; k <= std::max(of_a.size(), of_b.size()) && name_a == name_b; ++k) {
    if (k <= of_a.size()) name_a = of_a[of_a.size() - k] + (name_a.empty() ? "" : "/" + name_a);
    if (k <= of_b.size()) name_b = of_b[of_b.size() - k] + (name_b.empty() ? "" : "/" + name_b);
  }
  return {name_a, name_b};
}

reports::CompareSide side(const ComparedFolder& folder, const std::string& estimator, const std::string& label) {
  reports::CompareSide out;
  out.label = label;
  out.folder = folder.path.string();
  out.estimator = estimator;
  out.build = folder.build;
  out.provenance_json = folder.provenance_json;
  out.cells = folder.runs.size();
  return out;
}

void label_sides(const CompareSettings& settings, const ComparedFolder& a, const ComparedFolder& b,
                 reports::CompareInput& into) {
  const bool one_folder = fs::weakly_canonical(settings.a) == fs::weakly_canonical(settings.b);
  auto [name_a, name_b] = short_names(settings.a, settings.b);
  const std::string &of_a = settings.estimator_a, &of_b = settings.estimator_b;
  if (!of_a.empty() && of_a != of_b) {
    name_a = one_folder ? of_a : fmt::format("{} ({})", of_a, name_a);
    name_b = one_folder ? of_b : fmt::format("{} ({})", of_b, name_b);
  } else if (name_a == name_b) {
    name_a += " (A)";
    name_b += " (B)";
  }
  into.a = side(a, of_a, name_a);
  into.b = side(b, of_b, name_b);
}

void add_unfinished(const char* kind, const ComparedFolder& folder, std::vector<reports::CompareMissing>& missing) {
  if (folder.unfinished == 0) return;
  missing.push_back({kind, "cells of the sweep",
                     fmt::format("run them with `tarmac sweep ... -o {} --resume`", folder.path.string()),
                     folder.unfinished});
}

}  // namespace

reports::CompareInput compare_folders(const CompareSettings& settings, const core::Progress& progress) {
  const ComparedFolder a = read_compared_folder(
      settings.a, {settings.case_name, settings.estimator_a, settings.metrics}, part(progress, 0, 0.3));
  const ComparedFolder b = read_compared_folder(
      settings.b, {settings.case_name, settings.estimator_b, settings.metrics}, part(progress, 0.3, 0.6));
  check_is_there("estimator", settings.estimator_a, a, a.estimators);
  check_is_there("estimator", settings.estimator_b, b, b.estimators);
  check_is_there("case", settings.case_name, a, a.cases);
  check_is_there("case", settings.case_name, b, b.cases);
  check_metrics(a, b, settings.metrics);
  Pairing pairing = pair_runs(a, b, {settings.estimator_a, settings.estimator_b, settings.metrics});
  reports::CompareInput input;
  label_sides(settings, a, b, input);
  if (settings.drives) {
    input.drives = compare_drives(pairing, kMostDrives, part(progress, 0.6, 1), input.missing);
    input.drives_left_out = pairing.pairs.size() - std::min(pairing.pairs.size(), kMostDrives);
  }
  input.rows = std::move(pairing.rows);
  input.missing.insert(input.missing.begin(), pairing.missing.begin(), pairing.missing.end());
  add_unfinished("unfinished in A", a, input.missing);
  add_unfinished("unfinished in B", b, input.missing);
  input.same_recordings = pairing.same_recordings;
  input.different_recordings = pairing.different_recordings;
  input.unknown_recordings = pairing.unknown_recordings;
  input.different = std::move(pairing.different);
  if (progress) progress(1, "");
  return input;
}

}  // namespace tarmac::tools
