/// Reads users' mesh files: OBJ, PLY, STL, glTF and GLB. VTK stays behind this header.
#pragma once

#include <filesystem>
#include <vector>

#include "scenes/meshes/mesh_file.h"

namespace tarmac::io::world {

/// Lends scenes/ these readers: a program that makes scenes calls it first thing.
void install_mesh_readers();

/// By the file's extension. Throws core::InputError with the file (and the line, in text that has lines) when it cannot
/// be read, is cut short, or has an index out of range. Coordinates that are not finite are left for the caller to
/// judge, except in OBJ, where the line is known here.
scenes::MeshFile read_mesh(const std::filesystem::path& file);

/// The file itself, and the buffers that a glTF refers to.
std::vector<std::filesystem::path> mesh_parts(const std::filesystem::path& file);

}  // namespace tarmac::io::world
