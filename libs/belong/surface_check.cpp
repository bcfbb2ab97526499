// SPDX-License-Identifier: GPL-3.0-or-later
#include "belong/surface_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "belong/surface_fit.h"
#include "geometry/surface.h"

namespace axial::belong {
namespace {

constexpr std::size_t kEnoughPlaces = 50;
constexpr std::size_t kImagesToSee = 64;
constexpr std::size_t kFewestPoints = 100;  // of a cloud: fewer do not show where it is

std::string_view word_for(const Shape& shape) {
  return shape.faces.empty() ? "cloud" : "mesh";
}

std::vector<std::uint32_t> calibrated_images(const Scene& scene) {
  std::vector<std::uint32_t> images;
  for (std::size_t i = 0; i < scene.images.size(); ++i)
    if (scene.images[i].calibrated) images.push_back(static_cast<std::uint32_t>(i));
  return images;
}

// True if one of `count` parts appears in one of the images.
bool appears(const Shape& shape, std::size_t count, std::span<const std::uint32_t> images,
             SceneCameras& cameras) {
  for (const std::size_t part : spread_indices(shape.parts(), count))
    for (const std::uint32_t image : images)
      if (cameras.pixel(image, shape.middle(part))) return true;
  return false;
}

// A line of sight [frame of the scene].
struct Sight {
  Eigen::Vector3d origin, direction;
};

// A few rays of the images.
std::vector<Sight> sights_of(std::span<const std::uint32_t> images, const Scene& scene,
                             SceneCameras& cameras) {
  constexpr int kColumns = 12, kRows = 9;
  std::vector<Sight> sights;
  for (const std::uint32_t image : images) {
    const SceneImage& view = scene.images[image];
    for (int k = 0; k < kColumns * kRows; ++k) {
      const Eigen::Vector2d pixel((k % kColumns + 0.5) * view.camera.width / kColumns - 0.5,
                                  (k / kColumns + 0.5) * view.camera.height / kRows - 0.5);
      const auto ray = cameras.of(image).ray(pixel);
      sights.push_back(
          {view.pose.to_world(ray.origin), view.pose.rotation.transpose() * ray.direction});
    }
  }
  return sights;
}

// Whether a line of sight may meet a sphere.
bool may_meet(const Sight& sight, const Eigen::Vector3d& centre, double radius) {
  const Eigen::Vector3d to_centre = centre - sight.origin;
  const double along = std::max(0.0, to_centre.dot(sight.direction.normalized()));
  const double distance = (to_centre - along * sight.direction.normalized()).norm();
  return !(distance > 1.001 * radius);
}

// True if one of a few rays of the images meets the mesh.
bool is_met(const Shape& shape, std::span<const std::uint32_t> images, const Scene& scene,
            SceneCameras& cameras) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : shape.vertices) box.extend(vertex.cast<double>());
  std::vector<Sight> sights = sights_of(images, scene, cameras);
  std::erase_if(sights, [&](const Sight& sight) {
    return !may_meet(sight, box.center(), box.diagonal().norm() / 2);
  });
  if (sights.empty()) return false;  // without the time to divide the mesh
  const geometry::Surface surface(Mesh{{shape.vertices.begin(), shape.vertices.end()},
                                       {},
                                       {shape.faces.begin(), shape.faces.end()}});
  return std::ranges::any_of(sights, [&](const Sight& sight) {
    return surface.first_hit(sight.origin, sight.direction).has_value();
  });
}

