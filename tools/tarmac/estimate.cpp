// `tarmac estimate`: estimators on a recording that exists already, ours or a foreign one.
#include <fmt/format.h>

#include "core/error.h"
#include "io/sensor/plain.h"
#include "scenarios/scenario.h"
#include "tools/tarmac/commands.h"
#include "tools/tarmac/estimator_run.h"
#include "tools/tarmac/layout.h"
#include "tools/tarmac/provenance.h"
#include "tools/tarmac/results_table.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;

/// Where the recording lies, and where its truth does (empty: nowhere).
struct Source {
  fs::path recording, truth;
  Provenance provenance;
};

Source find_source(const fs::path& from, const fs::path& out, const Console& console) {
  Source source;
  if (fs::is_regular_file(from / "manifest.json")) {
    source.recording = from;
    if (fs::is_regular_file(from.parent_path() / "provenance.json") && fs::is_directory(from.parent_path() / "truth")) {
      source.truth = from.parent_path() / "truth";
      source.provenance = load_provenance(from.parent_path() / "provenance.json");
    }
  } else if (fs::is_directory(from / "recording")) {
    source.recording = from / "recording";
    if (fs::is_directory(from / "truth")) source.truth = from / "truth";
    if (fs::is_regular_file(from / "provenance.json")) source.provenance = load_provenance(from / "provenance.json");
  } else if (io::is_plain(from)) {
    fs::create_directories(out);
    fs::remove(RunFolder{out}.provenance());
    source.recording = out / "recording";
    io::import_plain(from, source.recording, console.progress("import"));
  } else {
    throw core::InputError(
        fmt::format("{}: is no folder of a run, no recording (no manifest.json) and no plain folder "
                    "(no lidar/stamps.txt)",
                    from.string()));
  }
  return source;
}

/// "out/recording/" names the same folder as "out/recording", and so has the same parent.
fs::path without_trailing_slash(const fs::path& path) {
  const fs::path absolute = fs::absolute(path).lexically_normal();
  return absolute.has_filename() ? absolute : absolute.parent_path();
}

std::vector<core::ConfigNode> blocks_of(const EstimateArguments& arguments) {
  core::ConfigNode config =
      arguments.config.empty() ? core::ConfigNode::parse("{}", "--set") : core::ConfigNode::load(arguments.config);
  for (const std::string& set : arguments.sets) {
    const auto [key, value] = scenarios::parse_override(set);
    // Estimators' names come first on this command: kiss-icp.voxel_size_m=0.5.
    config.set(key.starts_with("estimators.") ? key : "estimators." + key, value);
  }
  config.allow_only({"estimators"});
  return {config.child("estimators")};
}

std::string absolute_text(const fs::path& path) {
  return path.empty() ? "" : fs::absolute(path).lexically_normal().string();
}

}  // namespace

int estimate_command(const EstimateArguments& arguments, const CommonArguments& common) {
  const Console console(common.quiet);
  const auto requests = request_estimators(arguments.estimators, blocks_of(arguments));
  const RunFolder run{arguments.out};
  Source source = find_source(without_trailing_slash(arguments.recording), run.root, console);
  const core::Recording recording = core::Recording::open(source.recording);
  fs::create_directories(run.root);
  fs::remove(run.provenance());

  const auto outcomes =
      run_estimators(requests, source.recording, run.root, {common.threads(), arguments.diagnostics}, console);

  Provenance& provenance = source.provenance;
  provenance.recording_hash = recording.hash();
  const bool inside = fs::equivalent(source.recording.parent_path(), run.root);
  provenance.recording = inside ? "recording" : absolute_text(source.recording);
  provenance.truth = inside && !source.truth.empty() ? "truth" : absolute_text(source.truth);
  // Into the folder of the run that made the recording: what made that, and what ran there before, stays said.
  const std::string command = shell_command(common.words);
  provenance.command = inside && !provenance.command.empty() ? provenance.command + " && " + command : command;
  provenance.threads = common.threads();
  if (!inside) provenance.options.clear();
  bool failed = false;
  for (const EstimatorRequest& request : requests)
    provenance.options += fmt::format("{}:\n{}", request.name, resolved_options(request));
  for (const Outcome& outcome : outcomes) failed = failed || outcome.failed();
  const fs::path scenario = source.recording.parent_path() / "scenario.yaml";
  if (!inside && !source.truth.empty() && fs::is_regular_file(scenario)) {
    fs::copy_file(scenario, run.scenario(), fs::copy_options::overwrite_existing);
  }
  save_provenance(run.provenance(), provenance);
  link_latest(run.root);
  print_estimates(run, outcomes, common.json);
  return failed ? 3 : 0;
}

}  // namespace tarmac::tools
