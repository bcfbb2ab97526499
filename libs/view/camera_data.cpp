// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/camera_data.h"

#include <nlohmann/json.hpp>

#include "scene/any_camera.h"

namespace axial::view {
namespace {

using Json = nlohmann::ordered_json;

Json list(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

Json data_of(const refractive::FlatPort<double>& port) {
  return {{"kind", "flat"},
          {"normal", list(port.normal)},
          {"distance", port.distance},
          {"thickness", port.thickness},
          {"indices", {port.n_air, port.n_glass, port.n_water}}};
}

Json data_of(const refractive::DomePort<double>& port) {
  return {{"kind", "dome"},
          {"centre", list(port.centre)},
          {"inner_radius", port.inner_radius},
          {"thickness", port.thickness},
          {"indices", {port.n_air, port.n_glass, port.n_water}}};
}

Json data_of(const refractive::LensDistortion<double>& lens, double field) {
  return {{"fisheye", lens.fisheye > 0},
          {"spread", lens.spread},
          {"above", lens.above},
          {"below", lens.below},
          {"tangential", {lens.p1, lens.p2}},
          {"prism", {lens.prism.x(), lens.prism.y()}},
          {"field", field}};
}

Json corners_of(const SceneImage& image, const AnyCamera<double>& camera) {
  Json corners = Json::array();
  const double right = image.camera.width - 0.5, low = image.camera.height - 0.5;
  for (const Eigen::Vector2d& corner : {Eigen::Vector2d(-0.5, -0.5), Eigen::Vector2d(right, -0.5),
                                        Eigen::Vector2d(right, low), Eigen::Vector2d(-0.5, low)}) {
    const refractive::AxialRay<double> ray = camera.ray(corner);
    corners.push_back(list(image.pose.to_world(ray.origin)));
    corners.push_back(list(image.pose.rotation.transpose() * ray.direction));
  }
  return corners;
}

Json checks_of(const SceneImage& image, const AnyCamera<double>& camera,
               std::span<const Eigen::Vector3f> points) {
  Json checks = Json::array();
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3d x = point.cast<double>();
    const auto seen = camera.project(image.pose.to_camera(x));
    if (seen.visible) checks.push_back({x.x(), x.y(), x.z(), seen.pixel.x(), seen.pixel.y()});
  }
  return checks;
}

}  // namespace

nlohmann::ordered_json camera_data(const SceneImage& image,
                                   std::span<const Eigen::Vector3f> points) {
  const CameraModel& model = image.camera;
  const AnyCamera<double> camera(make_camera<double>(model));
  const Eigen::Matrix3d rows = image.pose.rotation.transpose();  // stored column by column
  Json data{{"size", {model.width, model.height}},
            {"rotation", std::vector<double>(rows.data(), rows.data() + 9)},
            {"centre", list(image.pose.centre)},
            {"lens", {model.lens.fx, model.lens.fy, model.lens.cx, model.lens.cy}}};
  if (model.distortion)
    data["distortion"] = data_of(*model.distortion, distorted_lens<double>(model).field);
  if (model.port) {
    data["port"] = std::visit([](const auto& port) { return data_of(port); }, *model.port);
    data["port"]["name"] = image.port_name;
  }
  data["corners"] = corners_of(image, camera);
  data["check"] = checks_of(image, camera, points);
  return data;
}

}  // namespace axial::view
