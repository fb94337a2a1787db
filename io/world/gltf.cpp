// glTF 2.0 and GLB. VTK builds the primitives; what it takes on trust (offsets and counts into the buffers) is checked
// on the JSON first. Pictures, materials' looks, skins and animations do not matter to rays.
#include <fmt/format.h>
#include <vtkBase64Utilities.h>
#include <vtkGLTFDocumentLoader.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "io/world/mesh_formats.h"
#include "io/world/vtk_messages.h"

namespace tarmac::io::world {

namespace {

using Json = nlohmann::json;

constexpr int kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6;

bool is_glb(const std::filesystem::path& file) {
  return file.extension() == ".glb" || file.extension() == ".GLB";
}

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

/// A document with the binary chunk that a GLB carries.
struct Document {
  Json json;
  std::string chunk;
};

/// Header of 12 bytes, then chunks: length, type, content; JSON is the first.
Document split_glb(const std::string& bytes, const std::filesystem::path& file) {
  constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A;
  const auto fail = [&](const std::string& what) {
    throw core::InputError(fmt::format("{}: {}", file.string(), what));
  };
  if (bytes.size() < 20 || word_at(bytes, 0) != kMagic || word_at(bytes, 4) != 2) fail("is no GLB of version 2");
  if (word_at(bytes, 8) != bytes.size()) {
    fail(fmt::format("is cut short: its header says {} bytes, and it has {}", word_at(bytes, 8), bytes.size()));
  }
  const std::uint64_t json_bytes = word_at(bytes, 12);
  if (word_at(bytes, 16) != kJson || 20 + json_bytes > bytes.size()) fail("its first chunk is no JSON of its length");
  Document document;
  document.json = Json::parse(bytes.begin() + 20, bytes.begin() + 20 + static_cast<std::ptrdiff_t>(json_bytes));
  const std::uint64_t chunk_at = 28 + json_bytes;
  if (chunk_at > bytes.size()) return document;
  const std::uint64_t chunk_bytes = word_at(bytes, 20 + json_bytes);
  if (chunk_at + chunk_bytes > bytes.size()) fail("its binary chunk is cut");
  document.chunk = bytes.substr(chunk_at, chunk_bytes);
  return document;
}

/// Runs f; what the JSON library throws becomes an error of the file's.
template <class F>
auto on_json(const std::filesystem::path& file, const F& f) {
  try {
    return f();
  } catch (const Json::exception& error) {
    throw core::InputError(fmt::format("{}: is no sound glTF: {}", file.string(), error.what()));
  }
}

Document read_document(const std::filesystem::path& file) {
  const std::string bytes = core::read_file(file.string());
  return on_json(file, [&] { return is_glb(file) ? split_glb(bytes, file) : Document{Json::parse(bytes), ""}; });
}

/// Names with %20 and the like written out.
std::string unescaped(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool escape = uri[i] == '%' && i + 2 < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[i + 1])) &&
                        std::isxdigit(static_cast<unsigned char>(uri[i + 2]));
    text += escape ? static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16)) : uri[i];
    if (escape) i += 2;
  }
  return text;
}

bool is_data(const std::string& uri) {
  return uri.starts_with("data:");
}

/// What a data: URI holds. Only base64, as the standard has it.
std::string decoded(const std::string& uri, const std::filesystem::path& file) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string::npos || !uri.substr(0, comma).ends_with(";base64")) {
    throw core::InputError(fmt::format("{}: the buffer in its text is not in base64", file.string()));
  }
  const auto* letters = reinterpret_cast<const unsigned char*>(uri.data()) + comma + 1;
  const std::size_t length = uri.size() - comma - 1;
  std::string bytes(length / 4 * 3, '\0');
  bytes.resize(
      vtkBase64Utilities::DecodeSafely(letters, length, reinterpret_cast<unsigned char*>(bytes.data()), bytes.size()));
  return bytes;
}

std::filesystem::path part_of(const std::string& uri, const std::filesystem::path& file) {
  const std::filesystem::path part = file.parent_path() / unescaped(uri);
  if (std::filesystem::is_regular_file(part)) return part;
  throw core::InputError(fmt::format("{}: its buffer {} is not there", file.string(), part.string()));
}

