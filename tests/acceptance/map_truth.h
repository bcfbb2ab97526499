// SPDX-License-Identifier: GPL-3.0-or-later
// The true map of a scene of SimulateUnderwater, for map_check.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>

#include "map/frame.h"
#include "simulate/presets/presets.h"
#include "simulate/triangle_mesh.h"

namespace axial::map_check {

struct SimulatedScene {
  simulate::Preset preset;
  simulate::TriangleMesh mesh;
};

// The terrain as vertical rays from above see it, in the pixels of a map.
struct TrueMap {
  cv::Mat1f heights;  // at the centre of the pixel [m]; NaN: no surface
  cv::Mat3b colors;   // R G B, mean of 3 x 3 vertical rays
  cv::Mat1b known;    // 0: not all of these rays meet the surface
  cv::Mat1b frames;   // number of photographs in whose frame the point at the centre is
  cv::Mat1b views;    // number of photographs under water that see the point at the centre
};

// A photograph sees a point if the exact camera projects the point into the image, and if the
// simulator's ray of this pixel meets no surface before the point. Surface that is nearer to the
// point than a thousandth of its distance does not count.
TrueMap true_map(const SimulatedScene& scene, const map::MapGrid& grid);

// Maps (R G B) that show each true point as the photograph shows it whose camera is nearest to the
// point. Pixels in no photograph are black.
struct NearestMaps {
  // Without visibility: a rock may hide the point from the photograph. Beside rocks such a map
  // shows the rocks a second time. 255 in `wrong`: the photograph does not see the point.
  cv::Mat3b naive;
  cv::Mat1b wrong;
  cv::Mat3b visible;  // from the nearest photograph that sees the point
};

// `photographs`: the folder with 0000.jpg and so on.
NearestMaps nearest_maps(const SimulatedScene& scene, const map::MapGrid& grid,
                         const TrueMap& truth, const std::filesystem::path& photographs);

}  // namespace axial::map_check
