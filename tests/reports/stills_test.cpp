// Pictures show what is there, where it is, at the time that was asked for.
#include "reports/stills.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
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

TEST_F(StillsOfTheExample, AnEyeSeesWhatLiesThatWay) {
  const Eigen::Vector3d block(example::kBlock.x(), example::kBlock.y(), 1.5);
  const Image east = stills_->seen_from({block + Eigen::Vector3d(10, 0, 0), block}, 320, 180);
  EXPECT_TRUE(is_red(pixel(east, 160, 90)));
  // The block's front is 8 m away and 2 m wide: (1 m / 8 m) / tan 25 degrees of half the picture's height.
  const int half_px = static_cast<int>(90 * (1.0 / 8) / std::tan(25 * M_PI / 180));
  for (const int side : {-1, 1}) {
    EXPECT_TRUE(is_red(pixel(east, 160 + side * (half_px - 2), 90)));
    EXPECT_FALSE(is_red(pixel(east, 160 + side * (half_px + 2), 90)));
  }
  // Looking west from the block's east, north is to the right: the cart.
  const Image both = stills_->seen_from({{20, 0, 3}, {0, 0, 0.5}}, 320, 180);
  std::size_t red_left = 0, blue_right = 0, wrong = 0;
  for (int y = 0; y < 180; ++y) {
    for (int x = 0; x < 320; ++x) {
      const Eigen::Vector3d c = pixel(both, x, y);
      (x < 160 ? red_left : wrong) += is_red(c);
      (x > 160 ? blue_right : wrong) += is_blue(c);
    }
  }
  EXPECT_GT(red_left, 20u);
  EXPECT_GT(blue_right, 20u);
  EXPECT_EQ(wrong, 0u);
  const Image away =
      stills_->seen_from({block + Eigen::Vector3d(10, 0, 0), block + Eigen::Vector3d(20, 0, 0)}, 320, 180);
  EXPECT_FALSE(is_red(pixel(away, 160, 90)));
  const Image down = stills_->seen_from({{8, -6, 20}, {8, -6, 0}}, 320, 180);
  EXPECT_TRUE(is_red(pixel(down, 160, 90))) << "straight down is a direction, too";
}

TEST(EyeView, SaysWhatIsWrongWithAPlace) {
  EXPECT_EQ(point_from("--eye", "12,-30.5,1e0"), Eigen::Vector3d(12, -30.5, 1));
  for (const char* bad : {"", "1,2", "1,2,3,4", "1,2,x", "1;2;3", "1, 2, 3", "1,2,nan", "1,2,inf", "1,2,3 "}) {
    EXPECT_THROW(point_from("--eye", bad), core::InputError) << bad;
  }
  EXPECT_THROW(check({{1, 2, 3}, {1, 2, 3}}), core::InputError);
  EXPECT_THROW(check({{1, 2, 3e7}, {1, 2, 3}}), core::InputError);
  EXPECT_NO_THROW(check({{1, 2, 3}, {1, 2, 3.01}}));
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
