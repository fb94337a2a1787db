#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iostream>
#include <map>
#include <numeric>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "scenes/materials/materials.h"
#include "tests/scenes/support.h"

namespace tarmac::scenes {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;
using tests::default_stand;
using tests::scene_node;

/// Every byte that a sensor could see, as text.
std::string fingerprint(const Scene& scene) {
  std::string bytes;
  const auto add = [&bytes](const auto* data, std::size_t count) {
    bytes.append(reinterpret_cast<const char*>(data), count * sizeof(*data));
  };
  for (const Mesh& mesh : scene.meshes) {
    add(mesh.vertices.data(), mesh.vertices.size());
    add(mesh.triangles.data(), mesh.triangles.size());
    add(mesh.materials.data(), mesh.materials.size());
  }
  for (const Instance& i : scene.instances) {
    add(&i.mesh, 1);
    add(i.T_parent_mesh.matrix().data(), 16);
  }
  for (int k = 0; k < 100; ++k) {
    const double h = scene.relief->height_m(0.31 * k - 15, 7.5 * k - 105);  // also across joints
    add(&h, 1);
  }
  for (const Actor& actor : scene.actors) {
    for (const double t : {0.0, 10.0, 40.0}) add(actor.motion->T_world_actor(core::time_from_s(t)).matrix().data(), 16);
  }
  return core::hash_hex(bytes);
}

TEST(Stand, HasThreeHundredThousandTrianglesAndMoreAndSaysSo) {
  const Scene& scene = default_stand();
  std::size_t counted = 0;
  for (const Instance& instance : scene.instances) counted += scene.meshes[instance.mesh].triangles.size();
  std::cout << "triangles after instancing: " << scene.triangle_count() << ", instances: " << scene.instances.size()
            << "\n";
  EXPECT_EQ(scene.triangle_count(), counted);
  EXPECT_GE(scene.triangle_count(), 300000u);
}

TEST(Stand, EveryTriangleIsFiniteNotDegenerateAndOfAKnownMaterial) {
  const Scene& scene = default_stand();
  for (const Mesh& mesh : scene.meshes) {
    ASSERT_EQ(mesh.materials.size(), mesh.triangles.size()) << mesh.name;
    double smallest = 1e9;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      ASSERT_LT(mesh.materials[t], scene.materials.size());
      Vector3d p[3];
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_LT(mesh.triangles[t][k], mesh.vertices.size());
        p[k] = mesh.vertices[mesh.triangles[t][k]].cast<double>();
        ASSERT_TRUE(p[k].allFinite()) << mesh.name;
      }
      smallest = std::min(smallest, 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm());
    }
    EXPECT_GT(smallest, 2e-7) << mesh.name << " [m^2]";
  }
}

TEST(Stand, InstancesReferToMeshesAndActorsAndHaveALabel) {
  const Scene& scene = default_stand();
  std::set<Label> labels;
  std::set<std::uint32_t> used;
  for (const Instance& i : scene.instances) {
    ASSERT_LT(i.mesh, scene.meshes.size());
    ASSERT_LT(i.actor, static_cast<int>(scene.actors.size()));
    EXPECT_NE(i.label, Label::none);
    EXPECT_TRUE(core::se3::all_finite(i.T_parent_mesh));
    labels.insert(i.label);
    used.insert(i.mesh);
  }
  EXPECT_EQ(used.size(), scene.meshes.size()) << "a mesh that nothing shows";
  for (const Label label : {Label::pavement, Label::marking, Label::building, Label::glass, Label::jet_bridge,
                            Label::aircraft, Label::mast, Label::ground_equipment, Label::cone, Label::vehicle}) {
    EXPECT_TRUE(labels.contains(label)) << name_of(label);
  }
}

/// Triangles grouped by the vertices that they share: the primitives a mesh was built from.
std::vector<std::vector<std::size_t>> parts_of(const Mesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    parent[root(b)] = root(a);
    parent[root(c)] = root(a);
  }
  std::map<std::uint32_t, std::vector<std::size_t>> parts;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) parts[root(mesh.triangles[t][0])].push_back(t);
  std::vector<std::vector<std::size_t>> list;
  for (auto& [vertex, triangles] : parts) list.push_back(std::move(triangles));
  return list;
}

/// Each edge run once in each direction.
bool is_closed(const Mesh& mesh, const std::vector<std::size_t>& part) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const std::size_t t : part) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!edges.emplace(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]).second) return false;
    }
  }
  return std::all_of(edges.begin(), edges.end(), [&](const auto& e) { return edges.contains({e.second, e.first}); });
}

double volume_m3(const Mesh& mesh, const std::vector<std::size_t>& part) {
  const Vector3d origin = mesh.vertices[mesh.triangles[part[0]][0]].cast<double>();
  double sum = 0;
  for (const std::size_t t : part) {
    const auto corner = [&](std::size_t k) -> Vector3d {
      return mesh.vertices[mesh.triangles[t][k]].cast<double>() - origin;
    };
    sum += corner(0).dot(corner(1).cross(corner(2))) / 6;
  }
  return sum;
}

