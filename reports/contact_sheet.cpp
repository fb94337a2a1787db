#include "reports/contact_sheet.h"

#include <vtkFreeTypeTools.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cstring>

#include "core/error.h"
#include "core/files.h"

namespace tarmac::reports {

namespace {

using Eigen::Vector3d;

constexpr int kScreen_dpi = 72;  // a font of n points is then n pixels high
const Vector3d kFrontLeft = Vector3d(-0.74, -0.67, 0.21).normalized();

Image white(int width_px, int height_px) {
  return {width_px, height_px, std::vector<std::uint8_t>(std::size_t(3) * width_px * height_px, 255)};
}

void paste(Image& onto, const Image& image, int x_px, int y_px) {
  const int width = std::min(image.width_px, onto.width_px - x_px);
  const int height = std::min(image.height_px, onto.height_px - y_px);
  for (int y = 0; y < height; ++y) {
    std::memcpy(&onto.rgb[3 * (std::size_t(y_px + y) * onto.width_px + x_px)],
                &image.rgb[3 * std::size_t(y) * image.width_px], std::size_t(3) * width);
  }
}

Eigen::AlignedBox3d box_of(const Exhibit& exhibit) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : exhibit.points) box.extend(p);
  return box;
}

/// Directions to the eye and up; pictures of the side and from above have the front on the left.
FlatView side_view(const Vector3d& middle, double m_per_px) {
  return {middle, -Vector3d::UnitY(), Vector3d::UnitZ(), m_per_px, 0, 0};
}
FlatView front_view(const Vector3d& middle, double m_per_px) {
  return {middle, -Vector3d::UnitX(), Vector3d::UnitZ(), m_per_px, 0, 0};
}
FlatView plan_view(const Vector3d& middle, double m_per_px) {
  return {middle, Vector3d::UnitZ(), Vector3d::UnitY(), m_per_px, 0, 0};
}

Image outline(Stills& stills, FlatView view, double width_m, double height_m) {
  view.width_px = std::max(8, static_cast<int>(width_m / view.m_per_px) + 4);
  view.height_px = std::max(8, static_cast<int>(height_m / view.m_per_px) + 4);
  return stills.silhouette(view);
}

}  // namespace

Image stack(const std::vector<Image>& images, int gap_px) {
  int width = 0, height = -gap_px;
  for (const Image& image : images) {
    width = std::max(width, image.width_px);
    height += image.height_px + gap_px;
  }
  Image all = white(width, height);
  int y = 0;
  for (const Image& image : images) {
    paste(all, image, (width - image.width_px) / 2, y);
    y += image.height_px + gap_px;
  }
  return all;
}

Image beside(const std::vector<Image>& images, int gap_px) {
  int width = -gap_px, height = 0;
  for (const Image& image : images) {
    height = std::max(height, image.height_px);
    width += image.width_px + gap_px;
  }
  Image all = white(width, height);
  int x = 0;
  for (const Image& image : images) {
    paste(all, image, x, (height - image.height_px) / 2);
    x += image.width_px + gap_px;
  }
  return all;
}

void draw_text(Image& image, int x_px, int y_px, const std::string& text, int size_px) {
  vtkNew<vtkTextProperty> property;
  property->SetFontFamilyToArial();
  property->SetFontSize(size_px);
  property->SetColor(0.10, 0.14, 0.20);
  vtkNew<vtkImageData> letters;
  vtkFreeTypeTools* const tools = vtkFreeTypeTools::GetInstance();
  if (!tools->RenderString(property, vtkStdString(text), kScreen_dpi, letters)) return;
  int extent[6];
  letters->GetExtent(extent);
  const auto* const rgba = static_cast<const unsigned char*>(letters->GetScalarPointer());
  const int width = extent[1] - extent[0] + 1, height = extent[3] - extent[2] + 1;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const unsigned char* const pixel = rgba + 4 * (std::size_t(row) * width + column);
      const int x = x_px + column, y = y_px - row;
      if (x < 0 || y < 0 || x >= image.width_px || y >= image.height_px) continue;
      std::uint8_t* const at = &image.rgb[3 * (std::size_t(y) * image.width_px + x)];
      const double cover = pixel[3] / 255.0;
      for (int channel = 0; channel < 3; ++channel) {
        at[channel] = static_cast<std::uint8_t>(cover * pixel[channel] + (1 - cover) * at[channel] + 0.5);
      }
    }
  }
}

Image contact_sheet(const std::vector<Tile>& tiles, int columns) {
  constexpr int gap = 12, line = 30, font = 18;
  if (tiles.empty()) return white(gap, gap);
  const int width = tiles.front().image.width_px, height = tiles.front().image.height_px;
  const int rows = (static_cast<int>(tiles.size()) + columns - 1) / columns;
  Image sheet = white(gap + columns * (width + gap), gap + rows * (height + line + gap));
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    const int column = static_cast<int>(k) % columns, row = static_cast<int>(k) / columns;
    const int x = gap + column * (width + gap), y = gap + row * (height + line + gap);
    paste(sheet, tiles[k].image, x, y);
    draw_text(sheet, x + 2, y + height + line - 9, tiles[k].name, font);
  }
  return sheet;
}

Image exhibit_picture(const Exhibit& exhibit, int width_px, int height_px) {
  Stills stills(*exhibit.scene, core::Time{});
  const Vector3d size = box_of(exhibit).sizes(), middle = box_of(exhibit).center();
  constexpr int gap = 16;
  const double m_per_px = 1.04 * (2 * size.x() + size.y()) / (width_px - 4 * gap);
  const Image outlines = beside({outline(stills, side_view(middle, m_per_px), size.x(), size.z()),
                                 outline(stills, front_view(middle, m_per_px), size.y(), size.z()),
                                 outline(stills, plan_view(middle, m_per_px), size.x(), size.y())},
                                gap);
  const int lower = std::min(outlines.height_px, height_px / 2);
  return stack({stills.view(exhibit.points, kFrontLeft, width_px, height_px - lower - gap), outlines}, gap);
}

Image exhibit_tile(const Exhibit& exhibit, double m_per_px, int width_px, int height_px, int outline_height_px) {
  Stills stills(*exhibit.scene, core::Time{});
  const Vector3d size = box_of(exhibit).sizes(), middle = box_of(exhibit).center();
  const Image outlines = beside({outline(stills, side_view(middle, m_per_px), size.x(), size.z()),
                                 outline(stills, front_view(middle, m_per_px), size.y(), size.z())},
                                10);
  Image tile = white(width_px, height_px);
  const int picture_px = height_px - outline_height_px;
  paste(tile, stills.view(exhibit.points, kFrontLeft, width_px, picture_px), 0, 0);
  paste(tile, outlines, std::max(0, (width_px - outlines.width_px) / 2),
        height_px - std::min(outline_height_px, outlines.height_px));
  return tile;
}

void write_picture(const std::filesystem::path& file, const Image& image, int jpeg_quality_percent) {
  const std::string extension = file.extension().string();
  if (extension == ".png") {
    core::write_file(file, to_png(image));
  } else if (extension == ".jpg" || extension == ".jpeg") {
    core::write_file(file, to_jpeg(image, jpeg_quality_percent));
  } else {
    throw core::InputError("picture " + file.string() + ": a name that ends in .png, .jpg or .jpeg is expected");
  }
}

}  // namespace tarmac::reports
