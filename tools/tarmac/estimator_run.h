/// Runs estimators on a recording, each as a child program in a private working folder that holds the recording, its
/// options and an output folder, and nothing of the truth.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/diagnostics.h"
#include "core/recording.h"
#include "estimators/estimator.h"
#include "scenarios/scenario.h"
#include "tools/tarmac/child.h"
#include "tools/tarmac/console.h"
#include "tools/tarmac/outcome.h"

namespace tarmac::tools {

/// A program of somebody else's that reads the plain format and writes a TUM trajectory.
struct ForeignTool {
  std::vector<std::string> command;   ///< {input} is replaced by the plain folder, {output} by the TUM file to write
  std::string frame = "lidar";        ///< whose pose it writes: lidar | body
  std::string interpolation = "se3";  ///< between its poses: se3 | slerp | hold
  double timeout_s = 600;
  void visit(core::OptionVisitor& v);
};

struct EstimatorRequest {
  std::string name;
  const estimators::EstimatorEntry* bundled = nullptr;  ///< nullptr: a foreign tool
  ForeignTool tool;
  core::ConfigNode options;
};

/// The `estimators:` blocks of a --config file (when there is one) and of the scenario, what --set says in both.
std::vector<core::ConfigNode> estimator_blocks(const scenarios::Scenario& scenario, const std::string& config,
                                               const std::vector<scenarios::Override>& overrides);

/// Estimators by the names in `list` ("a,b", or "all" for every bundled one and every foreign one that is configured).
/// `blocks` are the `estimators:` blocks of the scenario and of --config, later ones first. Validates all options.
/// Throws InputError.
std::vector<EstimatorRequest> request_estimators(const std::string& list, const std::vector<core::ConfigNode>& blocks);

/// The options of a request with every value written out, as YAML indented by 4 (or the foreign block).
std::string resolved_options(const EstimatorRequest& request);

struct EstimatorRunSettings {
  int threads = 1;
  std::string diagnostics = "full";
  ChildLimits limits = {};                       ///< a foreign tool's own timeout holds beside them
  std::filesystem::path work_folder = {};        ///< where private folders are made; empty: the system's place
  std::filesystem::path estimator_program = {};  ///< empty: the tarmac-estimate beside this program
};

/// Runs one; its results become the folder `target`, put in place whole.
Outcome run_one_estimator(const EstimatorRequest& request, const std::filesystem::path& recording_folder,
                          const std::string& recording_hash, const std::filesystem::path& target,
                          const EstimatorRunSettings& settings, const core::Progress& progress);

/// Runs them one after the other; results go to `folder`/<name>/, each put in place whole. Earlier results of the same
/// estimators are removed first.
std::vector<Outcome> run_estimators(const std::vector<EstimatorRequest>& requests,
                                    const std::filesystem::path& recording_folder, const std::filesystem::path& folder,
                                    const EstimatorRunSettings& settings, const Console& console);

}  // namespace tarmac::tools
