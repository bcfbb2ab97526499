// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmarks/survey.h"

#include <Eigen/Geometry>

#include "base/parallel.h"
#include "depth/views/warp.h"
#include "drawn.h"
#include "scene/camera_list.h"
#include "support/textured_scene.h"

namespace axial::benchmarks {
namespace {

CameraModel camera(bool behind_port) {
  CameraModel model;
  model.width = 512;
  model.height = 384;
  model.lens = {430, 430, 255.5, 191.5};
  if (!behind_port) return model;
  refractive::FlatPort<double> port;
  port.normal = Eigen::Vector3d(0.03, -0.02, 1).normalized();
  port.distance = 0.03;
  port.thickness = 0.018;
  port.n_glass = 1.49;
  port.n_water = 1.333;
  model.port = port;
  return model;
}

// The reference is in the middle of its sources, and all views look at the dome.
Pose pose(int view) {
  Pose result;
  const double angle = 2 * std::numbers::pi * view / kSourceViews;
  if (view > 0) result.centre = {0.22 * std::cos(angle), 0.22 * std::sin(angle), 0.02 * view};
  const Eigen::Vector3d forward = (Eigen::Vector3d(0, 0, 2) - result.centre).normalized();
  result.rotation =
      Eigen::Quaterniond::FromTwoVectors(forward, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return result;
}

// The truth with errors of about a tenth of a percent, as in a finished depth map.
DepthMap noisy_map(const depth::MatchImage& view, const cv::Mat1f& truth) {
  std::mt19937 random(view.id);
  std::normal_distribution<float> noise(1, 0.001f);
  DepthMap map;
  map.camera = view.camera;
  map.pose = view.pose;
  map.depth = truth.clone();
  for (float& depth : map.depth) depth *= noise(random);
  return map;
}

// The planes spanned by the points of neighbouring pixels.
depth::PlaneMap true_planes(const depth::MatchImage& view, const cv::Mat1f& truth) {
  depth::PlaneMap planes(truth.cols, truth.rows);
  std::visit(
      [&](const auto& camera) {
        const auto point = [&](int x, int y) -> Eigen::Vector3f {
          return camera.ray({static_cast<float>(x), static_cast<float>(y)}).at(truth(y, x));
        };
        for (int y = 0; y < truth.rows; ++y)
          for (int x = 0; x < truth.cols; ++x) {
            const int dx = x + 1 < truth.cols ? 1 : -1, dy = y + 1 < truth.rows ? 1 : -1;
            const Eigen::Vector3f here = point(x, y);
            Eigen::Vector3f normal =
                (point(x + dx, y) - here).cross(point(x, y + dy) - here).normalized();
            if (normal.dot(here) > 0) normal = -normal;
            planes.at(x, y) = {{truth(y, x), normal}, here, 0};
          }
      },
      make_camera<float>(view.camera));
  return planes;
}

std::vector<Eigen::Vector3f> sparse_points(const Survey& survey) {
  std::vector<Eigen::Vector3f> points;
  for (int y = 20; y < survey.truth.height; y += 40)
    for (int x = 20; x < survey.truth.width; x += 40)
      points.push_back(
          survey.views[0].pose.to_world(survey.truth.at(x, y).point.cast<double>()).cast<float>());
  return points;
}

Survey make_survey(bool behind_port) {
  Survey survey;
  const test::TexturedScene scene;
  survey.views.resize(kSourceViews + 1);
  std::vector<cv::Mat1f> truth(survey.views.size());
  parallel_for(survey.views.size(), [&](std::size_t i) {
    depth::MatchImage& view = survey.views[i];
    view.id = static_cast<std::uint32_t>(i);
    view.camera = camera(behind_port);
    view.pose = pose(static_cast<int>(i));
    const test::RenderedView rendered = test::render(scene, view.camera, view.pose);
    view.grey = rendered.image;
    truth[i] = rendered.depth;
  });
  for (std::size_t i = 0; i < truth.size(); ++i)
    survey.maps.push_back(noisy_map(survey.views[i], truth[i]));
  survey.truth = true_planes(survey.views[0], truth[0]);
  survey.points = sparse_points(survey);
  return survey;
}

template <class Camera>
std::vector<depth::SourceView<Camera>> sources_of(const Survey& survey, bool geometric,
                                                  const std::vector<depth::QuadImage>& quads) {
  std::vector<CameraModel> models;
  for (const depth::MatchImage& view : survey.views) models.push_back(view.camera);
  const auto cameras = std::get<std::vector<Camera>>(make_camera_list<float>(models));
  std::vector<depth::SourceView<Camera>> sources;
  for (std::size_t i = 1; i < survey.views.size(); ++i)
    sources.push_back({cameras[i], depth::RelativePose(survey.views[0].pose, survey.views[i].pose),
                       &quads[i - 1], geometric ? &survey.maps[i].depth : nullptr});
  return sources;
}

template <class Camera>
Camera reference_of(const Survey& survey) {
  return std::get<Camera>(make_camera<float>(survey.views[0].camera));
}

std::vector<depth::QuadImage> quads_of(const Survey& survey) {
  std::vector<depth::QuadImage> quads;
  for (std::size_t i = 1; i < survey.views.size(); ++i) quads.emplace_back(survey.views[i].grey);
  return quads;
}

}  // namespace

const Survey& survey(bool behind_port) {
  static std::array<std::unique_ptr<Survey>, 2> kept;
  std::unique_ptr<Survey>& survey = kept[behind_port ? 1 : 0];
  if (survey) return *survey;
  survey = std::make_unique<Survey>(make_survey(behind_port));
  for (std::size_t i = 1; i < survey->views.size(); ++i) {
    survey->sources.push_back(&survey->views[i]);
    survey->source_maps.push_back(&survey->maps[i]);
  }
  return *survey;
}

depth::PlaneHypothesis near_truth(const Survey& survey, int x, int y, float depth, float turn,
                                  std::mt19937& random) {
  std::uniform_real_distribution<float> unit(-1, 1);
  const depth::PlaneHypothesis& plane = survey.truth.at(x, y).plane;
  const Eigen::Vector3f off = axial::test::drawn<3>(unit, random);
  return {plane.depth * (1 + depth * unit(random)), (plane.normal + turn * off).normalized()};
}

template <class Camera>
Bench<Camera>::Bench(const Survey& survey, bool geometric, depth::lanes::InstructionSet set)
    : quads_(quads_of(survey)),
      matcher_(survey.views[0].grey, reference_of<Camera>(survey),
               sources_of<Camera>(survey, geometric, quads_), {}, set) {}

template class Bench<refractive::PinholeCamera<float>>;
template class Bench<refractive::FlatPortCamera<float>>;

}  // namespace axial::benchmarks
