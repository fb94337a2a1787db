// Tiles stand where they belong, names under them, outlines at one scale.
#include "reports/contact_sheet.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "scenes/primitives/mesh_builder.h"

namespace tarmac::reports {
namespace {

Image plain(int width_px, int height_px, std::uint8_t value) {
  return {width_px, height_px, std::vector<std::uint8_t>(std::size_t(3) * width_px * height_px, value)};
}

std::uint8_t red_at(const Image& image, int x, int y) {
  return image.rgb.at(3 * (std::size_t(y) * image.width_px + x));
}

TEST(ContactSheet, PutsTilesRowByRowAndTheirNamesBelow) {
  const Image sheet =
      contact_sheet({{"first", plain(100, 60, 10)}, {"second", plain(100, 60, 20)}, {"third", plain(100, 60, 30)}}, 2);
  ASSERT_EQ(sheet.width_px, 12 + 2 * 112);
  ASSERT_EQ(sheet.height_px, 12 + 2 * (60 + 30 + 12));
  EXPECT_EQ(red_at(sheet, 12 + 50, 12 + 30), 10);
  EXPECT_EQ(red_at(sheet, 12 + 112 + 50, 12 + 30), 20);
  EXPECT_EQ(red_at(sheet, 12 + 50, 12 + 102 + 30), 30);
  EXPECT_EQ(red_at(sheet, 12 + 112 + 50, 12 + 102 + 30), 255) << "no fourth tile";
  const auto ink = [&](int x0, int y0) {
    int dark = 0;
    for (int y = y0; y < y0 + 30; ++y) {
      for (int x = x0; x < x0 + 100; ++x) dark += red_at(sheet, x, y) < 128;
    }
    return dark;
  };
  EXPECT_GT(ink(12, 12 + 60), 30) << "a name below the first tile";
  EXPECT_GT(ink(12 + 112, 12 + 60), ink(12, 12 + 60)) << "'second' has more letters than 'first'";
  EXPECT_EQ(ink(12 + 112, 12 + 102 + 60), 0);
}

TEST(ContactSheet, StacksAndSetsBesideOnWhite) {
  const Image both = beside({plain(20, 10, 1), plain(30, 40, 2)}, 5);
  EXPECT_EQ(both.width_px, 55);
  EXPECT_EQ(both.height_px, 40);
  EXPECT_EQ(red_at(both, 10, 20), 1) << "in the middle of the height";
  EXPECT_EQ(red_at(both, 10, 2), 255);
  EXPECT_EQ(red_at(both, 40, 2), 2);
  const Image tall = stack({plain(20, 10, 1), plain(30, 40, 2)}, 5);
  EXPECT_EQ(tall.height_px, 55);
  EXPECT_EQ(red_at(tall, 15, 5), 1);
  EXPECT_EQ(red_at(tall, 15, 12), 255);
}

/// A box of 4 x 2 x 1 m on a floor.
scenes::Scene box_scene() {
  scenes::Scene scene;
  scene.materials = scenes::materials();
  scenes::MeshBuilder thing("box"), floor("floor");
  scenes::add_box(thing, {-2, -1, 0}, {2, 1, 1});
  scenes::add_patch(floor.use(scenes::MaterialId::concrete_dry), {-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0});
  scene.meshes = {std::move(thing).build(), std::move(floor).build()};
  scene.instances = {{0, scenes::Label::other, -1, core::SE3::Identity()},
                     {1, scenes::Label::pavement, -1, core::SE3::Identity()}};
  scene.interest_min = {-3, -3};
  scene.interest_max = {3, 3};
  return scene;
}

TEST(Exhibit, OutlinesAreTrueToScaleAndWithoutTheFloor) {
  const scenes::Scene scene = box_scene();
  Stills stills(scene, core::Time{});
  const FlatView side{.middle_m = {0, 0, 0.5},
                      .direction = Eigen::Vector3d::UnitY(),
                      .up = Eigen::Vector3d::UnitZ(),
                      .m_per_px = 0.05,
                      .width_px = 200,
                      .height_px = 100};
  const Image image = stills.silhouette(side);
  std::size_t dark = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) dark += image.rgb[i] < 128;
  EXPECT_NEAR(static_cast<double>(dark), (4 / 0.05) * (1 / 0.05), 0.02 * 1600);
  EXPECT_LT(red_at(image, 100 - 39, 50), 128);
  EXPECT_GT(red_at(image, 100 - 42, 50), 128) << "4 m are 80 pixels";
  EXPECT_GT(red_at(image, 100, 50 + 12), 128) << "the floor is no part of the outline";
}

TEST(Exhibit, ATileHasTheSizeThatWasAskedFor) {
  const scenes::Scene scene = box_scene();
  const Exhibit exhibit{&scene, Eigen::AlignedBox3d(Eigen::Vector3d(-2, -1, 0), Eigen::Vector3d(2, 1, 1))};
  const Image tile = exhibit_tile(exhibit, 0.05, 200, 160, 40);
  EXPECT_EQ(tile.width_px, 200);
  EXPECT_EQ(tile.height_px, 160);
  EXPECT_EQ(exhibit_picture(exhibit, 320, 240).width_px, 320);
}

TEST(Picture, IsWrittenByItsExtension) {
  const auto folder = std::filesystem::temp_directory_path();
  EXPECT_THROW(write_picture(folder / "picture.bmp", plain(8, 8, 0)), core::InputError);
}

}  // namespace
}  // namespace tarmac::reports
