// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/optics.h"

#include <Eigen/Geometry>
#include <cmath>

#include "base/error.h"

namespace axial::simulate {
namespace {

struct PortPath {
  Eigen::Vector3d exit;  // on the outer plane
  Eigen::Vector3d in_water;
};

// The point where a ray that starts inside a sphere leaves it.
Eigen::Vector3d leave_sphere(const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                             const Eigen::Vector3d& centre, double radius) {
  const Eigen::Vector3d offset = from - centre;
  const double along = offset.dot(direction);
  return from +
         (std::sqrt(along * along + radius * radius - offset.squaredNorm()) - along) * direction;
}

std::optional<PortPath> pass_dome(const Port& port, const Eigen::Vector3d& in_air) {
  const Eigen::Vector3d& centre = port.dome->centre;
  const double inner = port.dome->inner_radius;
  const Eigen::Vector3d on_inner = leave_sphere(Eigen::Vector3d::Zero(), in_air, centre, inner);
  const auto in_glass = refract(in_air, (on_inner - centre) / inner, port.n_air, port.n_glass);
  if (!in_glass) return std::nullopt;
  const double outer = inner + port.thickness;
  const Eigen::Vector3d on_outer = leave_sphere(on_inner, *in_glass, centre, outer);
  const auto in_water = refract(*in_glass, (on_outer - centre) / outer, port.n_glass, port.n_water);
  if (!in_water) return std::nullopt;
  return PortPath{on_outer, *in_water};
}

std::optional<PortPath> pass_port(const Port& port, const Eigen::Vector3d& in_air) {
  if (port.dome) return pass_dome(port, in_air);
  const double rise = in_air.dot(port.normal);
  if (!(rise > 1e-6)) return std::nullopt;
  const Eigen::Vector3d on_inner = in_air * (port.distance / rise);
  const auto in_glass = refract(in_air, port.normal, port.n_air, port.n_glass);
  if (!in_glass) return std::nullopt;
  const Eigen::Vector3d on_outer =
      on_inner + *in_glass * (port.thickness / in_glass->dot(port.normal));
  const auto in_water = refract(*in_glass, port.normal, port.n_glass, port.n_water);
  if (!in_water) return std::nullopt;
  return PortPath{on_outer, *in_water};
}

// The point of the line through the origin along `axis` that is nearest to the line of the ray in
// water.
Eigen::Vector3d foot_on_axis(const PortPath& path, const Eigen::Vector3d& axis) {
  const double c = axis.dot(path.in_water);
  const double sin2 = axis.cross(path.in_water).squaredNorm();
  const double along = (axis.dot(path.exit) - c * path.in_water.dot(path.exit)) / sin2;
  return axis * along;
}

// The unit axis, on the side to which the light goes. Zero for a centred dome, where all rays pass
// through the centre.
Eigen::Vector3d axis_of(const Port& port, const Eigen::Vector3d& in_air) {
  if (!port.dome) return port.normal;
  if (port.dome->centre.norm() < 1e-9) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d axis = port.dome->centre.normalized();
  return axis.dot(in_air) > 0 ? axis : Eigen::Vector3d(-axis);
}

}  // namespace

Lens make_lens(int width, int height, double horizontal_fov_degrees) {
  if (width < 1 || width > 20000) fail("width is {}: must be between 1 and 20000", width);
  if (height < 1 || height > 20000) fail("height is {}: must be between 1 and 20000", height);
  if (!(horizontal_fov_degrees >= 1 && horizontal_fov_degrees <= 150))
    fail("field of view is {} degrees: must be between 1 and 150", horizontal_fov_degrees);
  const double focal = 0.5 * width / std::tan(0.5 * horizontal_fov_degrees * kRadians);
  return {width, height, focal, 0.5 * (width - 1), 0.5 * (height - 1)};
}

Eigen::Vector3d tilted_normal(double tilt_degrees) {
  const double across = std::sin(tilt_degrees * kRadians);
  return {0.8 * across, 0.6 * across, std::cos(tilt_degrees * kRadians)};
}

void check_port(const Port& port, const Lens& lens) {
  if (port.is_surface && !(port.distance > 0))
    fail("the camera is {} m above the water surface: must be positive", port.distance);
  if (!port.is_surface && !(port.distance >= 0 && port.distance <= 1))
    fail("port distance is {} m: must be between 0 and 1", port.distance);
  if (port.dome && !(port.dome->inner_radius > 0 && port.dome->inner_radius <= 1))
    fail("dome radius is {} m: must be above 0 and at most 1", port.dome->inner_radius);
  if (port.dome && !(port.dome->centre.norm() < port.dome->inner_radius))
    fail("the dome's centre is {} m from the camera, its radius is {}", port.dome->centre.norm(),
         port.dome->inner_radius);
  if (!(port.thickness >= 0 && port.thickness <= 1))
    fail("port thickness is {} m: must be between 0 and 1", port.thickness);
  for (const double n : {port.n_air, port.n_glass, port.n_water})
    if (!(n >= 1 && n <= 4)) fail("refractive index is {}: must be between 1 and 4", n);
  for (const double u : {-0.5, lens.width - 0.5})
    for (const double v : {-0.5, lens.height - 0.5})
      if (!trace_pixel(lens, &port, u, v))
        fail("the port does not cover the image corner at pixel ({}, {})", u, v);
}

Port surface_port(double level, const View& view, double n_air, double n_water) {
  Port port{-view.rotation.col(2), view.centre.z() - level, 0, n_air, n_water, n_water};
  port.is_surface = true;
  return port;
}

std::optional<Eigen::Vector3d> refract(const Eigen::Vector3d& direction,
                                       const Eigen::Vector3d& normal, double n_from, double n_to) {
  const double ratio = n_from / n_to;
  // The component along the interface is scaled by the ratio of the indices.
  const Eigen::Vector3d along = ratio * (direction - direction.dot(normal) * normal);
  const double rest = 1.0 - along.squaredNorm();
  if (!(rest > 0)) return std::nullopt;
  return along + std::sqrt(rest) * normal;
}

std::optional<SceneRay> trace_pixel(const Lens& lens, const Port* port, double u, double v) {
  const Eigen::Vector3d in_air = direction_of(lens, u, v);
  if (!port) return SceneRay{Eigen::Vector3d::Zero(), in_air, Eigen::Vector3d::Zero()};
  const auto path = pass_port(*port, in_air);
  if (!path) return std::nullopt;
  const Eigen::Vector3d axis = axis_of(*port, in_air);
  if (axis.isZero()) return SceneRay{path->exit, path->in_water, Eigen::Vector3d::Zero()};
  // A ray along the axis meets it everywhere. The result is the limit for neighbouring rays,
  // approximated by one of them; its error is of second order in the step.
  constexpr double kStep = 1e-4;
  if (path->in_water.cross(axis).norm() >= kStep)
    return SceneRay{path->exit, path->in_water, foot_on_axis(*path, axis)};
  const Eigen::Vector3d aside = axis.unitOrthogonal();
  const auto near = pass_port(*port, (axis + 2 * kStep * aside).normalized());
  if (!near) return std::nullopt;
  return SceneRay{path->exit, path->in_water, foot_on_axis(*near, axis)};
}

SceneRay to_world(const View& view, const SceneRay& in_camera) {
  const auto turn = view.rotation.transpose();
  return {turn * in_camera.start + view.centre, turn * in_camera.direction,
          turn * in_camera.on_axis + view.centre};
}

}  // namespace axial::simulate
