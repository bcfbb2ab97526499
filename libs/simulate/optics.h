// SPDX-License-Identifier: GPL-3.0-or-later
// The path of light from a pixel into the water, interface by interface with Snell's law in vector
// form. On purpose independent of `refractive/`: the two check each other.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace axial::simulate {

// How a lens departs from the pinhole, as OpenCV defines it for perspective lenses (k1 k2 p1 p2)
// and for fisheyes (k1 k2 k3 k4).
struct Bend {
  bool fisheye = false;
  std::array<double, 4> k{};
};

// A lens in air: u = focal * x/z + cx, bent where it is; pixel centres at integers; camera axes x
// right, y down, z forward.
struct Lens {
  int width = 0, height = 0;
  double focal = 0;  // [px]
  double cx = 0, cy = 0;
  std::optional<Bend> bend = {};
};

// The pixel of a direction with z > 0, and the unit direction of a pixel. Precondition of both:
// check_lens.
Eigen::Vector2d pixel_of(const Lens& lens, const Eigen::Vector3d& direction);
Eigen::Vector3d direction_of(const Lens& lens, double u, double v);

// Error that names the coefficients unless every pixel of the image's outline has a direction that
// pixel_of brings back, and the lens folds back nowhere before it.
void check_lens(const Lens& lens);

// Square pixels, principal point in the image centre. Error unless 1 <= width, height and
// 1 <= horizontal_fov_degrees <= 150.
Lens make_lens(int width, int height, double horizontal_fov_degrees);

// A dome's shape in the camera frame, metres.
struct Dome {
  Eigen::Vector3d centre{0, 0, 0};
  double inner_radius = 0.05;
};

// A flat port in the camera frame, metres, or a dome. A dry camera is the absence of a port.
struct Port {
  Eigen::Vector3d normal{0, 0, 1};  // unit, from the camera to the water
  double distance = 0;              // camera centre to the inner plane
  double thickness = 0;
  double n_air = 1, n_glass = 1, n_water = 1;
  std::optional<Dome> dome = {};  // in place of the planes: normal and distance mean nothing
  bool is_surface = false;        // of the water itself: the camera may be high above it
};

// Unit normal of a port tilted by the given angle, towards the right and bottom of the image.
Eigen::Vector3d tilted_normal(double tilt_degrees);

// Error that names the value: distance, radius or thickness outside [0, 1] m, an index below 1 or
// above 4, a camera outside its dome or not above the water, a corner of the image whose light does
// not meet the port from inside.
void check_port(const Port& port, const Lens& lens);

// x_in_camera = rotation * (x_in_world - centre).
struct View {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
};

// The calm surface of water that stands `level` metres high in the world (z up), as `view` has it.
Port surface_port(double level, const View& view, double n_air, double n_water);

// A pixel's ray in the scene medium.
struct SceneRay {
  Eigen::Vector3d start;  // where it enters the scene medium: outer face of the glass, or centre
  Eigen::Vector3d direction;  // unit
  Eigen::Vector3d on_axis;    // where its line meets the camera's axis (C_v); dry: the centre
};

// Snell's law: `direction` and `normal` of unit length, direction . normal > 0. Nothing on total
// reflection.
std::optional<Eigen::Vector3d> refract(const Eigen::Vector3d& direction,
                                       const Eigen::Vector3d& normal, double n_from, double n_to);

// The ray of pixel (u, v) in the camera frame; `port` null for a dry camera. Nothing where no light
// passes (pixel looks away from the port, total reflection).
std::optional<SceneRay> trace_pixel(const Lens& lens, const Port* port, double u, double v);

SceneRay to_world(const View& view, const SceneRay& in_camera);

}  // namespace axial::simulate
