/// A small solid written in every format that is read, and binary writers for large ones.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace tarmac::tests {

struct PlainMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Four unlike corners: no symmetry hides a swapped axis.
inline PlainMesh tetrahedron() {
  return {{{0, 0, 0}, {3, 0, 0}, {0, 2, 0}, {0.5f, 0.25f, 1}}, {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{2, 0, 3}}}};
}

template <class T>
void put(std::string& bytes, T value, bool big_endian = false) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big_endian) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

inline void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

inline std::string obj_text(const PlainMesh& m, const std::string& before_faces = "") {
  std::string text = "# a comment\n";
  for (const auto& v : m.vertices) {
    text += "v " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z()) + "\n";
  }
  text += before_faces;
  for (const auto& [a, b, c] : m.triangles) {
    text += "f " + std::to_string(a + 1) + " " + std::to_string(b + 1) + " " + std::to_string(c + 1) + "\n";
  }
  return text;
}

inline std::string ply_header(const PlainMesh& m, const std::string& format) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(m.vertices.size()) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(m.triangles.size()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

inline std::string ply_text(const PlainMesh& m) {
  std::string text = ply_header(m, "ascii");
  for (const auto& v : m.vertices) {
    text += std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z()) + "\n";
  }
  for (const auto& [a, b, c] : m.triangles) {
    text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
  }
  return text;
}

inline std::string ply_binary(const PlainMesh& m, bool big_endian = false) {
  std::string bytes = ply_header(m, big_endian ? "binary_big_endian" : "binary_little_endian");
  for (const auto& v : m.vertices) {
    for (int k = 0; k < 3; ++k) put(bytes, v[k], big_endian);
  }
  for (const auto& t : m.triangles) {
    bytes += '\3';
    for (const std::uint32_t i : t) put(bytes, static_cast<std::int32_t>(i), big_endian);
  }
  return bytes;
}

inline std::string stl_text(const PlainMesh& m) {
  std::string text = "solid thing\n";
  for (const auto& t : m.triangles) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (const std::uint32_t i : t) {
      const auto& v = m.vertices[i];
      text += "   vertex " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z()) + "\n";
    }
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid thing\n";
}

inline std::string stl_binary(const PlainMesh& m, const std::string& title = "binary") {
  std::string bytes = title;
  bytes.resize(80, ' ');
  put(bytes, static_cast<std::uint32_t>(m.triangles.size()));
  for (const auto& t : m.triangles) {
    for (int k = 0; k < 3; ++k) put(bytes, 0.0f);
    for (const std::uint32_t i : t) {
      for (int k = 0; k < 3; ++k) put(bytes, m.vertices[i][k]);
    }
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}

inline std::string base64(const std::string& bytes) {
  constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (int k = 0; k < 4; ++k) text += letters[word >> (18 - 6 * k) & 63];
    if (i + 1 >= bytes.size()) text[text.size() - 2] = '=';
    if (i + 2 >= bytes.size()) text[text.size() - 1] = '=';
  }
  return text;
}

/// Positions, then indices.
inline std::string gltf_buffer(const PlainMesh& m) {
  std::string bytes;
  for (const auto& v : m.vertices) {
    for (int k = 0; k < 3; ++k) put(bytes, v[k]);
  }
  for (const auto& t : m.triangles) {
    for (const std::uint32_t i : t) put(bytes, i);
  }
  return bytes;
}

/// One node with the given properties ("\"translation\": [1, 2, 3],"), one mesh of one material.
inline std::string gltf_json(const PlainMesh& m, const std::string& uri, const std::string& node = "",
                             const std::string& material = "skin") {
  const std::size_t points = 12 * m.vertices.size(), indices = 12 * m.triangles.size();
  Eigen::Vector3f low = m.vertices.front(), high = low;
  for (const auto& v : m.vertices) {
    if (!v.allFinite()) continue;
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  const auto vector = [](const Eigen::Vector3f& v) {
    return "[" + std::to_string(v.x()) + "," + std::to_string(v.y()) + "," + std::to_string(v.z()) + "]";
  };
  const auto text = [](std::size_t n) { return std::to_string(n); };
  return "{\"asset\": {\"version\": \"2.0\"}, \"scene\": 0, \"scenes\": [{\"nodes\": [0]}],\n"
         "\"nodes\": [{" +
         node +
         "\"mesh\": 0}],\n"
         "\"materials\": [{\"name\": \"" +
         material +
         "\"}],\n"
         "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}, \"indices\": 1, \"material\": 0}]}],\n"
         "\"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": " +
         text(m.vertices.size()) + ", \"type\": \"VEC3\", \"min\": " + vector(low) + ", \"max\": " + vector(high) +
         "},\n"
         "{\"bufferView\": 1, \"componentType\": 5125, \"count\": " +
         text(3 * m.triangles.size()) +
         ", \"type\": \"SCALAR\"}],\n"
         "\"bufferViews\": [{\"buffer\": 0, \"byteOffset\": 0, \"byteLength\": " +
         text(points) + "}, {\"buffer\": 0, \"byteOffset\": " + text(points) + ", \"byteLength\": " + text(indices) +
         "}],\n"
         "\"buffers\": [{" +
         (uri.empty() ? "" : "\"uri\": \"" + uri + "\", ") + "\"byteLength\": " + text(points + indices) + "}]}\n";
}

inline std::string gltf_embedded(const PlainMesh& m, const std::string& node = "",
                                 const std::string& material = "skin") {
  return gltf_json(m, "data:application/octet-stream;base64," + base64(gltf_buffer(m)), node, material);
}

inline std::string glb(const PlainMesh& m) {
  std::string json = gltf_json(m, "");
  while (json.size() % 4 != 0) json += ' ';
  std::string chunk = gltf_buffer(m);
  while (chunk.size() % 4 != 0) chunk += '\0';
  std::string bytes = "glTF";
  put(bytes, std::uint32_t{2});
  put(bytes, static_cast<std::uint32_t>(28 + json.size() + chunk.size()));
  put(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  put(bytes, static_cast<std::uint32_t>(chunk.size()));
  bytes += std::string("BIN\0", 4) + chunk;
  return bytes;
}

}  // namespace tarmac::tests
