#include "io/world/mesh_readers.h"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTriangleFilter.h>

#include <algorithm>
#include <cctype>
#include <limits>

#include "core/error.h"
#include "io/world/mesh_formats.h"

namespace tarmac::io::world {

namespace {

struct Format {
  const char* extension;
  scenes::MeshFile (*read)(const std::filesystem::path&);
};

constexpr Format kFormats[] = {
    {".obj", read_obj}, {".ply", read_ply}, {".stl", read_stl}, {".gltf", read_gltf}, {".glb", read_gltf}};

std::string extension_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

const Format& format_of(const std::filesystem::path& file) {
  const std::string extension = extension_of(file);
  for (const Format& format : kFormats) {
    if (extension == format.extension) return format;
  }
  throw core::InputError(fmt::format("{}: meshes are read from .obj, .ply, .stl, .gltf and .glb; '{}' is none of them",
                                     file.string(), extension));
}

void check_indices(vtkCellArray& cells, vtkIdType points, const std::filesystem::path& file) {
  const auto cell = vtk::TakeSmartPointer(cells.NewIterator());
  for (cell->GoToFirstCell(); !cell->IsDoneWithTraversal(); cell->GoToNextCell()) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cell->GetCurrentCell(count, ids);
    for (vtkIdType k = 0; k < count; ++k) {
      if (ids[k] >= 0 && ids[k] < points) continue;
      throw core::InputError(fmt::format("{}: face {} (counted from 0) refers to vertex {}, and there are {}",
                                         file.string(), cell->GetCurrentCellId(), ids[k], points));
    }
  }
}

/// With an array that says which cell of `data` each triangle was.
vtkSmartPointer<vtkPolyData> cut_into_triangles(vtkPolyData& data) {
  vtkNew<vtkPolyData> numbered;
  numbered->SetPoints(data.GetPoints());
  numbered->SetPolys(data.GetPolys());
  numbered->SetStrips(data.GetStrips());
  vtkNew<vtkIntArray> cell;
  cell->SetName("cell");
  const vtkIdType skipped = data.GetNumberOfVerts() + data.GetNumberOfLines();
  for (vtkIdType k = 0; k < numbered->GetNumberOfCells(); ++k) cell->InsertNextValue(static_cast<int>(k + skipped));
  numbered->GetCellData()->AddArray(cell);
  vtkNew<vtkTriangleFilter> filter;
  filter->SetInputData(numbered);
  filter->PassVertsOff();
  filter->PassLinesOff();
  filter->Update();
  return filter->GetOutput();
}

}  // namespace

void append_triangles(vtkPolyData& data, const std::filesystem::path& file, scenes::MeshFile& mesh,
                      std::vector<int>* cell_of) {
  const vtkIdType points = data.GetNumberOfPoints();
  const std::size_t first = mesh.vertices.size();
  if (first + static_cast<std::size_t>(points) > std::numeric_limits<std::uint32_t>::max()) {
    throw core::InputError(fmt::format("{}: has more than 2^32 vertices", file.string()));
  }
  check_indices(*data.GetPolys(), points, file);
  check_indices(*data.GetStrips(), points, file);
  vtkSmartPointer<vtkPolyData> triangles = &data;
  const bool whole = data.GetStrips()->GetNumberOfCells() == 0 && data.GetPolys()->IsHomogeneous() == 3;
  if (!whole) triangles = cut_into_triangles(data);
  mesh.vertices.reserve(first + static_cast<std::size_t>(points));
  for (vtkIdType i = 0; i < points; ++i) {
    const double* const p = triangles->GetPoint(i);
    mesh.vertices.emplace_back(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
  }
  vtkDataArray* const cells = whole ? nullptr : triangles->GetCellData()->GetArray("cell");
  mesh.triangles.reserve(mesh.triangles.size() + static_cast<std::size_t>(triangles->GetNumberOfPolys()));
  const auto cell = vtk::TakeSmartPointer(triangles->GetPolys()->NewIterator());
  for (cell->GoToFirstCell(); !cell->IsDoneWithTraversal(); cell->GoToNextCell()) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cell->GetCurrentCell(count, ids);
    const auto corner = [&](int k) { return static_cast<std::uint32_t>(first + static_cast<std::size_t>(ids[k])); };
    mesh.triangles.push_back({corner(0), corner(1), corner(2)});
    if (cell_of == nullptr) continue;
    const vtkIdType id = cell->GetCurrentCellId();
    const vtkIdType skipped = data.GetNumberOfVerts() + data.GetNumberOfLines();
    cell_of->push_back(
        static_cast<int>(cells == nullptr ? id + skipped : static_cast<vtkIdType>(cells->GetTuple1(id))));
  }
}

scenes::MeshFile read_mesh(const std::filesystem::path& file) {
  const Format& format = format_of(file);
  if (!std::filesystem::is_regular_file(file)) {
    throw core::InputError(fmt::format("{}: there is no such file", file.string()));
  }
  if (std::filesystem::file_size(file) == 0) throw core::InputError(fmt::format("{}: is empty", file.string()));
  return format.read(file);
}

std::vector<std::filesystem::path> mesh_parts(const std::filesystem::path& file) {
  const Format& format = format_of(file);
  return format.read == read_gltf ? gltf_parts(file) : std::vector{file};
}

void install_mesh_readers() {
  static const scenes::MeshReader reader{.read = read_mesh, .parts = mesh_parts};
  scenes::install_mesh_reader(reader);
}

}  // namespace tarmac::io::world
