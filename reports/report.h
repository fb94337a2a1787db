/// Evaluations -> one self-contained HTML page.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "metrics/evaluation.h"
#include "reports/stills.h"
#include "scenes/scene.h"

namespace tarmac::reports {

/// One run's results, as found under DIR (or DIR/seed-N).
struct ReportRun {
  std::filesystem::path folder;
  std::string provenance_json;                   ///< provenance.json's text
  std::vector<metrics::Evaluation> evaluations;  ///< one an estimator
};

struct ReportInput {
  std::string title;
  std::string why;  ///< the scenario's reason and what would be a surprise
  std::string surprise;
  std::vector<ReportRun> runs;           ///< several = seeds of one scenario
  const scenes::Scene* scene = nullptr;  ///< of the first run, for top view and stills; nullptr = none
  core::Time picture_time;               ///< at which actors stand in the pictures
};

/// Renders figures and stills and writes the page, whole or not at all.
void write_report(const std::filesystem::path& html_file, const ReportInput& input, const core::Progress& progress);

/// A still of a scene as PNG or JPEG, by the extension (`tarmac describe scene NAME -o picture.png`): the bird's view,
/// or what an eye sees.
void render_scene(const std::filesystem::path& file, const scenes::Scene& scene, core::Time t, int width_px,
                  int height_px, const std::optional<EyeView>& from = {});

}  // namespace tarmac::reports
