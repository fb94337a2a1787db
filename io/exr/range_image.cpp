#include "io/exr/range_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace tarmac::io {
namespace {

using core::InputError;
using core::LidarSweep;
using sim::truth::PointLabels;

void check_labels(const LidarSweep& sweep, const PointLabels& labels) {
  if (labels.label.size() != sweep.size())
    throw InputError(fmt::format("sweep {}: {} points and {} labels: recording and truth do not belong together",
                                 sweep.index, sweep.size(), labels.label.size()));
  if (sweep.size() > 0 && !labels.has_point_truth())
    throw InputError(fmt::format("sweep {}: the truth holds no normals", sweep.index));
}

void put_truth(const PointLabels& labels, std::size_t i, std::size_t at, RangeLayer& layer) {
  layer.normal_x[at] = labels.normal_x[i];
  layer.normal_y[at] = labels.normal_y[i];
  layer.normal_z[at] = labels.normal_z[i];
  layer.cos_incidence[at] = labels.cos_incidence[i];
  layer.label[at] = static_cast<std::uint32_t>(labels.label[i]);
  layer.instance[at] = labels.instance[i];
  layer.moving[at] = labels.moving[i];
  layer.kind[at] = static_cast<std::uint32_t>(labels.kind_of(i));
}

}  // namespace

void RangeLayer::resize(std::size_t cells, bool with_truth) {
  const std::size_t of_truth = with_truth ? cells : 0;
  for (auto* values : {&range_m, &intensity}) values->resize(cells);
  time_ns.resize(cells);
  for (auto* values : {&normal_x, &normal_y, &normal_z, &cos_incidence}) values->resize(of_truth);
  for (auto* values : {&label, &instance, &moving, &kind}) values->resize(of_truth);
}

RangeImage make_range_image(const LidarSweep& sweep, const std::vector<RangeCell>& cells, std::size_t rings,
                            std::size_t columns, const PointLabels* labels) {
  if (labels) check_labels(sweep, *labels);
  RangeImage image;
  image.width = columns;
  image.height = rings;
  image.sweep = sweep.index;
  image.begin_ns = core::to_ns(sweep.begin);
  image.end_ns = core::to_ns(sweep.end);
  image.with_truth = labels != nullptr;
  std::int64_t origin_ns = 0;
  for (const std::int32_t t_ns : sweep.t_ns) origin_ns = std::min<std::int64_t>(origin_ns, t_ns);
  image.time_origin_ns = image.begin_ns + origin_ns;

  std::vector<std::uint8_t> taken(rings * columns, 0);
  image.returns.resize(1);
  image.returns[0].resize(taken.size(), image.with_truth);
  for (std::size_t i = 0; i < sweep.size(); ++i) {
    const std::size_t at = (rings - 1 - cells[i].ring) * columns + cells[i].column;
    if (taken[at] == 2)
      throw InputError(fmt::format("sweep {}: more than two returns of ring {} in column {}", sweep.index,
                                   cells[i].ring, cells[i].column));
    if (taken[at] == 1 && image.returns.size() == 1) {
      image.returns.emplace_back();
      image.returns[1].resize(taken.size(), image.with_truth);
    }
    RangeLayer& layer = image.returns[taken[at]++];
    layer.range_m[at] = static_cast<float>(sweep.point(i).norm());
    layer.intensity[at] = sweep.intensity[i];
    layer.time_ns[at] = static_cast<std::uint32_t>(sweep.t_ns[i] - origin_ns);
    if (labels) put_truth(*labels, i, at, layer);
  }
  return image;
}

std::vector<RangeCell> cells_by_time(const LidarSweep& sweep, std::size_t& rings, std::size_t& columns) {
  std::vector<std::int32_t> times = sweep.t_ns;
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  columns = std::max<std::size_t>(1, times.size());
  rings = 1;
  std::vector<RangeCell> cells;
  for (std::size_t i = 0; i < sweep.size(); ++i) {
    const auto column = std::lower_bound(times.begin(), times.end(), sweep.t_ns[i]);
    cells.push_back({sweep.ring[i], static_cast<std::size_t>(column - times.begin())});
    rings = std::max<std::size_t>(rings, sweep.ring[i] + std::size_t{1});
  }
  return cells;
}

}  // namespace tarmac::io
