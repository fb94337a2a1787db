// OBJ: text; v, f, usemtl and g are what counts here. VTK's reader takes numbers and indices on trust, so a pass over
// the lines comes first, which also knows their numbers.
#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "core/error.h"
#include "core/files.h"
#include "io/world/mesh_formats.h"
#include "io/world/vtk_messages.h"

namespace tarmac::io::world {

namespace {

/// Words of a line, one after the other; "" at its end.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}
  std::string_view next() {
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (!rest_.empty() && blank(rest_.front())) rest_.remove_prefix(1);
    std::size_t size = 0;
    while (size < rest_.size() && !blank(rest_[size])) ++size;
    const std::string_view word = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return word;
  }
  /// What is left, without blanks at either end.
  std::string_view rest() {
    const std::size_t first = rest_.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return rest_.substr(first, rest_.find_last_not_of(" \t\r") - first + 1);
  }

 private:
  std::string_view rest_;
};

template <class Number>
bool parse(std::string_view word, Number& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

/// Vertices count from 1, or from the last one backwards.
void check_face(Words words, std::int64_t vertices, const std::filesystem::path& file, std::size_t line) {
  int corners = 0;
  for (std::string_view word = words.next(); !word.empty(); word = words.next(), ++corners) {
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
  }
  if (corners < 3) {
    throw core::InputError(fmt::format("{}:{}: a face with {} corners; it needs 3", file.string(), line, corners));
  }
}

void check_vertex(Words words, const std::filesystem::path& file, std::size_t line, std::int64_t number) {
  for (int k = 0; k < 3; ++k) {
    const std::string_view word = words.next();
    double value = 0;
    if (parse(word, value) && std::isfinite(value)) continue;
    throw core::InputError(fmt::format("{}:{}: vertex {} (counted from 1) has '{}' for {}: a finite number is expected",
                                       file.string(), line, number, word, "xyz"[k]));
  }
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

/// Names as `usemtl` says them; one a face, in their order. VTK cuts a name at its first blank.
struct Names {
  std::vector<std::string> names;
  std::vector<std::uint16_t> of_face;
};

Names check_and_name(const std::filesystem::path& file) {
  const std::string text = core::read_file(file.string());
  std::int64_t vertices = 0;
  Names names;
  std::string current;
  std::size_t current_index = 0;
  bool known = false;
  for_each_line(text, [&](Words words, std::string_view first, std::size_t line) {
    if (first == "v") {
      check_vertex(words, file, line, ++vertices);
    } else if (first == "usemtl") {
      current = std::string(words.rest());
      known = false;
    } else if (first == "f") {
      check_face(words, vertices, file, line);
      if (!known) {
        const auto found = std::find(names.names.begin(), names.names.end(), current);
        current_index = static_cast<std::size_t>(found - names.names.begin());
        if (found == names.names.end()) names.names.push_back(current);
        if (names.names.size() > 65535) {
          throw core::InputError(fmt::format("{}:{}: more than 65535 materials", file.string(), line));
        }
        known = true;
      }
      names.of_face.push_back(static_cast<std::uint16_t>(current_index));
    }
  });
  return names;
}

}  // namespace

void check_obj(const std::filesystem::path& file) {
  check_and_name(file);
}

scenes::MeshFile read_obj(const std::filesystem::path& file) {
  const Names names = check_and_name(file);
  vtkNew<vtkOBJReader> reader;
  const VtkMessages messages;
  reader->SetFileName(file.c_str());
  reader->Update();
  if (const std::string said = messages.first(); !said.empty()) {
    throw core::InputError(fmt::format("{}: cannot be read: {}", file.string(), said));
  }
  vtkPolyData* const data = reader->GetOutput();
  scenes::MeshFile mesh;
  std::vector<int> cell_of;
  append_triangles(*data, file, mesh, &cell_of);
  const auto faces = static_cast<std::size_t>(data->GetNumberOfPolys());
  if (faces != names.of_face.size()) {
    throw core::InputError(fmt::format("{}: {} faces are written there and {} were read; is a line broken?",
                                       file.string(), names.of_face.size(), faces));
  }
  if (names.names.size() == 1 && names.names.front().empty()) return mesh;
  mesh.names = names.names;
  const int first_face = static_cast<int>(data->GetNumberOfVerts() + data->GetNumberOfLines());
  for (const int cell : cell_of) {
    mesh.name_of_triangle.push_back(names.of_face[static_cast<std::size_t>(cell - first_face)]);
  }
  return mesh;
}

}  // namespace tarmac::io::world
