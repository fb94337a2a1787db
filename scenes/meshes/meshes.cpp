#include "scenes/meshes/meshes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/error.h"
#include "core/files.h"
#include "scenes/meshes/material_map.h"
#include "scenes/meshes/mesh_file.h"

namespace tarmac::scenes {

namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

/// Coordinates are single precision. At this distance from the mesh's origin neighbouring values are 0.5 mm apart.
constexpr double kFarthest_m = 8192;
/// Where the world ends: ten times as far as any scene of ours.
constexpr double kWorld_m = 20000;
constexpr double kSmallest_m = 0.001;
/// A triangle below this area (a hundredth of a millimetre by a fifth) is met by no ray.
constexpr double kSmallestArea_m2 = 1e-12;

std::vector<std::string> label_names() {
  std::vector<std::string> names;
  for (int value = 1; value < 256; ++value) {
    const std::string name = name_of(static_cast<Label>(value));
    if (name != "unknown") names.push_back(name);
  }
  return names;
}

Label label_of(const std::string& name) {
  for (int value = 0; value < 256; ++value) {
    if (name == name_of(static_cast<Label>(value))) return static_cast<Label>(value);
  }
  return Label::other;
}

/// One entry of the list, but for its materials.
struct MeshOptions {
  std::string file;
  core::SE3 T_world_mesh = core::SE3::Identity();
  double scale = 1;
  std::string up = "auto";
  std::string label = "other";
  std::string content_hash;

