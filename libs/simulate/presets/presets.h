// SPDX-License-Identifier: GPL-3.0-or-later
// The scenes for the project's measurements: terrain, texture, port and views.
#pragma once

#include "simulate/presets/preset.h"

namespace axial::simulate {

// Makes a preset:
// - "reef": a survey from above in two rows. The seabed is 2 to 3.5 m away. Small air gap, thick
//   glass.
// - "outcrop": views of a mound of bedded rock, 2 to 3 m away, with the irregular poses of a
//   hand-held camera, through the port of "reef".
// - "closeup": views around an object with overhangs, 0.5 to 0.9 m away, through a tilted acrylic
//   port.
// - "survey": rows of ten views from above. The number of rows, the size of the seabed and the
//   number of boulders (one for each view) follow from the number of views, so that surveys of
//   different numbers of views show different ground.
// - "thicket": branching coral, ropes, plates and overhangs above a seabed, seen from above and
//   from all sides at about 0.9 m. The structures are 1 to 16 pixels thick in views 1024 pixels
//   wide.
// - "sand": low ripples with the views and the port of "reef". The contrast of the texture is about
//   that of the image noise.
// - "transect": one strip at the height of "reef". Successive views overlap by
//   PresetOptions::overlap: with 55 %, most of the ground is seen by exactly two views.
// - "amphora": views around a leaning vessel with a neck and two handles amid blocks, which hide
//   much of the ground and of each other, through the port of "closeup".
//
// "NAME-hazy" is the preset NAME in haze that leaves a seventh of the contrast. Throws an Error for
// another name, for `changed` with another preset than "reef" and for a reef without a boulder that
// can be moved (change_survey()), for a number of views outside [0, 100000], for a scale, relief or
// coarseness outside [0.01, 100], for an overlap outside [0, 0.95] or another one with another
// preset than "transect", and for a width, height or field of view that make_lens() refuses.
Preset make_preset(const PresetOptions& options);

// The port of `view` in its camera frame: the preset's water surface if Preset::water_level is set,
// otherwise the port of its camera.
Port port_of_view(const Preset& preset, const View& view);

// Throws an Error if check_port() (optics.h) refuses the port of a view. The message names the
// value that is refused, and the view if there is a water surface.
void check_ports(const Preset& preset);

// Throws an Error unless the whole mesh is below the preset's water surface. Without a water
// surface nothing is checked.
void check_submerged(const Preset& preset, const TriangleMesh& mesh);

}  // namespace axial::simulate
