// SPDX-License-Identifier: GPL-3.0-or-later
// The readers for meshes of any format.
#include "base/error.h"
#include "base/file_extension.h"
#include "io/textured/textured_mesh.h"
#include "textured/private/textured_readers.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

const MeshFormat& format_of(const fs::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj") return kObjMeshes;
  return extension == ".glb" || extension == ".gltf" ? kGltfMeshes : kPlyMeshes;
}

}  // namespace

bool is_textured_mesh(const fs::path& path) {
  return format_of(path).is_textured(path);
}

TextureFiles texture_files_of(const fs::path& path) {
  return format_of(path).texture_files(path);
}

std::vector<fs::path> files_of_mesh(const fs::path& path) {
  std::vector<fs::path> files{path};
  try {
    const TextureFiles named = texture_files_of(path);
    files.insert(files.end(), named.materials.begin(), named.materials.end());
    files.insert(files.end(), named.textures.begin(), named.textures.end());
  } catch (const Error&) {  // the reader of the mesh says what is wrong
  }
  return files;
}

std::uint64_t bytes_to_read_textures(const fs::path& path, const Context& context) {
  return format_of(path).bytes_of_textures(path, context);
}

std::uint64_t bytes_to_read_mesh(const fs::path& path) {
  return format_of(path).bytes_to_read(path);
}

MeshPlace mesh_place(const fs::path& path) {
  return format_of(path).place(path);
}

Mesh read_shape(const fs::path& path, const std::optional<LocalFrame>& frame) {
  return format_of(path).read_shape(path, frame);
}

TexturedMesh read_textured_mesh(const fs::path& path, const std::optional<LocalFrame>& frame,
                                const Context& context) {
  return format_of(path).read_textured(path, frame, context);
}

}  // namespace axial::io
