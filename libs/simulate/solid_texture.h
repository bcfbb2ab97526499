// SPDX-License-Identifier: GPL-3.0-or-later
// The look of the seabed: a solid (three-dimensional) texture of sediment, rock, algae and coral
// patches, with structure at every scale from the scene's down to a pixel, and a fixed sun.
#pragma once

#include "simulate/render.h"
#include "simulate/triangle_mesh.h"

namespace axial::simulate {

struct TextureOptions {
  std::uint32_t seed = 1;
  double largest = 1.0;  // size of the largest patches [m]; detail goes down from there to a pixel
  double contrast = 1;   // how far reflectances are from the sediment's, times this
};

// Reflectance (linear R G B) at a point. Detail finer than about a pixel's `footprint` [m] is left
// out, so that it does not alias.
Eigen::Vector3f seabed_albedo(const Eigen::Vector3d& p, double footprint,
                              const TextureOptions& options);

// Lambertian shading under a fixed sun with cast shadows and light from all around. Both `mesh`
// and `scene` (built from it) must outlive the shader.
Shader seabed_shader(const TriangleMesh& mesh, const RayScene& scene,
                     const TextureOptions& options);

}  // namespace axial::simulate
