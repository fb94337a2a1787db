/// Embree objects with owners. Private to sim/raycast: the only header that names Embree.
#pragma once

#include <embree3/rtcore.h>

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "core/lie.h"
#include "scenes/scene.h"

namespace tarmac::sim::raycast {

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;
using EmbreeScene = std::unique_ptr<RTCSceneTy, ReleaseScene>;

/// Throws std::runtime_error with Embree's reason.
Device new_device(const std::string& config);
/// One mesh as a committed scene of its own, in the mesh's frame.
EmbreeScene mesh_scene(RTCDevice device, const scenes::Mesh& mesh);
/// An empty scene, to be filled and committed.
EmbreeScene empty_scene(RTCDevice device);
/// Adds a mesh, carried by T_base_mesh in double precision, as triangles of the scene's own under `id`: hits report it
/// as geometry, with no instance. One hierarchy over all that stands still is faster to walk than instances whose boxes
/// overlap on one pavement.
void add_mesh(RTCDevice device, RTCScene scene, const scenes::Mesh& mesh, const core::SE3& T_base_mesh, unsigned id);
/// Builds the hierarchy. Waits without taking up other work of the thread pool: callers may hold locks.
void commit(RTCScene scene);

}  // namespace tarmac::sim::raycast
