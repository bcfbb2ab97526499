// SPDX-License-Identifier: GPL-3.0-or-later
// The photometric part of the system: the residuals between views, and the change of the residuals
// when vertices move along their normals. The symbols e, w and g are those of refine.h.
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "axial/refine.h"
#include "refine/raster.h"
#include "refine/visibility.h"

namespace axial::refine {

// The contribution of one face to the normal equations of a Gauss-Newton step: matrix * t = right.
// The unknowns t are the displacements of the face's three corners along their normals [mesh
// units]. `matrix` holds the entries 00, 01, 02, 11, 12 and 22 of the symmetric 3 x 3 matrix.
struct FaceEquations {
  std::array<float, 6> matrix{};
  std::array<float, 3> right{};
};

// The sum of the squared residuals w e^2, and the number of residuals.
struct Residuals {
  double squared = 0;
  std::uint64_t count = 0;
};

// Compares one reference view with its source views.
class ReferenceView {
 public:
  // `images`: the images of the mesh's vertices in the reference view. `raster`: the mesh drawn
  // into the reference view. `picture` (0 to 255) and `mask` (empty, or 0 where pixels are not
  // used): the pixels of the reference view, in the size of `raster`. `mesh` and `shape` must
  // outlive the object.
  ReferenceView(const Mesh& mesh, const Shape& shape, std::span<const VertexImage> images,
                Raster raster, cv::Mat1f picture, cv::Mat1b mask);

  // A source view.
  struct Source {
    std::span<const VertexImage> images;  // of the mesh's vertices in the source view
    const cv::Mat1f& picture;             // grey levels, 0 to 255
    const cv::Mat1b& mask;                // empty, or 0 where pixels are not used
    std::size_t view;                     // index of the source view
  };

  // Compares the reference view with `source`, and adds the result to the sums over the pairs.
  // `reference`: the index of the reference view. `visibility`: which views see which vertices, by
  // the two indices. Returns the residuals of this pair.
  Residuals add(const Source& source, std::size_t reference, const Visibility& visibility);

  // Adds the sums over all pairs to `equations`, which has one entry per face of the mesh. Nothing
  // is added for faces that the reference view sees at a grazing angle (kLeastCosine in
  // visibility.h). Call finish() once, after the last add().
  void finish(std::span<FaceEquations> equations) const;

 private:
  // x, y: the image of a vertex in the source view [px]. motion_x, motion_y: the motion of this
  // image [px] when the vertex moves by one mesh unit along the reference view's ray, away from the
  // camera. x is NaN unless both views see the vertex.
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
  geometry::Lists<> pixels_;
  cv::Mat2f corners_;  // Barycentric of every pixel with a face
  cv::Mat1f picture_;
  cv::Mat1b mask_;
  std::vector<PairVertex> pair_;
  // For every pixel of the reference view, in the current pair. warped_: the grey level of the
  // source view at the pixel's point on the mesh (NaN: none). slope_: the derivative of this grey
  // level by the distance of the point along the ray of the reference view.
  cv::Mat1f warped_, slope_;
  // Sums over the pairs for every pixel. weight_: sum of w g^2. pull_: sum of -w g e. Here g is
  // slope_ times the gain of the window (window_sums.h).
  cv::Mat1f weight_, pull_;
};

}  // namespace axial::refine
