// SPDX-License-Identifier: GPL-3.0-or-later
// The readers for meshes of any format.
#include "base/error.h"
#include "base/file_extension.h"
#include "io/openmvs/point_source.h"
#include "io/textured/textured_mesh.h"
#include "private/textured/textured_readers.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

enum class MeshFormat { ply, obj, gltf };

MeshFormat format_of(const fs::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj") return MeshFormat::obj;
  return extension == ".glb" || extension == ".gltf" ? MeshFormat::gltf : MeshFormat::ply;
}

// Calls the function of the format.
template <class Ply, class Obj, class Gltf>
auto by_format(const fs::path& path, const Ply& ply, const Obj& obj, const Gltf& gltf) {
  switch (format_of(path)) {
    case MeshFormat::obj:
      return obj(path);
    case MeshFormat::gltf:
      return gltf(path);
    case MeshFormat::ply:
      break;
  }
  return ply(path);
}

}  // namespace

bool is_textured_mesh(const fs::path& path) {
  return by_format(path, is_textured_ply, is_textured_obj, is_textured_gltf);
}

TextureFiles texture_files_of(const fs::path& path) {
  return by_format(path, texture_files_of_ply, texture_files_of_obj, texture_files_of_gltf);
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

std::uint64_t bytes_to_read_textures(const fs::path& path) {
  return by_format(path, bytes_of_ply_textures, bytes_of_obj_textures, bytes_of_gltf_textures);
}

std::uint64_t bytes_to_read_mesh(const fs::path& path) {
  return by_format(path, bytes_to_read_ply, bytes_to_read_obj, bytes_to_read_gltf);
}

MeshPlace mesh_place(const fs::path& path) {
  return by_format(path, ply_place, place_of_obj, place_of_gltf);
}

Mesh read_shape(const fs::path& path, const std::optional<LocalFrame>& frame) {
  const auto ply = [&](const fs::path& file) {
    return frame ? read_mesh_ply(file, *frame) : read_mesh_ply(file);
  };
  return by_format(
      path, ply, [&](const fs::path& file) { return read_shape_obj(file, frame); },
      [&](const fs::path& file) { return read_shape_gltf(file, frame); });
}

TexturedMesh read_textured_mesh(const fs::path& path, const std::optional<LocalFrame>& frame) {
  return by_format(
      path, [&](const fs::path& file) { return read_textured_ply(file, frame); },
      [&](const fs::path& file) { return read_textured_obj(file, frame); },
      [&](const fs::path& file) { return read_textured_gltf(file, frame); });
}

}  // namespace axial::io
