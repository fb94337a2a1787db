#include "sim/sweep_pipeline.h"

#include <tbb/concurrent_queue.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "sim/truth/ground_truth.h"

namespace tarmac::sim {
namespace {

using namespace core;

struct FinishedSweep {
  bool lost = false;
  Time true_begin;
  lidar::SimulatedSweep simulated;
  EncodedSweep encoded;
};

EncodedChunk pack(const ChunkData& data) {
  return {ChunkWriter::digest(data), ChunkWriter::pack(data)};
}

truth::PointLabels labels_of(const lidar::SimulatedSweep& simulated, const scenes::Scene& scene) {
  truth::PointLabels labels;
  labels.begin = simulated.sweep.begin;
  labels.end = simulated.sweep.end;
  labels.instance = simulated.instance;
  labels.t_ns = simulated.sweep.t_ns;
  labels.kind = simulated.kind;
  labels.true_range_m = simulated.true_range_m;
  labels.normal_x = simulated.normal_x;
  labels.normal_y = simulated.normal_y;
  labels.normal_z = simulated.normal_z;
  labels.cos_incidence = simulated.cos_incidence;
  labels.label.reserve(simulated.instance.size());
  labels.moving.reserve(simulated.instance.size());
  for (std::size_t i = 0; i < simulated.instance.size(); ++i) {
    const std::uint32_t id = simulated.instance[i];
    if (id == truth::PointLabels::no_instance) {
      const bool self = simulated.kind[i] == truth::ReturnKind::self;
      labels.label.push_back(self ? scenes::Label::own_body : scenes::Label::none);
      labels.moving.push_back(0);
      continue;
    }
    const scenes::Instance& instance = scene.instances[id];
    labels.label.push_back(instance.label);
    labels.moving.push_back(instance.actor >= 0 ? 1 : 0);
  }
  return labels;
}

faults::Columns columns_of(const lidar::FiringTable& firing, std::int64_t index) {
  faults::Columns columns;
  const lidar::SweepSpan span = firing.sweep(index);
  const Time first = firing.cycle(span, 0).t;
  for (std::int64_t k = 0; k < span.cycles; ++k) {
    const lidar::Cycle cycle = firing.cycle(span, k);
    columns.begin_ns.push_back(static_cast<std::int32_t>((cycle.t - first).count()));
    const double azimuth_deg = std::atan2(cycle.sin_azimuth, cycle.cos_azimuth) * 180 / std::numbers::pi;
    columns.azimuth_deg.push_back(azimuth_deg < 0 ? azimuth_deg + 360 : azimuth_deg);
  }
  return columns;
}

EncodedSweep encode(const LidarSweep& sweep, const truth::PointLabels& labels) {
  return {pack(RecordingWriter::chunk(sweep)), pack(truth::to_chunk(labels))};
}

}  // namespace

EncodedSweep encode(const lidar::SimulatedSweep& simulated, const scenes::Scene& scene) {
  return encode(simulated.sweep, labels_of(simulated, scene));
}

PipelineTotals run_sweeps(const lidar::SweepSimulator& simulator, const scenes::Scene& scene, std::int64_t count,
                          int threads, RecordingWriter& recording, ChunkWriter& labels, const AfterSweep& after_sweep,
                          const faults::LidarFaults* faults) {
  using Item = std::shared_ptr<FinishedSweep>;
  PipelineTotals totals;
  std::int64_t next = 0;
  const auto number = [&](tbb::flow_control& control) -> std::int64_t {
    if (next == count) control.stop();
    return next++;
  };
  // Arrays go round: fresh ones of a megabyte would have their pages mapped sweep after sweep.
  tbb::concurrent_queue<Item> finished;
  tbb::enumerable_thread_specific<lidar::Workspace> workspaces;
  const auto simulate = [&](std::int64_t index) -> Item {
    Item item;
    if (!finished.try_pop(item)) item = std::make_shared<FinishedSweep>();
    item->lost = faults && faults->lost(index);
    if (item->lost) return item;
    simulator.sweep(index, workspaces.local(), item->simulated);
    item->true_begin = item->simulated.sweep.begin;
    truth::PointLabels point_labels = labels_of(item->simulated, scene);
    if (faults)
      faults->apply(item->simulated.sweep, point_labels,
                    faults->needs_columns() ? columns_of(simulator.firing(), index) : faults::Columns());
    item->encoded = encode(item->simulated.sweep, point_labels);
    return item;
  };
  const auto write = [&](const Item& item) {
    if (item->lost) {
      totals.lost += 1;
      after_sweep(totals);
      return;
    }
    const LidarSweep& sweep = item->simulated.sweep;
    recording.write_packed(sweep, item->encoded.points.digest, item->encoded.points.bytes);
    labels.append(item->true_begin, item->encoded.labels.digest, item->encoded.labels.bytes);
    totals.sweeps += 1;
    totals.rays += item->simulated.rays;
    totals.points += sweep.size();
    totals.trace_cpu_s += item->simulated.trace_cpu_s;
    finished.push(item);
    after_sweep(totals);
  };
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_pipeline(static_cast<std::size_t>(threads) + 2,
                           tbb::make_filter<void, std::int64_t>(tbb::filter_mode::serial_in_order, number) &
                               tbb::make_filter<std::int64_t, Item>(tbb::filter_mode::parallel, simulate) &
                               tbb::make_filter<Item, void>(tbb::filter_mode::serial_in_order, write));
  });
  return totals;
}

}  // namespace tarmac::sim
