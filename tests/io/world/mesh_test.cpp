// Users' own meshes: what a file says is what the scene holds, and what is wrong is said with file and line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "io/world/mesh_readers.h"
#include "scenes/materials/materials.h"
#include "scenes/registry.h"
#include "tests/io/world/mesh_writers.h"
#include "tests/support/temporary_folder.h"

namespace tarmac {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using testing::HasSubstr;
using tests::tetrahedron;

/// Triangles in the world as sorted triples of corners: what is the same whatever the order in the file.
using Corners = std::vector<std::array<Vector3d, 3>>;

bool before(const Vector3d& a, const Vector3d& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

Corners corners_of(const scenes::Scene& scene) {
  Corners all;
  for (const scenes::Instance& instance : scene.instances) {
    const scenes::Mesh& mesh = scene.meshes[instance.mesh];
    for (const auto& t : mesh.triangles) {
      std::array<Vector3d, 3> corner;
      for (std::size_t k = 0; k < 3; ++k) corner[k] = instance.T_parent_mesh * mesh.vertices[t[k]].cast<double>();
      std::rotate(corner.begin(), std::min_element(corner.begin(), corner.end(), before),
                  corner.end());  // winding stays
      all.push_back(corner);
    }
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), before);
  });
  return all;
}

void expect_same(const Corners& a, const Corners& b, double tolerance_m = 1e-6) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t t = 0; t < a.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_LE((a[t][k] - b[t][k]).norm(), tolerance_m) << t << " " << k;
  }
}

class OwnMesh : public testing::Test {
 protected:
  void SetUp() override { io::world::install_mesh_readers(); }
  fs::path write(const std::string& name, const std::string& bytes) {
    tests::write_bytes(folder_ / name, bytes);
    return folder_ / name;
  }
  /// The scene of a scenario in the folder whose only entry is `entry`.
  core::ConfigNode scene_node(const std::string& entry) const {
    const std::string text = "name: x\nscene:\n  kind: bare\n  meshes:\n    - " + entry + "\n";
    return core::ConfigNode::parse(text, (folder_ / "scenario.yaml").string()).child("scene");
  }
  scenes::Scene load(const std::string& entry) const { return scenes::make_scene(scene_node(entry), 1); }
  std::string message_of(const std::string& entry) const {
    try {
      load(entry);
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "no error";
  }
  tests::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

TEST_F(OwnMesh, EveryFormatGivesTheSameTriangles) {
  const tests::PlainMesh m = tetrahedron();
  write("a.obj", tests::obj_text(m));
  write("text.ply", tests::ply_text(m));
  write("little.ply", tests::ply_binary(m));
  write("big.ply", tests::ply_binary(m, true));
  write("text.stl", tests::stl_text(m));
  write("binary.STL", tests::stl_binary(m));
  write("named.stl", tests::stl_binary(m, "solid binary all the same"));
  write("embedded.gltf", tests::gltf_embedded(m));
  write("with%20buffer.gltf", tests::gltf_json(m, "the%20buffer.bin"));
  write("the buffer.bin", tests::gltf_buffer(m));
  write("one.glb", tests::glb(m));
  Corners expected;
  for (const auto& [a, b, c] : m.triangles) {
    std::array<Vector3d, 3> t{m.vertices[a].cast<double>(), m.vertices[b].cast<double>(), m.vertices[c].cast<double>()};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end(), before), t.end());
    expected.push_back(t);
  }
  std::sort(expected.begin(), expected.end(), [](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), before);
  });
  for (const char* file : {"a.obj", "text.ply", "little.ply", "big.ply", "text.stl", "binary.STL", "named.stl",
                           "embedded.gltf", "with%20buffer.gltf", "one.glb"}) {
    SCOPED_TRACE(file);
    expect_same(corners_of(load(std::string("{file: ") + file + ", material: brick, up: z}")), expected);
  }
}

