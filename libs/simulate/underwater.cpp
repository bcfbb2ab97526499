// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/underwater.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"

namespace axial::simulate {
namespace {

constexpr double kFarthest = 50;  // end of rays that hit nothing [m]

cv::Vec3f bgr(const Eigen::Vector3f& rgb) {
  return {rgb.z(), rgb.y(), rgb.x()};
}

// What the rays of a pixel bring: their mean.
struct PixelLight {
  Eigen::Vector3f straight = Eigen::Vector3f::Zero(), blurred = Eigen::Vector3f::Zero();
  Eigen::Vector3f albedo = Eigen::Vector3f::Zero();
  double distance = 0;
  float missed = 0;  // the share of rays that hit nothing
  float lit = 0;     // Irradiance::lit
};

// A camera in the scene.
struct Camera {
  const LitScene& scene;
  const Lens& lens;
  const Port& port;
  const View& view;
  int samples;

  // Calls add(light, point) for the surface on each ray of a pixel.
  template <class Add>
  PixelLight mean_of_rays(int x, int y, const Add& add) const {
    PixelLight light;
    const auto offset = [&](int i) { return (i + 0.5) / samples - 0.5; };
    for (int i = 0; i < samples; ++i)
      for (int j = 0; j < samples; ++j) {
        const auto point =
            surface_point(scene.scene, lens, &port, view, x + offset(j), y + offset(i));
        light.distance += point ? point->hit.distance : kFarthest;
        if (point)
          add(light, *point);
        else
          light.missed += 1;
      }
    const float weight = 1.0f / static_cast<float>(samples * samples);
    for (Eigen::Vector3f* color : {&light.straight, &light.blurred, &light.albedo})
      *color *= weight;
    light.distance *= weight;
    light.missed *= weight;
    light.lit *= weight;
    return light;
  }

  cv::Mat3f black() const { return cv::Mat3f(lens.height, lens.width, cv::Vec3f(0, 0, 0)); }

