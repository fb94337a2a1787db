/// Pictures put together: several views of one thing, and tiles with names under them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reports/stills.h"

namespace tarmac::reports {

/// One picture of `height` = the sum of all, each centred on white.
Image stack(const std::vector<Image>& images, int gap_px);
/// Side by side on white, each in the middle of the tallest one's height.
Image beside(const std::vector<Image>& images, int gap_px);

struct Tile {
  std::string name;
  Image image;
};
/// Tiles row by row, `columns` wide, the name under each. All images have one size.
Image contact_sheet(const std::vector<Tile>& tiles, int columns);

/// Dark letters on what is there, their lower left corner at (x, y from the top).
void draw_text(Image& image, int x_px, int y_px, const std::string& text, int size_px);

/// A thing alone on a flat floor, and where it is.
struct Exhibit {
  const scenes::Scene* scene = nullptr;
  Eigen::AlignedBox3d box;  ///< of the thing, world
};
/// From the front left, at eye height and a little above; below it outlines from the left side, the front and above, at
/// one scale.
Image exhibit_picture(const Exhibit& exhibit, int width_px, int height_px);
/// For a tile: the same view; below it the outlines from the left and the front, `m_per_px` chosen by the caller so
/// that all tiles of a sheet show one scale.
Image exhibit_tile(const Exhibit& exhibit, double m_per_px, int width_px, int height_px, int outline_height_px);

/// PNG or JPEG by the file's extension; throws core::InputError for another one.
void write_picture(const std::filesystem::path& file, const Image& image, int jpeg_quality_percent = 85);

}  // namespace tarmac::reports
