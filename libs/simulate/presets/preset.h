// SPDX-License-Identifier: GPL-3.0-or-later
// A simulated scene and the views of it, as data.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulate/optics.h"
#include "simulate/solid_texture.h"
#include "simulate/terrain.h"

namespace axial::simulate {

struct PresetOptions {
  std::string name = "reef";           // see make_preset()
  std::uint32_t seed = 1;              // of all random numbers
  int views = 0;                       // number of views; 0: the default of the preset
  int width = 1024, height = 768;      // of the images [px]
  double horizontal_fov_degrees = 80;  // of the lens in air
  // Factor of the whole scene and of the views' distances. The port is not scaled.
  double scale = 1;
  // Factor of the scene's heights in the world (z). The views are not moved.
  double relief = 1;
  // Factor of the distance between the mesh's vertices.
  double coarseness = 1;
  // Of successive views of "transect" under water, as a share of the ground that a view sees.
  double overlap = 0.55;
  // A second survey of "reef" after a change: see change_survey() (survey_change.h).
  bool changed = false;
};

// The boulder that change_survey() moved.
struct MovedBoulder {
  std::size_t blob = 0;  // index into Terrain::blobs; the blob is at its new place
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  // the centre at the old place [world, m]
};

// A scene and the views of it, in the world frame: metres, z up.
struct Preset {
  Lens lens;                        // of all views
  Port port;                        // of all views, unless `water_level` or `second_port` is set
  std::optional<Port> second_port;  // of views of the second camera (second_camera.h)
  // Height of a water surface in the world [m]. If set, the surface replaces the port. Only n_air
  // and n_water of the port are then used.
  std::optional<double> water_level;
  Terrain terrain;
  TextureOptions texture;
  std::vector<View> views;
  double overlap = PresetOptions{}.overlap;
  std::optional<MovedBoulder> moved = {};  // set in a second survey after a change
  double haze = 0;  // share of scattered light in the photographs (add_haze() of render.h); 0: none
};

}  // namespace axial::simulate
