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

// glb: one binary file of glTF. gltf: a JSON file, a binary file and the images of the textures.
enum class TexturedFormat { ply, obj, glb, gltf };

// Returns the format of the name "ply", "obj", "glb" or "gltf", in lower case; nothing for another
// name.
std::optional<TexturedFormat> textured_format(std::string_view name);

// Returns the paths of all files that write_textured_mesh writes for a mesh with `textures`
// textures. The first path is that of the mesh. The extension of `path`, if it has one, is replaced
// by the extension of the format. The second path is the .mtl file of an OBJ or the .bin file of a
// glTF. The paths of the textures follow: for "dir/scene.ply" they are "dir/scene0.png",
// "dir/scene1.png" and so on, as in OpenMVS. A GLB is a single file that contains its textures: the
// result has one path.
std::vector<std::filesystem::path> textured_files(const std::filesystem::path& path,
                                                  TexturedFormat format, std::size_t textures);

// Writes the mesh and its textures to the files textured_files() and replaces existing files. All
// files are written under temporary names and then renamed one after the other. If anything fails
// before that, existing files keep their content. Colours of vertices are left out.
//
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
// a vertex or a texture coordinate is not finite, if a GLB would be larger than 4 GiB, or if a file
// cannot be written.
void write_textured_mesh(const std::filesystem::path& path, const TexturedMesh& mesh,
                         TexturedFormat format, const LocalFrame& frame = {});

// An upper bound of the memory [bytes] that write_textured_mesh() needs besides the mesh and its
// textures.
std::uint64_t bytes_to_write_textured(TexturedFormat format, std::uint64_t vertices,
                                      std::uint64_t faces, std::span<const cv::Size> textures);

// Reads a textured PLY and the textures beside it. Positions are returned as stored if `frame` is
// empty, and otherwise in `frame`, as by read_mesh_ply() (ply.h). Texture coordinates are returned
// in pixels, as in TexturedMesh. Error that names the file for a file without a comment
// TextureFile, a face that is not a triangle, a face without texcoord, a texture that is missing or
// cannot be read, or an index out of range. Other errors as for read_mesh_ply.
TexturedMesh read_textured_ply(const std::filesystem::path& path,
                               const std::optional<LocalFrame>& frame = {});

// Reads an OBJ, its MTL files and their textures. Faces with more than three corners are split into
// a fan of triangles. Vertices keep their order. Positions are treated as in read_textured_ply; a
// comment "# geo_offset X Y Z" states their origin. Error that names the file and the line for a
// number that is malformed or not finite, an index out of range (indices count from 1 and must not
// be negative), a corner without texture coordinate, or a face whose material has no texture
// (map_Kd). Error for a mesh without faces and for a texture that cannot be read.
TexturedMesh read_textured_obj(const std::filesystem::path& path,
                               const std::optional<LocalFrame>& frame = {});

// Reads a GLB. The triangles of all primitives of all meshes become one mesh, which has the
// vertices of the file: where charts meet, a GLB has several vertices at the same position.
// Positions are treated as in read_textured_ply; the key geo_offset in the extras of a node states
// their origin. Error that names the file for a malformed file, a mesh without faces, a primitive
// that is not made of triangles or has no position, texture coordinate or texture, a node with a
// transformation, data outside the file, or a texture that cannot be read.
TexturedMesh read_textured_glb(const std::filesystem::path& path,
                               const std::optional<LocalFrame>& frame = {});

// Returns the names of the textures of a PLY, from its comments TextureFile, in their order. A name
// is a path that starts at the folder of the PLY. Error that names the file for a PLY with a
// malformed header.
std::vector<std::string> textures_of_ply(const std::filesystem::path& path);

// The files that a reader of a textured mesh reads besides the file of the mesh.
struct TextureFiles {
  std::vector<std::filesystem::path> textures;
  std::vector<std::filesystem::path> materials;  // MTL files of an OBJ
};

// Returns the files that read_textured_mesh() reads for `path`. A GLB has none, and neither has a
// PLY without textures. Error that names the file if the mesh or an MTL file cannot be read.
TextureFiles texture_files_of(const std::filesystem::path& path);

// The memory [bytes] that read_textured_mesh() needs for the textures of `path`, those inside of a
// GLB included, besides bytes_to_read_mesh() (openmvs/point_source.h). Reads the headers of the
// images, and a GLB as a whole. Errors as for texture_files_of(), and for a texture or a GLB that
// cannot be read.
std::uint64_t bytes_to_read_textures(const std::filesystem::path& path);

// True if `path` names a textured mesh. Files with the extensions .obj and .glb, in upper or lower
// case, count as textured meshes and are not opened. Other files are PLY, and textured if they have
// a comment TextureFile. Error that names the file for a PLY with a malformed header.
bool is_textured_mesh(const std::filesystem::path& path);

// Reads a textured mesh by one of the three functions above, which the extension of `path` chooses.
TexturedMesh read_textured_mesh(const std::filesystem::path& path,
                                const std::optional<LocalFrame>& frame = {});

// Reads the vertices and faces of a PLY, OBJ or GLB, which the extension of `path` chooses. The
// mesh may have no textures; if it has some, no file of them is opened. Positions are treated as in
// read_textured_ply. Errors as for read_mesh_ply(), read_textured_obj() and read_textured_glb(),
// except those about textures.
Mesh read_shape(const std::filesystem::path& path, const std::optional<LocalFrame>& frame = {});

}  // namespace axial::io
