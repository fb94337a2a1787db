/// The smallest rotation that carries one direction onto another.
#pragma once

#include <Eigen/Geometry>

namespace tarmac::core {

/// As Eigen::Quaterniond::FromTwoVectors, to the bit: lengths do not matter, opposite directions turn about any axis
/// square to them. In a source of its own because of the singular value decomposition inside, which takes a compiler
/// longer than most files around a call.
Eigen::Quaterniond shortest_turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace tarmac::core
