// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: the textures of a mesh that is being read.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "axial/scene_images.h"
#include "base/error.h"
#include "bytes/private/only_for_io.h"
#include "scene/point_cloud.h"

namespace axial::io {

// What a texture shows at coordinates outside of 0 to 1.
enum class Wrap { repeat, mirror, clamp };

// A texture as a file describes it: a picture in a file of its own, the bytes of a picture, or one
// colour.
struct TextureSource {
  std::filesystem::path file{};  // empty: no file
  std::string bytes{};           // of a picture file; empty: no bytes
  std::string name{};            // of `bytes`, for messages
  Rgb color{255, 255, 255};      // without file and bytes
  // Factors of red, green and blue in linear light.
  Eigen::Vector3d factor = Eigen::Vector3d::Ones();
  std::array<Wrap, 2> wrap{Wrap::clamp, Wrap::clamp};  // of u and v
};

// A value of sRGB, 0 to 255, for a value of linear light, 0 to 1.
std::uint8_t srgb_of(double linear);

// Collects textures and places texture coordinates in them. A face that goes beyond the edge of a
// repeated texture gets a texture with copies of the picture beside one another.
class TextureSet {
 public:
  // `file`: of the mesh, for messages. `decode`: false to find the sizes of pictures alone.
  TextureSet(std::string file, bool decode) : file_(std::move(file)), decode_(decode) {}

  // Adds a texture and returns its number. Error that names the picture if it cannot be read.
  std::uint32_t add(const TextureSource& source);

  // Appends the texture and the texture coordinates of a face to `mesh`. The coordinates (u, v) of
  // the corners become pixels of the texture; v counts from the lower edge. Precondition: u and v
  // are finite. Error that begins with the result of name(), the name of the face, if the texture
  // would have to be repeated too often, or if a coordinate does not fit into float.
  template <class Name>
  void add_face(TexturedMesh& mesh, std::uint32_t texture, const std::array<Eigen::Vector2d, 3>& uv,
                const Name& name) {
    std::string problem;
    mesh.uv.push_back(place(texture, uv, problem));
    mesh.texture_of.push_back(texture);
    if (!problem.empty()) fail("{} {}", name(), problem);
  }

  // Moves the textures to `mesh`, to which add_face() added the faces.
  void finish(TexturedMesh& mesh);

  // The memory [bytes] of the textures that finish() makes, while they are made.
  std::uint64_t bytes() const;

 private:
  struct Texture {
    cv::Size size;  // of the picture
    std::array<Wrap, 2> wrap;
    cv::Size copies{1, 1};
    cv::Mat3b image;  // empty if not decoded
  };

  cv::Mat3b decoded(const TextureSource& source);
  // `problem`: receives a text that can follow the name of the face.
  TexturedMesh::Corners place(std::uint32_t texture, const std::array<Eigen::Vector2d, 3>& uv,
                              std::string& problem);

  std::string file_;
  bool decode_;
  std::vector<Texture> textures_;
  std::map<std::filesystem::path, cv::Mat3b> files_;  // pictures that several textures share
  std::uint64_t largest_decoding_ = 0;                // [bytes]
};

}  // namespace axial::io
