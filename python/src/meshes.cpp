// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes from clouds.
#include "axial/mesh.h"
#include "geometry/posed_camera.h"
#include "mesh/cloud_source.h"
#include "mesh/point_distances.h"
#include "mesh/unseen.h"
#include "scene/check_mesh.h"
#include "scene/local_frame.h"
#include "src/bind.h"
#include "src/mesh_options.h"
#include "src/records.h"
#include "src/stage.h"

namespace axial::python {
namespace {

void add_reconstruction(Keywords& keywords, mesh::ReconstructOptions& options) {
  keywords.add("min_distance", options.merge.min_distance, 0, 1e3)
      .add("constant_weight", options.votes.constant_weight)
      .add("weak_support", options.votes.weak_support)
      .add("thickness_factor", options.votes.thickness_factor, 1e-3, 1e3)
      .add("quality_factor", options.votes.quality_factor, 0, 1e3)
      .add("only_region", options.only_region)
      .add("crop_to_region", options.crop_to_region);
  add_cleaning_keywords(keywords, options.clean);
}

// The cloud in the frame of the scene.
PointCloud cloud_in(const LocalFrame& frame, const py::dict& fields) {
  PointCloud cloud = to_cloud(fields);
  move_positions(frame_of(fields), frame, cloud.positions);
  return cloud;
}

// The work of the program ReconstructMesh.
struct Reconstruction {
  mesh::ReconstructOptions options;
  bool close_unseen = false;

  Mesh run(PointCloud cloud, const Scene& scene, const Context& context) const {
    const std::vector<Eigen::Vector3f> positions = cloud.positions;
    Mesh mesh = mesh::reconstruct(std::move(cloud), scene, options, context);
    mesh::UnseenOptions unseen;
    unseen.keep = close_unseen;
    const mesh::CleanOptions& clean = options.clean;
    unseen.sizes_tell = clean.decimate == 1 && clean.target_faces == 0 && clean.edge_length == 0;
    unseen.cut_off = clean.cut_off;
    std::vector<Eigen::Vector3f> points;
    if (unseen.sizes_tell) points = some_of(positions, mesh::enough_points(mesh.faces.size()));
    unseen.points = points;
    return mesh::treat_unseen(std::move(mesh), geometry::posed_cameras(scene), unseen, context);
  }

 private:
  static std::vector<Eigen::Vector3f> some_of(const std::vector<Eigen::Vector3f>& positions,
                                              std::size_t most) {
    return mesh::some_positions(
        [&](const io::CloudPortionSink& sink) {
          PointCloud portion;
          portion.positions = positions;
          sink(std::move(portion), positions.size());
        },
        most);
  }
};

py::dict reconstruct_mesh(const py::dict& cloud_fields, const py::dict& scene_fields,
                          const py::dict& keywords) {
  Reconstruction reconstruction;
  StageControls controls;
  Keywords known;
  add_reconstruction(known, reconstruction.options);
  known.add("close_unseen", reconstruction.close_unseen);
  controls.add_to(known);
  known.take(keywords, "reconstruct_mesh");
  // As for ReconstructMesh, one size of pieces.
  mesh::CleanOptions& clean = reconstruction.options.clean;
  if (!keywords.contains("cut_off")) clean.cut_off = clean.spurious;
  const LocalFrame frame = frame_of(scene_fields);
  const Scene scene = to_scene(scene_fields);
  PointCloud cloud = cloud_in(frame, cloud_fields);
  Mesh mesh;
  run_stage(controls, [&](const Context& context) {
    mesh = reconstruction.run(std::move(cloud), scene, context);
  });
  return fields_of(std::move(mesh), frame);
}

py::dict clean_mesh(const py::dict& fields, const py::dict& keywords) {
  mesh::CleanOptions options;
  StageControls controls;
  Keywords known;
  add_cleaning_keywords(known, options);
  controls.add_to(known);
  known.take(keywords, "clean_mesh");
  const Mesh mesh = to_mesh(fields);
  check_mesh(mesh);
  Mesh result;
  run_stage(controls, [&](const Context&) { result = mesh::clean(mesh, options); });
  return fields_of(std::move(result), frame_of(fields));
}

}  // namespace

void add_cleaning_keywords(Keywords& keywords, mesh::CleanOptions& clean) {
  keywords.add("decimate", clean.decimate, 1e-6, 1)
      .add("target_faces", clean.target_faces, 0, 1e9)
      .add("spurious", clean.spurious, 0, 1e6)
      .add("spikes", clean.spikes)
      .add("close_holes", clean.close_holes, 0, 1000)
      .add("smooth", clean.smooth, 0, 1000)
      .add("edge_length", clean.edge_length, 0, 1e9)
      .add("cut_off", clean.cut_off, 0, 1e6);
}

void bind_meshes(py::module_& module) {
  module.def("reconstruct_mesh", &reconstruct_mesh);
  module.def("clean_mesh", &clean_mesh);
}

}  // namespace axial::python
