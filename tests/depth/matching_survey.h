// SPDX-License-Identifier: GPL-3.0-or-later
// A rendered survey of four views, ready to be matched, and the errors of its depth maps.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "depth/patch_match.h"
#include "support/textured_scene.h"

namespace axial::depth {

struct Survey {
  std::vector<MatchImage> views;
  std::vector<cv::Mat1f> truth;
  std::vector<Eigen::Vector3f> points;

  // The input for matching view `index` with all other views as sources.
  MatchInput input(std::size_t index, std::vector<const MatchImage*>& sources) const {
    sources.clear();
    for (std::size_t i = 0; i < views.size(); ++i)
      if (i != index) sources.push_back(&views[i]);
    return {&views[index], sources, points, nullptr, ProjectionMethod::exact};
  }
};

inline CameraModel small_camera() {
  CameraModel camera;
  camera.width = 160;
  camera.height = 120;
  camera.lens = {150, 150, 79.5, 59.5};
  return camera;
}

enum class Kind {
  pinhole,
  flat_port,
  dome_port,
  flat_ports_and_domes,
  fisheye_behind_flat_port,
  folding_lens
};

inline refractive::DomePort<double> dome() {
  return {{0.004, -0.003, -0.006}, 0.05, 0.008, 1, 1.49, 1.333};
}

inline refractive::FlatPort<double> thick_port() {
  refractive::FlatPort<double> port;
  port.normal =
      Eigen::AngleAxisd(0.05, Eigen::Vector3d(1, 2, 0).normalized()) * Eigen::Vector3d::UnitZ();
  port.distance = 0.03;
  port.thickness = 0.018;
  port.n_glass = 1.49;
  port.n_water = 1.333;
  return port;
}

inline Survey make_survey(Kind kind, const test::TexturedScene& scene = {}) {
  Survey survey;
  for (int i = 0; i < 4; ++i) {
    MatchImage view;
    view.id = static_cast<std::uint32_t>(10 + i);
    view.camera = small_camera();
    if (kind == Kind::flat_port) view.camera.port = thick_port();
    if (kind == Kind::dome_port) view.camera.port = dome();
    if (kind == Kind::flat_ports_and_domes && i % 2) view.camera.port = dome();
    if (kind == Kind::flat_ports_and_domes && i % 2 == 0) view.camera.port = thick_port();
    if (kind == Kind::fisheye_behind_flat_port) {
      view.camera.port = thick_port();
      view.camera.distortion.emplace();
      view.camera.distortion->fisheye = 1;
      view.camera.distortion->above[1] = -0.02;
    }
    if (kind == Kind::folding_lens) view.camera.distortion.emplace().above[1] = -1;
    const double x = 0.25 * (i % 2) - 0.12;
    const double y = 0.2 * (i / 2) - 0.1;
    view.pose.centre = {x, y, 0.05 * i};
    view.pose.rotation = Eigen::AngleAxisd(0.1 * x, Eigen::Vector3d::UnitY()).toRotationMatrix();
    const test::RenderedView rendered = test::render(scene, view.camera, view.pose);
    view.grey = rendered.image;
    survey.views.push_back(view);
    survey.truth.push_back(rendered.depth);
  }
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector3d direction(0.06 * (i % 10) - 0.27, 0.09 * (i / 10) - 0.22, 1);
    const Eigen::Vector3d unit = direction.normalized();
    survey.points.push_back(
        (unit * scene.depth_without_bar(Eigen::Vector3d::Zero(), unit)).cast<float>());
  }
  return survey;
}

struct Errors {
  double median_relative = 0;
  double valid_fraction = 0;
};

// The errors of the pixels whose distance to the image's border is in [least, most) [px].
inline Errors compare_ring(const DepthMap& map, const cv::Mat1f& truth, int least, int most) {
  std::vector<double> errors;
  int pixels = 0;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const int from_border = std::min({x, y, map.width() - 1 - x, map.height() - 1 - y});
      if (from_border < least || from_border >= most) continue;
      ++pixels;
      if (map.depth(y, x) > 0)
        errors.push_back(std::abs(map.depth(y, x) - truth(y, x)) / truth(y, x));
    }
  Errors result;
  result.valid_fraction = static_cast<double>(errors.size()) / pixels;
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2),
                   errors.end());
  result.median_relative = errors.empty() ? 1 : errors[errors.size() / 2];
  return result;
}

inline Errors compare(const DepthMap& map, const cv::Mat1f& truth) {
  return compare_ring(map, truth, 8, map.width());
}

}  // namespace axial::depth
