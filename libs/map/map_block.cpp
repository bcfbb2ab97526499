// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/map_block.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/order_statistics.h"
#include "base/plane_cross.h"
#include "map/geotiff.h"
#include "scene/bilinear.h"

namespace axial::map {
namespace {

bool has_known_color(const TexturedMesh::Corners& uv) {
  return uv[0] != uv[1] || uv[0] != uv[2];
}

// The colours of a mesh at samples of a map. Neighbouring samples often show the same face, so the
// corners of the last face are kept.
class Painter {
 public:
  explicit Painter(const MapContent& content) : content_(content) {}

  // Adds the colour B G R to `sum`. Returns false if it is not known.
  bool add_color(std::uint32_t face, const Eigen::Vector2d& place, Eigen::Vector3f& sum) {
    const TexturedMesh& mesh = content_.mesh;
    if (face == kNoFace || !has_known_color(mesh.uv[face])) return false;
    if (face != face_) {
      face_ = face;
      corners_ = corners_of(mesh.mesh, face, content_.frame, content_.grid);
    }
    const Eigen::Vector3f w = weights_at(corners_, place).cast<float>();
    const TexturedMesh::Corners& uv = mesh.uv[face];
    sum +=
        bilinear(mesh.textures[mesh.texture_of[face]], w[0] * uv[0] + w[1] * uv[1] + w[2] * uv[2]);
    return true;
  }

 private:
  const MapContent& content_;
  std::uint32_t face_ = kNoFace;
  FaceCorners corners_;
};

std::uint8_t level(float value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 255.0f) + 0.5f);
}

// `border`: pixels of `surface` around the block on each side.
void paint(const MapContent& content, const SurfaceBlock& surface, int border, MapBlock& block) {
  block.colors = cv::Mat4b(block.pixels.size(), cv::Vec4b(0, 0, 0, 0));
  Painter painter(content);
  const int n = surface.samples;
  for (int y = 0; y < block.colors.rows; ++y)
    for (int x = 0; x < block.colors.cols; ++x) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      int known = 0;
      for (int j = (y + border) * n; j < (y + border + 1) * n; ++j)
        for (int i = (x + border) * n; i < (x + border + 1) * n; ++i)
          known += painter.add_color(surface.face(j, i), surface.place(j, i), sum);
      if (2 * known < n * n) continue;
      sum /= static_cast<float>(known);
      block.colors(y, x) = {level(sum[2]), level(sum[1]), level(sum[0]), 255};
    }
}

// The heights at the centres of the pixels of `surface`, above the origin of MapFrame.
cv::Mat1f centre_heights(const SurfaceBlock& surface) {
  const int n = surface.samples;
  cv::Mat1f heights(surface.heights.rows / n, surface.heights.cols / n);
  for (int y = 0; y < heights.rows; ++y)
    for (int x = 0; x < heights.cols; ++x)
      heights(y, x) = surface.heights(y * n + n / 2, x * n + n / 2);
  return heights;
}

std::uint8_t shade_at(const cv::Mat1f& heights, int y, int x, double pixel) {
  const float middle = heights(y, x);
  const auto at = [&](int dy, int dx) {
    const float height = heights(y + dy, x + dx);
    return static_cast<double>(std::isnan(height) ? middle : height);
  };
  const double right = at(-1, 1) + 2 * at(0, 1) + at(1, 1);
  const double left = at(-1, -1) + 2 * at(0, -1) + at(1, -1);
  const double above = at(-1, -1) + 2 * at(-1, 0) + at(-1, 1);
  const double below = at(1, -1) + 2 * at(1, 0) + at(1, 1);
  const Eigen::Vector3d normal =
      Eigen::Vector3d(left - right, below - above, 8 * pixel).normalized();
  const Eigen::Vector3d light = Eigen::Vector3d(-0.5, 0.5, std::sqrt(0.5));
  return static_cast<std::uint8_t>(1.5 + 254 * std::clamp(normal.dot(light), 0.0, 1.0));
}

