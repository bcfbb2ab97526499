// SPDX-License-Identifier: GPL-3.0-or-later
// Makes depth maps and a cloud of a small simulated survey, whose cameras, photographs and sparse
// points are in memory:
//   densify_memory [MAPS [TILES [FOLDER]]]
// Stops after about MAPS depth maps if MAPS is above 0. TILES: the number of tiles of the cloud.
// With FOLDER, a second call goes on.
#include <axial/densify.h>
#include <refractive/flat_port_camera.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stop_token>

namespace {

using axial::refractive::FlatPortCamera;
using Clock = std::chrono::steady_clock;

constexpr double kGround = 1.5;  // z of the ground [m]

axial::CameraModel camera_model() {
  axial::refractive::FlatPort<double> port;
  port.distance = 0.02;
  port.thickness = 0.014;
  port.n_glass = 1.52;
  port.n_water = 1.333;
  return {160, 120, {160, 160, 79.5, 59.5}, port};
}

FlatPortCamera<double> camera_of(const axial::CameraModel& model) {
  return {model.lens, std::get<0>(*model.port), model.width, model.height};
}

// A grey level of a cell of the ground.
double level(long x, long y) {
  const double number = std::sin(static_cast<double>(12 * x + 79 * y)) * 43758.5453;
  return 40 + 170 * (number - std::floor(number));
}

// The grey level of the ground, which is interpolated between cells of 3 cm.
double ground(const Eigen::Vector3d& at) {
  const double u = at.x() / 0.03, v = at.y() / 0.03;
  const long x = std::lround(std::floor(u)), y = std::lround(std::floor(v));
  const double a = u - std::floor(u), b = v - std::floor(v);
  return (1 - b) * ((1 - a) * level(x, y) + a * level(x + 1, y)) +
         b * ((1 - a) * level(x, y + 1) + a * level(x + 1, y + 1));
}

axial::io::Photograph photograph(const axial::SceneImage& image) {
  const FlatPortCamera<double> camera = camera_of(image.camera);
  cv::Mat3b pixels(image.camera.height, image.camera.width);
  for (int y = 0; y < pixels.rows; ++y)
    for (int x = 0; x < pixels.cols; ++x) {
      const auto ray = camera.ray(Eigen::Vector2d(x, y));
      const double along = (kGround - ray.origin.z()) / ray.direction.z();
      const Eigen::Vector3d at = image.pose.to_world(ray.origin + along * ray.direction);
      pixels(y, x) = cv::Vec3b::all(static_cast<unsigned char>(ground(at)));
    }
  return {pixels, {}};
}

// Six cameras above the ground, and the points of a grid on the ground.
axial::survey::MemorySurvey simulated_survey() {
  axial::survey::MemorySurvey survey;
  axial::Scene& scene = survey.scene;
  for (int i = 0; i < 6; ++i) {
    axial::SceneImage image;
    image.path = "image " + std::to_string(i);
    image.camera = camera_model();
    image.pose.centre = {0.2 * (i % 3), 0.2 * (i / 3), 0};
    scene.images.push_back(image);
  }
  for (int i = 0; i < 900; ++i) {
    axial::SparsePoint point;
    point.position =
        Eigen::Vector3d(0.05 * (i % 30) - 0.5, 0.05 * (i / 30) - 0.5, kGround).cast<float>();
    for (unsigned k = 0; k < scene.images.size(); ++k) {
      const auto& image = scene.images[k];
      const auto seen =
          camera_of(image.camera).project(image.pose.to_camera(point.position.cast<double>()));
      if (seen.visible && seen.pixel.minCoeff() >= 0 && seen.pixel.x() <= 159 &&
          seen.pixel.y() <= 119)
        point.views.push_back({k, 0});
    }
    if (point.views.size() > 1) scene.points.push_back(point);
  }
  survey.read = [images = scene.images](std::size_t image) { return photograph(images[image]); };
  return survey;
}

void run(int argc, char** argv, std::stop_source& source, Clock::time_point& asked) {
  axial::densify::Options options;
  const std::size_t most = argc > 1 ? static_cast<std::size_t>(std::atoi(argv[1])) : 0;
  if (argc > 2) options.fusion.tiles = static_cast<std::size_t>(std::atoi(argv[2]));
  if (argc > 3) options.survey.files.working_folder = std::filesystem::absolute(argv[3]);
  std::size_t maps = 0;
  options.output.take_map = [&maps](std::size_t, axial::DepthMap) { ++maps; };
  axial::Limits limits;
  limits.memory = axial::MemoryBudget::of_program(1000);
  limits.threads = 2;  // on any computer, a stop leaves maps to be made
  const axial::Context context(
      [&](const axial::Event& event) {
        if (event.kind == axial::Event::Kind::line)
          return (void)std::printf("%s\n", event.text.c_str());
        std::printf("%s: %zu of %zu\n", event.text.c_str(), event.done, event.total);
        if (most == 0 || event.text != "Estimated depth maps" || event.done < most) return;
        asked = Clock::now();
        source.request_stop();
      },
      source.get_token(), limits);
  const auto result = axial::densify::densify(simulated_survey(), options, context);
  double sum = 0;
  for (const Eigen::Vector3f& point : result.cloud.positions) sum += std::abs(point.z() - kGround);
  const auto points = result.cloud.size();
  std::printf("%zu maps, %zu points, mean distance %.4f m\n", maps, points,
              sum / static_cast<double>(points));
}

}  // namespace

int main(int argc, char** argv) {
  std::stop_source source;
  Clock::time_point asked;
  try {
    run(argc, argv, source, asked);
  } catch (const axial::Stopped&) {
    std::printf("stopped after %.3f s\n",
                std::chrono::duration<double>(Clock::now() - asked).count());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