TEST_F(OwnMesh, PlaceScaleLabelAndMaterialAreWhatTheScenarioSays) {
  write("a.obj", tests::obj_text(tetrahedron()));
  const scenes::Scene scene = load(
      "{file: a.obj, scale: 0.001, label: building, material: concrete_wall,\n"
      "       T_world_mesh: {xyz_m: [10, 20, 30], rpy_deg: [0, 0, 90]}}");
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.instances[0].label, scenes::Label::building);
  EXPECT_EQ(scene.materials[scene.meshes[0].materials[0]].name, "concrete_wall");
  // The corner (3, 0, 0), in millimetres and turned to the left.
  const Vector3d p = scene.instances[0].T_parent_mesh * scene.meshes[0].vertices[1].cast<double>();
  EXPECT_LT((p - Vector3d(10, 20.003, 30)).norm(), 1e-9);
}

TEST_F(OwnMesh, GltfStandsUprightAndItsNodesMoveAndMirrorItsMeshes) {
  const tests::PlainMesh m = tetrahedron();
  write("moved.gltf", tests::gltf_embedded(m, "\"translation\": [1, 2, 3], \"scale\": [-1, 1, 1], "));
  const scenes::Scene scene = load("{file: moved.gltf, material: brick}");
  tests::PlainMesh expected = m;
  for (Eigen::Vector3f& v : expected.vertices) {
    const Eigen::Vector3f moved(1 - v.x(), 2 + v.y(), 3 + v.z());
    v = {moved.x(), -moved.z(), moved.y()};  // y up becomes z up
  }
  for (auto& t : expected.triangles) std::swap(t[1], t[2]);  // mirrored: outside stays outside
  write("expected.obj", tests::obj_text(expected));
  expect_same(corners_of(scene), corners_of(load("{file: expected.obj, material: brick}")), 1e-5);
}

TEST_F(OwnMesh, PolygonsNegativeIndicesAndNamesOfMaterialsInAnObj) {
  write("house.obj",
        "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nv 0 0 2\nv 4 0 2\nvt 0 0\nvn 0 0 1\n"
        "usemtl floor tiles\nf 1 2 3 4\n"
        "usemtl concrete_wall\nf -6/1 -5/1 -1/1 -2/1\n"
        "usemtl pane\nf 1//1 5//1 4//1\n");
  const scenes::Scene scene =
      load("{file: house.obj, materials: {floor tiles: floor_vinyl, pane: {diffuse: 0.01, transmission: 0.9}}}");
  const scenes::Mesh& mesh = scene.meshes[0];
  ASSERT_EQ(mesh.triangles.size(), 5u);
  std::map<std::string, double> area;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vector3d p = mesh.vertices[a].cast<double>(), u = mesh.vertices[b].cast<double>() - p,
                   v = mesh.vertices[c].cast<double>() - p;
    area[scene.materials[mesh.materials[t]].name] += 0.5 * u.cross(v).norm();
  }
  EXPECT_NEAR(area["floor_vinyl"], 12, 1e-6);
  EXPECT_NEAR(area["concrete_wall"], 8, 1e-6) << "a name of the table needs no entry";
  EXPECT_NEAR(area["house.obj:pane"], 3, 1e-6);
  EXPECT_EQ(scene.materials.back().transmission, 0.9);
}

TEST_F(OwnMesh, TrianglesWithoutAnAreaAreLeftOut) {
  tests::PlainMesh m = tetrahedron();
  m.triangles.push_back({0, 0, 1});
  m.triangles.push_back({2, 1, 2});
  write("a.ply", tests::ply_binary(m));
  EXPECT_EQ(load("{file: a.ply, material: brick}").meshes[0].triangles.size(), 4u);
}

TEST_F(OwnMesh, ComesAfterWhateverKindItStandsUnder) {
  write("a.obj", tests::obj_text(tetrahedron()));
  const auto node = [&](const std::string& meshes) {
    return core::ConfigNode::parse("kind: corridor\n" + meshes, (folder_ / "scenario.yaml").string());
  };
  const scenes::Scene plain = scenes::make_scene(node(""), 1);
  const scenes::Scene with = scenes::make_scene(node("meshes: [{file: a.obj, material: brick}]\n"), 1);
  ASSERT_EQ(with.instances.size(), plain.instances.size() + 1);
  EXPECT_EQ(with.instances.back().mesh, plain.meshes.size());
}

