// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/data_term.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "refine/window_sums.h"

namespace axial::refine {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

// Keys' cubic convolution (1981, a = -1/2) of four samples, and its derivative, at `f` from 0 to 1
// between the second and the third one.
struct Cubic {
  explicit Cubic(float f) {
    const float g = 1 - f;
    value = {-0.5f * f * g * g, 1 + f * f * (1.5f * f - 2.5f), 1 + g * g * (1.5f * g - 2.5f),
             -0.5f * g * f * f};
    slope = {-0.5f * g * (g - 2 * f), f * (4.5f * f - 5), -g * (4.5f * g - 5),
             -0.5f * f * (2 * g - f)};
  }
  std::array<float, 4> value, slope;
};

// The grey level and its derivatives at a position that has two pixels on each side.
struct Sample {
  float value, dx, dy;
};
Sample sample(const cv::Mat1f& image, float x, float y) {
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const Cubic across(x - static_cast<float>(left)), down(y - static_cast<float>(top));
  Sample result{0, 0, 0};
  for (int k = 0; k < 4; ++k) {
    const float* row = image[top - 1 + k] + left - 1;
    const float v = across.value[0] * row[0] + across.value[1] * row[1] + across.value[2] * row[2] +
                    across.value[3] * row[3];
    const float s = across.slope[0] * row[0] + across.slope[1] * row[1] + across.slope[2] * row[2] +
                    across.slope[3] * row[3];
    const auto j = static_cast<std::size_t>(k);
    result.value += down.value[j] * v;
    result.dx += down.value[j] * s;
    result.dy += down.slope[j] * v;
  }
  return result;
}

bool masked(const cv::Mat1b& mask, float x, float y) {
  return !mask.empty() &&
         mask(static_cast<int>(std::lround(y)), static_cast<int>(std::lround(x))) == 0;
}

}  // namespace

ReferenceView::ReferenceView(const Mesh& mesh, const Shape& shape,
                             std::span<const VertexImage> images, Raster raster, cv::Mat1f picture,
                             cv::Mat1b mask)
    : mesh_(mesh),
      shape_(shape),
      rays_(images.size()),
      raster_(std::move(raster)),
      pixels_(pixels_of_faces(raster_, mesh.faces.size())),
      corners_(raster_.depth.size()),
      picture_(std::move(picture)),
      mask_(std::move(mask)),
      pair_(images.size()),
      warped_(raster_.depth.size()),
      slope_(raster_.depth.size()),
      weight_(raster_.depth.size(), 0.0f),
      pull_(raster_.depth.size(), 0.0f) {
  raster_.depth.release();
  parallel_for(
      rays_.size(),
      [&](std::size_t v) {
        if (images[v].visible()) rays_[v] = images[v].ray();
      },
      kPointGrain);
  parallel_for(static_cast<std::size_t>(corners_.rows), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < corners_.cols; ++x) {
      const std::uint32_t f = raster_.face(x, y);
      if (f == kNoFace) continue;
      const auto& [a, b, c] = mesh_.faces[f];
      const Barycentric at = barycentric(images[a], images[b], images[c], static_cast<float>(x),
                                         static_cast<float>(y));
      corners_(y, x) = {at.b1, at.b2};
    }
  });
}

void ReferenceView::match_vertices(const Source& source, std::size_t reference,
                                   const Visibility& visibility) {
  parallel_for(
      pair_.size(),
      [&](std::size_t v) {
        const VertexImage& image = source.images[v];
        // Both views can have lost a vertex since the visibility was found.
        if (!visibility.seen(v, reference) || !visibility.seen(v, source.view) ||
            !image.visible()) {
          pair_[v].x = kNone;
          return;
        }
        const Eigen::Vector2f motion = image.by_point * rays_[v];
        pair_[v] = {image.x, image.y, motion.x(), motion.y()};
      },
      kPointGrain);
}

