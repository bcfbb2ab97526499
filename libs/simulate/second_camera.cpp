// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/second_camera.h"

#include <algorithm>

#include "base/error.h"

namespace axial::simulate {

void add_second_camera(Preset& preset, const SecondCamera& second) {
  if (preset.water_level || preset.port.dome)
    fail("a second camera needs a flat port, and the first has a {}",
         preset.water_level ? "water surface" : "dome");
  const std::vector<View> first = preset.views;
  if (first.size() < 2) fail("a second camera needs at least two views of the first");
  for (std::size_t i = 0; i < first.size(); ++i) {
    const std::size_t before = i - std::min<std::size_t>(i, 1);
    const std::size_t after = std::min(i + 1, first.size() - 1);
    const Eigen::Vector3d step =
        (first[after].centre - first[before].centre) / static_cast<double>(after - before);
    View view = first[i];
    view.centre += view.rotation.transpose() * Eigen::Vector3d(second.base, 0, 0);
    view.centre += second.delay * step;
    view.camera = 1;
    preset.views.push_back(view);
  }
  preset.second_port = preset.port;
  preset.second_port->distance = second.port_distance;
  check_port(*preset.second_port, preset.lens);
}

}  // namespace axial::simulate
