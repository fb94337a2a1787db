// Pictures show what is there, where it is, at the time that was asked for.
#include "reports/stills.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/reports/example.h"

namespace tarmac::reports {
namespace {

Eigen::Vector3d pixel(const Image& image, int x, int y) {
  const std::uint8_t* const p = &image.rgb.at(3 * (static_cast<std::size_t>(y) * image.width_px + x));
  return {double(p[0]), double(p[1]), double(p[2])};
}

/// What the documented mapping shows at a place of the world.
Eigen::Vector3d at_world(const Image& image, const TopView& view, const Eigen::Vector2d& p_world_m) {
  const double m_per_px = (view.max_m.x() - view.min_m.x()) / view.width_px;
  return pixel(image, static_cast<int>((p_world_m.x() - view.min_m.x()) / m_per_px),
               static_cast<int>((view.max_m.y() - p_world_m.y()) / m_per_px));
}

bool is_red(const Eigen::Vector3d& c) {
  return c.x() > 2 * c.y() && c.x() > 2 * c.z();
}
bool is_blue(const Eigen::Vector3d& c) {
  return c.z() > 2 * c.x() && c.z() > 2 * c.y();
}
bool is_grey(const Eigen::Vector3d& c) {
  return c.maxCoeff() - c.minCoeff() < 30;
}

double contrast(const Image& image) {
  double sum = 0, squares = 0;
  for (const std::uint8_t v : image.rgb) {
    sum += v;
    squares += double(v) * v;
  }
  const double n = static_cast<double>(image.rgb.size());
  return std::sqrt(squares / n - (sum / n) * (sum / n));
}

std::size_t differing_pixels(const Image& a, const Image& b) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    n += std::abs(a.rgb[i] - b.rgb[i]) + std::abs(a.rgb[i + 1] - b.rgb[i + 1]) + std::abs(a.rgb[i + 2] - b.rgb[i + 2]) >
         60;
  }
  return n;
}

class StillsOfTheExample : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = new scenes::Scene(example::scene());
    stills_ = new Stills(*scene_, core::Time{});
  }
  static void TearDownTestSuite() {
    delete stills_;
    delete scene_;
  }
  void SetUp() override { stills_->set_time(core::Time{}); }

  static scenes::Scene* scene_;
  static Stills* stills_;
  const TopView view_ = top_view({-20, -20}, {20, 20}, 320);
};
scenes::Scene* StillsOfTheExample::scene_ = nullptr;
Stills* StillsOfTheExample::stills_ = nullptr;

TEST_F(StillsOfTheExample, OverviewIsNoBlankSheet) {
  const Image image = stills_->overview(320, 180);
  ASSERT_EQ(image.rgb.size(), 3u * 320 * 180);
  EXPECT_GT(contrast(image), 15);
  std::size_t red = 0;
  for (int y = 0; y < 180; ++y) {
    for (int x = 0; x < 320; ++x) red += is_red(pixel(image, x, y));
  }
  EXPECT_GT(red, 50u) << "the red block is to be seen";
}

TEST_F(StillsOfTheExample, TopViewHasThingsWhereTheyStand) {
  const Image image = stills_->top(view_);
  ASSERT_EQ(image.height_px, 320);
  EXPECT_TRUE(is_red(at_world(image, view_, example::kBlock)));
  EXPECT_TRUE(is_red(at_world(image, view_, example::kBlock + Eigen::Vector2d(1.8, -0.8))));
  EXPECT_TRUE(is_grey(at_world(image, view_, example::kBlock + Eigen::Vector2d(-2.6, 0))));
  EXPECT_TRUE(is_grey(at_world(image, view_, {-example::kBlock.x(), example::kBlock.y()})));
  EXPECT_TRUE(is_grey(at_world(image, view_, {example::kBlock.x(), -example::kBlock.y()})));
  EXPECT_TRUE(is_blue(at_world(image, view_, example::kCartAtZero)));
}

TEST_F(StillsOfTheExample, ActorsStandWhereTheyAreAtTheTime) {
  const Image before = stills_->top(view_);
  stills_->set_time(core::time_from_s(3));  // 2 m/s: 6 m further east
  const Image after = stills_->top(view_);
  const Eigen::Vector2d moved = example::kCartAtZero + Eigen::Vector2d(6, 0);
  EXPECT_TRUE(is_blue(at_world(before, view_, example::kCartAtZero)));
  EXPECT_FALSE(is_blue(at_world(before, view_, moved)));
  EXPECT_FALSE(is_blue(at_world(after, view_, example::kCartAtZero)));
  EXPECT_TRUE(is_blue(at_world(after, view_, moved)));
  EXPECT_TRUE(is_red(at_world(after, view_, example::kBlock))) << "what is static stays";
}

TEST_F(StillsOfTheExample, ThingsThrowShadowsAwayFromTheSun) {
  const Image image = stills_->top(view_);
  // The sun is in the south-west and the block 3 m high.
  const double shadow = at_world(image, view_, example::kBlock + Eigen::Vector2d(1.2, 1.9)).sum();
  const double lit = at_world(image, view_, example::kBlock + Eigen::Vector2d(-3.5, -3.5)).sum();
  EXPECT_LT(shadow, 0.8 * lit);
}

TEST_F(StillsOfTheExample, SamePictureTwiceIsTheSameBytes) {
  EXPECT_EQ(stills_->overview(320, 180).rgb, stills_->overview(320, 180).rgb);
}

TEST_F(StillsOfTheExample, MapShowsStaticPointsInTheColourOfTheirError) {
  const ErrorScale scale{0.01, 1};
  metrics::MapSample sample;
  for (float x = -15; x < 15; x += 0.1f) {
    for (float y = -15; y < 15; y += 0.1f) {
      sample.p_world_m.emplace_back(x, y, 0.05f);
      sample.error_m.push_back(1.0f);
      sample.moving.push_back(0);
    }
  }
  const Image empty = stills_->map({}, scale, 320, 180);
  const Image bad = stills_->map(sample, scale, 320, 180);
  EXPECT_GT(differing_pixels(empty, bad), 5000u);
  EXPECT_TRUE((pixel(bad, 160, 100) / 255 - error_color(1).cast<double>()).cwiseAbs().maxCoeff() < 0.15)
      << pixel(bad, 160, 100).transpose();

  std::fill(sample.moving.begin(), sample.moving.end(), std::uint8_t{1});
  EXPECT_EQ(stills_->map(sample, scale, 320, 180).rgb, empty.rgb) << "points on movers are left out";
}

TEST_F(StillsOfTheExample, MapShowsPointsThatSankIntoTheGround) {
  metrics::MapSample sample;
  for (float x = -15; x < 15; x += 0.1f) {
    for (float y = -15; y < 15; y += 0.1f) {
      sample.p_world_m.emplace_back(x, y, -0.5f);
      sample.error_m.push_back(0.5f);
      sample.moving.push_back(0);
    }
  }
  EXPECT_GT(differing_pixels(stills_->map({}, {}, 320, 180), stills_->map(sample, {}, 320, 180)), 5000u);
}

TEST_F(StillsOfTheExample, PngIsAPngOfThatSize) {
  const std::string png = to_png(stills_->overview(160, 90));
  ASSERT_GT(png.size(), 24u);
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(static_cast<unsigned char>(png[19]), 160);
  EXPECT_EQ(static_cast<unsigned char>(png[23]), 90);
}

}  // namespace
}  // namespace tarmac::reports
