// SPDX-License-Identifier: GPL-3.0-or-later
// Files of meshes, with textures or without: PLY as OpenMVS and MeshLab write it, OBJ with MTL, and
// glTF 2.0.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "axial/base.h"
#include "axial/scene_images.h"
#include "io/ply/ply.h"

namespace axial::io {

// glb: one binary file of glTF. gltf: a JSON file, a binary file and the images of the textures.
enum class TexturedFormat { ply, obj, glb, gltf };

// Returns the format of the name "ply", "obj", "glb" or "gltf", in upper or lower case; nothing for
// another name.
std::optional<TexturedFormat> textured_format(std::string_view name);

// Returns the paths of all files that write_textured_mesh writes for a mesh with `textures`
// textures. The first path is that of the mesh. The extension of `path`, if it has one, is replaced
// by the extension of the format. The second path is the .mtl file of an OBJ or the .bin file of a
// glTF. The paths of the textures follow: for "dir/scene.ply" they are "dir/scene0.png",
// "dir/scene1.png" and so on, as in OpenMVS, for an OBJ "dir/scene_material_0_map_Kd.png" and so
// on, and for a glTF "dir/scene_gltf0.png" and so on. So the files of one format never replace
// those of another format. A GLB is a single file that contains its textures: the result has one
// path.
std::vector<std::filesystem::path> textured_files(const std::filesystem::path& path,
                                                  TexturedFormat format, std::size_t textures);

// Writes the mesh and its textures to the files textured_files() and replaces existing files. All
// files are written under temporary names and then renamed one after the other. If anything fails
// before that, existing files keep their content. Colours of vertices are left out.
//
// Let (x, y) be a texture coordinate of the mesh in pixels of its texture.
//   - PLY: a comment TextureFile names each texture. The list texcoord of a face holds u and v of
//     its corners. If there is more than one texture, texnumber is the index of the face's texture.
//     u = (x + 0.5) / width, v = 1 - (y + 0.5) / height. Mesh::unseen is the property unseen of the
//     faces; the other formats leave it out.
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
// Error if uv, texture_of or Mesh::unseen, unless it is empty, does not have one entry for each
// face, if an index is out of range, if
// a vertex or a texture coordinate is not finite, if a GLB would be larger than 4 GiB, or if a file
// cannot be written.
void write_textured_mesh(const std::filesystem::path& path, const TexturedMesh& mesh,
                         TexturedFormat format, const LocalFrame& frame = {});

// Writes the files of write_textured_mesh() under the names `temporaries`, for a caller that
// renames them to textured_files(path, format, textures) together with other files. Errors as for
// write_textured_mesh().
void write_textured_as(std::span<const std::filesystem::path> temporaries,
                       const std::filesystem::path& path, const TexturedMesh& mesh,
                       TexturedFormat format, const LocalFrame& frame = {});

// An upper bound of the memory [bytes] that write_textured_mesh() needs besides the mesh and its
// textures.
std::uint64_t bytes_to_write_textured(TexturedFormat format, std::uint64_t vertices,
                                      std::uint64_t faces, std::span<const cv::Size> textures);

// Readers of textured meshes, one for each format. Positions are returned as stored if `frame` is
// empty, and otherwise in `frame`, as by read_mesh_ply() (ply.h). Texture coordinates are returned
// in pixels, as in TexturedMesh. Coordinates outside of 0 to 1 follow the wrapping of their format
// (PLY: the edge of the texture; OBJ: repeated, or the edge with -clamp; glTF: the sampler). A face
// that extends over several copies of its picture gets a texture with these copies, up to 2^26
// pixels in all. Errors name the file.
//
// The names of pictures, MTL files and buffers start at the folder of the file that has the names.
// Absolute names and names with ".." are read, too, because people keep textures in other folders.
// Nothing is written to these places. Error for a name with a NUL byte.

// A PLY has its textures in comments TextureFile, and coordinates at the corners of faces (the list
// texcoord, and texnumber for the number of the texture) or at vertices (texture_u and texture_v, u
// and v, or s and t). Polygons are split into fans. Error for a file without TextureFile or
// coordinates, a list texcoord of another length than the face, a texture that cannot be read, or
// an index out of range. Other errors as for read_mesh_ply.
TexturedMesh read_textured_ply(const std::filesystem::path& path,
                               const std::optional<LocalFrame>& frame = {});

// An OBJ with its MTL files and the pictures of map_Kd, with the options -o, -s and -clamp. Faces
// of a material without map_Kd get a texture of its colour Kd; faces without a material are white.
// Kd has no effect on pictures. Faces with more than three corners are split into a fan of
// triangles. Vertices keep their order. A comment "# geo_offset X Y Z" states the origin of
// positions. Error that names the line for a number that is malformed or not finite, an index out
// of range, a corner without texture coordinate on a face with a picture, or a material that no MTL
// file has. Error for a mesh without faces and for a picture that cannot be read.
TexturedMesh read_textured_obj(const std::filesystem::path& path,
                               const std::optional<LocalFrame>& frame = {});

// A glTF 2.0, .gltf or .glb. The triangles of all nodes of the default scene become one mesh, moved
// by the transformations of their nodes, and turned round if a transformation mirrors them. The
// mesh has the vertices of the file: where charts meet, a glTF has several vertices at the same
// position. Textures are those of baseColorTexture, moved by KHR_texture_transform and multiplied
// by baseColorFactor; a material without a picture gives a texture of its colour. Light, other
// textures, points and lines have no effect. The key geo_offset in the extras of a node states the
// origin of positions. Error for a malformed file, an extension that is required and not known,
// data outside of their file, a mesh without faces, a primitive without position or without the
// texture coordinates of its picture, skins, morph targets that have an effect, and a picture that
// cannot be read. Warns through `context` of colours of vertices, which have no effect.
TexturedMesh read_textured_gltf(const std::filesystem::path& path,
                                const std::optional<LocalFrame>& frame = {},
                                const Context& context = {});

// Returns the names of the textures of a PLY, from its comments TextureFile, in their order. A name
// is a path that starts at the folder of the PLY. Error that names the file for a PLY with a
// malformed header.
std::vector<std::string> textures_of_ply(const std::filesystem::path& path);

// The files that belong to a mesh besides its own file.
struct TextureFiles {
  std::vector<std::filesystem::path> textures;
  std::vector<std::filesystem::path> materials;  // MTL files of an OBJ, buffers of a glTF
};

// The functions below take a mesh of any format. The extension chooses it, in upper or lower case:
// .obj, .glb, .gltf; other files are PLY.

// Returns the files that the mesh of `path` names. An MTL file that does not exist is returned, but
// its textures are not known. Error that names the file if the mesh or an MTL file cannot be read.
TextureFiles texture_files_of(const std::filesystem::path& path);

// Returns `path` and the files of texture_files_of(): all files that an output must not replace.
// Returns `path` alone for a mesh that cannot be read, because its reader says why.
std::vector<std::filesystem::path> files_of_mesh(const std::filesystem::path& path);

// An upper bound of the memory [bytes] that read_shape() needs, with its result and with texture
// coordinates. 0 if the size of the file cannot be found. For a PLY it is made from the size alone;
// the lines of an OBJ and the JSON part of a glTF are read for it. Error that names the file for a
// malformed glTF.
std::uint64_t bytes_to_read_mesh(const std::filesystem::path& mesh);

// The memory [bytes] that read_textured_mesh() needs for the textures of `path`, besides
// bytes_to_read_mesh(). Reads the headers of the pictures, and an OBJ or
// glTF as a whole. Warnings and errors as for read_textured_mesh().
std::uint64_t bytes_to_read_textures(const std::filesystem::path& path,
                                     const Context& context = {});

// True if read_textured_mesh() finds pictures: a PLY with TextureFile and texture coordinates, an
// OBJ with texture coordinates and a material with map_Kd, a glTF whose scene has a
// baseColorTexture. Pictures are not opened. Error that names the file if the mesh or an MTL file
// cannot be read.
bool is_textured_mesh(const std::filesystem::path& path);

// Reads a textured mesh of any format.
TexturedMesh read_textured_mesh(const std::filesystem::path& path,
                                const std::optional<LocalFrame>& frame = {},
                                const Context& context = {});

// Reads the vertices and faces of a mesh of any format, and colours of vertices if the file has
// them: red, green, blue of a PLY; numbers behind the positions of an OBJ; COLOR_0 times
// baseColorFactor of a glTF. No picture or MTL file is opened. Positions are treated as by the
// functions above. Errors as for read_mesh_ply() and the functions above, except errors about
// textures.
Mesh read_shape(const std::filesystem::path& path, const std::optional<LocalFrame>& frame = {});

// Returns the place of the positions of a mesh of any format, as ply_place() does for PLY.
// is_float is false for an OBJ, and for a glTF whose positions are moved by nodes.
using MeshPlace = PlyPlace;
MeshPlace mesh_place(const std::filesystem::path& path);

}  // namespace axial::io
