// SPDX-License-Identifier: GPL-3.0-or-later
// The module axialmvs._axialmvs. The package axialmvs gives its names to users.
#include "src/bind.h"

// The order is that of the types: a function whose default value or result has a type needs it.
PYBIND11_MODULE(_axialmvs, module) {
  using namespace axial::python;
  module.doc() = "The libraries of AxialMVS. Use the package axialmvs.";
  bind_errors(module);
  bind_ports(module);
  bind_cameras(module);
  bind_camera_files(module);
  bind_files(module);
  bind_densify(module);
  bind_meshes(module);
  bind_refine(module);
  bind_texture(module);
  bind_maps(module);
}