TEST_F(OwnMesh, ResolvedScenarioMakesTheSameSceneFromAnywhere) {
  write("a.obj", tests::obj_text(tetrahedron(), "usemtl skin\n"));
  const core::ConfigNode node =
      scene_node("{file: a.obj, scale: 2, label: vehicle, materials: {skin: {diffuse: 0.25, color: [1, 0, 0]}}}");
  const auto again = core::ConfigNode::parse("scene:\n" + scenes::resolve_scene(node), "/elsewhere/resolved.yaml");
  const scenes::Scene first = scenes::make_scene(node, 1), second = scenes::make_scene(again.child("scene"), 1);
  expect_same(corners_of(first), corners_of(second), 0);
  EXPECT_EQ(second.instances[0].label, scenes::Label::vehicle);
  EXPECT_EQ(second.materials.back().diffuse, 0.25);
  EXPECT_EQ(scenes::resolve_scene(again.child("scene")), scenes::resolve_scene(node));
}

TEST_F(OwnMesh, AFileThatHasChangedSinceIsRefused) {
  write("a.gltf", tests::gltf_json(tetrahedron(), "a.bin"));
  write("a.bin", tests::gltf_buffer(tetrahedron()));
  const std::string resolved = scenes::resolve_scene(scene_node("{file: a.gltf, material: brick}"));
  const auto again = core::ConfigNode::parse("scene:\n" + resolved, "resolved.yaml").child("scene");
  EXPECT_NO_THROW(scenes::make_scene(again, 1));
  tests::PlainMesh other = tetrahedron();
  other.vertices[3].z() = 1.5f;
  write("a.bin", tests::gltf_buffer(other));
  try {
    scenes::make_scene(again, 1);
    ADD_FAILURE() << "the buffer belongs to the mesh";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("resolved.yaml:"));
    EXPECT_THAT(error.what(), HasSubstr("a.gltf has changed"));
  }
}

/// A mesh file that is wrong in one way, and what the message must say of it.
struct Malformed {
  std::string name, bytes;
  std::vector<std::string> says;
  std::string more = "material: brick";
};

