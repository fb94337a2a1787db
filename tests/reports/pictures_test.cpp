// What pictures need besides drawing: rectangles, scales, and a clear word where drawing is not possible.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "reports/ground_light.h"
#include "reports/page.h"
#include "tests/reports/example.h"

namespace tarmac::reports {
namespace {

using ::testing::HasSubstr;

TEST(OffscreenGl, SaysWhatToInstallWhereThereIsNoEgl) {
  try {
    OffscreenGl gl("libEGL-that-is-not-there.so.9");
    FAIL() << "opened a library that does not exist";
  } catch (const RenderingUnavailable& error) {
    for (const char* package : {"libegl1", "libegl-mesa0", "libgl1-mesa-dri"}) {
      EXPECT_THAT(error.what(), HasSubstr(package));
    }
  }
}

TEST(DrawPictures, WithoutEglLeavesANoteInTheirPlace) {
  const scenes::Scene scene = example::scene();
  ReportInput input = example::input();
  input.scene = &scene;
  PictureSettings settings;
  settings.egl_library = "libEGL-that-is-not-there.so.9";
  const Pictures pictures = draw_pictures(input, {}, settings);
  EXPECT_FALSE(pictures.overview.has_value());
  EXPECT_THAT(pictures.note, HasSubstr("libegl1"));
}

TEST(TopViewMapping, PixelsAreSquaresOfTheWorldAndTheMiddleStays) {
  const TopView view = top_view({-30, 5}, {70, 44.7}, 640);
  const double m_per_px = 100.0 / 640;
  EXPECT_EQ(view.height_px, std::lround(39.7 / m_per_px));
  EXPECT_NEAR((view.max_m.y() - view.min_m.y()) / view.height_px, m_per_px, 1e-12);
  EXPECT_NEAR(0.5 * (view.min_m.y() + view.max_m.y()), 24.85, 1e-12);
}

TEST(ErrorScaling, SpansTheMapsInRoundSteps) {
  metrics::MapSample sample;
  for (int k = 1; k <= 1000; ++k) {
    sample.error_m.push_back(0.001f * static_cast<float>(k));  // 1 mm to 1 m, even
    sample.moving.push_back(k == 500);
  }
  const ErrorScale scale = error_scale({&sample});
  EXPECT_DOUBLE_EQ(scale.high_m, 1);   // the 99 % quantile is 0.99
  EXPECT_DOUBLE_EQ(scale.low_m, 0.1);  // the 25 % quantile is 0.25: less than a decade below
  EXPECT_DOUBLE_EQ(place_on(scale, scale.low_m), 0);
  EXPECT_DOUBLE_EQ(place_on(scale, scale.high_m), 1);
  EXPECT_NEAR(place_on(scale, std::sqrt(scale.low_m * scale.high_m)), 0.5, 1e-12) << "logarithmic";
  EXPECT_DOUBLE_EQ(place_on(scale, 0), 0);
  EXPECT_DOUBLE_EQ(place_on(scale, 100), 1);
}

TEST(ErrorScaling, ReachesDownToTheQuarterOfPointsThatAreBest) {
  metrics::MapSample sample;
  for (int k = 0; k < 1000; ++k) sample.error_m.push_back(k < 400 ? 0.003f : 0.8f);
  const ErrorScale scale = error_scale({&sample});
  EXPECT_DOUBLE_EQ(scale.low_m, 0.002);
  EXPECT_DOUBLE_EQ(scale.high_m, 1);
}

TEST(ErrorScaling, IsNotStretchedByOneMethodThatIsFarOff) {
  metrics::MapSample good, bad;
  for (int k = 1; k <= 100; ++k) {
    good.error_m.push_back(0.001f * static_cast<float>(k));
    bad.error_m.push_back(1.0f * static_cast<float>(k));
  }
  EXPECT_DOUBLE_EQ(error_scale({&bad, &good, &good}).high_m, error_scale({&good}).high_m);
  EXPECT_DOUBLE_EQ(error_scale({&bad, &good}).high_m, error_scale({&good}).high_m);
  EXPECT_GT(error_scale({&bad}).high_m, 100 * error_scale({&good}).high_m);
}

TEST(ErrorScaling, SurvivesAPerfectMapAndNone) {
  metrics::MapSample perfect;
  perfect.error_m.assign(10, 0.0f);
  const ErrorScale scale = error_scale({&perfect});
  EXPECT_GT(scale.low_m, 0);
  EXPECT_GT(scale.high_m, scale.low_m);
  EXPECT_GT(error_scale({}).high_m, 0);
}

TEST(ErrorScaling, NotANumberIsGrey) {
  EXPECT_EQ(error_color(place_on({}, NAN)), Eigen::Vector3f(0.5f, 0.5f, 0.5f));
}

TEST(Shadows, BlurKeepsTheLightAndSpreadsItEvenly) {
  GroundLight light(101);
  light.value[50 * 101 + 40] = 1;
  light.blur(3);
  double sum = 0;
  for (const float v : light.value) sum += v;
  EXPECT_NEAR(sum, 1, 1e-4);
  EXPECT_NEAR(light.value[50 * 101 + 44], light.value[50 * 101 + 36], 1e-6);
  EXPECT_NEAR(light.value[50 * 101 + 44], light.value[54 * 101 + 40], 1e-6) << "the same in both directions";
  EXPECT_NEAR(light.value[50 * 101 + 40 + 10], 0, 1e-6) << "three passes of radius 3 reach 9 pixels";
}

TEST(Shadows, ProjectionMeetsTheSlopedGroundAlongTheLight) {
  const Eigen::Vector3d to_sun = Eigen::Vector3d(-0.4, 0.2, 0.8).normalized(), p(3, -2, 5);
  const Eigen::Vector2d at(1, 1), gradient(0.02, -0.01);
  const Eigen::Vector3d q = (project_onto(to_sun, at, 0.5, gradient) * p.homogeneous()).hnormalized();
  EXPECT_NEAR(q.z(), 0.5 + gradient.dot(q.head<2>() - at), 1e-12);
  EXPECT_NEAR((p - q).cross(to_sun).norm(), 0, 1e-12);
  EXPECT_GT((p - q).dot(to_sun), 0);
}

TEST(Pixels, AreAveragedAndTurnedUpsideDown) {
  const unsigned char rgb[] = {0,  0,  0,  10, 10, 10, 100, 0, 0, 100, 0, 0,  // OpenGL's lowest row
                               20, 20, 20, 30, 30, 30, 100, 0, 0, 100, 0, 0,  //
                               9,  9,  9,  9,  9,  9,  0,   0, 0, 0,   0, 0,  //
                               9,  9,  9,  9,  9,  9,  0,   0, 0, 0,   0, 0};
  const Image image = reduce(rgb, 4, 4, 2);
  EXPECT_EQ(image.rgb, (std::vector<std::uint8_t>{9, 9, 9, 0, 0, 0, 15, 15, 15, 100, 0, 0}));
}

}  // namespace
}  // namespace tarmac::reports
