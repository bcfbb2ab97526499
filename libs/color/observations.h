// SPDX-License-Identifier: GPL-3.0-or-later
// The same points of a surface in many photographs.
#pragma once

#include <Eigen/Core>
#include <array>
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
  // Unit, of the way in water, from the camera to the surface, in the frame of the mesh.
  Eigen::Vector3f direction = Eigen::Vector3f::Zero();
  float height = 0;  // of the surface, along the upward direction of SeenSurface [m]
};

// A point of the surface in a photograph.
struct Observation {
  std::uint32_t point = 0, view = 0;
  Sight sight;
  Eigen::Array3f light;   // linear R G B, 0 to 1; NaN: clipped
  Eigen::Array3f spread;  // of the light in the neighbourhood: the largest difference
  // No face is between the point and places 0.4 m beside, above and below the camera: lamps near
  // the camera cast no shadow on the point.
  bool open = true;
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

// Every `step`-th point, from the point `first` on.
Observations every(std::size_t step, std::size_t first, const Observations& observations);

// Only the observations that are open. Points may have one observation, or none.
Observations without_shadows(const Observations& observations);

// Returns the light of a photograph (R G B, marked by mark_unusable()), of the size of its camera.
using LightSource = std::function<cv::Mat3f(std::size_t view)>;

struct ObserveOptions {
  std::size_t points = 12000;  // on the surface: on the rays of a grid of pixels in each view
  int longest_side = 640;      // of photographs after they are reduced [px]
  double least_cosine = 0.25;  // between the surface's normal and the light's way
  // Side of the piece of the surface over which light is averaged: in pixels of the first reduced
  // photograph if it was taken in air from the median way. In all photographs the same piece is
  // averaged. If more were averaged from afar, the texture would have less contrast there, as if
  // light was lost. Water blurs: with small pieces, the blur looks like a veil.
  double window = 12;
};

// Where the pixels of a camera see the surface, row by row. Place and direction are always set.
// Sight::way is 0 where the ray meets no face, or a face that no camera sees (Mesh::unseen).
struct SightImage {
  SightImage(int columns, int rows)
      : width(columns),
        height(rows),
        all(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}

  Sight& at(int x, int y) { return all[static_cast<std::size_t>(y * width + x)]; }
  const Sight& at(int x, int y) const { return all[static_cast<std::size_t>(y * width + x)]; }

  int width, height;
  std::vector<Sight> all;
};

class LightPyramid;

// The surface in the photographs of a survey.
class SeenSurface {
 public:
  // `mesh` must outlive the object. `up`: unit, in the frame of the mesh, or zero: all heights are
  // 0 then. Errors as for geometry::Surface.
  explicit SeenSurface(const Mesh& mesh, const Eigen::Vector3d& up = Eigen::Vector3d::Zero());

  // Looks at points of the surface in all photographs, even over the images. Points whose piece of
  // the surface is uneven by more than an eighth of its side are left out. A camera sees a point if
  // its piece is in the image, its middle 2 px from the border or more, if its face is turned
  // towards the camera, and if no face crosses the way of the light to the middle or to a corner.
  // Photographs are reduced by areas, in linear light. Points that fewer than two photographs see
  // are left out. The result does not depend on the number of threads.
  Observations observe(std::span<const geometry::PosedCamera> cameras, const LightSource& lights,
                       const ObserveOptions& options, const Context& context) const;

  // The memory [bytes] of observe(), besides the photographs, if a point is in 20 of them.
  static std::uint64_t bytes_to_observe(const ObserveOptions& options);

  SightImage sights(const geometry::PosedCamera& camera) const;

 private:
  // A point of the surface.
  struct Point {
    Eigen::Vector3d place, face_normal;
    Eigen::Vector3f normal;                      // smooth
    std::array<Eigen::Vector3d, 16> patch = {};  // places on the surface around the point
  };
  // Of a camera whose ray leaves the port at `from` [world].
  Sight sight_of(const Point& point, const Eigen::Vector3d& from, const Eigen::Vector2d& pixel,
                 const geometry::PosedCamera& posed) const;
  // Sets Point::patch: places of a square of this half side [m]. False if the surface is not even.
  bool set_patch(double half_side, Point& point) const;
  bool is_open(const Point& point, const Eigen::Vector3d& from, const Pose& pose) const;
  bool is_hidden(const Point& point, const Eigen::Vector3d& from) const;
  std::optional<Point> on_ray(const Eigen::Vector3d& start, const Eigen::Vector3d& direction) const;
  std::vector<Point> points_in(const geometry::PosedCamera& posed, std::size_t count,
                               std::vector<double>& ways) const;
  template <class Camera>
  std::vector<Observation> observed(const Camera& camera, const geometry::PosedCamera& posed,
                                    std::span<const Point> points, const LightPyramid& light,
                                    const ObserveOptions& options, double half_side) const;

  const Mesh& mesh_;
  Eigen::Vector3d up_;
  geometry::Surface surface_;
  std::vector<Eigen::Vector3f> normals_;  // at vertices
};

// The memory [bytes] of a SeenSurface of `mesh` while it is made.
std::uint64_t bytes_to_see(const Mesh& mesh);

// The place of a pixel in Sight::place.
Eigen::Vector2f place_of(const Eigen::Vector2d& pixel, const CameraModel& camera);

}  // namespace axial::color
