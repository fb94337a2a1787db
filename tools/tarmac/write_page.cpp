#include "tools/tarmac/write_page.h"

#include <fmt/format.h>

#include <optional>

#include "core/error.h"
#include "core/files.h"
#include "reports/report.h"
#include "scenarios/scenario.h"
#include "scenes/registry.h"
#include "tools/tarmac/evaluation_run.h"
#include "tools/tarmac/provenance.h"

namespace tarmac::tools {

void write_page(const std::vector<RunFolder>& runs, const std::filesystem::path& html_file, const Console& console) {
  reports::ReportInput input;
  std::optional<scenes::Scene> scene;
  bool first = true;
  for (const RunFolder& run : runs) {
    const Provenance provenance = load_provenance(run.provenance());
    const std::string shown = provenance.truth.empty() ? "Recording " + provenance.recording_hash : provenance.scenario;
    if (first && provenance.truth.empty()) {
      input.title = shown;
      input.why =
          "A recording from outside. What needs the true motion is left out or n/a; what the methods say of "
          "themselves is here.";
    } else if (first) {
      const scenarios::Scenario scenario = scenarios::load_scenario(run.scenario(), {});
      input.title = scenario.name;
      input.why = scenario.why;
      input.surprise = scenario.surprise;
      input.picture_time = core::time_from_s(scenario.duration_s / 2);
      scene = scenes::make_scene(scenario.scene, provenance.seed);
    } else if (shown != input.title) {
      throw core::InputError(fmt::format("{}: is a run of '{}', the others are of '{}'; one report shows one scenario",
                                         run.root.string(), shown, input.title));
    }
    first = false;
    input.runs.push_back({run.root, core::read_file(run.provenance()), load_evaluations(run)});
  }
  input.scene = scene ? &*scene : nullptr;
  if (html_file.has_parent_path()) std::filesystem::create_directories(html_file.parent_path());
  reports::write_report(html_file, input, console.progress("report"));
}

}  // namespace tarmac::tools
