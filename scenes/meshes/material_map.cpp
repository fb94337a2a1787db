#include "scenes/meshes/material_map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "core/error.h"
#include "scenes/materials/materials.h"

namespace tarmac::scenes {

namespace {

/// A material given by its values.
struct MaterialValues {
  Material material;

  void visit(core::OptionVisitor& v) {
    const core::Range share{.at_least = 0, .at_most = 1};
    v("diffuse", material.diffuse, "hemispherical reflectance", share);
    v("oren_nayar_sigma_rad", material.oren_nayar_sigma_rad, "roughness (0: Lambert)", {.at_least = 0, .at_most = 1});
    v("specular_f0", material.specular_f0, "Fresnel reflectance of the glossy lobe at normal incidence", share);
    v("ggx_alpha", material.ggx_alpha, "width of the glossy lobe (0: none)", share);
    v("retro", material.retro, "retro-reflecting lobe at normal incidence", {.at_least = 0, .at_most = 5000});
    v("transmission", material.transmission, "share of energy that passes", share);
    Eigen::Vector3d color = material.color.cast<double>();
    v("color", color, "for pictures, sRGB from 0 to 1");
    material.color = color.cwiseMax(0).cwiseMin(1).cast<float>();
  }
};

std::vector<std::string> table_names() {
  std::vector<std::string> names;
  for (const Material& material : materials()) names.push_back(material.name);
  return names;
}

std::optional<std::uint16_t> find_in_table(const std::string& name) {
  const std::vector<std::string> names = table_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::uint16_t>(found - names.begin());
}

std::uint16_t table_index(const core::ConfigNode& node) {
  const std::string name = node.scalar("material");
  if (const auto index = find_in_table(name)) return *index;
  const std::vector<std::string> names = table_names();
  const std::string guess = core::did_you_mean(name, names);
  node.fail(fmt::format("there is no material '{}'{}; known are {}, or give values: {{diffuse: 0.4}}", name,
                        guess.empty() ? "" : fmt::format(" (did you mean '{}'?)", guess), fmt::join(names, ", ")));
}

MaterialValues read_values(const core::ConfigNode& node) {
  MaterialValues values;
  node.read(values);
  if (values.material.diffuse + values.material.transmission > 1) {
    node.fail(fmt::format("diffuse {:g} and transmission {:g} are more than 1 together", values.material.diffuse,
                          values.material.transmission));
  }
  return values;
}

std::uint16_t read_material(const core::ConfigNode& node, const std::string& name, Scene& scene) {
  if (!node.is_block()) return table_index(node);
  MaterialValues values = read_values(node);
  values.material.name = name;
  scene.materials.push_back(values.material);
  return static_cast<std::uint16_t>(scene.materials.size() - 1);
}

/// A key of `materials:` that no triangle asks for is a typing error, or meant for another file.
void refuse_unused_keys(const core::ConfigNode& map, const MeshFile& file, const std::filesystem::path& path) {
  for (const std::string& key : map.keys()) {
    if (std::find(file.names.begin(), file.names.end(), key) != file.names.end()) continue;
    const std::string guess = core::did_you_mean(key, file.names);
    map.child(key).fail(fmt::format("{} names no material '{}'{}; it names {}", path.string(), key,
                                    guess.empty() ? "" : fmt::format(" (did you mean '{}'?)", guess),
                                    file.names.empty() ? "none" : fmt::format("{}", fmt::join(file.names, ", "))));
  }
}

[[noreturn]] void fail_uncovered(const core::ConfigNode& entry, const MeshFile& file, std::size_t name,
                                 const std::filesystem::path& path) {
  const auto count = std::count(file.name_of_triangle.begin(), file.name_of_triangle.end(), name);
  if (file.names.empty()) {
    entry.fail_at("material",
                  fmt::format("is missing: {} names no materials, so all its triangles need this one", path.string()));
  }
  if (file.names[name].empty()) {
    entry.fail_at("material", fmt::format("is missing: {} of {} triangles of {} stand in a group without a material's "
                                          "name, and this one would be theirs",
                                          count, file.triangles.size(), path.string()));
  }
  entry.fail_at("materials", fmt::format("does not hold '{}', which {} triangles of {} are made of; add it, or give "
                                         "`material:` for all that is not listed",
                                         file.names[name], count, path.string()));
}

std::string quoted_key(const std::string& key) {
  std::string text = "\"";
  for (const char c : key) {
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  return text + "\"";
}

std::string resolve_material(const core::ConfigNode& node, const std::string& key, int indent) {
  const std::string spaces(static_cast<std::size_t>(indent), ' ');
  if (node.is_block()) return spaces + key + ":\n" + core::write_options(read_values(node), indent + 2);
  table_index(node);
  return spaces + key + ": " + node.scalar("material") + "\n";
}

}  // namespace

std::vector<std::uint16_t> map_materials(const core::ConfigNode& entry, const MeshFile& file, Scene& scene,
                                         const std::filesystem::path& path) {
  const core::ConfigNode map = entry.child("materials"), otherwise = entry.child("material");
  if (map.present()) refuse_unused_keys(map, file, path);
  const std::string prefix = path.filename().string();
  std::optional<std::uint16_t> default_index;
  if (otherwise.present()) default_index = read_material(otherwise, prefix, scene);
  std::vector<std::uint16_t> indices;
  for (std::size_t name = 0; name < std::max<std::size_t>(1, file.names.size()); ++name) {
    const std::string& text = file.names.empty() ? "" : file.names[name];
    const core::ConfigNode mapped = text.empty() ? core::ConfigNode() : map.child(text);
    if (mapped.present()) {
      indices.push_back(read_material(mapped, prefix + ":" + text, scene));
    } else if (default_index) {
      indices.push_back(*default_index);
    } else if (const auto index = find_in_table(text)) {
      indices.push_back(*index);
    } else {
      fail_uncovered(entry, file, name, path);
    }
  }
  return indices;
}

std::string resolve_materials(const core::ConfigNode& entry, int indent) {
  std::string text;
  const std::string spaces(static_cast<std::size_t>(indent), ' ');
  if (const core::ConfigNode material = entry.child("material"); material.present()) {
    text += resolve_material(material, "material", indent);
  }
  if (const core::ConfigNode map = entry.child("materials"); map.present()) {
    if (!map.is_block()) map.fail("must be a block of `name in the file: material` lines");
    text += spaces + "materials:\n";
    for (const std::string& key : map.keys()) text += resolve_material(map.child(key), quoted_key(key), indent + 2);
  }
  return text;
}

}  // namespace tarmac::scenes
