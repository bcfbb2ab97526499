// SPDX-License-Identifier: GPL-3.0-or-later
// Files of textured meshes: PLY as OpenMVS and MeshLab write it, OBJ with MTL, and glTF 2.0.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "io/ply/ply.h"
#include "scene/textured_mesh.h"

namespace axial::io {

enum class TexturedFormat { ply, obj, glb, gltf };

// Returns the format that the name "ply", "obj", "glb" or "gltf" stands for; nothing for another
// name.
std::optional<TexturedFormat> textured_format(std::string_view name);

// Returns the paths of all files that write_textured_mesh writes for a mesh with `textures`
// textures. The first path is that of the mesh. The extension of `path`, if it has one, is replaced
// by the extension of the format. The second path is the .mtl file of an OBJ or the .bin file of a
// glTF. The paths of the textures follow: for "dir/scene.ply" they are "dir/scene0.png",
// "dir/scene1.png" and so on, as in OpenMVS. A GLB is a single file that contains its textures.
std::vector<std::filesystem::path> textured_files(const std::filesystem::path& path,
                                                  TexturedFormat format, std::size_t textures);

// Writes the mesh and its textures. Either all files are written, or none is.
// Let (x, y) be a texture coordinate of the mesh in pixels of its texture.
//   - PLY: a comment TextureFile names each texture. The list texcoord of a face holds u and v of
//     its corners. If there is more than one texture, texnumber is the index of the face's texture.
//     u = (x + 0.5) / width, v = 1 - (y + 0.5) / height.
//   - OBJ: u and v as in PLY. A pair (u, v) is written once for each vertex and texture that have
//     it. Each texture that faces use has a group and a material "material_K", where K is the index
//     of the texture.
//   - glTF: each texture that faces use has a primitive with vertices and bounds of its own.
//     u = (x + 0.5) / width, v = (y + 0.5) / height. Materials are without lighting
//     (KHR_materials_unlit). The axes are those of the scene. GLB holds the same data in one file.
//
// `frame` is the frame of the mesh's positions. Positions are written in `frame`, as float. If
// `frame` is not the world, its origin is written too: PLY has a comment "geo_offset X Y Z", OBJ a
// comment "# geo_offset X Y Z", and glTF a key geo_offset in the extras of its node.
//
// Error if uv or texture_of does not have one entry for each face, if an index is out of range, if
// a coordinate is not finite, if a GLB would be larger than 4 GiB, or if a file cannot be written.
void write_textured_mesh(const std::filesystem::path& path, const TexturedMesh& mesh,
                         TexturedFormat format, const LocalFrame& frame = {});

// An upper bound of the memory [bytes] that write_textured_mesh() needs besides the mesh and its
// textures.
std::uint64_t bytes_to_write_textured(TexturedFormat format, std::uint64_t vertices,
                                      std::uint64_t faces, std::span<const cv::Size> textures);

// Reads a textured PLY and the textures beside it. With and without `frame`, positions are treated
// as in the two functions read_mesh_ply. Error that names the file for a file without a comment
// TextureFile, a face that is not a triangle, a face without texcoord, a texture that is missing or
// cannot be read, or an index out of range. Other errors as for read_mesh_ply.
TexturedMesh read_textured_ply(const std::filesystem::path& path,
                               const std::optional<LocalFrame>& frame = {});

}  // namespace axial::io
