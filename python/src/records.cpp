// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/records.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <opencv2/imgproc.hpp>

namespace axial::python {
namespace {

// None for a vector without items.
template <class Item>
py::object or_none(std::vector<Item> items) {
  if (items.empty()) return py::none();
  return to_array(std::move(items));
}

template <class Item>
std::vector<Item> items_of(const py::dict& fields, const char* name) {
  return items_argument<Item>(fields[name], name);
}

// Throws a ValueError unless `begin` is empty or divides `all` views among `items` items.
void check_views(const std::vector<std::size_t>& begin, std::size_t items, std::size_t all) {
  const bool divides = begin.size() == items + 1 && begin.front() == 0 && begin.back() == all &&
                       std::ranges::is_sorted(begin);
  if (!(begin.empty() ? all == 0 : divides))
    throw py::value_error(fmt::format(
        "view_begin: must have {} ascending numbers, from 0 to the {} items of view_images",
        items + 1, all));
}

void check_count(const char* name, std::size_t count, std::size_t wanted) {
  if (count != 0 && count != wanted)
    throw py::value_error(fmt::format("{}: has {} items, but must have {}", name, count, wanted));
}

Pose pose_of(const py::dict& fields) {
  return {matrix_argument(fields["rotation"], "rotation"),
          vector_argument(fields["centre"], "centre")};
}

}  // namespace

py::dict fields_of(DepthMap map) {
  using py::literals::operator""_a;
  return py::dict(
      "depth"_a = to_array(map.depth), "normal"_a = to_array(map.normal),
      "confidence"_a = to_array(map.confidence), "camera"_a = Camera(map.camera, "camera"),
      "rotation"_a = to_array(map.pose.rotation), "centre"_a = to_array(map.pose.centre),
      "ids"_a = map.ids, "image_path"_a = map.image_path, "min_depth"_a = map.min_depth,
      "max_depth"_a = map.max_depth);
}

DepthMap to_depth_map(const py::dict& fields) {
  DepthMap map;
  map.depth = image_argument<float>(fields["depth"], "depth");
  map.normal = image_argument<cv::Vec3f>(fields["normal"], "normal");
  map.confidence = image_argument<float>(fields["confidence"], "confidence");
  if (map.normal.empty()) map.normal = cv::Mat3f::zeros(map.depth.size());
  const Pose pose = pose_of(fields);
  map.camera = fields["camera"].cast<const Camera&>().model;
  map.pose = pose;
  map.ids = fields["ids"].cast<std::vector<std::uint32_t>>();
  map.image_path = fields["image_path"].cast<std::string>();
  map.min_depth = fields["min_depth"].cast<float>();
  map.max_depth = fields["max_depth"].cast<float>();
  return map;
}

py::dict fields_of(PointCloud cloud, const LocalFrame& frame) {
  using py::literals::operator""_a;
  return py::dict("positions"_a = to_array(std::move(cloud.positions)),
                  "normals"_a = or_none(std::move(cloud.normals)),
                  "colors"_a = or_none(std::move(cloud.colors)),
                  "view_begin"_a = or_none(std::move(cloud.view_begin)),
                  "view_images"_a = or_none(std::move(cloud.view_images)),
                  "view_weights"_a = or_none(std::move(cloud.view_weights)),
                  "errors"_a = or_none(std::move(cloud.errors)),
                  "confidences"_a = or_none(std::move(cloud.confidences)),
                  "origin"_a = to_array(frame.origin));
}

PointCloud to_cloud(const py::dict& fields) {
  PointCloud cloud;
  cloud.positions = items_of<Eigen::Vector3f>(fields, "positions");
  cloud.normals = items_of<Eigen::Vector3f>(fields, "normals");
  cloud.colors = items_of<Rgb>(fields, "colors");
  cloud.view_begin = items_of<std::size_t>(fields, "view_begin");
  cloud.view_images = items_of<std::uint32_t>(fields, "view_images");
  cloud.view_weights = items_of<float>(fields, "view_weights");
  cloud.errors = items_of<float>(fields, "errors");
  cloud.confidences = items_of<float>(fields, "confidences");
  check_views(cloud.view_begin, cloud.size(), cloud.view_images.size());
  check_count("view_weights", cloud.view_weights.size(), cloud.view_images.size());
  check_count("normals", cloud.normals.size(), cloud.size());
  check_count("colors", cloud.colors.size(), cloud.size());
  check_count("errors", cloud.errors.size(), cloud.size());
  check_count("confidences", cloud.confidences.size(), cloud.size());
  return cloud;
}

py::dict fields_of(Mesh mesh, const LocalFrame& frame) {
  using py::literals::operator""_a;
  return py::dict(
      "vertices"_a = to_array(std::move(mesh.vertices)),
      "faces"_a = to_array(std::move(mesh.faces)), "colors"_a = or_none(std::move(mesh.colors)),
      "unseen"_a = or_none(std::move(mesh.unseen)), "origin"_a = to_array(frame.origin));
}

Mesh to_mesh(const py::dict& fields) {
  Mesh mesh;
  mesh.vertices = items_of<Eigen::Vector3f>(fields, "vertices");
  mesh.faces = items_of<std::array<std::uint32_t, 3>>(fields, "faces");
  mesh.colors = items_of<Rgb>(fields, "colors");
  mesh.unseen = items_of<std::uint8_t>(fields, "unseen");
  return mesh;
}

py::dict fields_of(TexturedMesh mesh, const LocalFrame& frame) {
  py::dict fields = fields_of(std::move(mesh.mesh), frame);
  py::list textures;
  for (const cv::Mat3b& texture : mesh.textures) {
    cv::Mat3b rgb;
    cv::cvtColor(texture, rgb, cv::COLOR_BGR2RGB);
    textures.append(to_array(rgb));
  }
  fields["uv"] = to_array(std::move(mesh.uv)).attr("reshape")(-1, 3, 2);
  fields["texture_of"] = to_array(std::move(mesh.texture_of));
  fields["textures"] = textures;
  return fields;
}

TexturedMesh to_textured_mesh(const py::dict& fields) {
  TexturedMesh mesh{to_mesh(fields), {}, {}, {}};
  if (!fields.contains("uv")) return mesh;
  const Array<float> uv = array_argument<float>(fields["uv"], "uv", {kAny, 3, 2});
  mesh.uv = items_argument<TexturedMesh::Corners>(uv.attr("reshape")(-1, 6), "uv");
  mesh.texture_of = items_of<std::uint32_t>(fields, "texture_of");
  for (const auto& [name, count] :
       {std::pair("uv", mesh.uv.size()), std::pair("texture_of", mesh.texture_of.size())})
    if (count != mesh.mesh.faces.size())
      throw py::value_error(
          fmt::format("{}: has {} items, but must have {}", name, count, mesh.mesh.faces.size()));
  for (const py::handle& texture : fields["textures"]) {
    const auto rgb =
        image_argument<cv::Vec3b>(py::reinterpret_borrow<py::object>(texture), "textures");
    if (rgb.empty()) throw py::value_error("textures: has a texture without pixels");
    cv::cvtColor(rgb, mesh.textures.emplace_back(), cv::COLOR_RGB2BGR);
  }
  return mesh;
}

LocalFrame frame_of(const py::dict& fields) {
  return {vector_argument(fields["origin"], "origin")};
}

void move_positions(const LocalFrame& from, const LocalFrame& to,
                    std::vector<Eigen::Vector3f>& positions) {
  const Eigen::Vector3d shift = from.origin - to.origin;
  if (shift.isZero(0)) return;
  for (Eigen::Vector3f& at : positions) at = (at.cast<double>() + shift).cast<float>();
}

}  // namespace axial::python
