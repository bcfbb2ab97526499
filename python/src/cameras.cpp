// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras for many points or pixels at once. Each function works on whole arrays, without Python's
// lock.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <limits>

#include "base/error.h"
#include "refractive/virtual_camera.h"
#include "src/arrays.h"
#include "src/bind.h"
#include "src/camera.h"
#include "survey/memory_survey.h"

namespace axial::python {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using refractive::Port;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Calls `work(camera, i)` for the camera of its own type and for i from 0 to n - 1, without
// Python's lock.
template <class Work>
void for_each(const Camera& camera, py::ssize_t n, Work work) {
  const py::gil_scoped_release unlocked;
  std::visit(
      [&](const auto& own) {
        for (py::ssize_t i = 0; i < n; ++i) work(own, i);
      },
      camera.camera);
}

template <int N>
Eigen::Map<const Eigen::Matrix<double, N, 1>> row(const double* rows, py::ssize_t i) {
  return Eigen::Map<const Eigen::Matrix<double, N, 1>>(rows + N * i);
}

template <int N>
void set_row(double* rows, py::ssize_t i, const Eigen::Matrix<double, N, 1>& value) {
  Eigen::Map<Eigen::Matrix<double, N, 1>>(rows + N * i) = value;
}

py::tuple project(const Camera& camera, const py::object& points) {
  const auto given = array_argument<double>(points, "points", {kAny, 3});
  const py::ssize_t n = given.shape(0);
  Array<double> pixels({n, py::ssize_t{2}});
  Array<bool> valid(n);
  const double* from = given.data();
  double* to = pixels.mutable_data();
  bool* seen = valid.mutable_data();
  for_each(camera, n, [=](const auto& own, py::ssize_t i) {
    const auto image = own.project(Vector3d(row<3>(from, i)));
    seen[i] = image.visible;
    set_row<2>(to, i, image.visible ? image.pixel : Vector2d(kNaN, kNaN));
  });
  return py::make_tuple(pixels, valid);
}

Array<double> jacobian(const Camera& camera, const py::object& points) {
  const auto given = array_argument<double>(points, "points", {kAny, 3});
  const py::ssize_t n = given.shape(0);
  Array<double> result({n, py::ssize_t{2}, py::ssize_t{3}});
  const double* from = given.data();
  double* to = result.mutable_data();
  for_each(camera, n, [=](const auto& own, py::ssize_t i) {
    refractive::Matrix23<double> by;
    if (!own.project(Vector3d(row<3>(from, i)), &by).visible) by.setConstant(kNaN);
    Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>>(to + 6 * i) = by;
  });
  return result;
}

py::tuple unproject(const Camera& camera, const py::object& pixels) {
  const auto given = array_argument<double>(pixels, "pixels", {kAny, 2});
  const py::ssize_t n = given.shape(0);
  Array<double> origins({n, py::ssize_t{3}}), directions({n, py::ssize_t{3}});
  const double* from = given.data();
  double *origin = origins.mutable_data(), *direction = directions.mutable_data();
  for_each(camera, n, [=](const auto& own, py::ssize_t i) {
    const auto ray = own.ray(Vector2d(row<2>(from, i)));
    set_row<3>(origin, i, ray.origin);
    set_row<3>(direction, i, ray.direction);
  });
  return py::make_tuple(origins, directions);
}

Array<double> exit_points(const Camera& camera, const py::object& pixels) {
  const auto given = array_argument<double>(pixels, "pixels", {kAny, 2});
  const py::ssize_t n = given.shape(0);
  Array<double> result({n, py::ssize_t{3}});
  const double* from = given.data();
  double* to = result.mutable_data();
  for_each(camera, n, [=](const auto& own, py::ssize_t i) {
    set_row<3>(to, i, own.exit_point(Vector2d(row<2>(from, i))));
  });
  return result;
}

Array<double> path_lengths(const Camera& camera, const py::object& points) {
  const auto given = array_argument<double>(points, "points", {kAny, 3});
  Array<double> result(given.shape(0));
  const double* from = given.data();
  double* to = result.mutable_data();
  for_each(camera, given.shape(0), [=](const auto& own, py::ssize_t i) {
    const Vector3d X = row<3>(from, i);
    const auto image = own.project(X);
    to[i] = image.visible ? (X - own.exit_point(image.pixel)).norm() : kNaN;
  });
  return result;
}

// The axes of the virtual cameras of `camera`, from its frame.
refractive::Matrix3<double> virtual_rotation(const Camera& camera) {
  if (const auto& port = camera.model.port)
    if (const auto* flat = std::get_if<refractive::FlatPort<double>>(&*port))
      return refractive::axis_from_camera(flat->normal);
  return refractive::Matrix3<double>::Identity();
}

py::tuple virtual_cameras(const Camera& camera, const py::object& pixels) {
  const auto given = array_argument<double>(pixels, "pixels", {kAny, 2});
  const py::ssize_t n = given.shape(0);
  Array<double> centres({n, py::ssize_t{3}}), principal({n, py::ssize_t{2}});
  const refractive::Matrix3<double> rotation = virtual_rotation(camera);
  const auto& lens = camera.model.lens;
  const double* from = given.data();
  double *centre = centres.mutable_data(), *point = principal.mutable_data();
  for_each(camera, n, [&](const auto& own, py::ssize_t i) {
    const Vector2d pixel = row<2>(from, i);
    const auto of_pixel = refractive::virtual_camera(lens, rotation, own.ray(pixel), pixel);
    set_row<3>(centre, i, of_pixel.centre);
    set_row<2>(point, i, {of_pixel.lens.cx, of_pixel.lens.cy});
  });
  return py::make_tuple(centres, to_array(Eigen::Matrix3d(rotation)), principal);
}

std::string camera_text(const Camera& camera) {
  const CameraModel& model = camera.model;
  return fmt::format("Camera({}, width={}, height={}, port={})",
                     text_of(Lens{model.lens, model.distortion}), model.width, model.height,
                     model.port ? text_of(*model.port) : "None");
}

void bind_methods(py::class_<Camera>& type) {
  type.def(
          "project", &project, py::arg("points"),
          "Exact images of points (N, 3) [camera frame, m]: pixels (N, 2), and whether light of a\n"
          "point reaches the lens (N,). A pixel is NaN if it does not, and it may lie outside of\n"
          "the image.")
      .def("jacobian", &jacobian, py::arg("points"),
           "Derivatives of the pixels by the points (N, 3): (N, 2, 3) [px/m]. NaN as in project().")
      .def("path_lengths", &path_lengths, py::arg("points"),
           "Lengths [m] of the paths of light in the water, from the points (N, 3) to the port: "
           "(N,).\n"
           "Without a port: from the points to the camera centre. NaN as in project().")
      .def("unproject", &unproject, py::arg("pixels"),
           "Rays of pixels (N, 2) in the water: origins on the axis of the camera (N, 3) [camera\n"
           "frame, m], and unit directions (N, 3).")
      .def("exit_points", &exit_points, py::arg("pixels"),
           "Where the rays of pixels (N, 2) enter the water: (N, 3) [camera frame, m].")
      .def("virtual_cameras", &virtual_cameras, py::arg("pixels"),
           "The pinholes that image the rays of pixels (N, 2) at these pixels: centres (N, 3)\n"
           "[camera frame, m], the rotation from the camera frame (3, 3), and principal points\n"
           "(N, 2) [px]. The focal lengths are those of the lens.")
      .def(
          "resized",
          [](const Camera& camera, int width, int height) {
            return Camera(camera.model.resized(width, height), "Camera");
          },
          py::arg("width"), py::arg("height"), "The camera of the image at another size [px].");
}

}  // namespace

Camera::Camera(const CameraModel& of, const std::string& where) : model(of) {
  survey::check_camera(model, where);
  if (model.distortion && !(distorted_lens<double>(model).field > 0))
    fail("{}.lens: the distortion mirrors the image", where);
  camera = make_camera<double>(model);
}

void bind_cameras(py::module_& module) {
  py::class_<Camera> type(module, "Camera", "A lens in air, behind a port or without one.");
  type.def(py::init([](const Lens& lens, int width, int height,
                       const std::optional<Port<double>>& port) {
             return Camera({width, height, lens.pinhole, port, lens.distortion}, "Camera");
           }),
           py::arg("lens"), py::kw_only(), py::arg("width"), py::arg("height"),
           py::arg("port") = py::none())
      .def_property_readonly("width", [](const Camera& camera) { return camera.model.width; })
      .def_property_readonly("height", [](const Camera& camera) { return camera.model.height; })
      .def_property_readonly("lens",
                             [](const Camera& camera) {
                               return Lens{camera.model.lens, camera.model.distortion};
                             })
      .def_property_readonly("port", [](const Camera& camera) { return camera.model.port; })
      .def("__repr__", [](const Camera& camera) { return camera_text(camera); });
  bind_methods(type);
}

}  // namespace axial::python
