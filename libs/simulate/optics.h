// SPDX-License-Identifier: GPL-3.0-or-later
// The path of light from a pixel into the water, one interface after the other, with Snell's law in
// vector form. The code uses nothing of `refractive/`, so that tests can check the two
// implementations against each other.
#pragma once

#include <Eigen/Core>
#include <array>
#include <numbers>
#include <optional>

namespace axial::simulate {

inline constexpr double kRadians = std::numbers::pi / 180;  // radians per degree

// The distortion of a lens, as OpenCV defines it: cv::projectPoints for perspective lenses,
// cv::fisheye for fisheyes. `k` holds k1 k2 p1 p2 for perspective lenses, and k1 k2 k3 k4 for
// fisheyes.
struct Bend {
  bool fisheye = false;
  std::array<double, 4> k{};
};

// A lens in air. Without distortion, the direction (x, y, z) has the pixel (u, v) with
// u = focal * x/z + cx and v = focal * y/z + cy. Pixel centres are at integers. Camera axes: x
// right, y down, z forward.
struct Lens {
  int width = 0, height = 0;      // of the image [px]
  double focal = 0;               // [px]
  double cx = 0, cy = 0;          // principal point [px]
  std::optional<Bend> bend = {};  // empty: no distortion
};

// pixel_of() projects a direction with z > 0 to its pixel. direction_of() returns the unit
// direction of a pixel. Directions are in the camera frame. Precondition of both: check_lens()
// accepts the lens.
Eigen::Vector2d pixel_of(const Lens& lens, const Eigen::Vector3d& direction);
Eigen::Vector3d direction_of(const Lens& lens, double u, double v);

// Checks the lens at samples along the border of the image, corners included. Each sampled pixel
// must have a direction that pixel_of() maps back to the pixel, and the lens must not mirror the
// image between the optical axis and this direction. Otherwise throws an Error that names the
// coefficients and the pixel. Lenses without distortion pass.
void check_lens(const Lens& lens);

// Makes a lens without distortion, with square pixels and the principal point in the image centre.
// The image is `horizontal_fov_degrees` wide, from the left edge to the right edge. Throws an Error
// unless width and height are 1 to 20000 and horizontal_fov_degrees is 1 to 150.
Lens make_lens(int width, int height, double horizontal_fov_degrees);

// The inner sphere of a dome in the camera frame [m].
struct Dome {
  Eigen::Vector3d centre{0, 0, 0};
  double inner_radius = 0.05;
};

// A flat port, a dome or a water surface in the camera frame [m]. A camera without a port is dry.
struct Port {
  Eigen::Vector3d normal{0, 0, 1};  // unit, from the camera to the water
  double distance = 0;              // from the camera centre to the inner face of the glass
  double thickness = 0;             // of the glass
  double n_air = 1, n_glass = 1, n_water = 1;  // refractive indices
  std::optional<Dome> dome = {};  // if set, the port is a dome; normal and distance are not used
  bool is_surface = false;        // the port is the water surface, possibly far away
};

// The unit normal [camera frame] of a port that is tilted by the given angle towards the lower
// right of the image. 0: the optical axis.
Eigen::Vector3d tilted_normal(double tilt_degrees);

// Throws an Error that names the value in these cases:
// - The port is a water surface and the camera is not above it.
// - The port is no water surface and its distance is outside 0 to 1 m.
// - The thickness is outside 0 to 1 m.
// - The inner radius of a dome is not above 0 or is above 1 m, or the camera centre is outside the
//   dome.
// - A refractive index is outside 1 to 4.
// - The ray of an image corner, the outer corner of the corner pixel, does not pass the port.
void check_port(const Port& port, const Lens& lens);

// The pose of a camera in the world: x_in_camera = rotation * (x_in_world - centre).
struct View {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  int camera = 0;  // 1: the second camera of a rig (second_camera.h)
};

// The calm water surface at the height `level` [m] in the world (z up), as a port in the camera
// frame of `view`. The distance is negative if the camera is under water; check_port() refuses this
// port.
Port surface_port(double level, const View& view, double n_air, double n_water);

// The ray of a pixel in the scene medium [m]. The scene medium contains the imaged points: water
// behind a port, air for a dry camera. The ray is in the frame that the function which returns it
// names.
struct SceneRay {
  // Where the ray enters the scene medium: on the outer face of the glass. Dry: the camera centre.
  Eigen::Vector3d start;
  Eigen::Vector3d direction;  // unit
  // Where the line of the ray meets the camera's axis (C_v). The axis runs through the camera
  // centre, along the normal of a flat port or through the centre of a dome. Dry, or for a dome
  // around the camera centre: the camera centre.
  Eigen::Vector3d on_axis;
};

// Returns the refracted unit direction by Snell's law, or nothing on total reflection. The light
// passes from the medium with the index `n_from` into the medium with the index `n_to`. `direction`
// and `normal` are of unit length, with direction . normal > 0.
std::optional<Eigen::Vector3d> refract(const Eigen::Vector3d& direction,
                                       const Eigen::Vector3d& normal, double n_from, double n_to);

// Returns the ray of pixel (u, v) in the camera frame. `port` is null for a dry camera. Returns
// nothing if the pixel looks away from the port, or if the light is totally reflected.
std::optional<SceneRay> trace_pixel(const Lens& lens, const Port* port, double u, double v);

// Returns the ray `in_camera`, which is in the camera frame of `view`, in the world frame.
SceneRay to_world(const View& view, const SceneRay& in_camera);

}  // namespace axial::simulate
