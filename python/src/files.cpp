// SPDX-License-Identifier: GPL-3.0-or-later
// Files of depth maps, clouds, meshes, scenes and photographs.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <map>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "base/error.h"
#include "io/images/image.h"
#include "io/openmvs/dmap.h"
#include "io/openmvs/mvs.h"
#include "io/openmvs/scene_with_cameras.h"
#include "io/ply/ply.h"
#include "io/textured/textured_mesh.h"
#include "scene/local_frame.h"
#include "src/bind.h"
#include "src/records.h"
#include "src/scene_files.h"
#include "src/stage.h"
#include "survey/memory_survey.h"

namespace axial::python {
namespace {

namespace fs = std::filesystem;

// Calls `work` without Python's lock.
template <class Work>
auto unlocked(Work work) {
  const py::gil_scoped_release release;
  return work();
}

py::dict read_depth_map(const fs::path& path) {
  io::StoredDepthMap stored = logged(
      [&](const Context& context) { return io::read_dmap(path, io::DmapSide::used, context); });
  py::dict fields = fields_of(std::move(stored.map));
  fields["made_from"] = stored.made_from;
  return fields;
}

void write_depth_map(const fs::path& path, const py::dict& fields) {
  const DepthMap map = to_depth_map(fields);
  const auto made_from = fields["made_from"].cast<std::string>();
  unlocked([&] { io::write_dmap(path, map, made_from); });
}

py::dict read_cloud(const fs::path& path) {
  LocalFrame frame;
  PointCloud cloud = unlocked([&] {
    frame = frame_of_file(path);
    PointCloud read = io::read_cloud_ply(path, frame);
    read.errors = io::read_vertex_property(path, "error");
    read.confidences = io::read_vertex_property(path, "confidence");
    return read;
  });
  return fields_of(std::move(cloud), frame);
}

void write_cloud(const fs::path& path, const py::dict& fields, bool double_precision) {
  const PointCloud cloud = to_cloud(fields);
  const LocalFrame frame = frame_of(fields);
  const bool views = !cloud.view_begin.empty();
  unlocked([&] { io::write_cloud_ply(path, cloud, views, {frame, double_precision}); });
}

py::dict read_mesh(const fs::path& path) {
  LocalFrame frame;
  Mesh mesh = unlocked([&] {
    frame = frame_of_file(path);
    return io::read_mesh_ply(path, frame);
  });
  return fields_of(std::move(mesh), frame);
}

void write_mesh(const fs::path& path, const py::dict& fields, bool double_precision) {
  const Mesh mesh = to_mesh(fields);
  const LocalFrame frame = frame_of(fields);
  unlocked([&] { io::write_mesh_ply(path, mesh, {frame, double_precision}); });
}

py::dict read_scene(const fs::path& path, const std::optional<fs::path>& working_folder,
                    const std::optional<fs::path>& housing, const std::string& ports,
                    bool allow_missing) {
  const io::SceneFiles files = scene_files(path, working_folder, housing, ports, allow_missing);
  const io::SceneWithCameras scene =
      logged([&](const Context& context) { return io::read_scene_with_cameras(files, context); });
  return fields_of(scene.scene, scene.frame);
}

void write_scene(const fs::path& path, const py::dict& fields,
                 const std::optional<fs::path>& working_folder) {
  io::SceneWithCameras scene{to_scene(fields), frame_of(fields), {}};
  run_logged([&](const Context& context) {
    const fs::path output = fs::absolute(path);
    scene.housing = survey::housing_of(scene.scene);
    const io::SceneLenses lenses = io::lenses_of(scene.scene, output);
    io::write_cameras_beside(output, scene, lenses, {}, context);
    io::write_mvs(output, scene.scene, fs::absolute(working_folder.value_or(output.parent_path())));
  });
}

py::object read_photograph(const fs::path& path) {
  return to_array(unlocked([&] {
    const io::Photograph photograph = io::read_photograph(path);
    cv::Mat rgb;
    cv::cvtColor(photograph.pixels, rgb, cv::COLOR_BGR2RGB);
    return rgb;
  }));
}

}  // namespace

LocalFrame frame_of_file(const fs::path& path) {
  const io::MeshPlace place = io::mesh_place(path);
  return place.frame.is_world() ? frame_near(place.first_vertex) : place.frame;
}

io::SceneFiles scene_files(const fs::path& scene, const std::optional<fs::path>& working_folder,
                           const std::optional<fs::path>& housing, const std::string& ports,
                           bool allow_missing) {
  using io::PortChoice;
  static const std::map<std::string, PortChoice> choices{{"automatic", PortChoice::automatic},
                                                         {"ignored", PortChoice::ignored},
                                                         {"required", PortChoice::required},
                                                         {"flat", PortChoice::flat}};
  const auto choice = choices.find(ports);
  if (choice == choices.end())
    fail("{} '{}': must be automatic, ignored, required or flat", setting("ports"), ports);
  io::SceneFiles files;
  files.scene = fs::absolute(scene);
  files.working_folder = fs::absolute(working_folder.value_or(files.scene.parent_path()));
  if (housing) files.housing = fs::absolute(*housing);
  files.ports = choice->second;
  files.allow_missing = allow_missing;
  return files;
}

void bind_files(py::module_& module) {
  module.def("read_depth_map", &read_depth_map);
  module.def("write_depth_map", &write_depth_map);
  module.def("read_cloud", &read_cloud);
  module.def("write_cloud", &write_cloud);
  module.def("read_mesh", &read_mesh);
  module.def("write_mesh", &write_mesh);
  module.def("read_scene", &read_scene);
  module.def("write_scene", &write_scene);
  module.def(
      "read_photograph", &read_photograph, py::arg("path"),
      "The pixels of a photograph: (height, width, 3) of uint8 or uint16, red, green, blue.");
}

}  // namespace axial::python