  // Calls of_pixel(x, y) for all pixels, rows in parallel.
  template <class OfPixel>
  void for_each_pixel(const OfPixel& of_pixel) const {
    parallel_for(static_cast<std::size_t>(lens.height), [&](std::size_t row) {
      for (int x = 0; x < lens.width; ++x) of_pixel(x, static_cast<int>(row));
    });
  }
};

LitImage render(const Camera& camera, const PlainWater& water) {
  LitImage image{camera.black(), camera.black(), {}};
  camera.for_each_pixel([&](int x, int y) {
    const PixelLight light =
        camera.mean_of_rays(x, y, [&](PixelLight& into, const SurfacePoint& point) {
          const Eigen::Vector3f color = camera.scene.albedo(point);
          into.albedo += color;
          into.straight += water.seen(color, point.hit.distance);
        });
    image.albedo(y, x) = bgr(light.albedo);
    image.radiance(y, x) =
        bgr(light.straight + light.missed * water.seen(Eigen::Vector3f::Zero(), kFarthest));
  });
  return image;
}

// Adds the light from a point of the surface.
void add_surface(PixelLight& into, const SurfacePoint& point, const LitScene& scene,
                 const Water& water, const LightOfView& light) {
  const Spectrum reflectance = reflectance_of(scene.albedo(point));
  const Eigen::Vector3d normal = smooth_normal(scene.mesh, scene.normals, point.hit);
  const Irradiance irradiance = light.irradiance(point.position, normal, point.hit.normal);
  const Spectrum leaving = reflectance * irradiance.light;
  into.lit += irradiance.lit;
  const auto way = static_cast<float>(point.hit.distance);
  const Spectrum straight = (-water.beam() * way).exp();
  into.albedo += color_of(reflectance);
  into.straight += color_of(leaving * straight);
  into.blurred += color_of(leaving * ((-water.loss() * way).exp() - straight));
}

LitImage render(const Camera& camera, const SpectralWater& lit) {
  const LightOfView light(lit.light, lit.water, camera.scene.scene, camera.view);
  LitImage image{camera.black(), camera.black(),
                 cv::Mat1f(camera.lens.height, camera.lens.width, 0.0f)};
  cv::Mat3f blurred = camera.black();
  camera.for_each_pixel([&](int x, int y) {
    const auto in_camera = trace_pixel(camera.lens, &camera.port, x, y);
    if (!in_camera) return;
    const PixelLight pixel =
        camera.mean_of_rays(x, y, [&](PixelLight& into, const SurfacePoint& point) {
          add_surface(into, point, camera.scene, lit.water, light);
        });
    const SceneRay ray = to_world(camera.view, *in_camera);
    const Spectrum veil = light.veil(ray.start, ray.direction, pixel.distance);
    image.albedo(y, x) = bgr(pixel.albedo);
    image.lit(y, x) = pixel.lit;
    image.radiance(y, x) = bgr(pixel.straight + color_of(veil));
    blurred(y, x) = bgr(pixel.blurred);
  });
  const double magnification = camera.port.dome ? 1 : camera.port.n_water / camera.port.n_air;
  const double sigma = lit.water.blur_angle * camera.lens.focal * magnification;  // [px]
  cv::GaussianBlur(blurred, blurred, {}, sigma, sigma, cv::BORDER_REPLICATE);
  image.radiance += blurred;
  return image;
}

float srgb(float light) {
  return light <= 0.0031308f ? 12.92f * light : 1.055f * std::pow(light, 1 / 2.4f) - 0.055f;
}

}  // namespace

LitImage render_underwater(const LitScene& scene, const AnyWater& water, const Lens& lens,
                           const Port& port, const View& view, int samples) {
  if (samples < 1 || samples > 16) fail("samples is {}: must be between 1 and 16", samples);
  const Camera camera{scene, lens, port, view, samples};
  return std::visit([&](const auto& kind) { return render(camera, kind); }, water);
}

cv::Vec3f white_balance(const AnyWater& water) {
  const auto* spectral = std::get_if<SpectralWater>(&water);
  if (!spectral) return {1, 1, 1};
  const Eigen::Vector3f white = color_of(spectral->light.lamps.empty() ? daylight() : white_led());
  return bgr(white.cwiseInverse());
}

double exposure(std::span<const cv::Mat3f> radiances, const cv::Vec3f& balance) {
  constexpr double kShare = 0.98, kValue = 0.8;
  std::vector<float> brightest;
  for (const cv::Mat3f& image : radiances)
    for (const cv::Vec3f& light : image)
      brightest.push_back(
          std::max({light[0] * balance[0], light[1] * balance[1], light[2] * balance[2]}));
  if (brightest.empty()) return 1;
  const auto place = brightest.begin() + static_cast<std::ptrdiff_t>(
                                             kShare * static_cast<double>(brightest.size() - 1));
  std::ranges::nth_element(brightest, place);
  return *place > 0 ? kValue / *place : 1;
}

Response parse_response(const std::string& name) {
  if (name == "linear") return Response::linear;
  if (name == "srgb") return Response::srgb;
  if (name == "camera") return Response::camera;
  fail("response is '{}', but must be linear, srgb or camera", name);
}

cv::Mat3f photograph_of(const cv::Mat3f& radiance, const cv::Vec3f& gains, Response response) {
  constexpr float kContrast = 0.35f;  // the share of a smooth step in the curve of `camera`
  cv::Mat3f image = radiance.clone();
  for (cv::Vec3f& pixel : image)
    for (int channel = 0; channel < 3; ++channel) {
      float value = std::clamp(pixel[channel] * gains[channel], 0.0f, 1.0f);
      if (response != Response::linear) value = srgb(value);
      if (response == Response::camera)
        value += kContrast * (value * value * (3 - 2 * value) - value);
      pixel[channel] = value;
    }
  return image;
}

}  // namespace axial::simulate
