// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of the module _axialmvs: each function adds the types and functions of one idea.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace axial::python {

namespace py = pybind11;

// A text with names of files, whose bytes need not be UTF-8.
py::str text_of_file_system(const std::string& text);

void bind_errors(py::module_& module);        // Error and Stopped
void bind_ports(py::module_& module);         // FlatPort, DomePort and Lens
void bind_cameras(py::module_& module);       // Camera
void bind_camera_files(py::module_& module);  // housings, cameras of COLMAP and Calibmar
void bind_files(py::module_& module);         // depth maps, clouds, meshes, scenes, photographs
void bind_densify(py::module_& module);
void bind_meshes(py::module_& module);
void bind_refine(py::module_& module);
void bind_texture(py::module_& module);
void bind_maps(py::module_& module);  // maps, and comparisons of two surveys

}  // namespace axial::python
