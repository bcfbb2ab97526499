// SPDX-License-Identifier: GPL-3.0-or-later
// How well a mesh or a cloud fits the sparse points of a scene, in pixels.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "belong/shape.h"
#include "scene/scene.h"
#include "scene/sparse_places.h"

namespace axial::belong {

// The numbers on which the check of a shape rests. A sample of at most 2,000 sparse points is
// measured. A sparse point counts if the shape appears around its pixel in one of at most 16 images
// (coverage.h), so that a part of a mesh fits as well as the whole mesh. The distance of a sparse
// point is the largest distance between its pixel and the pixel of the nearest point of the shape,
// in the images that see the sparse point. So an uncertain depth of a sparse point whose rays are
// nearly parallel does not count.
struct SurfaceFit {
  std::size_t places = 0;   // sparse points in the sample
  std::size_t counted = 0;  // of these: where the shape appears
  double distance = 0;      // median [px]; kFarthest: that or more. 0 if counted is 0
  double spacing = 0;       // of the faces or points of the shape in the images: median [px]
};

inline constexpr double kFarthest = 60;  // the largest distance that is measured [px]

// A change of the positions of sparse points, for tests whether the shape has other units or axes
// than the scene.
using PlaceChange = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

class SurfaceMeasure {
 public:
  // Chooses the sample. `scene` must outlive the object.
  explicit SurfaceMeasure(const Scene& scene);

  // Number of sparse points in the sample.
  std::size_t places() const { return places_.size(); }

  // Measures a shape in the frame of the scene.
  SurfaceFit fit(const Shape& shape);

  // Whether the median distance of the sparse points from the shape is at most `largest` [px] if
  // change(position) takes the place of positions and undo(change(x)) is x. All places of the
  // sample count. `scale`: the factor by which `change` multiplies distances. A hundred places are
  // measured first, so that a shape that does not fit takes little time. Precondition: places() is
  // not 0.
  bool fits_changed(const Shape& shape, const PlaceChange& change, const PlaceChange& undo,
                    double scale, double largest);

 private:
  std::vector<double> distances(const Shape& shape, const std::vector<std::size_t>& of,
                                const PlaceChange& change, const PlaceChange& undo, double scale);
  double distance_in_images(const SparsePlace& place, const Eigen::Vector3d& point);
  double footprint(const SparsePlace& place);

  const Scene& scene_;
  SceneCameras cameras_;
  std::vector<SparsePlace> places_;
  double reach_ = 0;  // farther from the places, nothing is searched for
};

}  // namespace axial::belong
