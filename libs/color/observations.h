// SPDX-License-Identifier: GPL-3.0-or-later
// The same points of a surface in many photographs.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

#include "axial/base.h"
#include "axial/geometry.h"
#include "geometry/surface.h"
#include "scene/mesh.h"

namespace axial::color {

// Where a camera sees a surface.
struct Sight {
  // In the image: 0 in the middle, and 1 or -1 at the ends of the longer side.
  Eigen::Vector2f place = Eigen::Vector2f::Zero();
  // The length of the light's way in water, from the surface to the outer face of the glass [m].
  float way = 0;
  Eigen::Vector3f normal{0, 0, -1};  // unit, of the surface, in the camera frame
};

// A point of the surface in a photograph.
struct Observation {
  std::uint32_t point = 0, view = 0;
  Sight sight;
  Eigen::Array3f light;   // linear R G B, 0 to 1; NaN: clipped
  Eigen::Array3f spread;  // of the light in the neighbourhood: the largest difference
};

// Sorted by point; the observations of point i are [first[i], first[i + 1]).
struct Observations {
  std::vector<Observation> all;
  std::vector<std::size_t> first;

  std::size_t points() const { return first.empty() ? 0 : first.size() - 1; }
  std::span<const Observation> of(std::size_t point) const {
    return std::span(all).subspan(first[point], first[point + 1] - first[point]);
  }
};

// Returns the light of a photograph (R G B, marked by mark_unusable()), of the size of its camera.
using LightSource = std::function<cv::Mat3f(std::size_t view)>;

struct ObserveOptions {
  std::size_t points = 12000;  // on the surface: on the rays of a grid of pixels in each view
  int longest_side = 640;      // of photographs after they are reduced [px]
  double least_cosine = 0.25;  // between the surface's normal and the light's way
  // Width over which light is averaged: in pixels of the first reduced photograph if it was taken
  // in air from the median way. In all photographs the same piece of the surface is averaged. If
  // more were averaged from afar, the texture would have less contrast there, as if light was lost.
  double window = 6;
};

// Where each pixel of a camera sees the surface. `way` is 0 where the ray meets no face, or a face
// that no camera sees (Mesh::unseen).
struct SightImage {
  cv::Mat1f way;
  cv::Mat3f normal;
};

class LightPyramid;

// The surface in the photographs of a survey.
class SeenSurface {
 public:
  // `mesh` must outlive the object. Errors as for geometry::Surface.
  explicit SeenSurface(const Mesh& mesh);

  // Looks at points of the surface in all photographs, even over the images. A camera sees a point
  // if it projects into the image, 2 px from the border or more, if its face is turned towards the
  // camera, and if no face crosses the way of the light. Photographs are reduced by areas, in
  // linear light. Points that fewer than two photographs see are left out. The result does not
  // depend on the number of threads.
  Observations observe(std::span<const geometry::PosedCamera> cameras, const LightSource& lights,
                       const ObserveOptions& options, const Context& context) const;

  SightImage sights(const geometry::PosedCamera& camera) const;

 private:
  // A point of the surface.
  struct Point {
    Eigen::Vector3d place, face_normal;
    Eigen::Vector3f normal;  // smooth
  };
  std::optional<Point> on_ray(const Eigen::Vector3d& start, const Eigen::Vector3d& direction) const;
  std::vector<Point> points_in(const geometry::PosedCamera& posed, std::size_t count,
                               std::vector<double>& ways) const;
  template <class Camera>
  std::vector<Observation> observed(const Camera& camera, const geometry::PosedCamera& posed,
                                    std::span<const Point> points, const LightPyramid& light,
                                    const ObserveOptions& options, double width) const;

  const Mesh& mesh_;
  geometry::Surface surface_;
  std::vector<Eigen::Vector3f> normals_;  // at vertices
};

// The memory [bytes] of a SeenSurface of `mesh` while it is made.
std::uint64_t bytes_to_see(const Mesh& mesh);

// The place of a pixel in Sight::place.
Eigen::Vector2f place_of(const Eigen::Vector2d& pixel, const CameraModel& camera);

}  // namespace axial::color