/// VTK goes on without a buffer that it cannot load, and reads beyond the others; it also takes %20 for itself. Hence
/// buffers are loaded here: exactly the bytes promised.
std::vector<std::vector<char>> load_buffers(const Document& document, const std::filesystem::path& file) {
  std::vector<std::vector<char>> buffers;
  for (const Json& buffer : document.json.value("buffers", Json::array())) {
    const std::uint64_t promised = buffer.at("byteLength").get<std::uint64_t>();
    std::string bytes, name = "the binary chunk";
    if (!buffer.contains("uri")) {
      bytes = document.chunk;
    } else if (const std::string uri = buffer.at("uri").get<std::string>(); is_data(uri)) {
      bytes = decoded(uri, file);
      name = "the buffer in its text";
    } else {
      name = part_of(uri, file).string();
      bytes = core::read_file(name);
    }
    if (bytes.size() < promised) {
      throw core::InputError(
          fmt::format("{}: {} has {} bytes of the {} promised", file.string(), name, bytes.size(), promised));
    }
    buffers.emplace_back(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(promised));
  }
  return buffers;
}

std::uint64_t bytes_of_component(int type) {
  switch (type) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      return 0;
  }
}

/// An accessor's elements must lie in its view, and the view in its buffer.
void check_accessor(const Json& json, const std::vector<std::vector<char>>& buffers, std::size_t index, bool vector,
                    const std::filesystem::path& file) {
  const auto fail = [&](const std::string& what) {
    throw core::InputError(fmt::format("{}: accessor {}: {}", file.string(), index, what));
  };
  const Json& accessors = json.at("accessors");
  if (index >= accessors.size()) fail(fmt::format("does not exist; there are {}", accessors.size()));
  const Json& accessor = accessors[index];
  const int type = accessor.at("componentType").get<int>();
  const std::uint64_t element = bytes_of_component(type) * (vector ? 3 : 1);
  const std::uint64_t count = accessor.at("count").get<std::uint64_t>();
  if (element == 0) fail(fmt::format("component type {} is unknown", type));
  if (accessor.at("type").get<std::string>() != (vector ? "VEC3" : "SCALAR") || (vector && type != 5126)) {
    fail(vector ? "positions must be VEC3 of floats" : "indices must be SCALAR");
  }
  if (!accessor.contains("bufferView") || accessor.contains("sparse")) {
    fail("is sparse or has no bufferView, which is not supported: write the file without sparse accessors");
  }
  const auto view_index = accessor.at("bufferView").get<std::size_t>();
  const Json& views = json.at("bufferViews");
  if (view_index >= views.size()) fail(fmt::format("bufferView {} does not exist", view_index));
  const Json& view = views[view_index];
  const auto buffer = view.at("buffer").get<std::size_t>();
  if (buffer >= buffers.size()) fail(fmt::format("buffer {} does not exist", buffer));
  const std::uint64_t length = view.at("byteLength").get<std::uint64_t>();
  const std::uint64_t stride = std::max(element, view.value("byteStride", std::uint64_t{0}));
  const std::uint64_t offset = accessor.value("byteOffset", std::uint64_t{0});
  const std::uint64_t limit = std::uint64_t{1} << 40;  // far beyond any file; keeps the sums below from wrapping
  if (count > limit / stride || offset > limit || length > limit) fail("is absurdly large");
  if (count > 0 && offset + stride * (count - 1) + element > length) {
    fail(fmt::format("{} elements do not fit the {} bytes of its view", count, length));
  }
  const std::uint64_t view_offset = view.value("byteOffset", std::uint64_t{0}), held = buffers[buffer].size();
  if (view_offset > held || view_offset + length > held) {
    fail(fmt::format("its view ends beyond the {} bytes of buffer {}", held, buffer));
  }
  // VTK keeps offsets and lengths in an int, and takes one that does not fit for none.
  if (view_offset + length > std::numeric_limits<std::int32_t>::max()) fail("lies beyond 2 GB of its buffer");
}

