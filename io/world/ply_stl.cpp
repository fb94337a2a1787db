// PLY and STL: what their headers promise is checked against the file's size before VTK allocates by it.
#include <fmt/format.h>
#include <vtkNew.h>
#include <vtkPLYReader.h>
#include <vtkPolyData.h>
#include <vtkSTLReader.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "io/world/mesh_formats.h"
#include "io/world/text_words.h"
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

/// One number, or a list of them behind their number.
struct Property {
  std::string name;
  bool list = false, count_has_sign = false;
  std::size_t count_bytes = 0, bytes = 0;  ///< of a list's number, and of one value, in a binary file
};

/// An element of a PLY's header: its count, and the fewest bytes that one takes in a binary file.
struct Element {
  std::string name;
  std::uint64_t count = 0, bytes = 0;
  std::vector<Property> properties;
};

/// What VTK takes for the corners of a face.
bool is_corners(const Element& element, const Property& property) {
  return element.name == "face" && property.list &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

struct PlyHeader {
  bool binary = false, big_endian = false;
  std::uint64_t size = 0;  ///< bytes up to the data
  std::size_t lines = 0;   ///< likewise
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
  const bool counts = !type.starts_with("float") && type != "double";
  if (size_of_type(type) == 0 || (list && (size_of_type(items) == 0 || !counts)) || name.empty()) {
    fail_ply(file, line, "a property needs a type such as float or `list uchar int`, and a name");
  }
  Element& element = header.elements.back();
  element.properties.push_back({name, list, !type.starts_with('u'), list ? size_of_type(type) : 0,
                                list ? size_of_type(items) : size_of_type(type)});
  // The shortest list that makes a face has three entries.
  element.bytes += size_of_type(type) + (is_corners(element, element.properties.back()) ? 3 * size_of_type(items) : 0);
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
      header.big_endian = kind == "binary_big_endian";
    } else if (first == "element") {
      Element element;
      words >> element.name >> element.count;
      if (words.fail()) fail_ply(file, line, "an element needs a name and a count");
      header.elements.push_back(element);
    } else if (first == "property") {
      read_property(words, header, file, line);
    } else if (first == "end_header") {
      header.size = in.eof() ? std::filesystem::file_size(file) : static_cast<std::uint64_t>(in.tellg());
      header.lines = line;
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

void check_properties(const PlyHeader& header, const std::filesystem::path& file) {
  const Element& vertex = element_of(header, "vertex", file);
  for (const char* axis : {"x", "y", "z"}) {
    const auto is_axis = [&](const Property& p) { return p.name == axis && !p.list; };
    if (std::none_of(vertex.properties.begin(), vertex.properties.end(), is_axis)) {
      throw core::InputError(fmt::format("{}: vertices have no property '{}'", file.string(), axis));
    }
  }
  const Element& face = element_of(header, "face", file);
  if (std::none_of(face.properties.begin(), face.properties.end(),
                   [&](const auto& p) { return is_corners(face, p); })) {
    throw core::InputError(
        fmt::format("{}: faces have no list 'vertex_indices' (or 'vertex_index') in the header", file.string()));
  }
  if (face.count == 0) throw core::InputError(fmt::format("{}: holds no triangles (element face 0)", file.string()));
}

void check_size(const PlyHeader& header, const std::filesystem::path& file) {
  std::uint64_t left = std::filesystem::file_size(file) - header.size;
  for (const Element& element : header.elements) {
    // In text, a number takes two bytes at least: a digit and a blank.
    const std::uint64_t least = header.binary ? element.bytes : 2 * element.properties.size();
    if (least == 0) continue;
    // The last line may end without a line's end.
    if (element.count > (left + (header.binary ? 0 : 1)) / least) {
      throw core::InputError(
          fmt::format("{}: is cut short: its header promises {} elements '{}' of at least {} bytes each, and {} bytes "
                      "are left for them",
                      file.string(), element.count, element.name, least, left));
    }
    left -= std::min(left, element.count * least);
  }
}

constexpr std::uint64_t kMostCorners = 255;  ///< VTK counts them in a byte

/// `where` is a function: it is called when something is wrong, not for each of millions of faces.
template <class Where>
void check_corners(std::uint64_t corners, const Where& where) {
  if (corners >= 3 && corners <= kMostCorners) return;
  throw core::InputError(fmt::format("{}: a face with {} corners; it needs 3, and {} are the most that are read",
                                     where(), corners, kMostCorners));
}

/// One line of a text PLY holds one element.
template <class Where>
void check_text_line(std::string_view line, const Element& element, const Where& where) {
  constexpr std::size_t kLongest = 4000;  // VTK cuts longer ones
  if (line.size() > kLongest) {
    throw core::InputError(fmt::format("{}: the line is longer than {} characters", where(), kLongest));
  }
  Words words(line);
  const auto next = [&](const Property& property) {
    const std::string_view word = words.next();
    double value = 0;
    if (parse(word, value)) return value;
    throw core::InputError(fmt::format("{}: {} has '{}' for {}: a number is expected (one line holds one element)",
                                       where(), element.name, word, property.name));
  };
  for (const Property& property : element.properties) {
    if (!property.list) {
      next(property);
      continue;
    }
    const double count = next(property);
    if (!(count >= 0 && count <= kLongest) || count != std::floor(count)) {
      throw core::InputError(fmt::format("{}: a list cannot have {} entries", where(), count));
    }
    if (is_corners(element, property)) check_corners(static_cast<std::uint64_t>(count), where);
    for (int k = 0; k < static_cast<int>(count); ++k) next(property);
  }
}

void check_text(const PlyHeader& header, const std::string& bytes, const std::filesystem::path& file) {
  std::size_t at = header.size, line = header.lines;
  for (const Element& element : header.elements) {
    for (std::uint64_t k = 0; k < element.count; ++k) {
      ++line;
      if (at >= bytes.size()) {
        throw core::InputError(fmt::format("{}: is cut short: it ends after {} of {} elements '{}'", file.string(), k,
                                           element.count, element.name));
      }
      const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
      check_text_line(std::string_view(bytes).substr(at, end - at), element,
                      [&] { return fmt::format("{}:{}", file.string(), line); });
      at = end + 1;
    }
  }
}

/// A list's number; below zero, it comes out far too large for any file.
std::uint64_t list_length(const char* at, const Property& list, bool big_endian) {
  std::uint64_t value = 0;
  for (std::size_t k = 0; k < list.count_bytes; ++k) {
    value = value << 8 | static_cast<unsigned char>(at[big_endian ? k : list.count_bytes - 1 - k]);
  }
  const bool negative = list.count_has_sign && (value >> (8 * list.count_bytes - 1)) != 0;
  return negative ? std::numeric_limits<std::uint64_t>::max() : value;
}

/// Bytes of the element at `at`; throws where it ends beyond the file.
template <class Where>
std::size_t size_of_element(const PlyHeader& header, const Element& element, const std::string& bytes, std::size_t at,
                            const Where& where) {
  const std::size_t begin = at;
  const auto take = [&](std::uint64_t count, std::size_t each) {
    if (count > (bytes.size() - at) / each) {
      throw core::InputError(fmt::format("{}: is cut short, or a list's length is wrong", where()));
    }
    at += count * each;
  };
  for (const Property& property : element.properties) {
    std::uint64_t count = 1;
    if (property.list) {
      take(1, property.count_bytes);
      count = list_length(&bytes[at - property.count_bytes], property, header.big_endian);
      if (is_corners(element, property)) check_corners(count, where);
    }
    take(count, property.bytes);
  }
  return at - begin;
}

void check_binary(const PlyHeader& header, const std::string& bytes, const std::filesystem::path& file) {
  std::size_t at = header.size;
  for (const Element& element : header.elements) {
    for (std::uint64_t k = 0; k < element.count; ++k) {
      at += size_of_element(header, element, bytes, at,
                            [&] { return fmt::format("{}: {} {} (counted from 0)", file.string(), element.name, k); });
    }
  }
}

/// VTK's reader trusts the header and every list's length, and brings the program down where they are wrong.
/// Returns the number of faces.
std::size_t check_ply(const std::filesystem::path& file) {
  const PlyHeader header = read_ply_header(file);
  check_properties(header, file);
  check_size(header, file);
  const std::string bytes = core::read_file(file.string());
  if (header.binary) {
    check_binary(header, bytes, file);
  } else {
    check_text(header, bytes, file);
  }
  return element_of(header, "face", file).count;
}

}  // namespace

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
  // Some binary files begin with 'solid' too: their headers hold bytes that no text has.
  const bool text = std::strncmp(head, "solid", 5) == 0 && std::none_of(head, head + in.gcount(), [](char c) {
                      return c == 0 || static_cast<unsigned char>(c) > 126;
                    });
  if (whole || text) return;
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