  void visit(core::OptionVisitor& v) {
    v("file", file, "OBJ, PLY, STL, glTF or GLB; relative paths count from the file that says so");
    v("T_world_mesh", T_world_mesh, "where the mesh stands, after scale and axes");
    v("scale", scale, "metres a unit of the file", {.above = 0, .at_most = 1e6});
    v.choice("up", up, {"auto", "z", "y"}, "the file's upward axis; auto: y for glTF, z for the others");
    v.choice("label", label, label_names(), "what its points are labelled as");
    v("content_hash", content_hash, "of the file's bytes: written by Tarmac, refused when the file is another");
  }
};

struct Request {
  core::ConfigNode node;
  MeshOptions options;
  fs::path file;  ///< absolute
};

/// Relative paths count from the file that says them; on the command line, from where the user stands.
fs::path absolute_path(const core::ConfigNode& node, const std::string& text) {
  const fs::path given(text);
  if (given.is_absolute()) return given.lexically_normal();
  const fs::path base = node.given_by_set() ? fs::current_path() : fs::absolute(fs::path(node.file())).parent_path();
  return (base / given).lexically_normal();
}

Request read_request(const core::ConfigNode& node) {
  Request request{node, {}, {}};
  node.read(request.options, {"material", "materials"});
  if (request.options.file.empty()) node.fail_at("file", "is missing: give the mesh's file");
  const core::ConfigNode file = node.child("file");
  request.file = absolute_path(file, request.options.file);
  if (!fs::is_regular_file(request.file)) {
    file.fail(fmt::format("{}: {}; relative paths count from the file that says them", request.file.string(),
                          fs::exists(request.file) ? "is no file" : "there is no such file"));
  }
  return request;
}

std::vector<Request> read_requests(const core::ConfigNode& list) {
  std::vector<Request> requests;
  if (!list.present()) return requests;
  for (const core::ConfigNode& item : list.items()) {
    if (!item.is_block()) item.fail("must be a block such as {file: hangar.ply, material: concrete_wall}");
    requests.push_back(read_request(item));
  }
  return requests;
}

const MeshReader& reader_for(const Request& request) {
  const MeshReader* reader = installed_mesh_reader();
  if (reader == nullptr) {
    request.node.fail(
        "this program was built without readers of mesh files: its main() must call "
        "io::world::install_mesh_readers()");
  }
  return *reader;
}

/// Runs `f` and puts the scenario's place before what it says of the mesh file.
template <class F>
auto at_line_of(const Request& request, const F& f) {
  try {
    return f();
  } catch (const core::InputError& error) {
    request.node.child("file").fail(error.what());
  }
}

std::string content_hash(const Request& request) {
  return at_line_of(request, [&] {
    std::string hashes;
    for (const fs::path& part : reader_for(request).parts(request.file)) {
      hashes += core::hash_hex(core::read_file(part.string()));
    }
    return hashes.size() == 16 ? hashes : core::hash_hex(hashes);
  });
}

void check_unchanged(const Request& request) {
  if (request.options.content_hash.empty()) return;
  const std::string now = content_hash(request);
  if (now == request.options.content_hash) return;
  request.node.child("content_hash")
      .fail(fmt::format("{} has changed since this was written (hash {} then, {} now): put the old file back, or "
                        "remove this line and simulate again",
                        request.file.string(), request.options.content_hash, now));
}

/// The file's coordinates to the mesh's frame: metres, z up.
Vector3d to_mesh(const Eigen::Vector3f& p_file, double scale, bool y_is_up) {
  const Vector3d p = scale * p_file.cast<double>();
  return y_is_up ? Vector3d(p.x(), -p.z(), p.y()) : p;
}

void check_finite(const MeshFile& file, const fs::path& path) {
  for (std::size_t i = 0; i < file.vertices.size(); ++i) {
    const Eigen::Vector3f& p = file.vertices[i];
    if (p.allFinite()) continue;
    throw core::InputError(
        fmt::format("{}: vertex {} (counted from 0) is ({}, {}, {}): every coordinate must be finite", path.string(), i,
                    p.x(), p.y(), p.z()));
  }
}

/// What is wrong with the size of a mesh is nearly always its unit, or an origin far away.
void check_extent(const Mesh& mesh, const Request& request) {
  Eigen::Vector3f low = mesh.vertices.front(), high = low;
  for (const Eigen::Vector3f& p : mesh.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double farthest = std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
  const double size = (high - low).maxCoeff();
  const auto box = fmt::format("it spans ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g}) m with scale {:g}", low.x(), low.y(),
                               low.z(), high.x(), high.y(), high.z(), request.options.scale);
  if (farthest > kFarthest_m) {
    throw core::InputError(
        fmt::format("{}: {}; within {:g} m of its origin is allowed, since coordinates have single precision: set "
                    "`scale:` (0.001 for millimetres), or move the mesh to an origin of its own",
                    request.file.string(), box, kFarthest_m));
  }
  if (size < kSmallest_m) {
    throw core::InputError(
        fmt::format("{}: {}, less than a millimetre: set `scale:` (1000 for kilometres)", request.file.string(), box));
  }
  const double reach = request.options.T_world_mesh.translation().cwiseAbs().maxCoeff();
  if (reach + 2 * farthest > kWorld_m) {
    request.node.child("T_world_mesh")
        .fail(fmt::format("puts {} beyond {:g} m from the world's origin", request.file.string(), kWorld_m));
  }
}

bool has_area(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const Vector3d a = mesh.vertices[t[0]].cast<double>();
  const Vector3d u = mesh.vertices[t[1]].cast<double>() - a, v = mesh.vertices[t[2]].cast<double>() - a;
  return 0.5 * u.cross(v).norm() > kSmallestArea_m2;
}

/// Metres, z up, the scene's materials. Triangles without an area are left out: no ray can meet them.
Mesh load(const Request& request, Scene& scene) {
  MeshFile file = reader_for(request).read(request.file);
  if (file.triangles.empty()) throw core::InputError(fmt::format("{}: holds no triangles", request.file.string()));
  check_finite(file, request.file);
  const std::vector<std::uint16_t> material_of_name = map_materials(request.node, file, scene, request.file);
  const bool y_is_up = request.options.up == "auto" ? file.y_is_up : request.options.up == "y";
  Mesh mesh;
  mesh.name = request.file.filename().string();
  mesh.vertices = std::move(file.vertices);
  for (Eigen::Vector3f& p : mesh.vertices) p = to_mesh(p, request.options.scale, y_is_up).cast<float>();
  check_extent(mesh, request);
  mesh.materials.reserve(file.triangles.size());
  for (std::size_t t = 0; t < file.triangles.size(); ++t) {
    if (!has_area(mesh, file.triangles[t])) continue;
    mesh.materials.push_back(material_of_name[file.name_of_triangle.empty() ? 0 : file.name_of_triangle[t]]);
    file.triangles[mesh.materials.size() - 1] = file.triangles[t];
  }
  if (mesh.materials.empty()) {
    throw core::InputError(
        fmt::format("{}: none of its {} triangles has an area", request.file.string(), file.triangles.size()));
  }
  file.triangles.resize(mesh.materials.size());
  mesh.triangles = std::move(file.triangles);
  return mesh;
}

}  // namespace

void add_meshes(Scene& scene, const core::ConfigNode& list) {
  for (const Request& request : read_requests(list)) {
    check_unchanged(request);
    Mesh mesh = at_line_of(request, [&] { return load(request, scene); });
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({static_cast<std::uint32_t>(scene.meshes.size() - 1), label_of(request.options.label), -1,
                               request.options.T_world_mesh});
  }
}

std::string resolve_meshes(const core::ConfigNode& list) {
  std::string text;
  for (Request& request : read_requests(list)) {
    check_unchanged(request);
    request.options.file = request.file.string();
    if (request.options.content_hash.empty()) request.options.content_hash = content_hash(request);
    std::string entry = core::write_options(request.options, 6) + resolve_materials(request.node, 6);
    entry[4] = '-';
    text += entry;
  }
  return text.empty() ? "" : "  meshes:\n" + text;
}

std::vector<core::OptionDescription> describe_meshes() {
  std::vector<core::OptionDescription> lines = core::describe_options<MeshOptions>();
  lines.push_back({"material", "text or block", "", "",
                   "of all triangles whose name in the file `materials:` does not hold: one of the table, or values"});
  lines.push_back({"materials", "block", "", "", "name in the file: name in the table, or a block of values"});
  for (core::OptionDescription& line : lines) line.name = "meshes[]." + line.name;
  return lines;
}

}  // namespace tarmac::scenes
