// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <pybind11/stl.h>

#include "io/cameras/housing.h"
#include "src/arrays.h"
#include "src/bind.h"
#include "src/camera.h"

namespace axial::python {
namespace {

using refractive::DomePort;
using refractive::FlatPort;
using refractive::LensDistortion;

FlatPort<double> flat_port(double distance, double thickness, double n_glass, double n_water,
                           double n_air, const py::object& normal) {
  FlatPort<double> port{
      vector_argument(normal, "normal"), distance, thickness, n_air, n_glass, n_water};
  if (port.normal.norm() > 0) port.normal.normalize();
  io::check_port(refractive::Port<double>(port), "FlatPort");
  return port;
}

DomePort<double> dome_port(double inner_radius, double thickness, double n_glass, double n_water,
                           double n_air, const py::object& centre) {
  const DomePort<double> port{
      vector_argument(centre, "centre"), inner_radius, thickness, n_air, n_glass, n_water};
  io::check_port(refractive::Port<double>(port), "DomePort");
  return port;
}

void bind_flat_port(py::module_& module) {
  using Port = FlatPort<double>;
  py::class_<Port>(module, "FlatPort",
                   "A plate of glass with parallel faces between the lens and the water.")
      .def(py::init(&flat_port), py::kw_only(), py::arg("distance"), py::arg("thickness"),
           py::arg("n_glass"), py::arg("n_water"), py::arg("n_air") = 1.0,
           py::arg("normal") = py::make_tuple(0.0, 0.0, 1.0))
      .def_readonly("distance", &Port::distance)
      .def_readonly("thickness", &Port::thickness)
      .def_readonly("n_air", &Port::n_air)
      .def_readonly("n_glass", &Port::n_glass)
      .def_readonly("n_water", &Port::n_water)
      .def_property_readonly("normal", [](const Port& port) { return to_array(port.normal); })
      .def(
          "__eq__", [](const Port& a, const Port& b) { return a == b; }, py::is_operator())
      .def("__repr__", [](const Port& port) { return text_of(port); });
}

void bind_dome_port(py::module_& module) {
  using Port = DomePort<double>;
  py::class_<Port>(module, "DomePort", "A spherical shell of glass between the lens and the water.")
      .def(py::init(&dome_port), py::kw_only(), py::arg("inner_radius"), py::arg("thickness"),
           py::arg("n_glass"), py::arg("n_water"), py::arg("n_air") = 1.0,
           py::arg("centre") = py::make_tuple(0.0, 0.0, 0.0))
      .def_readonly("inner_radius", &Port::inner_radius)
      .def_readonly("thickness", &Port::thickness)
      .def_readonly("n_air", &Port::n_air)
      .def_readonly("n_glass", &Port::n_glass)
      .def_readonly("n_water", &Port::n_water)
      .def_property_readonly("centre", [](const Port& port) { return to_array(port.centre); })
      .def(
          "__eq__", [](const Port& a, const Port& b) { return a == b; }, py::is_operator())
      .def("__repr__", [](const Port& port) { return text_of(port); });
}

using Above = std::array<double, 5>;
using Below = std::array<double, 3>;
using Pair = std::array<double, 2>;

Lens make_lens(double fx, double fy, double cx, double cy, bool fisheye, double spread,
               const Above& above, const Below& below, double p1, double p2, const Pair& prism) {
  const LensDistortion<double> distortion{fisheye ? 1.0 : 0.0, spread, above, below, p1, p2,
                                          {prism[0], prism[1]}};
  Lens lens{{fx, fy, cx, cy}, {}};
  if (!(distortion == LensDistortion<double>())) lens.distortion = distortion;
  return lens;
}

void bind_lens(py::module_& module) {
  const auto distortion = [](const Lens& lens) {
    return lens.distortion.value_or(LensDistortion<double>());
  };
  py::class_<Lens>(module, "Lens", "A lens in air, with or without distortion.")
      .def(py::init(&make_lens), py::arg("fx"), py::arg("fy"), py::arg("cx"), py::arg("cy"),
           py::kw_only(), py::arg("fisheye") = false, py::arg("spread") = 1.0,
           py::arg("above") = Above{1, 0, 0, 0, 0}, py::arg("below") = Below{0, 0, 0},
           py::arg("p1") = 0.0, py::arg("p2") = 0.0, py::arg("prism") = Pair{0, 0})
      .def_property_readonly("fx", [](const Lens& lens) { return lens.pinhole.fx; })
      .def_property_readonly("fy", [](const Lens& lens) { return lens.pinhole.fy; })
      .def_property_readonly("cx", [](const Lens& lens) { return lens.pinhole.cx; })
      .def_property_readonly("cy", [](const Lens& lens) { return lens.pinhole.cy; })
      .def_property_readonly("distorted",
                             [](const Lens& lens) { return lens.distortion.has_value(); })
      .def_property_readonly("fisheye", [=](const Lens& of) { return distortion(of).fisheye > 0; })
      .def_property_readonly("spread", [=](const Lens& of) { return distortion(of).spread; })
      .def_property_readonly("above", [=](const Lens& of) { return distortion(of).above; })
      .def_property_readonly("below", [=](const Lens& of) { return distortion(of).below; })
      .def_property_readonly("p1", [=](const Lens& of) { return distortion(of).p1; })
      .def_property_readonly("p2", [=](const Lens& of) { return distortion(of).p2; })
      .def_property_readonly("prism",
                             [=](const Lens& of) {
                               const Eigen::Vector2d prism = distortion(of).prism;
                               return Pair{prism.x(), prism.y()};
                             })
      .def("__repr__", [](const Lens& lens) { return text_of(lens); });
}

std::string vector_text(const Eigen::Vector3d& v) {
  return fmt::format("({}, {}, {})", v.x(), v.y(), v.z());
}

struct PortText {
  std::string operator()(const FlatPort<double>& port) const {
    return fmt::format(
        "FlatPort(distance={}, thickness={}, n_glass={}, n_water={}, n_air={}, normal={})",
        port.distance, port.thickness, port.n_glass, port.n_water, port.n_air,
        vector_text(port.normal));
  }
  std::string operator()(const DomePort<double>& port) const {
    return fmt::format(
        "DomePort(inner_radius={}, thickness={}, n_glass={}, n_water={}, n_air={}, centre={})",
        port.inner_radius, port.thickness, port.n_glass, port.n_water, port.n_air,
        vector_text(port.centre));
  }
};

}  // namespace

std::string text_of(const refractive::Port<double>& port) {
  return std::visit(PortText(), port);
}

std::string text_of(const Lens& lens) {
  const auto& pinhole = lens.pinhole;
  std::string text =
      fmt::format("Lens({}, {}, {}, {}", pinhole.fx, pinhole.fy, pinhole.cx, pinhole.cy);
  if (lens.distortion) {
    const LensDistortion<double>& d = *lens.distortion;
    text +=
        fmt::format(", fisheye={}, spread={}, above=({}), below=({}), p1={}, p2={}, prism=({}, {})",
                    d.fisheye > 0 ? "True" : "False", d.spread, fmt::join(d.above, ", "),
                    fmt::join(d.below, ", "), d.p1, d.p2, d.prism.x(), d.prism.y());
  }
  return text + ")";
}

void bind_ports(py::module_& module) {
  bind_flat_port(module);
  bind_dome_port(module);
  bind_lens(module);
}

}  // namespace axial::python
