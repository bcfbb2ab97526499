// SPDX-License-Identifier: GPL-3.0-or-later
// Renders a mesh into the view of a camera, in air or behind a port, and compares the picture with
// a photograph from this view.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <opencv2/core.hpp>

#include "axial/scene_images.h"
#include "evaluate/views.h"
#include "geometry/surface.h"

namespace axial::evaluate {

struct SurfaceColor {
  Eigen::Vector3f bgr;   // B G R [grey levels, 0 to 255]
  bool is_known = true;  // false: the mesh has no colour here, and `bgr` stands for that
};

// Returns the colour at a place of the surface. Called concurrently.
using Coloring = std::function<SurfaceColor(const geometry::SurfaceHit&)>;

// Returns the colours of the texture, interpolated bilinearly between the centres of the texels. A
// place beyond the outermost centres has the colour of the nearest place between them. A face whose
// three corners have the same texture coordinates has no known colour: TextureMesh writes such
// faces where no view saw the mesh. The result refers to `mesh`, whose member `mesh` is not used.
// Error unless uv and texture_of have as many entries and each texture_of names a texture with
// pixels.
Coloring texture_coloring(const TexturedMesh& mesh);

// Returns the colours `colors` of the vertices, interpolated linearly inside the faces. The result
// refers to `faces` and `colors`. Error if a face refers to a vertex without colour.
Coloring vertex_coloring(std::span<const std::array<std::uint32_t, 3>> faces,
                         std::span<const Rgb> colors);

struct RenderOptions {
  int samples = 3;                // see render_mesh(); 1 to 16
  Rgb background{255, 255, 255};  // where the mesh is not hit
};

// A picture with the size of the view's camera. The masks are 255 or 0.
struct RenderedView {
  cv::Mat3b image;    // B G R
  cv::Mat1b covered;  // every ray of the pixel meets the mesh
  cv::Mat1b known;    // every ray of the pixel meets the mesh where its colour is known
};

// Renders the mesh of `surface`. Each pixel is the mean of `samples` x `samples` rays, which lie on
// a regular grid in the area of the pixel. So the colours of the mesh are averaged over the
// footprint of the pixel, as in a photograph. A ray has the exact path of light of the view's
// camera: it begins where the light enters the water (behind a port, on the outer face of the
// glass; in air, at the camera centre), and ends at the first face that it meets, from either side.
// Light is not attenuated, and faces are not shaded. Error if RenderOptions::samples is out of
// range.
RenderedView render_mesh(const geometry::Surface& surface, const Coloring& coloring,
                         const View& view, const RenderOptions& options = {});

// Returns the mask RenderedView::covered alone.
cv::Mat1b covered_pixels(const geometry::Surface& surface, const View& view,
                         const RenderOptions& options = {});

// Sums of the differences of grey levels between two pictures. The differences of the three
// channels of a pixel count separately.
struct PictureDifference {
  std::size_t pixels = 0;  // that were compared
  double squared_sum = 0, absolute_sum = 0;

  PictureDifference& operator+=(const PictureDifference& other);

  // The mean absolute difference [grey levels]; 0 without pixels.
  double mean() const;

  // The peak signal-to-noise ratio 10 log10(255^2 / mean squared difference) [dB]. Infinite for
  // equal pictures; NaN without pixels.
  double psnr() const;
};

// Compares the pixels where `mask` is not 0. Error if the sizes differ.
PictureDifference compare_pictures(const cv::Mat3b& picture, const cv::Mat3b& photograph,
                                   const cv::Mat1b& mask);

}  // namespace axial::evaluate
