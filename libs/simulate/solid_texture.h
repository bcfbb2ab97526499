// SPDX-License-Identifier: GPL-3.0-or-later
// The appearance of the seabed: a solid (three-dimensional) texture of sediment, rock, algae and
// coral patches, with structure at all scales down to a pixel, under a fixed sun.
#pragma once

#include "simulate/render.h"
#include "simulate/triangle_mesh.h"

namespace axial::simulate {

struct TextureOptions {
  std::uint32_t seed = 1;
  double largest = 1.0;  // size of the largest patches [m]
  // Factor of the differences from the sediment's reflectance. 0: the sediment everywhere.
  double contrast = 1;
};

// Returns the reflectance (linear R G B) at the point `p` [world, m]. `footprint` is the width of a
// pixel at the point [m], above 0. Detail finer than about `footprint` is left out to avoid
// aliasing.
Eigen::Vector3f seabed_albedo(const Eigen::Vector3d& p, double footprint,
                              const TextureOptions& options);

// Returns a shader that returns seabed_albedo(), without any light.
Shader albedo_shader(const TextureOptions& options);

// Returns a shader with the reflectance of seabed_albedo(): Lambertian shading under a fixed sun
// with cast shadows and ambient light. `scene` must be built from `mesh`. Both must outlive the
// shader.
Shader seabed_shader(const TriangleMesh& mesh, const RayScene& scene,
                     const TextureOptions& options);

}  // namespace axial::simulate