std::string with(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

std::string with_byte(std::string text, std::size_t at, unsigned char byte) {
  text.at(at) = static_cast<char>(byte);
  return text;
}

tests::PlainMesh changed(std::size_t vertex, float x) {
  tests::PlainMesh m = tetrahedron();
  m.vertices[vertex].x() = x;
  return m;
}

tests::PlainMesh out_of_range() {
  tests::PlainMesh m = tetrahedron();
  m.triangles[2][1] = 9;
  return m;
}

tests::PlainMesh flat() {
  tests::PlainMesh m = tetrahedron();
  m.triangles = {{{0, 0, 1}}, {{1, 1, 2}}};
  return m;
}

tests::PlainMesh scaled(float factor) {
  tests::PlainMesh m = tetrahedron();
  for (auto& v : m.vertices) v *= factor;
  return m;
}

std::vector<Malformed> malformed() {
  const tests::PlainMesh m = tetrahedron();
  const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
  const std::string ply = tests::ply_binary(m), stl = tests::stl_binary(m), gltf = tests::gltf_embedded(m);
  return {
      {"mesh.xyz", "1 2 3\n", {"'.xyz' is none of them", ".gltf"}},
      {"empty.obj", "", {"is empty"}},
      {"points.obj", "v 0 0 0\nv 1 0 0\n", {"holds no triangles"}},
      {"nan.obj", tests::obj_text(changed(2, nan)), {"nan.obj:4: vertex 3", "nan"}},
      {"word.obj", "v 0 0 0\nv 1 0 zero\n", {"word.obj:2: vertex 2", "'zero'", "for z"}},
      {"short.obj", "v 0 0 0\nv 1 0\n", {"short.obj:2", "for z"}},
      {"range.obj", tests::obj_text(out_of_range()), {"range.obj:8", "vertex 10", "4 stand above"}},
      {"back.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -4\n", {"back.obj:4", "vertex -4"}},
      {"zero.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", {"zero.obj:4", "vertex 0"}},
      {"two.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n", {"two.obj:3", "2 corners"}},
      {"corner.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 c\n", {"corner.obj:4", "'c'"}},
      {"flat.obj", tests::obj_text(flat()), {"none of its 2 triangles has an area"}},
      {"unnamed.obj",
       with(tests::obj_text(m), "f 1 2 4\n", "usemtl skin\nf 1 2 4\n"),
       {"1 of 4 triangles", "without a material's name"},
       "materials: {skin: brick}"},
      {"unknown.obj", tests::obj_text(m, "usemtl skin\n"), {"does not hold 'skin'", "4 triangles"}, "label: building"},
      {"typo.obj",
       tests::obj_text(m, "usemtl skin\n"),
       {"scenario.yaml", "names no material 'skim'", "did you mean 'skin'"},
       "materials: {skim: brick}"},
      {"material.obj", tests::obj_text(m), {"there is no material 'brik'", "did you mean 'brick'"}, "material: brik"},
      {"value.obj", tests::obj_text(m), {"diffuse", "2 must be"}, "material: {diffuse: 2}"},
      {"none.ply", ply, {"material: is missing", "names no materials"}, "label: building"},
      {"nan.ply", tests::ply_binary(changed(3, nan)), {"vertex 3 (counted from 0)", "nan"}},
      {"inf.stl", tests::stl_binary(changed(0, inf)), {"vertex 0 (counted from 0)", "inf"}},
      {"range.ply", tests::ply_binary(out_of_range()), {"face 2", "vertex 9", "there are 4"}},
      {"text.ply", tests::ply_text(out_of_range()), {"face 2", "vertex 9"}},
      {"cut.ply", ply.substr(0, ply.size() - 9), {"is cut short", "'face'"}},
      {"cut_text.ply", tests::ply_text(m).substr(0, tests::ply_text(m).size() - 20), {"cut_text.ply"}},
      {"half_line.ply", with(tests::ply_text(m), "3 1 2 3\n", "3 1\n"), {"half_line.ply:16", "for vertex_indices"}},
      {"word.ply", with(tests::ply_text(m), "3 1 2 3\n", "3 1 two 3\n"), {"word.ply:16", "'two'"}},
      {"two.ply", with(tests::ply_text(m), "3 1 2 3\n", "2 1 2\n"), {"two.ply:16", "2 corners"}},
      {"many.ply", with(tests::ply_text(m), "3 1 2 3\n", "-3 1 2 3\n"), {"many.ply:16", "-3 entries"}},
      {"long_list.ply", with_byte(ply, ply.size() - 13, 200), {"face 3", "is cut short, or a list's length is wrong"}},
      {"below_zero.ply",
       with_byte(with(ply, "list uchar", "list char"), ply.size() - 1 - 13, 0xFD),
       {"face 3", "corners"}},
      {"other_list.ply", with(ply, "vertex_indices", "vertex_indizes"), {"faces have no list 'vertex_indices'"}},
      {"list_x.ply", with(ply, "property float x", "property list uchar float x"), {"no property 'x'"}},
      {"real_list.ply", with(ply, "list uchar int", "list float int"), {"real_list.ply:8", "needs a type"}},
      {"huge.ply", with(ply, "element vertex 4", "element vertex 99999999999"), {"is cut short", "'vertex'"}},
      {"faceless.ply", tests::ply_text({m.vertices, {}}), {"holds no triangles"}},
      {"magic.ply", "not a ply\n", {"magic.ply:1", "begins with the word ply"}},
      {"endless.ply", "ply\nformat ascii 1.0\n", {"has no end"}},
      {"type.ply", with(ply, "property float y", "property flaot y"), {"type.ply:5", "needs a type"}},
      {"noz.ply", with(ply, "property float z", "property float w"), {"no property 'z'"}},
      {"cut.stl", stl.substr(0, stl.size() - 10), {"promises 4 triangles", "284 bytes", "it has 274"}},
      {"no.stl", tests::stl_binary({m.vertices, {}}), {"holds no triangles"}},
      {"text.stl", "hello\n", {"neither a text STL"}},
      {"bad_text.stl", with(tests::stl_text(m), "vertex", "vertx"), {"bad_text.stl"}},
      {"km.obj", tests::obj_text(scaled(1e5f)), {"spans", "scale 1", "0.001 for millimetres"}},
      {"dust.obj", tests::obj_text(scaled(1e-4f)), {"less than a millimetre"}},
      {"json.gltf", "{\"asset\": ", {"no sound glTF"}},
      {"letters.gltf", with(gltf, "base64,AAAA", "base64,*AAA"), {"the buffer in its text has", "96 promised"}},
      {"plain.gltf", with(gltf, ";base64", ""), {"not in base64"}},
      {"buffer.gltf", tests::gltf_json(m, "gone.bin"), {"gone.bin is not there"}},
      {"view.gltf", with(gltf, "\"byteLength\": 48}", "\"byteLength\": 40}"), {"accessor 0", "do not fit"}},
      {"count.gltf", with(gltf, "\"count\": 12", "\"count\": 13"), {"accessor 1", "do not fit"}},
      {"offset.gltf", with(gltf, "\"byteOffset\": 48", "\"byteOffset\": 60"), {"ends beyond"}},
      {"sparse.gltf", with(gltf, "\"count\": 4", "\"sparse\": {}, \"count\": 4"), {"accessor 0", "sparse"}},
      {"range.gltf", tests::gltf_embedded(out_of_range()), {"vertex 9", "there are 4"}},
      {"nan.gltf", tests::gltf_embedded(changed(1, nan)), {"vertex 1 (counted from 0)"}},
      {"material.gltf", with(gltf, "\"material\": 0", "\"material\": 3"), {"material 3", "there are 1"}},
      {"circle.gltf", with(gltf, "\"mesh\": 0}]", "\"mesh\": 0, \"children\": [0]}]"), {"circle"}},
      {"lines.gltf", with(gltf, "\"indices\": 1", "\"mode\": 1, \"indices\": 1"), {"holds no triangles"}},
      {"cut.glb", tests::glb(m).substr(0, 300), {"is cut short"}},
  };
}

class MalformedMesh : public OwnMesh, public testing::WithParamInterface<Malformed> {};

TEST_P(MalformedMesh, IsRefusedWithFileAndLine) {
  const Malformed& bad = GetParam();
  write(bad.name, bad.bytes);
  const std::string message = message_of("{file: " + bad.name + ", " + bad.more + "}");
  EXPECT_THAT(message, HasSubstr("scenario.yaml:5")) << "the scenario's line";
  if (bad.more.find("brik") == std::string::npos && bad.more.find("diffuse") == std::string::npos) {
    EXPECT_THAT(message, HasSubstr(bad.name)) << "the mesh file";
  }
  for (const std::string& text : bad.says) EXPECT_THAT(message, HasSubstr(text));
}

std::string name_of_case(const testing::TestParamInfo<Malformed>& bad) {
  std::string name = bad.param.name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '.' || c == '%'; }, '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(All, MalformedMesh, testing::ValuesIn(malformed()), name_of_case);

TEST_F(OwnMesh, WrongEntriesAreRefusedWithTheirLine) {
  write("a.obj", tests::obj_text(tetrahedron()));
  EXPECT_THAT(
      message_of("{file: b.obj}"),
      HasSubstr("scenario.yaml:5: scene.meshes.0.file: " + (folder_ / "b.obj").string() + ": there is no such file"));
  EXPECT_THAT(message_of("{file: .}"), HasSubstr("is no file"));
  EXPECT_THAT(message_of("{material: brick}"), HasSubstr("file: is missing"));
  EXPECT_THAT(message_of("{file: a.obj, material: brick, scale: 0}"), HasSubstr("scale: 0 must be above 0"));
  EXPECT_THAT(message_of("{file: a.obj, material: brick, scale: -2}"), HasSubstr("scale: -2 must be above 0"));
  EXPECT_THAT(message_of("{file: a.obj, material: brick, label: bilding}"), HasSubstr("did you mean 'building'"));
  EXPECT_THAT(message_of("{file: a.obj, material: brick, colour: red}"), HasSubstr("colour"));
  EXPECT_THAT(message_of("{file: a.obj, material: brick, T_world_mesh: {xyz_m: [1e6, 0, 0], rpy_deg: [0, 0, 0]}}"),
              HasSubstr("beyond 20000 m"));
  EXPECT_THAT(message_of("a.obj"), HasSubstr("must be a block"));
}

TEST_F(OwnMesh, WhatIsWrongWithTheListIsFoundBeforeAnythingIsBuilt) {
  EXPECT_THROW(scenes::resolve_scene(scene_node("{file: gone.obj}")), core::InputError);
  write("a.obj", tests::obj_text(tetrahedron()));
  EXPECT_THROW(scenes::resolve_scene(scene_node("{file: a.obj, material: brik}")), core::InputError);
}

}  // namespace
}  // namespace tarmac
