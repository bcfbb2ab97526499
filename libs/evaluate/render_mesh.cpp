// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/render_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "scene/bilinear.h"

namespace axial::evaluate {
namespace {

Eigen::Vector3f as_bgr(const Rgb& color) {
  return {static_cast<float>(color[2]), static_cast<float>(color[1]), static_cast<float>(color[0])};
}

cv::Vec3b rounded(const Eigen::Vector3f& bgr) {
  const auto level = [](float value) {
    return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 255.0f) + 0.5f);
  };
  return {level(bgr[0]), level(bgr[1]), level(bgr[2])};
}

// Calls visit(x, y, i, hit) for every ray of every pixel, where `i` counts the rays of a pixel and
// `hit` is nothing if the ray meets no face. Rows are visited concurrently.
template <class Visit>
void for_each_ray(const geometry::Surface& surface, const View& view, const RenderOptions& options,
                  const Visit& visit) {
  if (options.samples < 1 || options.samples > 16)
    fail("samples is {}: must be between 1 and 16", options.samples);
  const auto offset = [&](int i) { return (i + 0.5) / options.samples - 0.5; };
  const Eigen::Matrix3d to_world = view.pose.rotation.transpose();
  const auto cast_row = [&](const auto& camera, int y) {
    for (int x = 0; x < view.camera.width; ++x)
      for (int i = 0; i < options.samples * options.samples; ++i) {
        const Eigen::Vector2d pixel(x + offset(i % options.samples),
                                    y + offset(i / options.samples));
        const Eigen::Vector3d direction = to_world * camera.ray(pixel).direction;
        const Eigen::Vector3d from = view.pose.to_world(camera.exit_point(pixel));
        const bool has_light = from.allFinite() && direction.allFinite();
        visit(x, y, i, has_light ? surface.first_hit(from, direction) : std::nullopt);
      }
  };
  std::visit(
      [&](const auto& camera) {
        parallel_for(static_cast<std::size_t>(view.camera.height),
                     [&](std::size_t row) { cast_row(camera, static_cast<int>(row)); });
      },
      make_camera<double>(view.camera));
}

cv::Mat1b full_mask(const View& view) {
  return cv::Mat1b(view.camera.height, view.camera.width, std::uint8_t{255});
}

}  // namespace

Coloring texture_coloring(const TexturedMesh& mesh) {
  if (mesh.uv.size() != mesh.texture_of.size())
    fail("the mesh has {} texture coordinates and {} texture numbers", mesh.uv.size(),
         mesh.texture_of.size());
  for (const std::uint32_t texture : mesh.texture_of)
    if (texture >= mesh.textures.size() || mesh.textures[texture].empty())
      fail("the mesh has no texture {}", texture);
  return [&mesh](const geometry::SurfaceHit& hit) -> SurfaceColor {
    const TexturedMesh::Corners& uv = mesh.uv[hit.face];
    const Eigen::Vector2f at = uv[0] + hit.u * (uv[1] - uv[0]) + hit.v * (uv[2] - uv[0]);
    const bool is_known = uv[0] != uv[1] || uv[0] != uv[2];
    return {bilinear(mesh.textures[mesh.texture_of[hit.face]], at), is_known};
  };
}

Coloring vertex_coloring(std::span<const std::array<std::uint32_t, 3>> faces,
                         std::span<const Rgb> colors) {
  for (const auto& face : faces)
    for (const std::uint32_t corner : face)
      if (corner >= colors.size()) fail("vertex {} of the mesh has no colour", corner);
  return [faces, colors](const geometry::SurfaceHit& hit) -> SurfaceColor {
    const auto& [a, b, c] = faces[hit.face];
    return {(1 - hit.u - hit.v) * as_bgr(colors[a]) + hit.u * as_bgr(colors[b]) +
            hit.v * as_bgr(colors[c])};
  };
}

RenderedView render_mesh(const geometry::Surface& surface, const Coloring& coloring,
                         const View& view, const RenderOptions& options) {
  RenderedView result{cv::Mat3b(view.camera.height, view.camera.width), full_mask(view),
                      full_mask(view)};
  cv::Mat3f sums(result.image.size(), cv::Vec3f(0, 0, 0));
  const Eigen::Vector3f background = as_bgr(options.background);
  for_each_ray(surface, view, options,
               [&](int x, int y, int, const std::optional<geometry::SurfaceHit>& hit) {
                 const SurfaceColor color = hit ? coloring(*hit) : SurfaceColor{background, false};
                 if (!hit) result.covered(y, x) = 0;
                 if (!color.is_known) result.known(y, x) = 0;
                 sums(y, x) += cv::Vec3f(color.bgr[0], color.bgr[1], color.bgr[2]);
               });
  const float weight = 1.0f / static_cast<float>(options.samples * options.samples);
  for (int y = 0; y < sums.rows; ++y)
    for (int x = 0; x < sums.cols; ++x) {
      const cv::Vec3f mean = sums(y, x) * weight;
      result.image(y, x) = rounded({mean[0], mean[1], mean[2]});
    }
  return result;
}

cv::Mat1b covered_pixels(const geometry::Surface& surface, const View& view,
                         const RenderOptions& options) {
  cv::Mat1b covered = full_mask(view);
  for_each_ray(surface, view, options,
               [&](int x, int y, int, const std::optional<geometry::SurfaceHit>& hit) {
                 if (!hit) covered(y, x) = 0;
               });
  return covered;
}

PictureDifference& PictureDifference::operator+=(const PictureDifference& other) {
  pixels += other.pixels;
  squared_sum += other.squared_sum;
  absolute_sum += other.absolute_sum;
  return *this;
}

double PictureDifference::mean() const {
  return pixels > 0 ? absolute_sum / (3 * static_cast<double>(pixels)) : 0;
}

double PictureDifference::psnr() const {
  if (pixels == 0) return std::numeric_limits<double>::quiet_NaN();
  const double squared = squared_sum / (3 * static_cast<double>(pixels));
  return 10 * std::log10(255.0 * 255.0 / squared);
}

PictureDifference compare_pictures(const cv::Mat3b& picture, const cv::Mat3b& photograph,
                                   const cv::Mat1b& mask) {
  if (picture.size() != photograph.size() || picture.size() != mask.size())
    fail("pictures of {} x {} and {} x {} pixels cannot be compared", picture.cols, picture.rows,
         photograph.cols, photograph.rows);
  PictureDifference difference;
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) {
      if (mask(y, x) == 0) continue;
      ++difference.pixels;
      for (int c = 0; c < 3; ++c) {
        const double d = static_cast<double>(picture(y, x)[c]) - photograph(y, x)[c];
        difference.squared_sum += d * d;
        difference.absolute_sum += std::abs(d);
      }
    }
  return difference;
}

}  // namespace axial::evaluate
