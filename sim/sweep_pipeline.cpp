#include "sim/sweep_pipeline.h"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <memory>
#include <vector>

#include "sim/truth/ground_truth.h"

namespace tarmac::sim {
namespace {

using namespace core;

struct FinishedSweep {
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
  labels.label.reserve(simulated.instance.size());
  labels.moving.reserve(simulated.instance.size());
  for (const std::uint32_t id : simulated.instance) {
    const scenes::Instance& instance = scene.instances[id];
    labels.label.push_back(instance.label);
    labels.moving.push_back(instance.actor >= 0 ? 1 : 0);
  }
  return labels;
}

}  // namespace

EncodedSweep encode(const lidar::SimulatedSweep& simulated, const scenes::Scene& scene) {
  return {pack(RecordingWriter::chunk(simulated.sweep)), pack(truth::to_chunk(labels_of(simulated, scene)))};
}

PipelineTotals run_sweeps(const lidar::SweepSimulator& simulator, const scenes::Scene& scene, std::int64_t count,
                          int threads, RecordingWriter& recording, ChunkWriter& labels, const AfterSweep& after_sweep) {
  using Item = std::shared_ptr<FinishedSweep>;
  PipelineTotals totals;
  std::int64_t next = 0;
  const auto number = [&](tbb::flow_control& control) -> std::int64_t {
    if (next == count) control.stop();
    return next++;
  };
  const auto simulate = [&](std::int64_t index) -> Item {
    auto item = std::make_shared<FinishedSweep>();
    item->simulated = simulator.sweep(index);
    item->encoded = encode(item->simulated, scene);
    return item;
  };
  const auto write = [&](const Item& item) {
    const LidarSweep& sweep = item->simulated.sweep;
    recording.write_packed(sweep, item->encoded.points.digest, item->encoded.points.bytes);
    labels.append(sweep.begin, item->encoded.labels.digest, item->encoded.labels.bytes);
    totals.sweeps += 1;
    totals.rays += item->simulated.rays;
    totals.points += sweep.size();
    totals.trace_cpu_s += item->simulated.trace_cpu_s;
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
