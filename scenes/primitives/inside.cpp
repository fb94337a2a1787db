#include "scenes/primitives/inside.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace tarmac::scenes {

using Eigen::Vector3d;

double winding_number(const Mesh& mesh, const Vector3d& p) {
  // tan(angle / 2) = a.(b x c) / (|a||b||c| + (a.b)|c| + (b.c)|a| + (c.a)|b|), corners counted from p
  double half_angles = 0;
  for (const auto& triangle : mesh.triangles) {
    const Vector3d a = mesh.vertices[triangle[0]].cast<double>() - p, b = mesh.vertices[triangle[1]].cast<double>() - p,
                   c = mesh.vertices[triangle[2]].cast<double>() - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    half_angles += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return half_angles / (2 * std::numbers::pi);
}

Eigen::AlignedBox3f bounds_of(const Mesh& mesh) {
  Eigen::AlignedBox3f bounds;
  for (const Eigen::Vector3f& v : mesh.vertices) bounds.extend(v);
  return bounds;
}

bool is_inside(const Mesh& mesh, const Vector3d& p) {
  // Less than once, by whatever little: the surface has an opening, and may be a building of one skin.
  return bounds_of(mesh).contains(p.cast<float>()) && winding_number(mesh, p) > 0.999;
}

}  // namespace tarmac::scenes
