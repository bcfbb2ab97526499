// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

namespace axial::densify {

// Properties of a scene that are known before its views are selected.
struct SceneFacts {
  bool behind_ports = false;  // an image is behind a port
  bool own_region = false;    // the scene file contains a region of interest
  bool region = false;        // the run has a region of interest: its own or an estimated one
};
using SceneObserver = std::function<void(const SceneFacts&)>;

}  // namespace axial::densify
