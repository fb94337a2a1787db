#include "reports/report.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/files.h"
#include "reports/offscreen_gl.h"
#include "reports/page.h"
#include "reports/stills.h"

namespace tarmac::reports {

namespace {

constexpr int kOverviewWidth_px = 1600, kOverviewHeight_px = 860;
constexpr int kTopWidth_px = 2000;
constexpr double kNarrowestFrame = 1 / 0.6, kWidestFrame = 1 / 0.45;  ///< width over height, as in topview.js
constexpr int kMapWidth_px = 1200, kMapHeight_px = 700;
constexpr int kJpegQuality_percent = 84;
constexpr double kPathMargin = 0.1;  ///< of the path's longer side, as in topview.js

Picture jpeg(const Image& image) {
  return {"image/jpeg", to_jpeg(image, kJpegQuality_percent), image.width_px, image.height_px};
}

/// The scene's own rectangle, grown to hold the true path with room around it and to the shape of the page's frame, so
/// that the picture fills it. Estimated paths may leave it: the reader can pan.
TopView view_of(const ReportInput& input) {
  Eigen::AlignedBox2d path;
  for (const auto& run : input.runs) {
    for (const auto& evaluation : run.evaluations) {
      const metrics::Series* const series = evaluation.find("path_true");
      for (std::size_t i = 0; series && i < std::min(series->x.size(), series->y.size()); ++i) {
        if (std::isfinite(series->x[i]) && std::isfinite(series->y[i])) {
          path.extend(Eigen::Vector2d(series->x[i], series->y[i]));
        }
      }
    }
  }
  Eigen::AlignedBox2d shown(input.scene->interest_min, input.scene->interest_max);
  if (!path.isEmpty()) {
    const Eigen::Vector2d margin = Eigen::Vector2d::Constant(kPathMargin * std::max(10.0, path.sizes().maxCoeff()));
    shown.extend(path.min() - margin).extend(path.max() + margin);
  }
  const double missing_x_m = kNarrowestFrame * shown.sizes().y() - shown.sizes().x();
  const double missing_y_m = shown.sizes().x() / kWidestFrame - shown.sizes().y();
  const Eigen::Vector2d grow(std::max(0.0, 0.5 * missing_x_m), std::max(0.0, 0.5 * missing_y_m));
  return top_view(shown.min() - grow, shown.max() + grow, kTopWidth_px);
}

/// Maps of the first run only: pictures are large, and seeds differ in noise.
std::vector<const metrics::Evaluation*> with_maps(const ReportInput& input) {
  std::vector<const metrics::Evaluation*> list;
  if (input.runs.empty()) return list;
  for (const auto& evaluation : input.runs.front().evaluations) {
    if (!evaluation.map.p_world_m.empty()) list.push_back(&evaluation);
  }
  return list;
}

void draw_pictures(const ReportInput& input, const core::Progress& progress, Pictures& pictures) {
  const auto evaluations = with_maps(input);
  const double steps = static_cast<double>(evaluations.size()) + 4;
  double done = 0;
  const auto tell = [&](const std::string& note) {
    if (progress) progress(done++ / steps, note);
  };
  tell("setting up the scene");
  Stills stills(*input.scene, input.picture_time);
  tell("drawing the scene");
  pictures.overview = jpeg(stills.overview(kOverviewWidth_px, kOverviewHeight_px));
  tell("drawing the scene from above");
  pictures.top_view = view_of(input);
  pictures.top = jpeg(stills.top(pictures.top_view));
  std::vector<const metrics::MapSample*> maps;
  for (const auto* evaluation : evaluations) maps.push_back(&evaluation->map);
  pictures.scale = error_scale(maps);
  for (const auto* evaluation : evaluations) {
    tell("drawing the map of " + evaluation->estimator);
    pictures.maps.push_back({evaluation->estimator, evaluation->seed,
                             jpeg(stills.map(evaluation->map, pictures.scale, kMapWidth_px, kMapHeight_px))});
  }
}

}  // namespace

void write_report(const std::filesystem::path& html_file, const ReportInput& input, const core::Progress& progress) {
  Pictures pictures;
  if (input.scene) {
    try {
      draw_pictures(input, progress, pictures);
    } catch (const RenderingUnavailable& error) {
      pictures = {};
      pictures.note = fmt::format("There are no pictures of the scene: {}. Then make the report again.", error.what());
      if (progress) progress(0.9, error.what());
    }
  } else {
    pictures.note = "There are no pictures of the scene: this run has none (a recording from outside).";
  }
  if (progress) progress(0.95, "writing the page");
  core::write_file(html_file, assemble_page(input, pictures));
  if (progress) progress(1, html_file.filename().string());
}

void render_scene(const std::filesystem::path& png_file, const scenes::Scene& scene, core::Time t, int width_px,
                  int height_px) {
  core::write_file(png_file, to_png(Stills(scene, t).overview(width_px, height_px)));
}

}  // namespace tarmac::reports
