/// Where the stills are seen from.
#pragma once

#include <vtkRenderer.h>

#include <Eigen/Core>
#include <vector>

#include "reports/stills.h"

namespace tarmac::reports {

void look_from_above(vtkRenderer* renderer, const TopView& view, double ground_z_m);

/// As near as corners (relative to `center`) allow, from `direction` (unit vector from the scene to the eye).
void look_at_corners(vtkRenderer* renderer, const Eigen::Vector3d& center, const std::vector<Eigen::Vector3d>& corners,
                     const Eigen::Vector3d& direction, double aspect);

/// A bird's view from the south-west of a rectangle of the ground: without its near corner, which is empty ground in
/// the foreground, and without its outermost sides.
void look_as_bird(vtkRenderer* renderer, const Eigen::Vector3d& center, const Eigen::Vector2d& half_m, double aspect);

/// `nearest_m`: from the eye to the nearest thing.
void look_from_eye(vtkRenderer* renderer, const EyeView& view, double nearest_m);

/// Without perspective, along `direction`; `m_per_px` is the same for all pictures that are to be compared.
void look_flat(vtkRenderer* renderer, const FlatView& view);

}  // namespace tarmac::reports
