/// Still pictures of a scene and of a map on it. VTK stays behind this header.
///
/// The look is fixed: same scene, time and size, same pixels (software rasteriser; see offscreen_gl.h).
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/time.h"
#include "metrics/evaluation.h"
#include "reports/offscreen_gl.h"
#include "scenes/scene.h"

namespace tarmac::reports {

/// RGB, 8 bits each, row by row from the top left.
struct Image {
  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> rgb;
};
std::string to_png(const Image& image);
std::string to_jpeg(const Image& image, int quality_percent);

/// What a picture from straight above shows: x to the right, y up. Every pixel is a square of the world.
struct TopView {
  Eigen::Vector2d min_m, max_m;  ///< world, of the outer edges of the outer pixels
  int width_px = 0, height_px = 0;
};
/// The rectangle [min_m, max_m], its height rounded to a whole pixel.
TopView top_view(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m, int width_px);

/// A view without perspective: pictures with one `m_per_px` show things at one scale.
struct FlatView {
  Eigen::Vector3d middle_m;       ///< shown in the picture's middle
  Eigen::Vector3d direction, up;  ///< unit vectors: from the scene to the eye; upward in the picture
  double m_per_px = 0;
  int width_px = 0, height_px = 0;
};

/// What someone standing there sees. The picture's upper edge is up; looking straight down or up, it is +y.
struct EyeView {
  Eigen::Vector3d eye_m, look_at_m;  ///< world; at least 1 mm apart
  double height_deg = 50;            ///< angle from the picture's lower to its upper edge
};
/// Throws core::InputError where `text` is not three finite numbers with commas between ("12,-30,1.7"); `option` names
/// it in the message.
Eigen::Vector3d point_from(const std::string& option, const std::string& text);
/// Throws core::InputError where nothing can be seen that way.
void check(const EyeView& view);

/// Logarithmic colour scale of errors: below `low_m` the first colour, above `high_m` the last.
struct ErrorScale {
  double low_m = 0.01, high_m = 1;
};
/// 1-2-5 steps around the 25 % and 99 % quantiles of the middle map (the lower one of two), at least one decade: one
/// scale for all pictures of a report, which a single method that is far off does not stretch.
ErrorScale error_scale(const std::vector<const metrics::MapSample*>& maps);
/// sRGB in [0, 1] at a place of the scale in [0, 1]; NaN is grey.
Eigen::Vector3f error_color(double place);
/// Where an error stands on the scale, clipped to [0, 1].
double place_on(const ErrorScale& scale, double error_m);

/// Draws one scene again and again. Throws RenderingUnavailable when this machine cannot draw.
class Stills {
 public:
  Stills(const scenes::Scene& scene, core::Time t, const std::string& egl_library = kEglLibrary);
  ~Stills();
  Stills(const Stills&) = delete;
  Stills& operator=(const Stills&) = delete;

  /// Actors are put where they stand at t.
  void set_time(core::Time t);
  /// A bird's view from the south-west that holds the scene's rectangle of interest.
  Image overview(int width_px, int height_px);
  Image top(const TopView& view);
  /// As near as `points` (world) allow, with a little room around them, from `direction` (unit vector from the scene to
  /// the eye).
  Image view(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& direction, int width_px, int height_px);
  /// Ceilings are drawn here (the views from above leave them out). Throws core::InputError as `check` does.
  Image seen_from(const EyeView& view, int width_px, int height_px);
  /// Outlines: everything but the ground in one dark colour on white.
  Image silhouette(const FlatView& view);
  /// The scene dimmed, with the static points of a map over it coloured by their error. Same camera as `overview`.
  Image map(const metrics::MapSample& sample, const ErrorScale& scale, int width_px, int height_px);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tarmac::reports