void ReferenceView::warp_row(const Source& source, int y) {
  const auto right = static_cast<float>(source.picture.cols - 2);
  const auto bottom = static_cast<float>(source.picture.rows - 2);
  for (int x = 0; x < warped_.cols; ++x) {
    warped_(y, x) = kNone;
    const std::uint32_t f = raster_.face(x, y);
    if (f == kNoFace || (!mask_.empty() && mask_(y, x) == 0)) continue;
    const auto& face = mesh_.faces[f];
    const PairVertex &a = pair_[face[0]], &b = pair_[face[1]], &c = pair_[face[2]];
    const float b1 = corners_(y, x)[0], b2 = corners_(y, x)[1], b0 = 1 - b1 - b2;
    const float u = b0 * a.x + b1 * b.x + b2 * c.x;
    const float v = b0 * a.y + b1 * b.y + b2 * c.y;
    if (!(u >= 1 && v >= 1 && u < right && v < bottom)) continue;
    if (masked(source.mask, u, v)) continue;
    const Sample at = sample(source.picture, u, v);
    warped_(y, x) = at.value;
    slope_(y, x) = at.dx * (b0 * a.motion_x + b1 * b.motion_x + b2 * c.motion_x) +
                   at.dy * (b0 * a.motion_y + b1 * b.motion_y + b2 * c.motion_y);
  }
}

Residuals ReferenceView::compare() {
  std::vector<Residuals> sums(window_bands(warped_.rows));
  parallel_for(sums.size(), [&](std::size_t band) {
    for_each_window(picture_, warped_, band, [&](int x, int y, const Windows& window) {
      if (!window.comparable()) return;
      const float gain = window.gain();
      const float residual = gain * (warped_(y, x) - window.warped_mean()) -
                             (picture_(y, x) - window.reference_mean());
      const float slope = gain * slope_(y, x);
      const float w = window.precision();
      weight_(y, x) += w * slope * slope;
      pull_(y, x) -= w * slope * residual;
      sums[band].squared += w * residual * residual;
      ++sums[band].count;
    });
  });
  Residuals total;
  for (const Residuals& sum : sums) {
    total.squared += sum.squared;
    total.count += sum.count;
  }
  return total;
}

Residuals ReferenceView::add(const Source& source, std::size_t reference,
                             const Visibility& visibility) {
  match_vertices(source, reference, visibility);
  parallel_for(static_cast<std::size_t>(warped_.rows),
               [&](std::size_t y) { warp_row(source, static_cast<int>(y)); });
  return compare();
}

void ReferenceView::add_face(std::size_t f, FaceEquations& sum) const {
  const auto& face = mesh_.faces[f];
  const Eigen::Vector3f normal = face_vector(mesh_, face).normalized();
  // When a corner moves by one along its normal, the face recedes by this along the corner's ray.
  std::array<float, 3> along;
  for (std::size_t k = 0; k < 3; ++k) {
    const float facing = normal.dot(rays_[face[k]]);
    if (!(facing < -kLeastCosine)) return;
    along[k] = normal.dot(shape_.normals[face[k]]) / facing;
  }
  for (const std::uint32_t pixel : pixels_.of(f)) {
    const float w = weight_(static_cast<int>(pixel));
    if (!(w > 0)) continue;
    const float pull = pull_(static_cast<int>(pixel));
    const cv::Vec2f at = corners_(static_cast<int>(pixel));
    const std::array<float, 3> b{(1 - at[0] - at[1]) * along[0], at[0] * along[1],
                                 at[1] * along[2]};
    for (std::size_t k = 0; k < 3; ++k) sum.right[k] += pull * b[k];
    sum.matrix[0] += w * b[0] * b[0], sum.matrix[1] += w * b[0] * b[1];
    sum.matrix[2] += w * b[0] * b[2], sum.matrix[3] += w * b[1] * b[1];
    sum.matrix[4] += w * b[1] * b[2], sum.matrix[5] += w * b[2] * b[2];
  }
}

void ReferenceView::finish(std::span<FaceEquations> equations) const {
  parallel_for(
      mesh_.faces.size(),
      [&](std::size_t f) {
        if (!pixels_.of(f).empty()) add_face(f, equations[f]);
      },
      kPointGrain);
}

}  // namespace axial::refine
