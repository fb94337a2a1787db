// `tarmac evaluate`: runs against their truth, or one trajectory file against another.
#include <fmt/format.h>

#include "core/error.h"
#include "io/sensor/tum.h"
#include "metrics/foreign.h"
#include "tools/tarmac/commands.h"
#include "tools/tarmac/evaluation_run.h"
#include "tools/tarmac/layout.h"
#include "tools/tarmac/results_table.h"

namespace tarmac::tools {
namespace {

std::vector<metrics::StampedPose> poses_of(const std::string& file) {
  std::vector<metrics::StampedPose> poses;
  for (const io::StampedPose& pose : io::read_trajectory(file)) poses.emplace_back(pose.t, pose.T);
  return poses;
}

int evaluate_files(const EvaluateArguments& arguments, const CommonArguments& common) {
  if (arguments.truth.empty() || arguments.estimate.empty()) {
    throw core::InputError("evaluate: --truth and --estimate belong together; expected both, or folders of runs");
  }
  metrics::ForeignSettings settings;
  settings.alignment = metrics::alignment(arguments.align.empty() ? "se3" : arguments.align);
  const metrics::ForeignEvaluation result =
      metrics::evaluate_poses(poses_of(arguments.truth), poses_of(arguments.estimate), settings);
  print_rows(result.rows, common.json);
  if (!common.json) {
    fmt::print("{} poses associated by interpolating the truth, {} outside its span, {} in its gaps\n",
               result.associated, result.outside, result.in_gaps);
  }
  return 0;
}

}  // namespace

int evaluate_command(const EvaluateArguments& arguments, const CommonArguments& common) {
  const bool files = !arguments.truth.empty() || !arguments.estimate.empty();
  if (files && !arguments.folders.empty())
    throw core::InputError("evaluate: give folders, or --truth and --estimate, not both");
  if (files) return evaluate_files(arguments, common);
  if (!arguments.align.empty())
    throw core::InputError(
        "evaluate: --align belongs to --truth and --estimate; runs are scored under every alignment");
  if (arguments.folders.empty())
    throw core::InputError("evaluate: expected folders of runs, or --truth FILE --estimate FILE");
  const Console console(common.quiet);
  std::vector<metrics::Evaluation> evaluations;
  bool failed = false;
  for (const std::string& folder : arguments.folders) {
    for (const RunFolder& run : runs_below(folder)) {
      for (metrics::Evaluation& evaluation : evaluate_run(run, common.threads(), console)) {
        failed = failed || (evaluation.status != "ok" && evaluation.status != "not_initialised");
        evaluations.push_back(std::move(evaluation));
      }
    }
  }
  print_results(evaluations, common.json);
  return failed ? 3 : 0;
}

}  // namespace tarmac::tools