void check_primitive(const Json& json, const Json& primitive, const std::vector<std::vector<char>>& buffers,
                     const std::filesystem::path& file) {
  const Json& attributes = primitive.at("attributes");
  if (!attributes.contains("POSITION")) {
    throw core::InputError(fmt::format("{}: a primitive has no POSITION", file.string()));
  }
  check_accessor(json, buffers, attributes.at("POSITION").get<std::size_t>(), true, file);
  if (primitive.contains("indices")) {
    check_accessor(json, buffers, primitive.at("indices").get<std::size_t>(), false, file);
  }
  const std::size_t materials = json.value("materials", Json::array()).size();
  if (primitive.contains("material") && primitive.at("material").get<std::size_t>() >= materials) {
    throw core::InputError(fmt::format("{}: a primitive is of material {}, and there are {}", file.string(),
                                       primitive.at("material").dump(), materials));
  }
}

/// Nodes must form trees: VTK follows children without looking back.
void check_nodes(const Json& json, const std::filesystem::path& file) {
  const Json nodes = json.value("nodes", Json::array());
  std::vector<int> parents(nodes.size(), 0);
  const auto fail = [&](const std::string& what) {
    throw core::InputError(fmt::format("{}: {}", file.string(), what));
  };
  for (const Json& node : nodes) {
    if (node.contains("mesh") && node.at("mesh").get<std::size_t>() >= json.value("meshes", Json::array()).size()) {
      fail(fmt::format("a node shows mesh {}, which does not exist", node.at("mesh").dump()));
    }
    for (const Json& child : node.value("children", Json::array())) {
      const auto index = child.get<std::size_t>();
      if (index >= nodes.size()) fail(fmt::format("node {} does not exist", index));
      if (++parents[index] > 1) fail(fmt::format("node {} has two parents", index));
    }
  }
  std::size_t reached = 0;
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < parents.size(); ++i) {
    if (parents[i] == 0) open.push_back(i);
  }
  while (!open.empty()) {
    const std::size_t node = open.back();
    open.pop_back();
    ++reached;
    for (const Json& child : nodes[node].value("children", Json::array())) open.push_back(child.get<std::size_t>());
  }
  if (reached != nodes.size()) fail("its nodes run in a circle");
}

/// Roots of the scene that is shown: the default one, else the first; without scenes, all nodes that have no parent.
std::vector<std::size_t> roots_of(const Json& json, const std::filesystem::path& file) {
  const Json scenes = json.value("scenes", Json::array());
  const std::size_t nodes = json.value("nodes", Json::array()).size();
  const auto chosen = json.value("scene", std::size_t{0});
  if (json.contains("scene") && chosen >= scenes.size()) {
    throw core::InputError(fmt::format("{}: scene {} does not exist", file.string(), chosen));
  }
  if (scenes.empty()) throw core::InputError(fmt::format("{}: holds no scene, hence shows nothing", file.string()));
  auto roots = scenes[chosen].value("nodes", std::vector<std::size_t>());
  for (const std::size_t root : roots) {
    if (root >= nodes) throw core::InputError(fmt::format("{}: node {} does not exist", file.string(), root));
  }
  return roots;
}

/// The document, and the buffers' bytes, after everything that VTK takes on trust was found to be sound.
Json checked_json(const std::filesystem::path& file, std::vector<std::vector<char>>& buffers) {
  Document document = read_document(file);
  on_json(file, [&] {
    buffers = load_buffers(document, file);
    for (const Json& mesh : document.json.value("meshes", Json::array())) {
      for (const Json& primitive : mesh.at("primitives")) check_primitive(document.json, primitive, buffers, file);
    }
    check_nodes(document.json, file);
    roots_of(document.json, file);
  });
  return std::move(document.json);
}

void move_to_world(scenes::MeshFile& mesh, std::size_t first, vtkMatrix4x4* T_root_node) {
  if (T_root_node == nullptr) return;
  for (std::size_t i = first; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3f& p = mesh.vertices[i];
    const double in[4] = {p.x(), p.y(), p.z(), 1};
    double out[4];
    T_root_node->MultiplyPoint(in, out);
    mesh.vertices[i] = Eigen::Vector3d(out[0], out[1], out[2]).cast<float>();
  }
}

