// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "axial/scene_images.h"
#include "base/context.h"
#include "options.h"
#include "scene/mesh.h"
#include "scene/point_cloud.h"
#include "survey/survey.h"

namespace axial::apps {

// What the viewer shows, in the frame of the scene.
struct Contents {
  survey::Survey survey;
  PointCloud cloud;              // at most about Options::max_points points
  std::size_t all_points = 0;    // of the file of the cloud
  std::vector<float> distances;  // of the points to the true mesh [m]; empty: no true mesh
  // At most one of the two meshes.
  std::optional<Mesh> mesh;
  std::optional<TexturedMesh> textured;
};

// Reads the files that `options` name. Error for a malformed file, a cloud without points, a mesh
// without faces, and a scene without calibrated images.
Contents read_contents(const Options& options, const Context& context);

// Writes the data files and the reduced photographs to `staging`. Error for a photograph that
// cannot be read or has another shape than its camera, for views of the cloud that the scene does
// not have, and for a file that cannot be written.
void write_contents(const Contents& contents, const Options& options,
                    const std::filesystem::path& staging, const Context& context);

}  // namespace axial::apps
