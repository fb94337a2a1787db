/// Sweeps as OpenEXR images of several channels: a row for each ring, a column for each firing cycle.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/measurements.h"
#include "sim/truth/ground_truth.h"

namespace tarmac::io {

/// One return of every firing, as arrays of width x height values, row by row from the top.
struct RangeLayer {
  std::vector<float> range_m;          ///< from the sensor frame's origin; 0: no return (all else is 0 then)
  std::vector<float> intensity;        ///< as recorded
  std::vector<std::uint32_t> time_ns;  ///< firing time, from RangeImage::time_origin_ns
  // Of the truth; empty where it was left out.
  std::vector<float> normal_x, normal_y, normal_z;  ///< unit normal of the surface, world axes, towards the sensor
  std::vector<float> cos_incidence;
  std::vector<std::uint32_t> label, instance, moving, kind;  ///< scenes::Label, PointLabels, ReturnKind

  void resize(std::size_t cells, bool with_truth);
  bool operator==(const RangeLayer&) const = default;
};

struct RangeImage {
  std::size_t width = 0;   ///< columns
  std::size_t height = 0;  ///< rings; row 0 is the highest ring, so that the picture stands upright
  std::string sensor;      ///< model, and its number on the rig: "vlp-16 (lidar0)"
  std::string columns;     ///< what a column is: "firing cycle" or "firing time"
  std::int64_t sweep = 0;  ///< index
  std::int64_t begin_ns = 0, end_ns = 0, time_origin_ns = 0;  ///< on the recording's clock
  bool with_truth = false;
  std::vector<RangeLayer> returns;  ///< one, or two where a firing of the sweep returned twice

  bool operator==(const RangeImage&) const = default;
};

/// Where a point belongs.
struct RangeCell {
  std::size_t ring = 0, column = 0;
};

/// An image of a sweep. `cells`: one a point, ring < rings, column < columns; a cell's second point goes to the second
/// layer. Times count from the sweep's begin, or from the earliest point where a faulty clock has put one before it.
/// @param labels  of the sweep's points, with point truth (has_point_truth()); nullptr: without truth
/// Throws InputError when more than two points fall into a cell, or labels do not belong to the sweep.
RangeImage make_range_image(const core::LidarSweep& sweep, const std::vector<RangeCell>& cells, std::size_t rings,
                            std::size_t columns, const sim::truth::PointLabels* labels);
/// Columns where no firing table is known: one for each instant at which something returned.
std::vector<RangeCell> cells_by_time(const core::LidarSweep& sweep, std::size_t& rings, std::size_t& columns);

/// One scan-line image, compressed without loss (ZIP); channels and attributes: docs/formats.md. Throws InputError when
/// the file cannot be written.
void write_range_image(const std::filesystem::path& file, const RangeImage& image);
/// Reads what write_range_image wrote. Throws InputError when the file is none or lacks a channel.
RangeImage read_range_image(const std::filesystem::path& file);

}  // namespace tarmac::io
