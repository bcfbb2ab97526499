// SPDX-License-Identifier: GPL-3.0-or-later
// Facts about a scene that a run tells its caller.
#pragma once

#include <functional>

namespace axial::densify {

// Properties of a scene that are known before its views are selected.
struct SceneFacts {
  // At least one image is behind a port. False if the settings ignore the ports
  // (io::PortChoice::ignored).
  bool behind_ports = false;
  bool own_region = false;  // the scene file contains a region of interest
  // The run has a region of interest: the region of the scene file, or else an estimated region.
  bool region = false;
};

// A function that receives the facts. densify() says when it is called. It may be empty.
using SceneObserver = std::function<void(const SceneFacts&)>;

}  // namespace axial::densify
