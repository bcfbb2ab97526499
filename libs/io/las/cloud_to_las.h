// SPDX-License-Identifier: GPL-3.0-or-later
// Clouds as LAS 1.4, for programs of surveying and of point clouds.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "axial/base.h"
#include "axial/scene.h"

namespace axial::io {

struct LasReport {
  std::uint64_t points = 0;
  double step = 0;            // of the stored coordinates; they are wrong by half of it at most
  Eigen::Vector3d low, high;  // corners of the box of the stored points [world]
};

// Writes the cloud in the file `ply` to the file `las`, and replaces an existing file. `frame`: of
// the scene to which the cloud belongs, for a cloud that states no offset (frame_of_positions() in
// io/openmvs/point_source.h); without a scene, the world. `crs`: WKT of the coordinate reference
// system of the world; empty: the file states none.
//
// Positions are written in the world, from the numbers of the file in double precision, in steps
// of 1e-6, or of 1e-5, 1e-4 or 1e-3 if the cloud is longer than 4.2, 42 or 420 km. Colours,
// normals, the number of views, error and confidence are written if the cloud has them. Weights of
// views and other properties are not. The file is read twice; memory does not grow with it.
//
// Error that names the file for a malformed or truncated PLY, a mesh, a file without points, a
// point that is not finite or has more than 65535 views, a cloud of more than 4200 km, or an output
// that cannot be written.
LasReport write_cloud_as_las(const std::filesystem::path& ply, const std::filesystem::path& las,
                             const LocalFrame& frame, const std::string& crs,
                             const Context& context = {});

}  // namespace axial::io
