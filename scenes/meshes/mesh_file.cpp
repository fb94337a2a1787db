#include "scenes/meshes/mesh_file.h"

namespace tarmac::scenes {

namespace {

const MeshReader*& installed() {
  static const MeshReader* reader = nullptr;
  return reader;
}

}  // namespace

void install_mesh_reader(const MeshReader& reader) {
  installed() = &reader;
}

const MeshReader* installed_mesh_reader() {
  return installed();
}

}  // namespace tarmac::scenes
