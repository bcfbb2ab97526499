// SPDX-License-Identifier: GPL-3.0-or-later
#include "truth.h"

#include "base/log.h"
#include "base/naming.h"
#include "geometry/surface.h"
#include "io/openmvs/point_source.h"

namespace axial::apps {

std::vector<float> distances_to_truth(const LocalFrame& frame, const PointCloud& cloud,
                                      const std::filesystem::path& truth, const Context& context) {
  const Mesh mesh = io::read_mesh_of_scene(frame, truth, context);
  const geometry::Surface surface = naming(truth, [&] { return geometry::Surface(mesh); });
  log_info("{}: {} faces", truth.string(), mesh.faces.size());
  return geometry::distances_to(surface, cloud.positions);
}

}  // namespace axial::apps
