// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/render.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/hash.h"
#include "base/parallel.h"

namespace axial::simulate {
namespace {

// The sum of four uniform numbers, scaled to variance 1: bell-shaped, without log and cos.
float bell(std::uint64_t bits) {
  float sum = 0;
  for (int i = 0; i < 4; ++i) sum += static_cast<float>((bits >> (16 * i)) & 0xFFFFu);
  return (sum / 65535.0f - 2.0f) * 1.7320508f;
}

// The width of one pixel, across the ray, at `distance` in the scene medium.
double pixel_width(const Lens& lens, const Port* port, const SceneRay& in_camera, double distance) {
  // Behind a dome the magnification is about that in air.
  const double magnification = port && !port->dome ? port->n_water / port->n_air : 1.0;
  // The air gap of a housing is so short that it is neglected.
  const double in_air = port && port->is_surface ? in_camera.start.norm() : 0.0;
  return in_air / lens.focal + distance / (lens.focal * magnification);
}

}  // namespace

std::optional<SurfacePoint> surface_point(const RayScene& scene, const Lens& lens, const Port* port,
                                          const View& view, double u, double v) {
  const auto in_camera = trace_pixel(lens, port, u, v);
  if (!in_camera) return std::nullopt;
  const SceneRay ray = to_world(view, *in_camera);
  const auto hit = scene.first_hit(ray.start, ray.direction);
  if (!hit) return std::nullopt;
  const double footprint = pixel_width(lens, port, *in_camera, hit->distance);
  return SurfacePoint{ray.start + hit->distance * ray.direction, *hit, footprint};
}

cv::Mat3f render_radiance(const RayScene& scene, const Shader& shader, const Lens& lens,
                          const Port* port, const View& view, int samples) {
  if (samples < 1 || samples > 16) fail("samples is {}: must be between 1 and 16", samples);
  cv::Mat3f image(lens.height, lens.width);
  const float weight = 1.0f / static_cast<float>(samples * samples);
  const auto offset = [&](int i) { return (i + 0.5) / samples - 0.5; };
  parallel_for(static_cast<std::size_t>(lens.height), [&](std::size_t row) {
    const auto y = static_cast<int>(row);
    for (int x = 0; x < lens.width; ++x) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (int i = 0; i < samples; ++i)
        for (int j = 0; j < samples; ++j)
          if (const auto point =
                  surface_point(scene, lens, port, view, x + offset(j), y + offset(i)))
            sum += shader(*point);
      image(y, x) = cv::Vec3f(sum.z(), sum.y(), sum.x()) * weight;
    }
  });
  return image;
}

void add_haze(cv::Mat3f& radiance, double haze) {
  const auto share = static_cast<float>(haze);
  for (cv::Vec3f& light : radiance) light = (1 - share) * light + cv::Vec3f::all(0.5f * share);
}

cv::Mat3b develop(const cv::Mat3f& radiance, double noise, std::uint64_t key) {
  cv::Mat3b image(radiance.size());
  const auto sigma = static_cast<float>(noise);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const auto pixel = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(image.cols) +
                         static_cast<std::uint64_t>(x);
      for (int c = 0; c < 3; ++c) {
        const std::uint64_t bits =
            scramble(scramble(key) + pixel * 3 + static_cast<std::uint64_t>(c));
        const float grey = 255.0f * radiance(y, x)[c] + sigma * bell(bits);
        image(y, x)[c] = static_cast<std::uint8_t>(std::clamp(grey, 0.0f, 255.0f) + 0.5f);
      }
    }
  }
  return image;
}

std::uint64_t noise_key(std::uint32_t seed, std::size_t view, bool water) {
  return (std::uint64_t{seed} << 32) + 2 * view + (water ? 1 : 0);
}

Truth render_truth(const RayScene& scene, const Lens& lens, const Port* port, const View& view) {
  Truth truth{cv::Mat1f(lens.height, lens.width, 0.0f),
              cv::Mat3f(lens.height, lens.width, cv::Vec3f(0, 0, 0))};
  parallel_for(static_cast<std::size_t>(lens.height), [&](std::size_t row) {
    const auto y = static_cast<int>(row);
    for (int x = 0; x < lens.width; ++x) {
      const auto in_camera = trace_pixel(lens, port, x, y);
      if (!in_camera) continue;
      const SceneRay ray = to_world(view, *in_camera);
      const auto hit = scene.first_hit(ray.start, ray.direction);
      if (!hit) continue;
      const double to_start = (ray.start - ray.on_axis).dot(ray.direction);
      truth.distance(y, x) = static_cast<float>(to_start + hit->distance);
      const Eigen::Vector3f n = hit->normal.cast<float>();
      truth.normal(y, x) = cv::Vec3f(n.x(), n.y(), n.z());
    }
  });
  return truth;
}

}  // namespace axial::simulate
