#include "metrics/sweep_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "core/error.h"
#include "core/merged_sweeps.h"

namespace tarmac::metrics {

using sim::truth::PointLabels;

DiagnosticsSource diagnostics_of(const core::DiagnosticsReader& reader) {
  return {reader.size(), [&reader](std::size_t i) { return reader.read(i); }};
}

DiagnosticsSource diagnostics_of(const std::vector<core::SweepDiagnostics>& sweeps) {
  return {sweeps.size(), [&sweeps](std::size_t i) { return sweeps[i]; }};
}

std::vector<core::SE3> SweepSource::true_mountings(const core::Rig& truth) const {
  std::vector<core::SE3> mountings;
  for (std::size_t k = 0; k < T_body_lidars.size(); ++k)
    mountings.push_back(truth.lidars.at(k).T_body_lidar * T_body_lidars[k].inverse());
  return mountings;
}

SweepSource sweeps_of(const core::Recording& recording) {
  if (recording.rig().lidars.size() < 2)
    return {recording.sweep_count(), [&recording](std::size_t i) { return recording.sweep(i); }, recording.rig()};
  const auto merged = std::make_shared<const core::MergedSweeps>(recording);
  SweepSource source{merged->count(), [merged](std::size_t i) { return merged->sweep(i); }, merged->rig()};
  for (const core::LidarSheet& lidar : recording.rig().lidars) source.T_body_lidars.push_back(lidar.T_body_lidar);
  return source;
}

namespace {

/// One merged sweep's labels: times count from the first LiDAR's true begin.
PointLabels merged_labels(const std::vector<core::PointSource>& sources, const PointLabels& first,
                          const std::vector<std::vector<PointLabels>>& of_lidars) {
  PointLabels merged;
  merged.begin = first.begin;
  merged.end = first.end;
  for (const core::PointSource& source : sources) {
    const PointLabels& labels = of_lidars.at(source.lidar).at(source.sweep);
    if (source.point >= labels.label.size())
      throw core::InputError(fmt::format(
          "lidar{}: a sweep has more points than the truth has labels: they do not belong together", source.lidar));
    merged.label.push_back(labels.label[source.point]);
    merged.instance.push_back(labels.instance[source.point]);
    merged.moving.push_back(labels.moving[source.point]);
    merged.kind.push_back(labels.kind_of(source.point));
    const std::int64_t t_ns = (labels.time(source.point) - merged.begin).count();
    if (t_ns != static_cast<std::int32_t>(t_ns))
      throw core::InputError(
          fmt::format("lidar{}: its true time is {:.3f} s away from the sweep that its stamps put it "
                      "into: with clocks so far apart several LiDARs cannot be scored as one",
                      source.lidar, 1e-9 * static_cast<double>(t_ns)));
    merged.t_ns.push_back(static_cast<std::int32_t>(t_ns));
    merged.end = std::max(merged.end, labels.time(source.point));
  }
  return merged;
}

}  // namespace

std::vector<PointLabels> labels_of(const core::Recording& recording, const sim::truth::GroundTruth& truth) {
  if (recording.rig().lidars.size() < 2) return truth.labels();
  std::vector<std::vector<PointLabels>> of_lidars;
  for (std::size_t k = 0; k < recording.rig().lidars.size(); ++k) {
    of_lidars.push_back(truth.labels(k));
    if (of_lidars[k].size() != recording.sweep_count(k))
      throw core::InputError(
          fmt::format("lidar{}: the recording has {} sweeps and the truth labels of {}: they do not belong together", k,
                      recording.sweep_count(k), of_lidars[k].size()));
  }
  const core::MergedSweeps merged(recording);
  std::vector<PointLabels> labels;
  std::vector<core::PointSource> sources;
  for (std::size_t i = 0; i < merged.count(); ++i) {
    merged.sweep(i, &sources);
    labels.push_back(merged_labels(sources, of_lidars[0][i], of_lidars));
  }
  return labels;
}

}  // namespace tarmac::metrics
