// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure_volume.h"

#include <algorithm>

#include "base/error.h"
#include "base/log.h"
#include "base/naming.h"
#include "base/order_statistics.h"
#include "evaluate/topology.h"
#include "geometry/volume.h"
#include "moved_mesh.h"

namespace axial::apps {
namespace {

// The middle of the camera centres, coordinate by coordinate.
Eigen::Vector3d middle_of_cameras(const Scene& scene) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const SceneImage& image : scene.images)
      if (image.calibrated) values.push_back(image.pose.centre(axis));
    if (values.empty()) fail("no image is calibrated: the upper side of the ground is not known");
    middle(axis) = upper_median(std::move(values));
  }
  return middle;
}

void measure(const Options& options, const Scene& scene, const FrameMove& move,
             const Context& context) {
  const Mesh mesh = moved_mesh(options, move, context);
  const evaluate::Topology topology = evaluate::topology_of(mesh);
  const bool closed = topology.border_edges == 0 && topology.non_manifold_edges == 0;
  if (options.plane_threshold < 0 && !closed)
    fail(
        "it is not closed ({} border edges, {} edges of more than two faces): its volume needs a "
        "ground plane (--plane-threshold 0)",
        topology.border_edges, topology.non_manifold_edges);
  if (topology.inconsistent_edges > 0)
    log_warning("{}: {} edges are inconsistently oriented: the volume is not reliable",
                options.mesh.string(), topology.inconsistent_edges);
  if (closed)
    log_info("Volume that the mesh encloses: {:.9g} m^3", geometry::enclosed_volume(mesh));
  if (options.plane_threshold < 0) return;
  const geometry::Plane plane = geometry::ground_plane(mesh, middle_of_cameras(scene),
                                                       {options.up_axis, options.plane_threshold});
  const Eigen::Vector3d& n = plane.normal;
  log_info("Ground plane: normal ({:.6f}, {:.6f}, {:.6f}), {:.6f} m from the origin", n.x(), n.y(),
           n.z(), plane.offset + n.dot(move.to.origin));
  log_info("Volume above the ground plane: {:.9g} m^3", geometry::volume_above(mesh, plane));
}

}  // namespace

void measure_volume(const Options& options, const Scene& scene, const FrameMove& move,
                    const Context& context) {
  naming(options.mesh, [&] { measure(options, scene, move, context); });
}

}  // namespace axial::apps
