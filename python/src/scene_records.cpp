// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <tuple>

#include "src/records.h"

namespace axial::python {
namespace {

using py::literals::operator""_a;

using Neighbour = std::tuple<std::uint32_t, std::uint32_t, float, float, float, float>;

std::vector<Neighbour> tuples_of(const std::vector<ViewScore>& scores) {
  std::vector<Neighbour> tuples;
  for (const ViewScore& of : scores)
    tuples.emplace_back(of.image, of.points, of.scale, of.angle, of.area, of.score);
  return tuples;
}

std::vector<ViewScore> to_scores(const std::vector<Neighbour>& tuples) {
  std::vector<ViewScore> scores;
  for (const auto& [image, points, scale, angle, area, score] : tuples)
    scores.push_back({image, points, scale, angle, area, score});
  return scores;
}

py::dict image_fields(const SceneImage& image, std::size_t index) {
  const py::object id = image.id == kNoId ? py::object(py::none()) : py::int_(image.id);
  CameraModel model = image.camera;
  // An image without a pose may have a camera that is not possible.
  const py::object camera = image.calibrated
                                ? py::cast(Camera(model, fmt::format("images[{}].camera", index)))
                                : py::object(py::none());
  return py::dict(
      "path"_a = image.path, "camera"_a = camera, "rotation"_a = to_array(image.pose.rotation),
      "centre"_a = to_array(image.pose.centre), "id"_a = id, "mask_path"_a = image.mask_path,
      "calibrated"_a = image.calibrated, "neighbours"_a = tuples_of(image.neighbours));
}

SceneImage to_image(const py::dict& fields) {
  SceneImage image;
  image.path = py::str(fields["path"]).cast<std::string>();
  image.mask_path = py::str(fields["mask_path"]).cast<std::string>();
  if (!fields["id"].is_none()) image.id = fields["id"].cast<std::uint32_t>();
  image.calibrated = fields["calibrated"].cast<bool>();
  if (!fields["camera"].is_none()) image.camera = fields["camera"].cast<const Camera&>().model;
  image.pose = {matrix_argument(fields["rotation"], "rotation"),
                vector_argument(fields["centre"], "centre")};
  image.neighbours = to_scores(fields["neighbours"].cast<std::vector<Neighbour>>());
  return image;
}

py::object region_fields(const std::optional<OrientedBox>& region) {
  if (!region) return py::none();
  return py::dict("rotation"_a = to_array(region->rotation), "centre"_a = to_array(region->centre),
                  "half_extent"_a = to_array(region->half_extent));
}

std::optional<OrientedBox> to_region(const py::object& fields) {
  if (fields.is_none()) return {};
  return OrientedBox{matrix_argument(fields["rotation"], "rotation"),
                     vector_argument(fields["centre"], "centre"),
                     vector_argument(fields["half_extent"], "half_extent")};
}

}  // namespace

py::dict fields_of(const Scene& scene, const LocalFrame& frame) {
  PointCloud cloud = cloud_of(scene);
  if (cloud.view_begin.empty()) cloud.view_begin = {0};
  py::list images;
  for (std::size_t i = 0; i < scene.images.size(); ++i)
    images.append(image_fields(scene.images[i], i));
  py::dict points = fields_of(std::move(cloud), frame);
  if (points["view_images"].is_none()) points["view_images"] = Array<std::uint32_t>(0);
  return py::dict("images"_a = images, "points"_a = points["positions"],
                  "view_begin"_a = points["view_begin"], "view_images"_a = points["view_images"],
                  "view_confidences"_a = points["view_weights"],
                  "point_normals"_a = points["normals"], "point_colors"_a = points["colors"],
                  "region"_a = region_fields(scene.region), "origin"_a = points["origin"]);
}

Scene to_scene(const py::dict& fields) {
  const PointCloud cloud = to_cloud(py::dict(
      "positions"_a = fields["points"], "normals"_a = fields["point_normals"],
      "colors"_a = fields["point_colors"], "view_begin"_a = fields["view_begin"],
      "view_images"_a = fields["view_images"], "view_weights"_a = fields["view_confidences"],
      "errors"_a = py::none(), "confidences"_a = py::none()));
  Scene scene;
  for (const py::handle image : fields["images"])
    scene.images.push_back(to_image(image.cast<py::dict>()));
  scene.point_normals = cloud.normals;
  scene.point_colors = cloud.colors;
  scene.region = to_region(fields["region"]);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    SparsePoint& point = scene.points.emplace_back();
    point.position = cloud.positions[i];
    if (cloud.view_begin.empty()) continue;
    for (std::size_t k = cloud.view_begin[i]; k < cloud.view_begin[i + 1]; ++k)
      point.views.push_back(
          {cloud.view_images[k], cloud.view_weights.empty() ? 0.0f : cloud.view_weights[k]});
  }
  return scene;
}

}  // namespace axial::python
