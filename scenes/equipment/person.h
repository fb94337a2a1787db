/// A marshaller of 1.75 m in high-visibility clothing with a wand in each hand, in parts that can move.
/// Frame of the person: origin on the ground between the feet, x forward, y left, z up.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/lie.h"
#include "scenes/primitives/mesh_builder.h"

namespace tarmac::scenes {

/// A rigid part in its own frame, whose origin is the joint that joins it to its parent; standing, all frames are
/// parallel to the person's.
struct PersonPart {
  std::string name;         ///< "torso", "left_thigh", ...
  int parent;               ///< index into person_parts(); -1: the person itself
  Eigen::Vector3d joint_m;  ///< origin in the parent's frame, standing
  Mesh mesh;
};
/// Always in the same order, parents first; torso (with head and pelvis), then left and right thigh, shank, foot, upper
/// arm, forearm (with hand and wand).
const std::vector<PersonPart>& person_parts();

/// Angles as C-infinity functions of the phases, so a phase that is smooth in time moves every part smoothly.
struct PersonPosture {
  double gait_phase_rad = 0;  ///< 2 pi a stride (two steps)
  double gait = 0;            ///< 0 stands, 1 walks with full steps; between: shorter steps
  double arms_raised = 0;     ///< 0 hang down (and swing with the gait), 1 wands held up
  double wave_phase_rad = 0;  ///< with raised arms: the forearms beckon, 2 pi a beckoning
};
/// Way that a full stride covers: the phase advances by 2 pi over it, so that the foot on the ground hardly slips.
double person_stride_m(double gait = 1);
/// T_person_part for every part. The lower foot stays within 3 mm of z = 0.
std::vector<core::SE3> person_pose(const PersonPosture& posture);
/// All parts in one mesh, for people that do not move.
Mesh make_person(const PersonPosture& posture);
void add_person(MeshBuilder& b, const PersonPosture& posture);

/// Of a sphere around the person's origin that holds it in every posture [m].
inline constexpr double kPersonRadius_m = 2.7;

}  // namespace tarmac::scenes