void fill(const MapContent& content, const SurfaceBlock& surface, int border, MapBlock& block) {
  const cv::Mat1f heights = centre_heights(surface);
  const int n = surface.samples;
  block.heights = cv::Mat1f(block.pixels.size(), kNoHeight);
  block.shades = cv::Mat1b(block.pixels.size(), std::uint8_t{0});
  if (!content.views.empty()) block.counts = cv::Mat1w(block.pixels.size(), kNoCount);
  if (!content.errors.empty()) block.errors = cv::Mat1f(block.pixels.size(), kNoHeight);
  for (int y = 0; y < block.heights.rows; ++y)
    for (int x = 0; x < block.heights.cols; ++x) {
      const int v = y + border, u = x + border;
      if (std::isnan(heights(v, u))) continue;
      block.is_empty = false;
      block.heights(y, x) = static_cast<float>(heights(v, u) + content.frame.origin.z());
      block.shades(y, x) = shade_at(heights, v, u, content.grid.pixel);
      const std::uint32_t face = surface.face(v * n + n / 2, u * n + n / 2);
      if (!content.views.empty()) block.counts(y, x) = content.views[face];
      if (!content.errors.empty()) block.errors(y, x) = content.errors[face];
    }
}

}  // namespace

void check_content(const MapContent& content) {
  const TexturedMesh& mesh = content.mesh;
  const std::size_t faces = mesh.mesh.faces.size();
  if (!content.views.empty() && content.views.size() != faces)
    fail("there are {} numbers of views for {} faces", content.views.size(), faces);
  if (!content.errors.empty() && content.errors.size() != faces)
    fail("there are {} expected errors for {} faces", content.errors.size(), faces);
  if (mesh.textures.empty()) return;
  if (mesh.uv.size() != faces || mesh.texture_of.size() != faces)
    fail("{} faces have {} texture coordinates and {} texture numbers", faces, mesh.uv.size(),
         mesh.texture_of.size());
  for (std::size_t f = 0; f < faces; ++f) {
    if (mesh.texture_of[f] >= mesh.textures.size() || mesh.textures[mesh.texture_of[f]].empty())
      fail("face {} has no texture {}", f, mesh.texture_of[f]);
    for (const Eigen::Vector2f& uv : mesh.uv[f])
      if (!uv.allFinite()) fail("face {} has a texture coordinate that is not finite", f);
  }
}

int samples_per_pixel(const MapContent& content) {
  std::vector<double> widths;
  widths.reserve(bytes_of_samples(content) / sizeof(double));
  for (std::uint32_t f = 0; f < content.mesh.mesh.faces.size() && !content.mesh.textures.empty();
       ++f) {
    const TexturedMesh::Corners& uv = content.mesh.uv[f];
    if (!has_known_color(uv)) continue;
    const auto at = corners_of(content.mesh.mesh, f, content.frame, content.grid).at;
    const Eigen::Vector2d a = at.col(1) - at.col(0), b = at.col(2) - at.col(0);
    const Eigen::Vector2d s = (uv[1] - uv[0]).cast<double>(), t = (uv[2] - uv[0]).cast<double>();
    const double pixels = std::abs(plane_cross(a, b));
    if (pixels > 0) widths.push_back(std::abs(plane_cross(s, t)) / pixels);
  }
  if (widths.empty()) return 1;
  const double wanted = 1.5 * std::sqrt(upper_median(std::move(widths)));
  int samples = 1;
  while (samples < wanted && samples < 9) samples += 2;
  return samples;
}

std::uint64_t bytes_of_samples(const MapContent& content) {
  return content.mesh.textures.empty() ? 0 : content.mesh.mesh.faces.size() * sizeof(double);
}

MapBlock make_block(const MapContent& content, const FaceBins& bins, std::size_t block,
                    int samples) {
  constexpr int kBorder = 1;  // for the shades
  MapBlock result;
  result.pixels = bins.pixels(block);
  if (bins.faces(block).empty()) return result;
  const cv::Rect& at = result.pixels;
  const cv::Rect wider(at.x - kBorder, at.y - kBorder, at.width + 2 * kBorder,
                       at.height + 2 * kBorder);
  const SurfaceBlock surface = look_from_above(content.mesh.mesh, content.frame, content.grid,
                                               wider, samples, bins.faces(block));
  fill(content, surface, kBorder, result);
  if (content.mesh.textures.empty()) return result;
  paint(content, surface, kBorder, result);
  for (const cv::Vec4b& color : result.colors) result.is_empty &= color[3] == 0;
  return result;
}

std::uint64_t bytes_of_block(int block_size, int samples) {
  const auto side = static_cast<std::uint64_t>(block_size + 2);
  const auto per_pixel = static_cast<std::uint64_t>(8 * samples * samples + 4 + 4 + 4 + 4 + 2 + 1);
  return side * side * per_pixel;
}

}  // namespace axial::map
