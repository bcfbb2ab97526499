// SPDX-License-Identifier: GPL-3.0-or-later
#include "textured/private/texture_set.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/srgb.h"
#include "images/private/image_codecs.h"
#include "io/images/image.h"
#include "textured/private/textured_readers.h"

namespace axial::io {
namespace {

constexpr double kMostPixels = 1 << 26;  // of all textures with copies of their pictures

cv::Mat3b multiplied(const cv::Mat3b& image, const Eigen::Vector3d& factor) {
  cv::Mat3b table(1, 256), result;
  for (int value = 0; value < 256; ++value)
    for (int c = 0; c < 3; ++c)
      table(0, value)[c] = srgb_of(light_of_srgb(value / 255.0) * factor[2 - c]);
  cv::LUT(image, table, result);
  return result;
}

// Copies of a picture beside one another. Row 0 of copies is at the lower edge.
cv::Mat3b with_copies(const cv::Mat3b& image, cv::Size copies, const std::array<Wrap, 2>& wrap) {
  cv::Mat3b result(image.rows * copies.height, image.cols * copies.width);
  for (int j = 0; j < copies.height; ++j)
    for (int i = 0; i < copies.width; ++i) {
      const bool flip_x = wrap[0] == Wrap::mirror && i % 2 == 1;
      const bool flip_y = wrap[1] == Wrap::mirror && j % 2 == 1;
      cv::Mat3b copy = result(
          cv::Rect(i * image.cols, (copies.height - 1 - j) * image.rows, image.cols, image.rows));
      image.copyTo(copy);
      if (flip_x) cv::flip(copy, copy, 1);
      if (flip_y) cv::flip(copy, copy, 0);
    }
  return result;
}

// Moves the coordinates of a face by whole copies, so that it begins in the first copy, and returns
// the number of copies that it needs. Coordinates within half a pixel of the texture stay.
double moved_into_texture(std::array<double*, 3> values, Wrap wrap, int pixels) {
  const double border = 0.5 / pixels;
  const auto [low, high] = std::minmax({*values[0], *values[1], *values[2]});
  if (wrap == Wrap::clamp || (low >= -border && high <= 1 + border)) return 1;
  double shift = std::floor(low + border);
  if (wrap == Wrap::mirror) shift = 2 * std::floor(shift / 2);
  const double end = high - shift;
  for (double* const value : values) *value -= shift;
  return std::max(1.0, std::ceil(end - border));
}

}  // namespace

std::uint8_t srgb_of(double linear) {
  return static_cast<std::uint8_t>(std::lround(255 * srgb_of_light(std::clamp(linear, 0.0, 1.0))));
}

cv::Mat3b TextureSet::decoded(const TextureSource& source) {
  if (source.file.empty()) return decode_color_image(source.bytes, source.name);
  if (source.factor != Eigen::Vector3d::Ones()) return read_color_image(source.file);
  cv::Mat3b& image = files_[source.file];
  if (image.empty()) image = read_color_image(source.file);
  return image;
}

std::uint32_t TextureSet::add(const TextureSource& source) {
  Texture texture;
  texture.size = {2, 2};  // of one colour
  texture.wrap = source.wrap;
  const auto [r, g, b] = source.color;
  if (source.file.empty() && source.bytes.empty()) {
    texture.image = cv::Mat3b(texture.size, cv::Vec3b(b, g, r));
  } else if (decode_) {
    texture.image = decoded(source);
    texture.size = texture.image.size();
  } else {
    const ImageHeader header = source.file.empty() ? image_header_of(source.bytes, source.name)
                                                   : read_image_header(source.file);
    texture.size = header.size;
    largest_decoding_ = std::max(largest_decoding_, bytes_needed(header));
  }
  if (!texture.image.empty() && source.factor != Eigen::Vector3d::Ones())
    texture.image = multiplied(texture.image, source.factor);
  textures_.push_back(std::move(texture));
  return static_cast<std::uint32_t>(textures_.size() - 1);
}

TexturedMesh::Corners TextureSet::place(std::uint32_t index,
                                        const std::array<Eigen::Vector2d, 3>& uv,
                                        std::string& problem) {
  Texture& texture = textures_[index];
  std::array<Eigen::Vector2d, 3> at = uv;
  const auto copies = [&](int axis, int pixels) {
    return moved_into_texture({&at[0][axis], &at[1][axis], &at[2][axis]},
                              texture.wrap[static_cast<std::size_t>(axis)], pixels);
  };
  const double wide = std::max<double>(texture.copies.width, copies(0, texture.size.width));
  const double high = std::max<double>(texture.copies.height, copies(1, texture.size.height));
  if (wide * high > 1 && !(wide * high * texture.size.area() <= kMostPixels)) {
    problem =
        fmt::format("shows its texture {:.0f} x {:.0f} times, which is not supported", wide, high);
    return {};
  }
  texture.copies = {static_cast<int>(wide), static_cast<int>(high)};
  TexturedMesh::Corners corners;
  for (std::size_t k = 0; k < 3; ++k) {
    corners[k] = pixel_of(at[k], texture.size);
    if (!corners[k].allFinite()) problem = "has a texture coordinate that is too large";
  }
  return corners;
}

void TextureSet::finish(TexturedMesh& mesh) {
  files_.clear();
  double pixels = 0;
  for (const Texture& texture : textures_)
    if (texture.copies.area() > 1)
      pixels += static_cast<double>(texture.copies.area()) * texture.size.area();
  if (pixels > kMostPixels)
    fail_in(file_, "its repeated textures have {:.0f} pixels, more than {:.0f} are not supported",
            pixels, kMostPixels);
  for (Texture& texture : textures_) {
    if (texture.copies.area() > 1 && !texture.image.empty())
      texture.image = with_copies(texture.image, texture.copies, texture.wrap);
    mesh.textures.push_back(std::exchange(texture.image, {}));
  }
  for (std::size_t f = 0; f < mesh.uv.size(); ++f) {
    const Texture& texture = textures_[mesh.texture_of[f]];
    const int below = (texture.copies.height - 1) * texture.size.height;
    if (below == 0) continue;
    for (Eigen::Vector2f& corner : mesh.uv[f]) corner.y() += static_cast<float>(below);
  }
}

std::uint64_t TextureSet::bytes() const {
  std::uint64_t all = 0, largest = largest_decoding_;
  for (const Texture& texture : textures_) {
    const std::uint64_t picture = 3 * static_cast<std::uint64_t>(texture.size.width) *
                                  static_cast<std::uint64_t>(texture.size.height);
    const auto copies = static_cast<std::uint64_t>(texture.copies.area());
    all += picture * copies;
    if (copies > 1) largest = std::max(largest, picture);
  }
  return all + largest;
}

}  // namespace axial::io