TEST(Stand, SolidsAreClosedAndFaceOutwardAndOnlyGroundAndPanesAreOpen) {
  const Scene& scene = default_stand();
  std::size_t closed = 0, open = 0;
  std::set<std::uint32_t> ground_meshes;
  for (const Instance& i : scene.instances) {
    if (tests::on_the_ground(i.label)) ground_meshes.insert(i.mesh);
  }
  for (std::uint32_t m = 0; m < scene.meshes.size(); ++m) {
    if (ground_meshes.contains(m)) continue;
    const Mesh& mesh = scene.meshes[m];
    for (const auto& part : parts_of(mesh)) {
      if (is_closed(mesh, part)) {
        ++closed;
        EXPECT_GT(volume_m3(mesh, part), 0) << mesh.name;
      } else {
        ++open;
        EXPECT_GT(scene.materials[mesh.materials[part[0]]].transmission, 0)
            << mesh.name << " has an open part that is no pane";
      }
    }
  }
  EXPECT_GT(closed, 1000u);
  EXPECT_GT(open, 200u);
}

TEST(Stand, GroundFacesUpAndTheFacadesGlassFacesTheApron) {
  const Scene& scene = default_stand();
  tests::for_each_static_triangle(
      scene, [](const Instance& i) { return tests::on_the_ground(i.label) || i.label == Label::glass; },
      [&](const Instance& i, const tests::Triangle& t) {
        const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
        if (i.label == Label::glass) {
          ASSERT_LT(normal.y(), -0.99);
        } else {
          ASSERT_GT(normal.z(), 0.5) << "a joint's strip may be steep, never upside down";
        }
      });
}

TEST(Stand, TheSameSeedGivesTheSameBytesAndAnotherSeedOthers) {
  const std::string first = fingerprint(default_stand());
  EXPECT_EQ(first, fingerprint(make_scene(scene_node(), 1)));
  EXPECT_NE(first, fingerprint(make_scene(scene_node(), 2)));
}

TEST(Stand, EveryOptionChangesTheScene) {
  const std::string plain = fingerprint(default_stand());
  const std::map<std::string, std::string> other{{"slab_size_m", "10"},
                                                 {"crossfall_percent", "0.5"},
                                                 {"undulation_mm", "0"},
                                                 {"slab_tilt_mm", "0"},
                                                 {"relief_rms_mm", "1"},
                                                 {"joint_depth_mm", "1"},
                                                 {"apron_south_m", "-200"},
                                                 {"with_surroundings", "false"},
                                                 {"with_aircraft", "false"},
                                                 {"with_equipment", "false"},
                                                 {"cones", "3"},
                                                 {"carts", "2"},
                                                 {"with_tug", "false"},
                                                 {"tug_speed_m_s", "5"},
                                                 {"tug_start_s", "12"}};
  for (const core::OptionDescription& option : scene_of(scene_node()).describe()) {
    ASSERT_TRUE(other.contains(option.name)) << option.name << " is not tested";
    EXPECT_NE(plain, fingerprint(make_scene(scene_node(option.name + ": " + other.at(option.name) + "\n"), 1)))
        << option.name;
  }
}

TEST(Stand, EntryGivesTheSameGroundAsTheScene) {
  const auto ground = make_ground(scene_node(), 1);
  for (const double x : {-50.0, 0.0, 31.7}) {
    EXPECT_EQ(ground->height_m(x, -12), default_stand().ground->height_m(x, -12));
  }
}

TEST(Stand, ResolvedOptionsReadBackAsTheSameScene) {
  const core::ConfigNode node = scene_node("carts: 3\nslab_tilt_mm: 1\n");
  const core::ConfigNode again = core::ConfigNode::parse("scene:\n" + resolve_scene(node), "resolved.yaml");
  EXPECT_EQ(fingerprint(make_scene(node, 4)), fingerprint(make_scene(again.child("scene"), 4)));
}

std::string message_of(const std::string& yaml) {
  try {
    make_scene(core::ConfigNode::parse(yaml, "scenario.yaml"), 1);
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Stand, AnUnknownOptionIsAnErrorWithItsLineAndASuggestion) {
  const std::string message = message_of("kind: stand\nslab_sise_m: 5\n");
  EXPECT_THAT(message, HasSubstr("scenario.yaml:2"));
  EXPECT_THAT(message, HasSubstr("slab_size_m"));
  EXPECT_THAT(message_of("kind: stand\ncarts: 40\n"), HasSubstr("carts"));
}

TEST(Registry, AnUnknownSceneIsAnErrorThatListsTheKnownOnes) {
  const std::string message = message_of("kind: stnad\n");
  EXPECT_THAT(message, HasSubstr("stnad"));
  EXPECT_THAT(message, HasSubstr("did you mean stand"));
  EXPECT_NE(message_of("carts: 1\n"), "no error") << "no kind";
}

}  // namespace
}  // namespace tarmac::scenes
