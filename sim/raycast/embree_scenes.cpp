#include "sim/raycast/embree_scenes.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <cstring>
#include <stdexcept>
#include <string>

namespace tarmac::sim::raycast {
namespace {

void throw_reason(void*, RTCError code, const char* reason) {
  if (code != RTC_ERROR_NONE)
    throw std::runtime_error(fmt::format("Embree: {} (code {})", reason, static_cast<int>(code)));
}

}  // namespace

Device new_device(const std::string& config) {
  RTCDevice device = rtcNewDevice(config.c_str());
  if (device == nullptr)
    throw std::runtime_error(
        fmt::format("Embree cannot start with '{}' (code {})", config, static_cast<int>(rtcGetDeviceError(nullptr))));
  rtcSetDeviceErrorFunction(device, throw_reason, nullptr);
  return Device(device);
}

EmbreeScene mesh_scene(RTCDevice device, const scenes::Mesh& mesh) {
  EmbreeScene scene = empty_scene(device);
  add_mesh(device, scene.get(), mesh, core::SE3::Identity(), 0);
  commit(scene.get());
  return scene;
}

EmbreeScene empty_scene(RTCDevice device) {
  return EmbreeScene(rtcNewScene(device));
}

void add_mesh(RTCDevice device, RTCScene scene, const scenes::Mesh& mesh, const core::SE3& T_base_mesh, unsigned id) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  if (!mesh.triangles.empty()) {
    auto* vertices = static_cast<Eigen::Vector3f*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Eigen::Vector3f), mesh.vertices.size()));
    for (std::size_t k = 0; k < mesh.vertices.size(); ++k)
      vertices[k] = (T_base_mesh * mesh.vertices[k].cast<double>()).cast<float>();
    void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                              3 * sizeof(std::uint32_t), mesh.triangles.size());
    std::memcpy(triangles, mesh.triangles.data(), mesh.triangles.size() * 3 * sizeof(std::uint32_t));
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

void commit(RTCScene scene) {
  tbb::this_task_arena::isolate([&] { rtcCommitScene(scene); });
}

}  // namespace tarmac::sim::raycast
