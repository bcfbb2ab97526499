// SPDX-License-Identifier: GPL-3.0-or-later
// Where in the images of a scene a mesh or a cloud appears.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>

#include "belong/shape.h"
#include "scene/sparse_places.h"

namespace axial::belong {

// The part of an image in which a shape appears, as cells of a grid.
struct Coverage {
  double cell = 0;           // side of a cell [px]; 0: too few parts appear in the image
  cv::Mat1b covered;         // 255: the cell contains a part, and so do the cells around it
  double spacing = 0;        // square root of the area that covers one part [px]
  std::size_t in_image = 0;  // number of the sampled parts that appear in the image

  bool contains(const Eigen::Vector2d& pixel) const;
};

// Finds the cells of an image in which the middles of parts appear. `parts`: the sampled parts of
// the shape. Parts that others hide count, too. The cells are so large that they contain 12 sampled
// parts on average, and at least 1/32 of the longer side of the image. With fewer than 100 sampled
// parts in the image, no cell is covered. Precondition: the image is calibrated.
Coverage coverage_of(const Scene& scene, SceneCameras& cameras, std::uint32_t image,
                     const Shape& shape, std::span<const std::size_t> parts);

}  // namespace axial::belong
