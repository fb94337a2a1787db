#include "reports/stills_cameras.h"

#include <vtkCamera.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "reports/stills_meshes.h"

namespace tarmac::reports {

namespace {

constexpr double kFramedWidth = 0.8;
constexpr double kTallest_m = 14;  ///< what the bird's view leaves room for above the ground
const Eigen::Vector3d kBirdDirection = Eigen::Vector3d(-0.62, -1.0, 0.50).normalized();  ///< from the scene to the eye
constexpr double kFieldOfView_deg = 28;

}  // namespace

void look_from_above(vtkRenderer* renderer, const TopView& view, double ground_z_m) {
  vtkCamera* const camera = renderer->GetActiveCamera();
  const Eigen::Vector2d middle = 0.5 * (view.min_m + view.max_m);
  camera->ParallelProjectionOn();
  camera->SetParallelScale(0.5 * (view.max_m.y() - view.min_m.y()));
  camera->SetFocalPoint(middle.x(), middle.y(), ground_z_m);
  camera->SetPosition(middle.x(), middle.y(), ground_z_m + 200);
  camera->SetViewUp(0, 1, 0);
  camera->SetClippingRange(20, 230);
}

void look_at_corners(vtkRenderer* renderer, const Eigen::Vector3d& center, const std::vector<Eigen::Vector3d>& corners,
                     const Eigen::Vector3d& direction, double aspect) {
  const Eigen::Vector3d right = Eigen::Vector3d::UnitZ().cross(direction).normalized();
  const Eigen::Vector3d up = direction.cross(right);
  const double tan_y = std::tan(0.5 * kFieldOfView_deg * M_PI / 180), tan_x = tan_y * aspect;
  // An eye at focus + s * direction sees a corner c when |right·c| <= tan_x (s - direction·c), and so for up. Sides
  // are handled apart: the focus is moved until left and right, top and bottom need the same distance.
  double right_m = -1e9, left_m = -1e9, top_m = -1e9, bottom_m = -1e9;
  for (const Eigen::Vector3d& corner : corners) {
    const double depth_m = direction.dot(corner);
    right_m = std::max(right_m, depth_m + right.dot(corner) / tan_x);
    left_m = std::max(left_m, depth_m - right.dot(corner) / tan_x);
    top_m = std::max(top_m, depth_m + up.dot(corner) / tan_y);
    bottom_m = std::max(bottom_m, depth_m - up.dot(corner) / tan_y);
  }
  const Eigen::Vector3d focus =
      center + 0.5 * tan_x * (right_m - left_m) * right + 0.5 * tan_y * (top_m - bottom_m) * up;
  const double distance_m = 0.5 * std::max(right_m + left_m, top_m + bottom_m);
  vtkCamera* const camera = renderer->GetActiveCamera();
  camera->ParallelProjectionOff();
  camera->SetViewAngle(kFieldOfView_deg);
  camera->SetFocalPoint(focus.x(), focus.y(), focus.z());
  const Eigen::Vector3d eye = focus + distance_m * direction;
  camera->SetPosition(eye.x(), eye.y(), eye.z());
  camera->SetViewUp(0, 0, 1);
  camera->SetClippingRange(0.1 * distance_m, distance_m + kGroundRadius_m);
}

void look_as_bird(vtkRenderer* renderer, const Eigen::Vector3d& center, const Eigen::Vector2d& half_m, double aspect) {
  const double x = kFramedWidth * half_m.x(), y = half_m.y();
  std::vector<Eigen::Vector3d> corners;
  for (const double z : {0.0, kTallest_m}) {
    corners.insert(corners.end(), {{-x, y, z}, {x, y, z}, {x, -y, z}, {-x, 0, z}, {0, -y, z}});
  }
  look_at_corners(renderer, center, corners, kBirdDirection, aspect);
}

void look_from_eye(vtkRenderer* renderer, const EyeView& view, double nearest_m) {
  const Eigen::Vector3d forward = view.look_at_m - view.eye_m;
  const bool upright = forward.head<2>().norm() > 1e-3 * forward.norm();
  vtkCamera* const camera = renderer->GetActiveCamera();
  camera->ParallelProjectionOff();
  camera->SetViewAngle(view.height_deg);
  camera->SetFocalPoint(view.look_at_m.x(), view.look_at_m.y(), view.look_at_m.z());
  camera->SetPosition(view.eye_m.x(), view.eye_m.y(), view.eye_m.z());
  camera->SetViewUp(0, upright ? 0 : 1, upright ? 1 : 0);
  // The nearer the near plane, the less depth is left to tell paint from the slab 2 mm below it; what is nearest may
  // stand in a corner of the picture, where it is nearer to the plane than to the eye.
  constexpr double corner_share = 0.4;
  camera->SetClippingRange(std::max(0.005, corner_share * nearest_m), view.eye_m.norm() + 2 * kGroundRadius_m);
}

void look_flat(vtkRenderer* renderer, const FlatView& view) {
  constexpr double distance_m = 500;
  vtkCamera* const camera = renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetParallelScale(0.5 * view.height_px * view.m_per_px);
  const Eigen::Vector3d eye = view.middle_m + distance_m * view.direction;
  camera->SetFocalPoint(view.middle_m.x(), view.middle_m.y(), view.middle_m.z());
  camera->SetPosition(eye.x(), eye.y(), eye.z());
  camera->SetViewUp(view.up.x(), view.up.y(), view.up.z());
  camera->SetClippingRange(1, 2 * distance_m);
}

}  // namespace tarmac::reports
