// Five million triangles: how long they take to load and what memory that needs.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <iostream>
#include <memory>

#include "io/world/mesh_readers.h"
#include "scenes/registry.h"
#include "sim/raycast/tracer.h"
#include "tests/io/world/mesh_writers.h"
#include "tests/support/temporary_folder.h"

namespace tarmac {
namespace {

constexpr int kColumns = 2500, kRows = 1000;  ///< two triangles a cell
constexpr double kLimit_s = 10, kLimit_gb = 4;

/// Rolling ground in cells of 0.1 m.
float height(int i, int j) {
  return 0.5f * std::sin(0.01f * static_cast<float>(i)) * std::cos(0.013f * static_cast<float>(j));
}
Eigen::Vector3f corner(int i, int j) {
  return {0.1f * static_cast<float>(i), 0.1f * static_cast<float>(j), height(i, j)};
}

void write_ply(const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  out << "ply\nformat binary_little_endian 1.0\nelement vertex " << (kColumns + 1) * (kRows + 1)
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << 2 * kColumns * kRows
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  std::string bytes;
  for (int j = 0; j <= kRows; ++j) {
    for (int i = 0; i <= kColumns; ++i) {
      for (const float v : corner(i, j)) tests::put(bytes, v);
    }
  }
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      const int a = j * (kColumns + 1) + i, b = a + 1, c = b + kColumns + 1, d = c - 1;
      for (const auto& [p, q, r] : {std::array{a, b, c}, {a, c, d}}) {
        bytes += '\3';
        for (const int v : {p, q, r}) tests::put(bytes, static_cast<std::int32_t>(v));
      }
    }
  }
  out << bytes;
}

void write_stl(const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  std::string bytes(80, ' ');
  tests::put(bytes, static_cast<std::uint32_t>(2 * kColumns * kRows));
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      const auto a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1), d = corner(i, j + 1);
      for (const auto& facet : {std::array{a, b, c}, {a, c, d}}) {
        bytes.append(12, '\0');
        for (const auto& p : facet) {
          for (const float v : p) tests::put(bytes, v);
        }
        bytes.append(2, '\0');
      }
    }
    out << bytes;
    bytes.clear();
  }
}

/// Of this process, since it began [GB].
double peak_gb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024 / 1e9;
}

void load_and_measure(const std::filesystem::path& folder, const std::string& name) {
  io::world::install_mesh_readers();
  const auto node = core::ConfigNode::parse("kind: bare\nmeshes: [{file: " + name + ", material: concrete_wall}]\n",
                                            (folder / "scenario.yaml").string());
  const auto wall = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  const auto scene = std::make_shared<const scenes::Scene>(scenes::make_scene(node, 1));
  const double cpu_s = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
  const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
  std::cout << name << ": " << scene->triangle_count() << " triangles, " << wall_s << " s (" << cpu_s
            << " s of computing), peak " << peak_gb() << " GB\n";
  EXPECT_EQ(scene->triangle_count(), 2u * kColumns * kRows);
  EXPECT_LT(cpu_s, kLimit_s) << "computing time: others may be using this machine";
  EXPECT_LT(peak_gb(), kLimit_gb);

  // Apart from loading: what tracing rays through it needs first.
  const auto built = std::chrono::steady_clock::now();
  const std::clock_t built_cpu = std::clock();
  const sim::raycast::Tracer tracer(scene, {.threads = 2, .fast = false});
  std::cout << name << ": hierarchy for rays in "
            << std::chrono::duration<double>(std::chrono::steady_clock::now() - built).count() << " s ("
            << static_cast<double>(std::clock() - built_cpu) / CLOCKS_PER_SEC << " s of computing), peak " << peak_gb()
            << " GB\n";
}

TEST(LargeMesh, FiveMillionTrianglesOfABinaryPlyLoadInTenSecondsAndFourGigabytes) {
  const tests::TemporaryFolder folder;
  write_ply(folder / "large.ply");
  load_and_measure(folder.path(), "large.ply");
}

TEST(LargeMesh, FiveMillionTrianglesOfABinaryStlLoadInTenSecondsAndFourGigabytes) {
  const tests::TemporaryFolder folder;
  write_stl(folder / "large.stl");
  load_and_measure(folder.path(), "large.stl");
}

}  // namespace
}  // namespace tarmac
