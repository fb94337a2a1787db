// PLY and STL: what their headers promise is checked against the file's size before VTK allocates by it.
#include <fmt/format.h>
#include <vtkNew.h>
#include <vtkPLYReader.h>
#include <vtkPolyData.h>
#include <vtkSTLReader.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>

#include "core/error.h"
#include "io/world/mesh_formats.h"
#include "io/world/vtk_messages.h"

namespace tarmac::io::world {

namespace {

std::size_t size_of_type(const std::string& type) {
  static const std::map<std::string, std::size_t> sizes{{"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},
                                                        {"short", 2}, {"ushort", 2},  {"int16", 2},  {"uint16", 2},
                                                        {"int", 4},   {"uint", 4},    {"int32", 4},  {"uint32", 4},
                                                        {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  const auto found = sizes.find(type);
  return found == sizes.end() ? 0 : found->second;
}

/// An element of a PLY's header: its count, and the fewest bytes that one takes in a binary file.
struct Element {
  std::string name;
  std::uint64_t count = 0, bytes = 0;
  std::vector<std::string> properties;
};

struct PlyHeader {
  bool binary = false;
  std::uint64_t size = 0;  ///< bytes up to the data
  std::vector<Element> elements;
};

[[noreturn]] void fail_ply(const std::filesystem::path& file, std::size_t line, const std::string& message) {
  throw core::InputError(fmt::format("{}:{}: {}", file.string(), line, message));
}

void read_property(std::istringstream& words, PlyHeader& header, const std::filesystem::path& file, std::size_t line) {
  if (header.elements.empty()) fail_ply(file, line, "a property before any element");
  std::string type, name;
  words >> type;
  const bool list = type == "list";
  std::string items;
  if (list) words >> type >> items;
  words >> name;
  if (size_of_type(type) == 0 || (list && size_of_type(items) == 0) || name.empty()) {
    fail_ply(file, line, "a property needs a type such as float or `list uchar int`, and a name");
  }
  Element& element = header.elements.back();
  element.properties.push_back(name);
  // The shortest list that makes a face has three entries.
  element.bytes += size_of_type(type) + (list && element.name == "face" ? 3 * size_of_type(items) : 0);
}

PlyHeader read_ply_header(const std::filesystem::path& file) {
  constexpr std::size_t kLongest = 4096;
  std::ifstream in(file, std::ios::binary);
  PlyHeader header;
  std::string text;
  for (std::size_t line = 1; line <= kLongest && std::getline(in, text); ++line) {
    std::istringstream words(text);
    std::string first;
    words >> first;
    if (line == 1 && first != "ply") fail_ply(file, line, "a PLY begins with the word ply");
    if (first == "format") {
      std::string kind;
      words >> kind;
      if (kind != "ascii" && kind != "binary_little_endian" && kind != "binary_big_endian") {
        fail_ply(file, line, fmt::format("'{}' is no format of PLY", kind));
      }
      header.binary = kind != "ascii";
    } else if (first == "element") {
      Element element;
      words >> element.name >> element.count;
      if (words.fail()) fail_ply(file, line, "an element needs a name and a count");
      header.elements.push_back(element);
    } else if (first == "property") {
      read_property(words, header, file, line);
    } else if (first == "end_header") {
      header.size = static_cast<std::uint64_t>(in.tellg());
      return header;
    }
  }
  throw core::InputError(fmt::format("{}: the header has no end (end_header)", file.string()));
}

const Element& element_of(const PlyHeader& header, const char* name, const std::filesystem::path& file) {
  for (const Element& element : header.elements) {
    if (element.name == name) return element;
  }
  throw core::InputError(
      fmt::format("{}: there is no element '{}' in the header: this is no mesh", file.string(), name));
}

}  // namespace

std::size_t check_ply(const std::filesystem::path& file) {
  const PlyHeader header = read_ply_header(file);
  const Element& vertex = element_of(header, "vertex", file);
  for (const char* axis : {"x", "y", "z"}) {
    if (std::find(vertex.properties.begin(), vertex.properties.end(), axis) == vertex.properties.end()) {
      throw core::InputError(fmt::format("{}: vertices have no property '{}'", file.string(), axis));
    }
  }
  const Element& face = element_of(header, "face", file);
  if (face.count == 0) throw core::InputError(fmt::format("{}: holds no triangles (element face 0)", file.string()));
  std::uint64_t left = std::filesystem::file_size(file) - header.size;
  for (const Element& element : header.elements) {
    // In text, a number takes two bytes at least: a digit and a blank.
    const std::uint64_t least = header.binary ? element.bytes : 2 * element.properties.size();
    if (least == 0) continue;
    if (element.count > left / least) {
      throw core::InputError(
          fmt::format("{}: is cut short: its header promises {} elements '{}' of at least {} bytes each, and {} bytes "
                      "are left for them",
                      file.string(), element.count, element.name, least, left));
    }
    left -= element.count * least;
  }
  return face.count;
}

scenes::MeshFile read_ply(const std::filesystem::path& file) {
  const std::size_t faces = check_ply(file);
  scenes::MeshFile mesh;
  vtkNew<vtkPLYReader> reader;
  const VtkMessages messages;
  reader->SetFileName(file.c_str());
  reader->SetDuplicatePointsForFaceTexture(false);
  reader->Update();
  if (const std::string said = messages.first(); !said.empty()) {
    throw core::InputError(fmt::format("{}: cannot be read, or is cut short: {}", file.string(), said));
  }
  vtkPolyData* const data = reader->GetOutput();
  if (static_cast<std::size_t>(data->GetNumberOfPolys()) != faces) {
    throw core::InputError(fmt::format("{}: the header promises {} faces and {} were read", file.string(), faces,
                                       data->GetNumberOfPolys()));
  }
  append_triangles(*data, file, mesh, nullptr);
  return mesh;
}

namespace {

constexpr std::uint64_t kStlHeader = 84, kStlFacet = 50;

/// A binary STL may begin with "solid" too; its size tells.
void check_stl(const std::filesystem::path& file) {
  const std::uint64_t size = std::filesystem::file_size(file);
  std::ifstream in(file, std::ios::binary);
  char head[kStlHeader] = {};
  in.read(head, kStlHeader);
  std::uint32_t facets = 0;
  std::memcpy(&facets, head + 80, 4);
  const bool whole = size >= kStlHeader && size == kStlHeader + kStlFacet * facets;
  if (whole && facets == 0) throw core::InputError(fmt::format("{}: holds no triangles", file.string()));
  if (whole || std::strncmp(head, "solid", 5) == 0) return;
  throw core::InputError(
      fmt::format("{}: is neither a text STL (it does not begin with 'solid') nor a whole binary one: its header "
                  "promises {} triangles, which is a file of {} bytes, and it has {}",
                  file.string(), facets, kStlHeader + kStlFacet * facets, size));
}

}  // namespace

scenes::MeshFile read_stl(const std::filesystem::path& file) {
  check_stl(file);
  scenes::MeshFile mesh;
  vtkNew<vtkSTLReader> reader;
  const VtkMessages messages;
  reader->SetFileName(file.c_str());
  reader->MergingOff();  // rays do not care, and merging five million triangles takes longer than all the rest
  reader->Update();
  if (const std::string said = messages.first(); !said.empty()) {
    throw core::InputError(fmt::format("{}: cannot be read: {}", file.string(), said));
  }
  append_triangles(*reader->GetOutput(), file, mesh, nullptr);
  return mesh;
}

}  // namespace tarmac::io::world
