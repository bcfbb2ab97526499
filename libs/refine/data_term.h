// SPDX-License-Identifier: GPL-3.0-or-later
// The photometric part of the system: how well the views agree, and how the agreement changes when
// vertices move along their normals.
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "refine/raster.h"
#include "refine/refine.h"
#include "refine/visibility.h"

namespace axial::refine {

// The normal equations of one face. `matrix`: the entries 00, 01, 02, 11, 12, 22 of the symmetric
// matrix of its three corners. The displacements t of a Gauss-Newton step solve matrix * t = right.
struct FaceEquations {
  std::array<float, 6> matrix{};
  std::array<float, 3> right{};
};

// The sum of the weighted squared residuals, and the number of residuals.
struct Residuals {
  double squared = 0;
  std::uint64_t count = 0;
};

// One reference view. The arguments of the constructor must outlive it.
class ReferenceView {
 public:
  ReferenceView(const Mesh& mesh, const Shape& shape, std::span<const VertexImage> images,
                Raster raster, cv::Mat1f picture, cv::Mat1b mask);

  struct Source {
    std::span<const VertexImage> images;
    const cv::Mat1f& picture;
    const cv::Mat1b& mask;
    std::size_t view;
  };

  // Adds the pair with `source`. `reference`: the index of this view.
  Residuals add(const Source& source, std::size_t reference, const Visibility& visibility);

  // Adds the equations of all pairs so far to those of the faces. Call it once.
  void finish(std::span<FaceEquations> equations) const;

 private:
  // The image of a vertex in the source view, and its motion there [px] when the vertex recedes by
  // one mesh unit along the ray of the reference view. x is NaN if not both views see the vertex.
  struct PairVertex {
    float x, y, motion_x, motion_y;
  };

  void match_vertices(const Source& source, std::size_t reference, const Visibility& visibility);
  void warp_row(const Source& source, int y);
  Residuals compare();
  void add_face(std::size_t face, FaceEquations& sum) const;

  const Mesh& mesh_;
  const Shape& shape_;
  std::vector<Eigen::Vector3f> rays_;  // of vertices, in the mesh's frame
  Raster raster_;
  Lists pixels_;
  cv::Mat2f corners_;  // Barycentric of every pixel with a face
  cv::Mat1f picture_;
  cv::Mat1b mask_;
  std::vector<PairVertex> pair_;
  // Of every pixel in the present pair: the source's grey level (NaN: none), and its derivative by
  // the distance of the pixel's point.
  cv::Mat1f warped_, slope_;
  // Sums over the pairs: w g^2 and -w g e for g = slope.
  cv::Mat1f weight_, pull_;
};

}  // namespace axial::refine
