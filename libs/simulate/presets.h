// SPDX-License-Identifier: GPL-3.0-or-later
// The scenes the project is measured on: what is photographed, through what, from where.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulate/optics.h"
#include "simulate/solid_texture.h"
#include "simulate/terrain.h"

namespace axial::simulate {

struct PresetOptions {
  std::string name = "reef";
  std::uint32_t seed = 1;
  int views = 0;  // 0: the preset's own number
  int width = 1024, height = 768;
  double horizontal_fov_degrees = 80;
  // The whole scene and the views' distances times this; the port stays as it is.
  double scale = 1;
  // Heights of the scene times this; the views stay where they are.
  double relief = 1;
  // Distance between the mesh's vertices times this.
  double coarseness = 1;
};

struct Preset {
  Lens lens;
  Port port;
  // Height in the world of a water surface in place of the port, of which n_air and n_water count.
  std::optional<double> water_level;
  Terrain terrain;
  TextureOptions texture;
  std::vector<View> views;
  double haze = 0;  // that the scene is photographed in, as add_haze
};

// "reef": a survey from above in two rows, seabed 2 to 3.5 m away, thin gap and thick glass.
// "outcrop": ten views, as a hand would hold the camera, of a mound of bedded rock 2 to 3 m away,
// through reef's port.
// "closeup": views all around an object with overhangs, 0.5 to 0.9 m away, behind tilted acrylic.
// "survey": rows of ten views from above, as many as it takes; what a view sees does not depend on
// how many there are.
// "thicket": branching coral, ropes, plates and overhangs above a seabed that views look down on
// from about 0.9 m all around: structures 1 to 16 pixels thick in views 1024 pixels wide. "sand":
// low ripples under reef's views and port, with a texture of about the noise's contrast.
// "transect": one strip from reef's height, each view 55 % over the one before under water, so that
// most of the ground is seen by exactly two.
// Each of them also as "NAME-hazy", in haze that leaves a seventh of the contrast. Error for
// another name, a number of views outside [0, 200], a scale, relief or coarseness outside [0.01,
// 100], or what make_lens refuses.
Preset make_preset(const PresetOptions& options);

// What `view` looks through: the preset's port, or the water's surface.
Port port_of_view(const Preset& preset, const View& view);

// Error that names the view and the value: a port that check_port refuses.
void check_ports(const Preset& preset);

// Error if the mesh is not all below the preset's water surface.
void check_submerged(const Preset& preset, const TriangleMesh& mesh);

}  // namespace axial::simulate
