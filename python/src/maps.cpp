// SPDX-License-Identifier: GPL-3.0-or-later
// Maps of a mesh, and what changed between two meshes.
#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "axial/compare.h"
#include "axial/map.h"
#include "base/error.h"
#include "base/naming.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "compare/registration.h"
#include "geometry/faces.h"
#include "geometry/posed_camera.h"
#include "map/map_block.h"
#include "map/up_direction.h"
#include "map/world_axes.h"
#include "scene/check_mesh.h"
#include "scene/marked_faces.h"
#include "src/bind.h"
#include "src/records.h"
#include "src/stage.h"

namespace axial::python {
namespace {

namespace fs = std::filesystem;
using py::literals::operator""_a;

// The directions of the axes of a map in the world: rows of `axes`. [map] = axes * [world] +
// offset.
py::dict place_fields(const map::MapFrame& frame, const map::MapGrid& grid,
                      const LocalFrame& mesh_frame) {
  const map::WorldAxes axes = map::world_axes(frame, mesh_frame);
  return py::dict("axes"_a = to_array(Eigen::Matrix3d(axes.axes)),
                  "offset"_a = to_array(Eigen::Vector3d(axes.offset)), "left"_a = grid.left,
                  "top"_a = grid.top, "pixel"_a = grid.pixel);
}

// The keyword `up`: three numbers, or None.
void add_up(Keywords& keywords, std::optional<Eigen::Vector3d>& up) {
  keywords.add("up", [&up](const py::handle& value) {
    if (value.is_none()) return;
    up = vector_argument(py::reinterpret_borrow<py::object>(value), "up");
    if (!(up->norm() > 0) || !up->allFinite())
      fail("{} {}: must be a direction, other than 0", setting("up"), map::up_text(*up));
  });
}

// The pixels of a map.
struct Pixels {
  cv::Mat1f heights;
  cv::Mat4b colors;
  cv::Mat1b shades;
};

Pixels pixels_of(const map::MapContent& content, const Context& context) {
  constexpr int kBlock = 512;
  context.memory().require(map::bytes_of_samples(content), "the width of a pixel in texels");
  const int samples = map::samples_per_pixel(content);
  constexpr std::uint64_t kBytes =
      sizeof(float) + sizeof(cv::Vec4b) + 1;  // of a pixel of the result
  const std::uint64_t result = static_cast<std::uint64_t>(content.grid.pixels()) * kBytes;
  const auto fixed = context.memory().reserve(
      result + map::FaceBins::bytes(content.mesh.mesh, content.frame, content.grid, kBlock));
  const std::size_t at_once =
      context.memory().items(map::bytes_of_block(kBlock, samples), thread_count(), "a map");
  const map::FaceBins bins(content.mesh.mesh, content.frame, content.grid, kBlock);
  const cv::Size size(content.grid.columns, content.grid.rows);
  Pixels all{cv::Mat1f(size, std::numeric_limits<float>::quiet_NaN()), {}, cv::Mat1b(size, 0)};
  if (!content.mesh.textures.empty()) all.colors = cv::Mat4b(size, cv::Vec4b(0, 0, 0, 0));
  ProgressCounter counter(context.stage("Maps"), bins.blocks());
  for_each_in_flight(bins.blocks(), at_once, [&](std::size_t b) {
    context.check_stop();
    const map::MapBlock block = map::make_block(content, bins, b, samples);
    if (!block.is_empty) {
      block.heights.copyTo(all.heights(block.pixels), block.heights != map::kNoHeight);
      block.shades.copyTo(all.shades(block.pixels));
      if (!block.colors.empty()) block.colors.copyTo(all.colors(block.pixels));
    }
    counter.add();
  });
  return all;
}

py::dict map_surface(const py::dict& fields, const py::dict& keywords) {
  double pixel = 0;
  std::optional<Eigen::Vector3d> up;
  StageControls controls;
  Keywords known;
  known.add("pixel", pixel, 1e-9, 1e6);
  add_up(known, up);
  controls.add_to(known);
  known.take(keywords, "map_surface");
  TexturedMesh mesh = to_textured_mesh(fields);
  check_mesh(mesh.mesh);
  remove_marked_faces(mesh);
  if (mesh.mesh.faces.empty()) fail("the mesh has no faces, or all are marked as unseen");
  const LocalFrame mesh_frame = frame_of(fields);
  const map::MapFrame frame = map::frame_with_up(up.value_or(Eigen::Vector3d::UnitZ()), mesh_frame);
  const map::MapContent content{mesh, {}, {}, frame, map::grid_around(mesh.mesh, frame, pixel)};
  map::check_content(content);
  Pixels pixels;
  run_stage(controls, [&](const Context& context) { pixels = pixels_of(content, context); });
  py::dict result = place_fields(frame, content.grid, mesh_frame);
  result["heights"] = to_array(pixels.heights);
  result["colors"] = to_array(pixels.colors);
  result["shades"] = to_array(pixels.shades);
  return result;
}

// The options of a comparison.
struct Comparing {
  compare::CompareOptions options;
  double sigma_before = 0, sigma_after = 0;
  std::optional<Eigen::Vector3d> up;

