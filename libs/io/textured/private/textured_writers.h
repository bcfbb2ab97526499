// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: makes the contents of the files of textured meshes, without writing them.
#pragma once

#include <array>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "bytes/private/only_for_io.h"
#include "io/textured/textured_mesh.h"

namespace axial::io {

using Bytes = std::vector<unsigned char>;

// The corners of the faces that have one texture, without repetitions. Two corners are the same if
// they have the same vertex and the same texture coordinates. Corner i has the vertex `vertex[i]`
// and the texture coordinates `uv[i]`.
struct UnifiedCorners {
  std::vector<std::uint32_t> vertex;                // indices into the vertices of the mesh
  std::vector<Eigen::Vector2f> uv;                  // [px]
  std::vector<std::array<std::uint32_t, 3>> faces;  // indices into `vertex` and `uv`
};

// Unifies the corners of the faces of one texture after the other. The time for a texture depends
// on the number of its faces alone, so that many textures do not take longer than one.
class CornerUnifier {
 public:
  // `mesh` must outlive the object.
  explicit CornerUnifier(const TexturedMesh& mesh);

  // Returns the corners of all faces with the texture `texture`, in the order of the mesh.
  UnifiedCorners corners_of(std::uint32_t texture);

 private:
  const TexturedMesh& mesh_;
  std::vector<std::vector<std::uint32_t>> faces_;  // of each texture
  std::vector<std::uint32_t> first_;  // work space: the first unified corner of each vertex
};

// Converts texture coordinates from pixels to ((x + 0.5) / width, (y + 0.5) / height), so that v
// counts from the upper edge. `texture` is the size of the texture.
Eigen::Vector2f relative(const Eigen::Vector2f& uv, const cv::Size& texture);

// Return the bytes of a PLY, OBJ and MTL file. `textures` holds the file names of the textures, and
// `materials` is the name of the MTL file.
std::string textured_ply(const TexturedMesh& mesh, const std::vector<std::string>& textures,
                         const LocalFrame& frame);
std::string textured_obj(const TexturedMesh& mesh, const std::string& materials,
                         const LocalFrame& frame);
std::string textured_mtl(const std::vector<std::string>& textures);

// The two files of a glTF. textured_gltf takes the file names of the textures, and in `binary` the
// name of the file that will hold `buffer`.
struct GltfFiles {
  std::string json;
  Bytes buffer;
};
GltfFiles textured_gltf(const TexturedMesh& mesh, const std::vector<std::string>& textures,
                        const std::string& binary, const LocalFrame& frame);

// Writes the bytes of a GLB file. `pngs` holds the textures, encoded as PNG. A texture is freed as
// soon as it is in the buffer of the file.
void write_textured_glb(std::ostream& out, const TexturedMesh& mesh, std::vector<Bytes> pngs,
                        const LocalFrame& frame);

}  // namespace axial::io
