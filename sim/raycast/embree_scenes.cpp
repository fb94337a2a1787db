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

void set_rigid(RTCGeometry instance, const core::SE3& pose) {
  Eigen::Matrix<float, 3, 4> matrix;  // column-major, as Embree wants it
  matrix.leftCols<3>() = pose.linear().cast<float>();
  matrix.rightCols<1>() = pose.translation().cast<float>();
  rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix.data());
}

// Matrices interpolated entry by entry would shrink what turns; quaternions do not.
void set_moving(RTCGeometry instance, std::span<const core::SE3> poses) {
  rtcSetGeometryTimeStepCount(instance, static_cast<unsigned>(poses.size()));
  Eigen::Quaterniond previous = Eigen::Quaterniond::Identity();
  for (std::size_t k = 0; k < poses.size(); ++k) {
    Eigen::Quaterniond q(poses[k].linear());
    if (k > 0 && q.dot(previous) < 0) q.coeffs() = -q.coeffs();  // the short way round
    previous = q;
    const Eigen::Vector3f t = poses[k].translation().cast<float>();
    RTCQuaternionDecomposition decomposition;
    rtcInitQuaternionDecomposition(&decomposition);
    rtcQuaternionDecompositionSetQuaternion(&decomposition, static_cast<float>(q.w()), static_cast<float>(q.x()),
                                            static_cast<float>(q.y()), static_cast<float>(q.z()));
    rtcQuaternionDecompositionSetTranslation(&decomposition, t.x(), t.y(), t.z());
    rtcSetGeometryTransformQuaternion(instance, static_cast<unsigned>(k), &decomposition);
  }
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

void add_instance(RTCDevice device, RTCScene top, RTCScene mesh, unsigned id, std::span<const core::SE3> poses) {
  RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(instance, mesh);
  if (poses.size() == 1)
    set_rigid(instance, poses.front());
  else
    set_moving(instance, poses);
  rtcCommitGeometry(instance);
  rtcAttachGeometryByID(top, instance, id);
  rtcReleaseGeometry(instance);
}

void commit(RTCScene scene) {
  tbb::this_task_arena::isolate([&] { rtcCommitScene(scene); });
}

}  // namespace tarmac::sim::raycast
