#include "core/merged_sweeps.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <numeric>

namespace tarmac::core {
namespace {

Rig merged_rig(const Rig& rig) {
  Rig merged = rig;
  LidarSheet sheet = rig.lidars.at(0);
  sheet.T_body_lidar = SE3::Identity();
  for (std::size_t k = 1; k < rig.lidars.size(); ++k) {
    sheet.model += " + " + rig.lidars[k].model;
    sheet.min_range_m = std::min(sheet.min_range_m, rig.lidars[k].min_range_m);
    sheet.max_range_m = std::max(sheet.max_range_m, rig.lidars[k].max_range_m);
  }
  merged.lidars = {sheet};
  return merged;
}

}  // namespace

/// Points of one period, not yet in order.
struct MergedSweeps::Gathered {
  std::vector<Time> t;
  std::vector<Time> key;  ///< the latest stamp of its LiDAR's so far
  std::vector<Eigen::Vector3f> p_body_m;
  std::vector<std::uint16_t> ring;
  std::vector<float> intensity;
  std::vector<PointSource> source;
};

struct MergedSweeps::Kept {
  struct Entry {
    std::size_t lidar, i;
    std::shared_ptr<const LidarSweep> sweep;
  };
  std::mutex mutex;
  std::deque<Entry> entries;
};

MergedSweeps::MergedSweeps(const Recording& recording)
    : recording_(&recording),
      rig_(merged_rig(recording.rig())),
      period_(duration_from_s(1 / rig_.lidars[0].sweep_rate_hz)),
      kept_(std::make_shared<Kept>()) {}

std::shared_ptr<const LidarSweep> MergedSweeps::fetch(std::size_t lidar, std::size_t i) const {
  {
    const std::lock_guard lock(kept_->mutex);
    for (const Kept::Entry& entry : kept_->entries)
      if (entry.lidar == lidar && entry.i == i) return entry.sweep;
  }
  auto sweep = std::make_shared<const LidarSweep>(recording_->sweep(i, lidar));
  const std::lock_guard lock(kept_->mutex);
  kept_->entries.push_back({lidar, i, sweep});
  if (kept_->entries.size() > 8 * recording_->rig().lidars.size()) kept_->entries.pop_front();
  return sweep;
}

std::size_t MergedSweeps::count() const {
  return recording_->sweep_count();
}

Time MergedSweeps::period_end(std::size_t k, Time own_end) const {
  const Time begin = recording_->sweep_begin(k);
  Time end = std::max(begin + period_, own_end + Duration(1));
  if (k + 1 < count()) {
    const Time next = recording_->sweep_begin(k + 1);
    if (next - begin <= period_ + period_ / 2) end = next;
  }
  return end;
}

void MergedSweeps::gather(std::size_t lidar, std::size_t i, const LidarSweep& sweep, Time from, Time to,
                          Gathered& into) const {
  const LidarSheet& sheet = recording_->rig().lidars[lidar];
  const Duration ahead = sheet.clock_offset - recording_->rig().lidars[0].clock_offset;
  for (std::size_t p = 0; p < sweep.size(); ++p) {
    const Time t = sweep.time(p) - ahead;
    if (lidar > 0 && (t < from || t >= to)) continue;
    const bool follows = !into.t.empty() && into.source.back().lidar == lidar;
    into.key.push_back(follows ? std::max(into.key.back(), t) : t);
    into.t.push_back(t);
    into.p_body_m.push_back((sheet.T_body_lidar * sweep.point(p)).cast<float>());
    into.ring.push_back(sweep.ring[p]);
    into.intensity.push_back(sweep.intensity[p]);
    into.source.push_back(
        {static_cast<std::uint16_t>(lidar), static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(p)});
  }
}

LidarSweep MergedSweeps::sweep(std::size_t k, std::vector<PointSource>* sources) const {
  Gathered all;
  const LidarSweep first = *fetch(0, k);
  const Time from = first.begin, to = period_end(k, first.end);
  gather(0, k, first, from, to, all);
  for (std::size_t lidar = 1; lidar < recording_->rig().lidars.size(); ++lidar) {
    const Duration ahead = recording_->rig().lidars[lidar].clock_offset - recording_->rig().lidars[0].clock_offset;
    // A sweep's points lie between its begin and the next one's, or a sweep off where its clock's stamps are odd.
    const Duration odd = duration_from_s(2 / recording_->rig().lidars[lidar].sweep_rate_hz);
    std::size_t i = 0;
    for (std::size_t last = recording_->sweep_count(lidar); i < last;) {
      const std::size_t middle = i + (last - i) / 2;
      if (recording_->sweep_begin(middle, lidar) - ahead + odd < from)
        i = middle + 1;
      else
        last = middle;
    }
    for (; i < recording_->sweep_count(lidar) && recording_->sweep_begin(i, lidar) - ahead - odd < to; ++i)
      gather(lidar, i, *fetch(lidar, i), from, to, all);
  }
  std::vector<std::size_t> order(all.t.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return all.key[a] < all.key[b]; });

  LidarSweep merged;
  merged.index = first.index;
  merged.begin = first.begin;
  merged.end = first.end;
  merged.reserve(order.size());
  if (sources) sources->clear();
  for (const std::size_t i : order) {
    merged.push_back(all.p_body_m[i], static_cast<std::int32_t>((all.t[i] - first.begin).count()), all.ring[i],
                     all.intensity[i]);
    merged.point_sensor.push_back(all.source[i].lidar);
    if (all.source[i].lidar > 0) merged.end = std::max(merged.end, all.t[i]);
    if (sources) sources->push_back(all.source[i]);
  }
  return merged;
}

void MergedSweeps::replay(const std::function<void(std::size_t, const ImuSample&)>& on_imu,
                          const std::function<void(const LidarSweep&)>& on_sweep) const {
  recording_->replay(
      count(), [this](std::size_t k) { return sweep(k); }, on_imu, on_sweep);
}

}  // namespace tarmac::core
