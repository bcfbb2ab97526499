// SPDX-License-Identifier: GPL-3.0-or-later
// Photographs with the light of --water.
#pragma once

#include <filesystem>

#include "arguments.h"
#include "simulate/presets/presets.h"
#include "simulate/underwater.h"

namespace axial::apps {

// The water and light that --water, --light, --depth and --scattering name. Error for an unknown
// type, for a wrong number, and for a file of lamps that cannot be read.
simulate::AnyWater water_of(const Arguments& a, const CommonOptions& common);

// Error if cameras or ground are above the water's surface of daylight.
void check_depth(const simulate::AnyWater& water, const simulate::Preset& preset,
                 const simulate::TriangleMesh& mesh);

// Renders all views in `water` into `folder`: photographs, <name>.albedo.tiff with the surface's
// linear colours (R G B) in white light, and light.json (docs/formats.md, "Simulated light").
void photograph_with_light(const Arguments& a, const simulate::Preset& preset,
                           const simulate::LitScene& scene, const simulate::AnyWater& water,
                           std::uint32_t noise_seed, const std::filesystem::path& folder);

}  // namespace axial::apps