/// A mirrored node turns its triangles inside out.
void keep_outward(scenes::MeshFile& mesh, std::size_t first, vtkMatrix4x4* T_root_node) {
  if (T_root_node == nullptr || T_root_node->Determinant() >= 0) return;
  for (std::size_t t = first; t < mesh.triangles.size(); ++t) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
}

std::uint16_t name_index(scenes::MeshFile& mesh, const std::string& name) {
  const auto found = std::find(mesh.names.begin(), mesh.names.end(), name);
  if (found == mesh.names.end()) mesh.names.push_back(name);
  return static_cast<std::uint16_t>(found - mesh.names.begin());
}

void append_node(vtkGLTFDocumentLoader::Model& model, const Json& json, std::size_t index,
                 const std::filesystem::path& file, scenes::MeshFile& mesh) {
  const vtkGLTFDocumentLoader::Node& node = model.Nodes.at(index);
  if (node.Mesh >= 0) {
    for (const auto& primitive : model.Meshes.at(static_cast<std::size_t>(node.Mesh)).Primitives) {
      const bool surface =
          primitive.Mode == kTriangles || primitive.Mode == kTriangleStrip || primitive.Mode == kTriangleFan;
      if (!surface || primitive.Geometry == nullptr) continue;
      const std::size_t first_vertex = mesh.vertices.size(), first_triangle = mesh.triangles.size();
      append_triangles(*primitive.Geometry, file, mesh, nullptr);
      move_to_world(mesh, first_vertex, node.GlobalTransform);
      keep_outward(mesh, first_triangle, node.GlobalTransform);
      std::string name;
      if (primitive.Material >= 0) {
        name = json.at("materials")[static_cast<std::size_t>(primitive.Material)].value("name", "");
      }
      mesh.name_of_triangle.resize(mesh.triangles.size(), name_index(mesh, name));
    }
  }
  for (const int child : node.Children) append_node(model, json, static_cast<std::size_t>(child), file, mesh);
}

}  // namespace

std::vector<std::filesystem::path> gltf_parts(const std::filesystem::path& file) {
  const Document document = read_document(file);
  std::vector<std::filesystem::path> parts{file};
  on_json(file, [&] {
    for (const Json& buffer : document.json.value("buffers", Json::array())) {
      const std::string uri = buffer.value("uri", "");
      if (!uri.empty() && !is_data(uri)) parts.push_back(part_of(uri, file));
    }
  });
  return parts;
}

namespace {

/// Pictures, skins and animations are of no use to rays, and a missing one must not stop the geometry; what else
/// vertices carry has not been checked.
void keep_positions_alone(vtkGLTFDocumentLoader::Model& model) {
  model.Images.clear();
  model.Textures.clear();
  model.Skins.clear();
  model.Animations.clear();
  for (auto& node : model.Nodes) node.Skin = -1;
  for (auto& mesh : model.Meshes) {
    for (auto& primitive : mesh.Primitives) {
      primitive.Targets.clear();
      std::erase_if(primitive.AttributeIndices, [](const auto& entry) { return entry.first != "POSITION"; });
    }
  }
}

}  // namespace

scenes::MeshFile read_gltf(const std::filesystem::path& file) {
  std::vector<std::vector<char>> buffers;
  const Json json = checked_json(file, buffers);
  vtkNew<vtkGLTFDocumentLoader> loader;
  const VtkMessages messages;
  bool built = loader->LoadModelMetaDataFromFile(file.string());
  if (built) {
    vtkGLTFDocumentLoader::Model& model = *loader->GetInternalModel();
    keep_positions_alone(model);
    model.Buffers = std::move(buffers);
    model.BufferMetaData = "[]";  // none left to load
    built = loader->LoadModelData({}) && loader->BuildModelVTKGeometry();
  }
  if (!built) {
    throw core::InputError(fmt::format("{}: cannot be read: {}", file.string(), messages.first()));
  }
  loader->BuildGlobalTransforms();
  scenes::MeshFile mesh;
  mesh.y_is_up = true;
  for (const std::size_t root : roots_of(json, file)) append_node(*loader->GetInternalModel(), json, root, file, mesh);
  if (mesh.names.size() == 1 && mesh.names.front().empty()) {
    mesh.names.clear();
    mesh.name_of_triangle.clear();
  }
  return mesh;
}

}  // namespace tarmac::io::world
