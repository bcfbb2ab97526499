// SPDX-License-Identifier: GPL-3.0-or-later
// The surface of a mesh as a map sees it from above: heights and visible faces in blocks of a map.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "geometry/lists.h"
#include "map/frame.h"
#include "scene/mesh.h"

namespace axial::map {

inline constexpr std::uint32_t kNoFace = 0xFFFFFFFFu;

// Where the three corners of a face lie in a map. All functions of this library compute the corners
// with corners_of(), so that faces with a common vertex get the same numbers.
struct FaceCorners {
  // Column and row of the corners, in pixels from the upper left corner of the map. The centre of
  // pixel (column, row) is at (column + 0.5, row + 0.5).
  Eigen::Matrix<double, 2, 3> at;
  Eigen::Vector3d height;  // above MapFrame::origin [m]
};
FaceCorners corners_of(const Mesh& mesh, std::uint32_t face, const MapFrame& frame,
                       const MapGrid& grid);

// The faces that may be visible in each block of a map. The blocks are squares of `block_size`
// pixels; those at the right and the lower edge may be smaller.
class FaceBins {
 public:
  FaceBins(const Mesh& mesh, const MapFrame& frame, const MapGrid& grid, int block_size);

  // The blocks in rows from above, and their number.
  std::size_t blocks() const { return faces_.begin.size() - 1; }
  // The pixels of a block.
  cv::Rect pixels(std::size_t block) const;
  // The faces whose bounding box touches the block or a pixel beside it, in increasing order.
  std::span<const std::uint32_t> faces(std::size_t block) const { return faces_.of(block); }

  // The memory [bytes] of the object for this mesh and grid.
  static std::uint64_t bytes(const Mesh& mesh, const MapFrame& frame, const MapGrid& grid,
                             int block_size);

 private:
  int columns_, rows_, block_size_, block_columns_;
  geometry::Lists<std::uint32_t, std::uint64_t> faces_;
};

// The surface at samples of a block. Each pixel has `samples` x `samples` samples in a regular
// grid. `samples` is odd, so that one of them lies at the centre of the pixel.
struct SurfaceBlock {
  cv::Rect pixels;
  int samples = 1;
  cv::Mat1f heights;    // above MapFrame::origin [m]; NaN where the mesh has no surface
  cv::Mat_<int> faces;  // the face that is visible at the sample, as int; kNoFace as -1

  std::uint32_t face(int y, int x) const { return static_cast<std::uint32_t>(faces(y, x)); }
  // The place of sample (x, y), in pixels from the upper left corner of the map.
  Eigen::Vector2d place(int y, int x) const {
    // One rounding each, so that the place does not depend on the block.
    return {(double{1} * pixels.x * samples + x + 0.5) / samples,
            (double{1} * pixels.y * samples + y + 0.5) / samples};
  }
};

// Finds at each sample the highest point of the mesh on the vertical line through the sample, from
// either side of the faces. Of faces with the same height, the one with the lowest index is
// visible. A sample on the common edge of two faces meets at least one of them, so that no gaps
// appear between faces. Vertical faces meet no sample. The result of a sample does not depend on
// the block that contains it.
SurfaceBlock look_from_above(const Mesh& mesh, const MapFrame& frame, const MapGrid& grid,
                             const cv::Rect& pixels, int samples,
                             std::span<const std::uint32_t> faces);

// The weights of the corners of a face at a sample of the face: they are at least 0, and their sum
// is 1.
Eigen::Vector3d weights_at(const FaceCorners& corners, const Eigen::Vector2d& place);

}  // namespace axial::map
