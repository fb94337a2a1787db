/// Meshes that follow a Ground: bands along a centre line, and rectangles of the plane. Cells are as large as the
/// ground's curvature allows, along and across apart, so that facets stay within a given distance of it.
#pragma once

#include <functional>
#include <vector>

#include "scenes/paving/centre_line.h"
#include "scenes/primitives/mesh_builder.h"

namespace tarmac::scenes {

struct MeshTolerance {
  double sagitta_m = 0.0004;  ///< largest distance, measured upright, of a facet from the ground
  double max_cell_m = 8;      ///< edge of a cell, where the ground would allow more
};

/// Bands beside each other along a line: all share the same stations, so neighbours meet without gaps.
class StripMesher {
 public:
  /// From station s0 to s1 > s0; [low_d_m, high_d_m] holds all bands to come. Keeps references to ground and line.
  StripMesher(const Ground& ground, const CentreLine& line, double s0_m, double s1_m, double low_d_m, double high_d_m,
              const MeshTolerance& tolerance = {});

  /// The ground between d = right_d_m and left_d_m > right_d_m, facing up.
  void band(MeshBuilder& b, double right_d_m, double left_d_m) const;
  /// An upright strip along d from `low_m` to `high_m` above the ground, its face turned to the left or to the right.
  void wall(MeshBuilder& b, double d_m, double low_m, double high_m, bool faces_left) const;
  /// The underside of a slab `height_m` above the ground, facing down.
  void ceiling(MeshBuilder& b, double right_d_m, double left_d_m, double height_m) const;
  const std::vector<double>& stations_m() const { return stations_m_; }

 private:
  std::vector<double> lines_across(double right_d_m, double left_d_m) const;
  void surface(MeshBuilder& b, double right_d_m, double left_d_m, double height_m, bool faces_up) const;

  const Ground* ground_;
  const CentreLine* line_;
  MeshTolerance tolerance_;
  std::vector<double> stations_m_;
};

/// Which cells to leave out: the rectangle [low, high] of a cell.
using CellFilter = std::function<bool(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m)>;
/// The ground over the rectangle [low_m, high_m], `lift_m` above it, facing up; cells for which `keep` is false are
/// left out. Cells are cut at `cuts_x_m` and `cuts_y_m` too, so that a filter may follow straight edges exactly.
void add_ground_region(MeshBuilder& b, const Ground& ground, const Eigen::Vector2d& low_m,
                       const Eigen::Vector2d& high_m, const MeshTolerance& tolerance = {}, const CellFilter& keep = {},
                       double lift_m = 0, const std::vector<double>& cuts_x_m = {},
                       const std::vector<double>& cuts_y_m = {});
/// The corner between two lines that meet at `corner_m`, filled up to an arc that touches both (a fillet): `start` and
/// `end` are unit vectors along the two lines, away from the corner.
void add_fillet(MeshBuilder& b, const Ground& ground, const Eigen::Vector2d& corner_m, const Eigen::Vector2d& start,
                const Eigen::Vector2d& end, double radius_m, const MeshTolerance& tolerance = {});
/// What a fillet leaves of the square (in general: kite) between its two touching points, beyond the arc.
void add_fillet_rest(MeshBuilder& b, const Ground& ground, const Eigen::Vector2d& corner_m,
                     const Eigen::Vector2d& start, const Eigen::Vector2d& end, double radius_m,
                     const MeshTolerance& tolerance = {});

/// A closed bar along the line from s0 to s1 with the cross-section `outline`: points (d, height above the ground below
/// the line), counter-clockwise seen along the line. Kerbs, guard rails, pipes, cable trays. Convex outlines.
void add_swept(MeshBuilder& b, const Ground& ground, const CentreLine& line, double s0_m, double s1_m,
               const std::vector<Eigen::Vector2d>& outline, double step_m);
/// Corners of a rectangle, and points of a circle, as such outlines.
std::vector<Eigen::Vector2d> rectangle_outline(double d0_m, double h0_m, double d1_m, double h1_m);
std::vector<Eigen::Vector2d> circle_outline(double d_m, double h_m, double radius_m, int segments);

/// Places u0 = from, u1, ... = to such that a chord between neighbours lies within `sagitta_m` of a curve whose second
/// derivative is at most curvature_at(u), and is at most max_step_m long.
std::vector<double> chord_steps(double from, double to, const std::function<double(double)>& curvature_at,
                                double sagitta_m, double max_step_m);

}  // namespace tarmac::scenes
