// OBJ: text; v, f and usemtl are what counts here. VTK's reader drops faces whose corners carry textures or normals
// where others do not, and cuts names of materials at a blank, so the lines are read here; VTK cuts the polygons.
#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/files.h"
#include "io/world/mesh_formats.h"
#include "io/world/text_words.h"
#include "io/world/vtk_messages.h"

namespace tarmac::io::world {

namespace {

/// What the lines hold; faces refer to vertices above them alone.
struct Content {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> faces;
  std::vector<std::string> names;           ///< as `usemtl` says them; "" before the first
  std::vector<std::uint16_t> name_of_face;  ///< index into names, in the faces' order
};

/// Vertices count from 1, or from the last one backwards.
void add_face(Words words, Content& content, const std::filesystem::path& file, std::size_t line) {
  const std::int64_t vertices = content.points->GetNumberOfPoints();
  std::vector<vtkIdType> corners;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    std::int64_t index = 0;
    if (!parse(word.substr(0, word.find('/')), index)) {
      throw core::InputError(
          fmt::format("{}:{}: '{}' is no corner of a face such as 7, 7/1 or 7//2", file.string(), line, word));
    }
    const std::int64_t counted = index < 0 ? vertices + index + 1 : index;
    if (counted < 1 || counted > vertices) {
      throw core::InputError(fmt::format("{}:{}: a face refers to vertex {}, and {} stand above it", file.string(),
                                         line, index, vertices));
    }
    corners.push_back(counted - 1);
  }
  if (corners.size() < 3) {
    throw core::InputError(
        fmt::format("{}:{}: a face with {} corners; it needs 3", file.string(), line, corners.size()));
  }
  content.faces->InsertNextCell(static_cast<vtkIdType>(corners.size()), corners.data());
}

void add_vertex(Words words, Content& content, const std::filesystem::path& file, std::size_t line) {
  double p[3];
  for (int k = 0; k < 3; ++k) {
    const std::string_view word = words.next();
    if (parse(word, p[k]) && std::isfinite(p[k])) continue;
    throw core::InputError(fmt::format("{}:{}: vertex {} (counted from 1) has '{}' for {}: a finite number is expected",
                                       file.string(), line, content.points->GetNumberOfPoints() + 1, word, "xyz"[k]));
  }
  content.points->InsertNextPoint(p);
}

std::uint16_t index_of(const std::string& name, Content& content, const std::filesystem::path& file, std::size_t line) {
  const auto found = std::find(content.names.begin(), content.names.end(), name);
  const auto index = static_cast<std::size_t>(found - content.names.begin());
  if (found == content.names.end()) content.names.push_back(name);
  if (content.names.size() > 65535) {
    throw core::InputError(fmt::format("{}:{}: more than 65535 materials", file.string(), line));
  }
  return static_cast<std::uint16_t>(index);
}

/// Calls f(words after the first, first word, line number) for each line.
template <class F>
void for_each_line(const std::string& text, const F& f) {
  std::size_t line = 1;
  for (std::size_t at = 0; at < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    Words words(std::string_view(text).substr(at, end - at));
    const std::string_view first = words.next();
    if (!first.empty()) f(words, first, line);
    at = end + 1;
  }
}

void read_lines(const std::filesystem::path& file, Content& content) {
  const std::string text = core::read_file(file.string());
  std::string current;
  std::uint16_t index = 0;
  bool known = false;  // a name counts when a face has it
  for_each_line(text, [&](Words words, std::string_view first, std::size_t line) {
    if (first == "v") {
      add_vertex(words, content, file, line);
    } else if (first == "usemtl") {
      current = std::string(words.rest());
      known = false;
    } else if (first == "f") {
      add_face(words, content, file, line);
      if (!known) index = index_of(current, content, file, line);
      known = true;
      content.name_of_face.push_back(index);
    }
  });
}

}  // namespace

scenes::MeshFile read_obj(const std::filesystem::path& file) {
  Content content;
  read_lines(file, content);
  const VtkMessages messages;  // what the cutting into triangles has to say does not belong on the terminal
  vtkNew<vtkPolyData> data;
  data->SetPoints(content.points);
  data->SetPolys(content.faces);
  scenes::MeshFile mesh;
  std::vector<int> cell_of;
  append_triangles(*data, file, mesh, &cell_of);
  if (content.names.empty() || (content.names.size() == 1 && content.names.front().empty())) return mesh;
  mesh.names = content.names;
  for (const int cell : cell_of) mesh.name_of_triangle.push_back(content.name_of_face[static_cast<std::size_t>(cell)]);
  return mesh;
}

}  // namespace tarmac::io::world
