#include "tools/tarmac/export_images.h"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "core/chunk_file.h"
#include "core/error.h"
#include "core/recording.h"
#include "io/exr/range_image.h"
#include "sim/lidar/firing_grid.h"
#include "sim/rig_options.h"
#include "sim/truth/ground_truth.h"
#include "tools/tarmac/layout.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;
using core::InputError;
using core::LidarSweep;
using sim::truth::PointLabels;

/// What is known of a LiDAR's sweeps beside the recording.
struct Truth {
  std::unique_ptr<core::ChunkReader> labels;
  std::optional<sim::lidar::FiringTable> firing;
};

Truth open_truth(const fs::path& recording, std::size_t lidar) {
  Truth truth;
  const fs::path folder = recording.parent_path() / "truth";
  const fs::path labels = folder / fmt::format("lidar{}_labels.chunks", lidar), scenario = folder / "scenario.yaml";
  if (!fs::is_regular_file(labels) || !fs::is_regular_file(scenario)) return truth;
  const core::ConfigNode config = core::ConfigNode::load(scenario.string());
  const auto seed = static_cast<std::uint64_t>(std::stoll(config.child("seed").scalar("seed")));
  truth.firing = sim::firing_table(sim::read_rig(config.child("rig")), seed, lidar);
  truth.labels = std::make_unique<core::ChunkReader>(labels);
  return truth;
}

/// By the sensor's firing table and the true firing times, whatever was wrong with its clock.
std::vector<io::RangeCell> cells_by_table(const LidarSweep& sweep, const PointLabels& labels,
                                          const sim::lidar::FiringGrid& grid) {
  if (labels.t_ns.size() != sweep.size())
    throw InputError(fmt::format("sweep {}: {} points and {} labels: recording and truth do not belong together",
                                 sweep.index, sweep.size(), labels.t_ns.size()));
  std::vector<io::RangeCell> cells;
  for (std::size_t i = 0; i < sweep.size(); ++i) {
    const auto cell = grid.cell(sweep.ring[i], labels.t_ns[i]);
    if (!cell)
      throw InputError(
          fmt::format("sweep {}: ring {} does not fire {} ns after the sweep's begin: truth/scenario.yaml "
                      "is not the scenario of this recording",
                      sweep.index, sweep.ring[i], labels.t_ns[i]));
    cells.push_back({cell->ring, cell->column});
  }
  return cells;
}

class Exporter {
 public:
  Exporter(const TransferArguments& arguments)
      : folder_(recording_of(arguments.from)),
        recording_(core::Recording::open(folder_)),
        lidar_(static_cast<std::size_t>(arguments.lidar)),
        no_truth_(arguments.no_truth) {
    if (lidar_ >= recording_.rig().lidars.size())
      throw InputError(fmt::format("--lidar {}: the recording has {} LiDARs, counted from 0", lidar_,
                                   recording_.rig().lidars.size()));
    truth_ = open_truth(folder_, lidar_);
    if (!no_truth_ && !truth_.labels)
      throw InputError(
          fmt::format("{}: has no truth beside it, so normals, incidence and labels are not known; "
                      "--no-truth leaves them out",
                      folder_.string()));
    if (truth_.labels && truth_.labels->size() != recording_.sweep_count(lidar_))
      throw InputError(fmt::format("{}: the recording has {} sweeps and the truth beside it {}", folder_.string(),
                                   recording_.sweep_count(lidar_), truth_.labels->size()));
  }

  std::size_t sweeps() const { return recording_.sweep_count(lidar_); }
  LidarSweep sweep(std::size_t i) const { return recording_.sweep(i, lidar_); }

  /// `sweep` is the i-th.
  void write(std::size_t i, const LidarSweep& sweep, const fs::path& file) const {
    io::RangeImage image = truth_.labels ? with_table(sweep, i) : without_table(sweep);
    image.sensor = fmt::format("{} (lidar{})", recording_.rig().lidars[lidar_].model, lidar_);
    io::write_range_image(file, image);
  }

 private:
  io::RangeImage with_table(const LidarSweep& sweep, std::size_t i) const {
    const PointLabels labels = sim::truth::labels_from_chunk(truth_.labels->read(i));
    if (!no_truth_ && sweep.size() > 0 && !labels.has_point_truth())
      throw InputError(
          fmt::format("{}: the truth holds labels only; simulate again with --point-truth (or `truth: {{per_point: "
                      "true}}` in the scenario) for normals and incidence, or leave them out with --no-truth",
                      folder_.string()));
    const sim::lidar::FiringGrid grid(*truth_.firing, sweep.index);
    io::RangeImage image = io::make_range_image(sweep, cells_by_table(sweep, labels, grid), grid.rings(),
                                                grid.columns(), no_truth_ ? nullptr : &labels);
    image.columns = "firing cycle";
    return image;
  }

  io::RangeImage without_table(const LidarSweep& sweep) const {
    std::size_t rings = 0, columns = 0;
    const std::vector<io::RangeCell> cells = io::cells_by_time(sweep, rings, columns);
    io::RangeImage image = io::make_range_image(sweep, cells, rings, columns, nullptr);
    image.columns = "firing time";
    return image;
  }

  fs::path folder_;
  core::Recording recording_;
  std::size_t lidar_;
  bool no_truth_;
  Truth truth_;
};

}  // namespace

int export_images(const TransferArguments& arguments, const Console& console) {
  if (!arguments.estimator.empty()) throw InputError("export --format exr: -e has no place in it");
  const Exporter exporter(arguments);
  const fs::path to = arguments.to;
  const bool one_file = to.extension() == ".exr";
  if (one_file && arguments.sweep < 0)
    throw InputError(
        fmt::format("-o {}: is one file, and all sweeps were asked for; give --sweep, or a folder", to.string()));
  if (!one_file) fs::create_directories(to);
  const core::Progress progress = console.progress("export");
  bool found = false;
  for (std::size_t i = 0; i < exporter.sweeps(); ++i) {
    const LidarSweep sweep = exporter.sweep(i);
    if (arguments.sweep >= 0 && sweep.index != arguments.sweep) continue;
    found = true;
    exporter.write(i, sweep, one_file ? to : to / fmt::format("{:06}.exr", sweep.index));
    progress(static_cast<double>(i + 1) / static_cast<double>(exporter.sweeps()), "");
  }
  if (!found && arguments.sweep >= 0)
    throw InputError(fmt::format("--sweep {}: the recording has no sweep of that index", arguments.sweep));
  progress(1.0, "");
  fmt::print("{}\n", arguments.to);
  return 0;
}

}  // namespace tarmac::tools
