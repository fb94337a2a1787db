/// The scene as double precision sees it: a plane for every triangle, a pose for every instance.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/lie.h"
#include "core/time.h"
#include "scenes/scene.h"

namespace tarmac::sim::raycast {

/// n'x = d in the mesh's frame; n is of unit length, or zero for a triangle without area.
struct alignas(32) TrianglePlane {  // never across two cache lines: rays fetch them at random
  Eigen::Vector3d normal;
  double offset_m;
};

/// Throws InputError when a triangle, an instance or an actor refers to something that does not exist.
void check_references(const scenes::Scene& scene);

std::vector<TrianglePlane> planes_of(const scenes::Mesh& mesh);

/// How many equidistant poses, first and last included, keep the error of interpolating between them below 0.2 mm for a
/// point that accelerates by at most `acceleration_m_s2`: a T^2 / (8 (n - 1)^2). At least 2.
int motion_steps(double acceleration_m_s2, core::Duration span);

}  // namespace tarmac::sim::raycast
