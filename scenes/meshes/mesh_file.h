/// What a user's mesh file holds, and the hook through which a program lends scenes/ its readers: VTK, which does the
/// reading, is no dependency of this library (io/world/mesh_readers.h installs them).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tarmac::scenes {

/// Triangles as the file has them: its units, its axes, its order. Polygons are cut into triangles.
struct MeshFile {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into `vertices`, within range
  std::vector<std::string> names;                       ///< of materials, as the file calls them; "" = none named
  std::vector<std::uint16_t> name_of_triangle;          ///< index into `names`, one a triangle; empty: nothing is named
  bool y_is_up = false;                                 ///< what the format's standard says (glTF); else z
};

struct MeshReader {
  /// Throws core::InputError whose message begins with the file's path and, where there are lines, the line.
  MeshFile (*read)(const std::filesystem::path& file);
  /// The file and those it refers to that hold geometry (glTF's buffers). Throws core::InputError.
  std::vector<std::filesystem::path> (*parts)(const std::filesystem::path& file);
};

/// `reader` lives as long as the program. Not for use while scenes are being made.
void install_mesh_reader(const MeshReader& reader);
/// nullptr: this program has installed none.
const MeshReader* installed_mesh_reader();

}  // namespace tarmac::scenes
