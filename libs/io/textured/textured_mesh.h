// SPDX-License-Identifier: GPL-3.0-or-later
// Files of textured meshes: PLY as OpenMVS and MeshLab write it, OBJ with MTL, and glTF 2.0.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "io/ply/ply.h"
#include "scene/textured_mesh.h"

namespace axial::io {

enum class TexturedFormat { ply, obj, glb, gltf };

// The format of a name "ply", "obj", "glb" or "gltf"; nothing for another name.
std::optional<TexturedFormat> textured_format(std::string_view name);

// The files of a mesh with `textures` textures, the mesh first. `path` has any extension, or none,
// which is replaced. The textures of "dir/scene.ply" are "dir/scene0.png", "dir/scene1.png" and so
// on, as in OpenMVS. A GLB contains its textures.
std::vector<std::filesystem::path> textured_files(const std::filesystem::path& path,
                                                  TexturedFormat format, std::size_t textures);

// Writes the mesh and its textures. Either all files are written, or none is.
//   - PLY: comments TextureFile; for each face texcoord, a list of u v of its corners, and the
//     index texnumber if there is more than one texture. u = (x + 0.5) / width,
//     v = 1 - (y + 0.5) / height.
//   - OBJ: the same u and v, each pair once for each vertex and texture; a group and a material
//     "material_K" for each texture.
//   - glTF: a primitive for each texture, with vertices and bounds of its own,
//     u = (x + 0.5) / width and v = (y + 0.5) / height; materials without lighting
//     (KHR_materials_unlit). The axes are those of the scene. GLB is the same in one file, of at
//     most 4 GiB.
// Positions are written in `frame`, as float. If that is not the world, PLY has the comment
// geo_offset, OBJ a comment "# geo_offset X Y Z", and glTF the same key in the extras of its node.
// Error if uv and texture_of do not have an entry for each face, if an index is out of range or a
// coordinate is not finite, if a GLB would be larger than
// 4 GiB, and if a file cannot be written.
void write_textured_mesh(const std::filesystem::path& path, const TexturedMesh& mesh,
                         TexturedFormat format, const LocalFrame& frame = {});

// Reads a textured PLY and the textures beside it. Error that names the file for a face that is no
// triangle or has no texcoord, for a texture that is missing or cannot be read, for an index out of
// range, and as for read_mesh_ply. With `frame`, positions are in that frame, as in read_mesh_ply.
TexturedMesh read_textured_ply(const std::filesystem::path& path,
                               const std::optional<LocalFrame>& frame = {});

}  // namespace axial::io
