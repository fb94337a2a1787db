/// Puts a report's page together: text, data, pictures, script and style in one HTML file. No VTK here.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reports/offscreen_gl.h"
#include "reports/report.h"
#include "reports/stills.h"

namespace tarmac::reports {

/// An encoded picture.
struct Picture {
  std::string media_type;  ///< "image/jpeg"
  std::string bytes;
  int width_px = 0, height_px = 0;
};

struct MapPicture {
  std::string estimator;
  std::uint64_t seed = 0;
  Picture picture;
};

struct Pictures {
  std::optional<Picture> overview;
  std::optional<Picture> top;
  TopView top_view;  ///< where `top` lies in the world
  std::vector<MapPicture> maps;
  ErrorScale scale;
  std::string note;  ///< why pictures are missing; shown in their place
};

/// Sizes that make a page of a few megabytes.
struct PictureSettings {
  int overview_width_px = 1600, overview_height_px = 860;
  int top_width_px = 2000;
  int map_width_px = 1200, map_height_px = 700;
  std::string egl_library = kEglLibrary;
};
/// Draws what the input has to show: the scene, the scene from above, and the maps of the first run. Where this machine
/// cannot draw, the result's note says why and what to install.
Pictures draw_pictures(const ReportInput& input, const core::Progress& progress, const PictureSettings& settings = {});

/// The whole page. It refers to nothing outside of itself.
std::string assemble_page(const ReportInput& input, const Pictures& pictures);

/// A document around a page's body, data block (safe inside a script element), style and script.
std::string frame_page(const std::string& title, std::string_view style, const std::string& body,
                       const std::string& data, std::string_view script);

/// The page's data block as JSON, safe inside a script element. Its form is described in reports/README.md.
std::string page_data(const ReportInput& input, const Pictures& pictures);

/// One sentence that the data support, and a second one on how sure it is (may be empty).
struct Verdict {
  std::string sentence, note;
};
Verdict verdict(const std::vector<ReportRun>& runs);

/// Text as HTML text or attribute value.
std::string escape_html(const std::string& text);
std::string base64(const std::string& bytes);

}  // namespace tarmac::reports
