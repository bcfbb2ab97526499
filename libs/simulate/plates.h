// SPDX-License-Identifier: GPL-3.0-or-later
// Plates with black and white patterns on the seabed.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "simulate/render.h"
#include "simulate/triangle_mesh.h"

namespace axial::simulate {

// A square slab.
struct Plate {
  Eigen::Vector3d centre;  // of the upper side [world, m]
  // Columns: to the right and down for a reader of the pattern, and into the ground.
  Eigen::Matrix3d axes;
  double side = 0.1;  // [m]
  // True where the pattern is white. x to the right and y down, from -1 to 1.
  std::function<bool(double x, double y)> white = {};
};

struct PlateLayout {
  std::size_t single = 0;    // number of single plates
  std::vector<double> bars;  // distances of the centres of pairs of plates [m]
  double side = 0.1;         // [m]
  std::uint64_t seed = 1;
};

// Lays plates at random places that the views see, flat on the ground and without a touch: first
// the single plates, then the two plates of each bar. The plates of a bar lie in one plane. The
// patterns stay empty: set them before with_plates(). `ground` is seen without a port. Throws an
// Error if a bar is shorter than 1.6 sides, and if there is no room. Precondition: there are views.
std::vector<Plate> lay_plates(const RayScene& ground, const Lens& lens, std::span<const View> views,
                              const PlateLayout& layout);

// The plates as slabs, with kPlateFaces faces for each.
inline constexpr std::uint32_t kPlateFaces = 10;
TriangleMesh plate_mesh(std::span<const Plate> plates);

// A shader for a mesh whose faces from `first_face` on are plate_mesh(plates): the pattern on the
// upper sides, matt and averaged over the footprint
// of a ray, with `samples` rays along each side of a pixel; `ground` elsewhere.
Shader with_plates(Shader ground, std::vector<Plate> plates, std::uint32_t first_face, int samples);

// The image of a plate in a view. Pixel centres are integers.
struct PlateImage {
  Eigen::Vector2d centre;  // the image of the plate's centre [px]
  double width = 0;        // square root of the area of the plate's image [px]
  double oblique = 0;      // between the plate's normal and the ray to the centre [rad]
};

// The pixels of places on the upper side of `plate`, in the coordinates of Plate::white, whether
// they are hidden or not. Nothing if one has none. Pixel centres are integers. `port`: in the
// camera frame of `view`; null for a dry camera.
std::optional<std::vector<Eigen::Vector2d>> pixels_of(const Plate& plate,
                                                      std::span<const Eigen::Vector2d> places,
                                                      const Lens& lens, const Port* port,
                                                      const View& view);

// The image of `plate`, or nothing if a part of the plate is outside of the photograph or a part
// of its upper side, which is sampled at 9 x 9 places, is hidden. `scene` contains the plate.
// `port`: as above.
std::optional<PlateImage> image_of(const Plate& plate, const RayScene& scene, const Lens& lens,
                                   const Port* port, const View& view);

}  // namespace axial::simulate
