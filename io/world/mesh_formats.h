/// One function a format; mesh_readers.h chooses among them. What is checked before VTK sees a file is what VTK takes
/// on trust: sizes that a header promises, indices, numbers.
#pragma once

#include <filesystem>
#include <vector>

#include "scenes/meshes/mesh_file.h"

class vtkPolyData;

namespace tarmac::io::world {

scenes::MeshFile read_obj(const std::filesystem::path& file);
scenes::MeshFile read_ply(const std::filesystem::path& file);
scenes::MeshFile read_stl(const std::filesystem::path& file);
scenes::MeshFile read_gltf(const std::filesystem::path& file);
/// Throws core::InputError for a file that is no JSON, and for buffers that are not there.
std::vector<std::filesystem::path> gltf_parts(const std::filesystem::path& file);

/// Appends polygons (cut into triangles) and strips. The names of triangles are the caller's business: `cell_of` gets
/// the polygon that each triangle came from, unless it is nullptr. Throws core::InputError for an index out of range.
void append_triangles(vtkPolyData& data, const std::filesystem::path& file, scenes::MeshFile& mesh,
                      std::vector<int>* cell_of);

}  // namespace tarmac::io::world