  void add_to(Keywords& keywords) {
    compare::ChangeOptions& changes = options.changes;
    add_up(keywords, up);
    keywords.add("pixel", options.pixel, 0, 1e6)
        .add("align", options.align, {{"none", false}, {"icp", true}})
        .add("sigma_before", sigma_before, 1e-9, 1e3)
        .add("sigma_after", sigma_after, 1e-9, 1e3)
        .add("strong", changes.strong, 0, 1e3)
        .add("weak", changes.weak, 0, 1e3)
        .add("least_pixels", changes.least_pixels, 1, 1'000'000)
        .add("rim", changes.rim, 0, 1000)
        .add("least_views", options.photos.least, 1, 1000)
        .add("allow_other_place", options.allow_other_place);
  }

  void take_sigmas() {
    if ((sigma_before > 0) != (sigma_after > 0))
      fail("{} is missing: both standard deviations must be given, or none",
           setting(sigma_before > 0 ? "sigma_after" : "sigma_before"));
    if (sigma_before > 0) options.sigmas = {sigma_before, sigma_after};
  }
};

// The photographs of the scene of a survey in `frame`; None: not known.
std::vector<geometry::PosedCamera> photos_of(const py::object& scene, const char* name,
                                             const LocalFrame& frame) {
  if (scene.is_none()) return {};
  const auto fields = scene.cast<py::dict>();
  Scene known = to_scene(fields);
  enter({frame.origin - frame_of(fields).origin}, known);
  std::vector<geometry::PosedCamera> photos = geometry::posed_cameras(known);
  if (photos.empty()) fail("{}: has no calibrated image", setting(name));
  return photos;
}

Mesh shape_of(const py::dict& fields, const fs::path& name, const LocalFrame& frame) {
  Mesh mesh = to_mesh(fields);
  naming(name, [&] { check_mesh(mesh); });
  remove_marked_faces(mesh);
  if (mesh.faces.empty()) fail_in(name, "the mesh has no faces, or all are marked as unseen");
  move_positions(frame_of(fields), frame, mesh.vertices);
  return mesh;
}

// As CompareSurveys: z for coordinates far from the origin, which are those of a reference system.
Eigen::Vector3d upward(const std::optional<Eigen::Vector3d>& wanted, const LocalFrame& frame,
                       const Mesh& before) {
  if (wanted) return *wanted;
  if (!frame.is_world()) return Eigen::Vector3d::UnitZ();
  return compare::upward_direction(before, geometry::mean_normal(before));
}

// Error if a map would show the far side of a survey: what came would count as gone.
void check_up(const Eigen::Vector3d& up, const Mesh& mesh, const fs::path& name) {
  if (map::shows_far_side(up, geometry::mean_normal(mesh)))
    fail(
        "{} {}: points away from the side to which the faces of {} are turned, so that what came "
        "would count as gone",
        setting("up"), map::up_text(up), name.string());
}

py::dict region_fields(const compare::Region& region) {
  return py::dict("came"_a = region.came, "volume"_a = region.size.volume,
                  "sigma"_a = region.size.sigma, "area"_a = region.size.area, "x"_a = region.x,
                  "y"_a = region.y, "largest"_a = region.largest);
}

py::dict comparison_fields(const compare::Comparison& found, const LocalFrame& frame) {
  py::dict fields = place_fields(found.frame, found.grid, frame);
  const compare::Changes& changes = found.changes;
  cv::Mat1f before = found.before.clone();
  before += found.base;
  py::list regions;
  for (const compare::Region& region : changes.regions) regions.append(region_fields(region));
  fields["before"] = to_array(before);
  fields["difference"] = to_array(found.difference);
  fields["sigma"] = to_array(found.sigma);
  fields["classes"] = to_array(changes.classes);
  fields["regions"] = regions;
  fields["came"] = py::make_tuple(changes.came.volume, changes.came.sigma);
  fields["gone"] = py::make_tuple(changes.gone.volume, changes.gone.sigma);
  fields["net"] = py::make_tuple(changes.net, changes.net_sigma);
  fields["area_compared"] = changes.area_compared;
  fields["area_unseen"] = found.area_unseen;
  fields["noise"] = found.noise.typical;
  const Similarity moved =
      compare::in_world(found.registration.motion, map::world_axes(found.frame, frame));
  fields["rotation"] = to_array(moved.rotation);
  fields["translation"] = to_array(moved.translation);
  return fields;
}

py::dict compare_surveys(const py::dict& before_fields, const py::dict& after_fields,
                         const py::object& scene_before, const py::object& scene_after,
                         const py::dict& keywords) {
  Comparing comparing;
  StageControls controls;
  Keywords known;
  comparing.add_to(known);
  controls.add_to(known);
  known.take(keywords, "compare_surveys");
  comparing.take_sigmas();
  const LocalFrame frame = frame_of(before_fields);
  compare::CompareOptions& options = comparing.options;
  const Mesh before = shape_of(before_fields, options.name_before, frame),
             after = shape_of(after_fields, options.name_after, frame);
  options.photos.before = photos_of(scene_before, "scene_before", frame);
  options.photos.after = photos_of(scene_after, "scene_after", frame);
  compare::Comparison found;
  run_stage(controls, [&](const Context& context) {
    const Eigen::Vector3d up = upward(comparing.up, frame, before);
    check_up(up, before, options.name_before);
    check_up(up, after, options.name_after);
    found =
        compare::compare_surveys(before, after, map::frame_with_up(up, frame), options, context);
  });
  return comparison_fields(found, frame);
}

}  // namespace

void bind_maps(py::module_& module) {
  module.def("map_surface", &map_surface);
  module.def("compare_surveys", &compare_surveys);
}

}  // namespace axial::python
