// SPDX-License-Identifier: GPL-3.0-or-later
#include "belong/surface_fit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "base/order_statistics.h"
#include "belong/coverage.h"
#include "belong/nearest_places.h"

namespace axial::belong {
namespace {

constexpr std::size_t kMostPlaces = 2000, kMostSights = 6, kMostImages = 16, kMostParts = 20'000;
constexpr std::size_t kFewPlaces = 100;  // tell that a shape does not fit

Eigen::Vector3d unchanged(const Eigen::Vector3d& place) {
  return place;
}

}  // namespace

SurfaceMeasure::SurfaceMeasure(const Scene& scene)
    : scene_(scene),
      cameras_(scene),
      places_(spread_places(scene, cameras_, kMostPlaces, kMostSights)) {
  std::vector<double> footprints;
  for (const SparsePlace& place : places_)
    if (const double width = footprint(place); std::isfinite(width) && width > 0)
      footprints.push_back(width);
  reach_ = 1.5 * kFarthest * lower_quantile(std::move(footprints), 0.75);
}

// The width of a pixel at a sparse point, in the first image that sees it [unit of the scene].
double SurfaceMeasure::footprint(const SparsePlace& place) {
  const PlaceSight& sight = place.sights.front();
  refractive::Matrix23<double> jacobian;
  cameras_.of(sight.image)
      .project(scene_.images[sight.image].pose.to_camera(place.position), &jacobian);
  return std::sqrt(2.0) / jacobian.norm();
}

// The largest distance between the images of a sparse point and of another point [px]; kFarthest if
// no image sees the other point.
double SurfaceMeasure::distance_in_images(const SparsePlace& place, const Eigen::Vector3d& point) {
  double largest = -1;
  for (const PlaceSight& sight : place.sights)
    if (const auto pixel = cameras_.pixel(sight.image, point))
      largest = std::max(largest, (*pixel - sight.pixel).norm());
  return largest < 0 ? kFarthest : std::min(largest, kFarthest);
}

// The distances [px] of the places `of` from the shape; as for fits_changed().
std::vector<double> SurfaceMeasure::distances(const Shape& shape,
                                              const std::vector<std::size_t>& of,
                                              const PlaceChange& change, const PlaceChange& undo,
                                              double scale) {
  if (!(reach_ > 0) || !std::isfinite(reach_ * scale))
    return std::vector<double>(of.size(), kFarthest);
  std::vector<Eigen::Vector3d> at;
  for (const std::size_t i : of) at.push_back(change(places_[i].position));
  const auto nearest = nearest_places(shape, at, reach_ * scale);
  std::vector<double> result;
  for (std::size_t k = 0; k < of.size(); ++k)
    result.push_back(nearest[k] ? distance_in_images(places_[of[k]], undo(*nearest[k]))
                                : kFarthest);
  return result;
}

SurfaceFit SurfaceMeasure::fit(const Shape& shape) {
  SurfaceFit result;
  result.places = places_.size();
  std::map<std::uint32_t, std::vector<std::size_t>> seen;  // places of each image
  for (std::size_t i = 0; i < places_.size(); ++i)
    for (const PlaceSight& sight : places_[i].sights) seen[sight.image].push_back(i);
  std::vector<std::uint32_t> images;
  for (const auto& [image, seen_places] : seen) images.push_back(image);
  const std::vector<std::size_t> parts = spread_indices(shape.parts(), kMostParts);
  std::vector<bool> counts(places_.size());
  std::vector<double> spacings;
  for (const std::size_t i : spread_indices(images.size(), kMostImages)) {
    const Coverage coverage = coverage_of(scene_, cameras_, images[i], shape, parts);
    if (coverage.cell <= 0) continue;
    spacings.push_back(coverage.spacing);
    for (const std::size_t place : seen[images[i]])
      for (const PlaceSight& sight : places_[place].sights)
        if (sight.image == images[i] && coverage.contains(sight.pixel)) counts[place] = true;
  }
  std::vector<std::size_t> counted;
  for (std::size_t i = 0; i < places_.size(); ++i)
    if (counts[i]) counted.push_back(i);
  result.counted = counted.size();
  result.spacing = lower_quantile(std::move(spacings), 0.5);
  result.distance = lower_quantile(distances(shape, counted, unchanged, unchanged, 1), 0.5);
  return result;
}

bool SurfaceMeasure::fits_changed(const Shape& shape, const PlaceChange& change,
                                  const PlaceChange& undo, double scale, double largest) {
  // If half of all places fit, it is very unlikely that fewer than a fifth of these fit.
  const std::vector<std::size_t> some = spread_indices(places_.size(), kFewPlaces);
  if (lower_quantile(distances(shape, some, change, undo, scale), 0.2) > largest) return false;
  const std::vector<std::size_t> all = spread_indices(places_.size(), places_.size());
  return lower_quantile(distances(shape, all, change, undo, scale), 0.5) <= largest;
}

}  // namespace axial::belong
