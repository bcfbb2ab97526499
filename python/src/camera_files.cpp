// SPDX-License-Identifier: GPL-3.0-or-later
// Housings, and cameras in files of COLMAP and Calibmar.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "base/error.h"
#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"
#include "io/colmap/colmap_lens.h"
#include "src/arrays.h"
#include "src/bind.h"
#include "src/camera.h"
#include "src/stage.h"

namespace axial::python {
namespace {

namespace fs = std::filesystem;

// The camera of a file, with its port. Throws an Error that names the file and the camera.
Camera camera_of(const io::ColmapCamera& from, const fs::path& file) {
  const std::string where = fmt::format("{}: camera {}", file.string(), from.id);
  constexpr std::uint64_t kLargest = 1u << 16;
  if (from.width > kLargest || from.height > kLargest)
    fail("{}: size {} x {} is out of range", where, from.width, from.height);
  CameraModel model;
  model.width = static_cast<int>(from.width);
  model.height = static_cast<int>(from.height);
  model.port = from.port;
  const lens::Lens lens = io::lens_of(from);
  model.lens = lens.pinhole;
  if (!pinhole_lens(lens)) {
    model.distortion = lens_distortion(lens);
    if (!model.distortion) fail("{}: the model {} has no polynomial form", where, from.model);
  }
  return {model, where};
}

std::map<std::uint32_t, Camera> read_cameras(const fs::path& path) {
  std::map<std::uint32_t, Camera> cameras;
  const auto read =
      logged([&](const Context& context) { return io::read_colmap_cameras(path, context); });
  for (const io::ColmapCamera& camera : read) cameras.emplace(camera.id, camera_of(camera, path));
  return cameras;
}

io::Housing make_housing(std::map<std::string, io::HousingPort> ports, std::string default_port,
                         std::map<std::uint32_t, std::string> cameras,
                         std::map<std::string, std::string> images) {
  return {std::move(ports), std::move(default_port), std::move(cameras), std::move(images)};
}

void bind_water_surface(py::module_& module) {
  py::class_<WaterSurface>(module, "WaterSurface",
                           "The calm surface of the water, fixed in the world, seen from the air.")
      .def(py::init(
               [](const py::object& normal, const py::object& point, double n_air, double n_water) {
                 return WaterSurface{vector_argument(normal, "normal"),
                                     vector_argument(point, "point"), n_air, n_water};
               }),
           py::kw_only(), py::arg("normal"), py::arg("point"), py::arg("n_air") = 1.0,
           py::arg("n_water") = 1.333)
      .def_property_readonly("normal", [](const WaterSurface& of) { return to_array(of.normal); })
      .def_property_readonly("point", [](const WaterSurface& of) { return to_array(of.point); })
      .def_readonly("n_air", &WaterSurface::n_air)
      .def_readonly("n_water", &WaterSurface::n_water);
}

}  // namespace

void bind_camera_files(py::module_& module) {
  using io::Housing;
  bind_water_surface(module);
  py::class_<Housing>(module, "Housing", "The ports of the images of a scene or a COLMAP model.")
      .def(py::init(&make_housing), py::arg("ports"), py::arg("default_port") = "none",
           py::arg("cameras") = std::map<std::uint32_t, std::string>(),
           py::arg("images") = std::map<std::string, std::string>())
      .def_readonly("ports", &Housing::ports)
      .def_readonly("default_port", &Housing::default_port)
      .def_readonly("cameras", &Housing::cameras)
      .def_readonly("images", &Housing::images)
      .def("port_of", &Housing::port_of, py::arg("image_name"), py::arg("camera_id") = 0)
      .def("carried_port", &Housing::carried_port, py::arg("name"));
  module.def(
      "read_housing",
      [](const fs::path& path) {
        return logged([&](const Context& context) {
          return io::read_housing(path, io::PortValues::checked, context);
        });
      },
      py::arg("path"));
  module.def("write_housing", &io::write_housing, py::arg("path"), py::arg("housing"));
  module.def("read_cameras", &read_cameras, py::arg("path"));
}

}  // namespace axial::python