// True if a camera looks at a part of the shape, which others may hide.
bool is_in_view(const Scene& scene, const Shape& shape) {
  SceneCameras cameras(scene);
  const std::vector<std::uint32_t> all = calibrated_images(scene);
  std::vector<std::uint32_t> images;
  for (const std::size_t i : spread_indices(all.size(), kImagesToSee)) images.push_back(all[i]);
  if (appears(shape, 20'000, images, cameras)) return true;
  if (!shape.faces.empty()) return is_met(shape, images, scene, cameras);
  return appears(shape, 200'000, images, cameras);
}

// A difference between the coordinates of a shape and those of its scene.
struct Misfit {
  PlaceChange change, undo;
  double scale = 1;
  std::string text;  // "the mesh is ..."
};

std::vector<Misfit> misfits() {
  std::vector<Misfit> all;
  const auto scaled = [&](double factor, std::string text) {
    all.push_back({[=](const Eigen::Vector3d& x) { return Eigen::Vector3d(factor * x); },
                   [=](const Eigen::Vector3d& x) { return Eigen::Vector3d(x / factor); }, factor,
                   std::move(text)});
  };
  scaled(1000, "1000 times too large: is it in millimetres?");
  scaled(100, "100 times too large: is it in centimetres?");
  scaled(10, "10 times too large");
  scaled(0.1, "10 times too small");
  scaled(0.01, "100 times too small");
  scaled(0.001, "1000 times too small: is the scene in millimetres?");
  scaled(1 / 0.3048, "3.28 times too large: is it in feet?");
  scaled(0.3048, "3.28 times too small: is the scene in feet?");
  scaled(1 / 0.0254, "39.4 times too large: is it in inches?");
  const auto turned = [&](const Eigen::Matrix3d& axes, std::string text) {
    all.push_back({[=](const Eigen::Vector3d& x) { return Eigen::Vector3d(axes * x); },
                   [=](const Eigen::Vector3d& x) { return Eigen::Vector3d(axes.transpose() * x); },
                   1, std::move(text)});
  };
  Eigen::Matrix3d axes;
  axes << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  turned(axes, "turned: another program wrote x, z, -y for x, y, z");
  turned(axes.transpose(), "turned: another program wrote x, -z, y for x, y, z");
  turned(Eigen::Vector3d(1, -1, -1).asDiagonal(),
         "turned: another program wrote x, -y, -z for x, y, z");
  return all;
}

// The text of the difference with which the shape fits; empty: none is known.
std::string known_misfit(SurfaceMeasure& measure, const Shape& shape, double largest) {
  for (const Misfit& misfit : misfits())
    if (measure.fits_changed(shape, misfit.change, misfit.undo, misfit.scale, largest))
      return fmt::format("the {} is {}", word_for(shape), misfit.text);
  return {};
}

void report_misfit(const SurfaceCheck& check, bool is_certain, const std::string& text,
                   const Context& context) {
  if (is_certain && !check.only_warn) fail_in(check.shape, "{}", text);
  context.warning("{}: {}", check.shape.string(), text);
}

std::string distance_text(const Shape& shape, const SurfaceFit& fit) {
  return fmt::format("half of the scene's sparse points lie {:.1f} pixels or more from the {}",
                     fit.distance, word_for(shape));
}

// Reports a shape that does not fit. `known`: of known_misfit().
void report_distance(const SurfaceCheck& check, const Shape& shape, const SurfaceFit& fit,
                     double largest, const std::string& known, const Context& context) {
  const std::string cause =
      !known.empty() ? known
                     : fmt::format("is it the {} of another survey, or did the poses change since?",
                                   word_for(shape));
  report_misfit(check, !known.empty() || fit.distance >= 2 * largest,
                fmt::format("does not belong to {}: {}; {}", check.scene.string(),
                            distance_text(shape, fit), cause),
                context);
}

}  // namespace

double largest_distance(const Scene& scene, const Shape& shape, double spacing) {
  int side = 0;
  for (const SceneImage& image : scene.images)
    if (image.calibrated) side = std::max({side, image.camera.width, image.camera.height});
  return std::max({3.0, side / 300.0, (shape.faces.empty() ? 1 : 0.5) * spacing});
}

void check_surface(const Scene& scene, const Shape& shape, const SurfaceCheck& check,
                   const Context& context) {
  if (shape.parts() == 0 || calibrated_images(scene).empty()) return;
  if (shape.faces.empty() && shape.parts() < kFewestPoints) return;
  SurfaceMeasure measure(scene);
  const SurfaceFit fit = measure.places() >= kEnoughPlaces ? measure.fit(shape) : SurfaceFit{};
  const double largest = largest_distance(scene, shape, fit.spacing);
  if (fit.counted >= kEnoughPlaces && fit.distance <= largest) return;
  const std::string known =
      fit.places >= kEnoughPlaces ? known_misfit(measure, shape, largest) : std::string();
  if (fit.counted >= kEnoughPlaces)
    return report_distance(check, shape, fit, largest, known, context);
  if (!known.empty())
    return report_misfit(check, true,
                         fmt::format("does not belong to {}: {}", check.scene.string(), known),
                         context);
  if (!is_in_view(scene, shape))
    report_misfit(check, true,
                  fmt::format("no camera of {} looks at the {}: is it the {} of another survey, or "
                              "did it lose its offset?",
                              check.scene.string(), word_for(shape), word_for(shape)),
                  context);
}

}  // namespace axial::belong
