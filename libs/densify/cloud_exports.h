// SPDX-License-Identifier: GPL-3.0-or-later
// The point exports: clouds that a run writes instead of densifying, as OpenMVS's program does.
// Their points are the scene's own points, or the points of ViewOptions::point_cloud.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

#include "densify/project.h"
#include "scene/scene.h"

namespace axial::densify {

// Removes from `scene` the points for which kept(index in scene.points) returns false. The other
// points keep their order, normals and colours. `kept` is called once for each point, in ascending
// order.
void keep_points(Scene& scene, const std::function<bool(std::size_t point)>& kept);

// The result of export_cloud().
struct WrittenCloud {
  std::filesystem::path file;  // the .ply file
  std::size_t points = 0;      // number of points in the file
};

// Writes one cloud beside the output scene. Let <out> be the path OutputOptions::scene without its
// extension. The list begins with the field of ExportJob that asks for the cloud, and its value. If
// the job asks for several clouds, only the first in this list is written:
//   filter_point_cloud T < 0   <out>_filtered.ply and .mvs: points whose visibility is above T
//   export_number_views N != 0 <out>_<|N|>views.ply, for N < 0 also .mvs: points that |N| images
//                              or more see
//   estimate_scale F > 0       <out>_scale.ply: all points with their sizes; a size is F times the
//                              mean width of a pixel at the point (cloud::PointScale)
// The visibility of a point is its value of cloud::visibility_of_points(). Clouds have the frame
// and precision of the dense cloud. Beside a written .mvs file, its ports, lenses and offset are
// written. `project`: the result of load_scene(). Precondition: ExportJob::any(). Throws an Error
// if the scene has no points, if an output is one of `inputs`, or if an output cannot be written.
WrittenCloud export_cloud(Project project, const ExportJob& job, const OutputOptions& output,
                          const std::vector<std::filesystem::path>& inputs, const Context& context);

}  // namespace axial::densify
