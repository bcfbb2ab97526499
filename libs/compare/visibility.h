// SPDX-License-Identifier: GPL-3.0-or-later
// Which places of a map both surveys have seen.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>

#include "base/progress.h"
#include "map/frame.h"
#include "map/pixel_width.h"
#include "scene/mesh.h"

namespace axial::compare {

// A survey with its photographs, whose poses are in the frame of the mesh. `frame`: of the mesh.
struct SeenSurvey {
  const Mesh& mesh;
  map::MapFrame frame;
  std::span<const geometry::PosedCamera> photos;
};

// Sets `unseen` to 255 at the pixels that too few photographs of the survey see. A photograph sees
// a point if the point is in the image, at least a pixel from its border, and if the mesh of the
// survey does not hide it. Crossings of the mesh within `slack` [m] from the point do not hide it.
// `own` and `other`: the heights of the survey and of the other one above `base` [map, m].
// At a pixel, at least `least` photographs must see the surface of the survey. If the surface of
// the other survey is higher there, at least `least` photographs must see its point, too, although
// the mesh has no surface there: otherwise the survey does not show whether this space was free.
// Pixels where one of the surveys has no height, and pixels that are 255 already, stay as they are.
// `progress` counts rows. The memory besides the arguments is geometry::bytes_of_surface().
void mark_unseen(const SeenSurvey& survey, const map::MapGrid& grid, double base,
                 const cv::Mat1f& own, const cv::Mat1f& other, int least, double slack,
                 const ProgressSink& progress, cv::Mat1b& unseen);

}  // namespace axial::compare
