#include "io/exr/range_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "core/error.h"
#include "core/random.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::io {
namespace {

using core::LidarSweep;
using sim::truth::PointLabels;
using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

struct Sweep {
  LidarSweep sweep;
  PointLabels labels;
  std::vector<RangeCell> cells;
};

/// Points in some of the cells of 6 rings and 40 columns, some of them twice, with numbers of every digit.
Sweep some_sweep(bool twice) {
  Sweep s;
  s.sweep.index = 41;
  s.sweep.begin = s.labels.begin = core::time_from_ns(1'700'000'000'123'456'789);
  s.sweep.end = s.labels.end = s.sweep.begin + core::Duration(99'999'999);
  const core::RandomStream draw(1, "test/range_image");
  for (std::size_t cell = 0; cell < 240; ++cell) {
    if (draw.uniform(10 * cell) < 0.3) continue;
    for (int echo = 0; echo < (twice && draw.uniform(10 * cell + 1) < 0.2 ? 2 : 1); ++echo) {
      const auto u = [&](std::size_t k) {
        return static_cast<float>(50 * draw.normal(1000 + 20 * cell + 10 * static_cast<std::size_t>(echo) + k));
      };
      s.sweep.push_back({u(0), u(1), u(2)}, static_cast<std::int32_t>(2'499'999 * (cell % 40)),
                        static_cast<std::uint16_t>(cell / 40), std::abs(u(3)));
      s.cells.push_back({cell / 40, cell % 40});
      s.labels.label.push_back(static_cast<scenes::Label>(cell % 14));
      s.labels.instance.push_back(cell % 7 == 0 ? PointLabels::no_instance : static_cast<std::uint32_t>(cell));
      s.labels.moving.push_back(cell % 3 == 0);
      s.labels.t_ns.push_back(s.sweep.t_ns.back());
      s.labels.kind.push_back(static_cast<sim::truth::ReturnKind>(cell % 11));
      s.labels.true_range_m.push_back(1);
      s.labels.normal_x.push_back(u(4));
      s.labels.normal_y.push_back(std::nextafter(0.0f, 1.0f));  // a denormal number
      s.labels.normal_z.push_back(-0.0f);
      s.labels.cos_incidence.push_back(std::nextafter(1.0f, 0.0f));
    }
  }
  return s;
}

class RangeImages : public testing::Test {
 protected:
  std::string complaint(const fs::path& file) const {
    try {
      read_range_image(file);
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "";
  }
  const tests::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

std::vector<std::uint32_t> bits(const std::vector<float>& values) {
  std::vector<std::uint32_t> result(values.size());
  std::memcpy(result.data(), values.data(), 4 * values.size());
  return result;
}

TEST_F(RangeImages, AreReadBackBitByBit) {
  for (const bool twice : {false, true})
    for (const bool with_truth : {true, false}) {
      const Sweep s = some_sweep(twice);
      RangeImage image = make_range_image(s.sweep, s.cells, 6, 40, with_truth ? &s.labels : nullptr);
      image.sensor = "test (lidar3)";
      image.columns = "firing cycle";
      ASSERT_EQ(image.returns.size(), twice ? 2u : 1u);
      write_range_image(folder_ / "a.exr", image);
      const RangeImage back = read_range_image(folder_ / "a.exr");
      EXPECT_EQ(back, image);
      for (std::size_t k = 0; k < image.returns.size(); ++k) {  // -0 equals 0 above
        EXPECT_EQ(bits(back.returns[k].range_m), bits(image.returns[k].range_m));
        EXPECT_EQ(bits(back.returns[k].normal_z), bits(image.returns[k].normal_z));
        EXPECT_EQ(bits(back.returns[k].normal_y), bits(image.returns[k].normal_y));
      }
      write_range_image(folder_ / "b.exr", back);
      std::ifstream a(folder_ / "a.exr", std::ios::binary), b(folder_ / "b.exr", std::ios::binary);
      EXPECT_EQ(std::string(std::istreambuf_iterator<char>(a), {}), std::string(std::istreambuf_iterator<char>(b), {}));
    }
}

TEST_F(RangeImages, EveryPointLiesInItsCellAndEverythingElseIsEmpty) {
  const Sweep s = some_sweep(true);
  const RangeImage image = make_range_image(s.sweep, s.cells, 6, 40, &s.labels);
  EXPECT_EQ(image.begin_ns, 1'700'000'000'123'456'789);
  EXPECT_EQ(image.time_origin_ns, image.begin_ns);
  std::vector<int> taken(240, 0);
  for (std::size_t i = 0; i < s.sweep.size(); ++i) {
    const std::size_t at = (5 - s.cells[i].ring) * 40 + s.cells[i].column;  // the highest ring stands at the top
    const RangeLayer& layer = image.returns.at(static_cast<std::size_t>(taken[at]++));
    EXPECT_EQ(layer.range_m[at], static_cast<float>(s.sweep.point(i).norm()));
    EXPECT_EQ(layer.intensity[at], s.sweep.intensity[i]);
    EXPECT_EQ(layer.time_ns[at], static_cast<std::uint32_t>(s.sweep.t_ns[i]));
    EXPECT_EQ(layer.normal_x[at], s.labels.normal_x[i]);
    EXPECT_EQ(layer.cos_incidence[at], s.labels.cos_incidence[i]);
    EXPECT_EQ(layer.label[at], static_cast<std::uint32_t>(s.labels.label[i]));
    EXPECT_EQ(layer.instance[at], s.labels.instance[i]);
    EXPECT_EQ(layer.moving[at], s.labels.moving[i]);
    EXPECT_EQ(layer.kind[at], static_cast<std::uint32_t>(s.labels.kind[i]));
  }
  for (std::size_t at = 0; at < taken.size(); ++at)
    for (std::size_t k = static_cast<std::size_t>(taken[at]); k < image.returns.size(); ++k) {
      EXPECT_EQ(image.returns[k].range_m[at], 0);
      EXPECT_EQ(image.returns[k].time_ns[at], 0u);
      EXPECT_EQ(image.returns[k].label[at], 0u);
    }
}

TEST_F(RangeImages, TimesBeforeTheSweepsBeginMoveTheOrigin) {
  Sweep s = some_sweep(false);
  s.sweep.t_ns[3] = -7'000'001;
  const RangeImage image = make_range_image(s.sweep, s.cells, 6, 40, nullptr);
  EXPECT_EQ(image.time_origin_ns, image.begin_ns - 7'000'001);
  for (std::size_t i = 0; i < s.sweep.size(); ++i)
    EXPECT_EQ(image.returns[0].time_ns[(5 - s.cells[i].ring) * 40 + s.cells[i].column],
              static_cast<std::uint32_t>(s.sweep.t_ns[i] + 7'000'001));
}

TEST_F(RangeImages, WithoutATableColumnsAreInstants) {
  LidarSweep sweep;
  sweep.push_back({1, 0, 0}, 30, 2, 1);
  sweep.push_back({2, 0, 0}, 30, 0, 1);
  sweep.push_back({3, 0, 0}, 10, 2, 1);
  std::size_t rings = 0, columns = 0;
  const auto cells = cells_by_time(sweep, rings, columns);
  EXPECT_EQ(rings, 3u);
  EXPECT_EQ(columns, 2u);
  EXPECT_EQ(cells[0].column, 1u);
  EXPECT_EQ(cells[2].column, 0u);
  EXPECT_EQ(cells[1].ring, 0u);
}

TEST_F(RangeImages, WhatCannotBeAnImageIsRefused) {
  Sweep s = some_sweep(false);
  PointLabels fewer = s.labels;
  fewer.label.pop_back();
  EXPECT_THROW(make_range_image(s.sweep, s.cells, 6, 40, &fewer), core::InputError);
  PointLabels plain = s.labels;
  plain.true_range_m.clear();
  EXPECT_THROW(make_range_image(s.sweep, s.cells, 6, 40, &plain), core::InputError);
  const std::vector<RangeCell> one_cell(s.sweep.size(), RangeCell{2, 3});
  EXPECT_THROW(make_range_image(s.sweep, one_cell, 6, 40, &s.labels), core::InputError);
  EXPECT_THROW(write_range_image(folder_ / "absent" / "a.exr", make_range_image(s.sweep, s.cells, 6, 40, nullptr)),
               core::InputError);
}

TEST_F(RangeImages, DamagedAndForeignFilesAreRefusedByName) {
  EXPECT_THAT(complaint(folder_ / "absent.exr"), HasSubstr("absent.exr"));
  std::ofstream(folder_ / "text.exr") << "no image";
  EXPECT_THAT(complaint(folder_ / "text.exr"), AllOf(HasSubstr("text.exr"), HasSubstr("OpenEXR")));
  const Sweep s = some_sweep(false);
  write_range_image(folder_ / "whole.exr", make_range_image(s.sweep, s.cells, 6, 40, &s.labels));
  EXPECT_EQ(complaint(folder_ / "whole.exr"), "");
  fs::resize_file(folder_ / "whole.exr", fs::file_size(folder_ / "whole.exr") - 500);
  EXPECT_THAT(complaint(folder_ / "whole.exr"), HasSubstr("whole.exr"));
}

}  // namespace
}  // namespace tarmac::io
