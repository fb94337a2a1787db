#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "reports/page.h"

namespace tarmac::reports {

namespace {

constexpr double kNarrowestFrame = 1 / 0.6, kWidestFrame = 1 / 0.45;  ///< width over height, as in topview.js
constexpr int kJpegQuality_percent = 84;
constexpr double kPathMargin = 0.1;  ///< of the path's longer side, as in topview.js

Picture jpeg(const Image& image) {
  return {"image/jpeg", to_jpeg(image, kJpegQuality_percent), image.width_px, image.height_px};
}

/// The scene's own rectangle, grown to hold the true path with room around it and to the shape of the page's frame, so
/// that the picture fills it. Estimated paths may leave it: the reader can pan.
TopView view_of(const ReportInput& input, int width_px) {
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
  return top_view(shown.min() - grow, shown.max() + grow, width_px);
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

Pictures draw_all(const ReportInput& input, const core::Progress& progress, const PictureSettings& settings) {
  const auto evaluations = with_maps(input);
  const double steps = static_cast<double>(evaluations.size()) + 4;
  double done = 0;
  const auto tell = [&](const std::string& note) {
    if (progress) progress(done++ / steps, note);
  };
  Pictures pictures;
  tell("setting up the scene");
  Stills stills(*input.scene, input.picture_time, settings.egl_library);
  tell("drawing the scene");
  pictures.overview = jpeg(stills.overview(settings.overview_width_px, settings.overview_height_px));
  tell("drawing the scene from above");
  pictures.top_view = view_of(input, settings.top_width_px);
  pictures.top = jpeg(stills.top(pictures.top_view));
  std::vector<const metrics::MapSample*> maps;
  for (const auto* evaluation : evaluations) maps.push_back(&evaluation->map);
  pictures.scale = error_scale(maps);
  for (const auto* evaluation : evaluations) {
    tell("drawing the map of " + evaluation->estimator);
    const Image image = stills.map(evaluation->map, pictures.scale, settings.map_width_px, settings.map_height_px);
    pictures.maps.push_back({evaluation->estimator, evaluation->seed, jpeg(image)});
  }
  return pictures;
}

Pictures none(const std::string& why) {
  Pictures pictures;
  pictures.note = why;
  return pictures;
}

}  // namespace

Pictures draw_pictures(const ReportInput& input, const core::Progress& progress, const PictureSettings& settings) {
  if (!input.scene) return none("There are no pictures of the scene: these runs have none (a recording from outside).");
  try {
    return draw_all(input, progress, settings);
  } catch (const RenderingUnavailable& error) {
    if (progress) progress(0.9, error.what());
    return none(fmt::format("There are no pictures of the scene: {}. Then make the report again.", error.what()));
  }
}

}  // namespace tarmac::reports
