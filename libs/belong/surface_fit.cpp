// SPDX-License-Identifier: GPL-3.0-or-later
#include "belong/surface_fit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "belong/coverage.h"
#include "belong/nearest_places.h"

namespace axial::belong {
namespace {

constexpr std::size_t kMostPlaces = 2000, kMostSights = 6, kMostImages = 16, kMostParts = 20'000;

double quantile_of(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double median_of_values(std::vector<double> values) {
  return quantile_of(std::move(values), 0.5);
}

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
  reach_ = 1.5 * kFarthest * quantile_of(footprints, 0.75);
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

double SurfaceMeasure::median_distance(const Shape& shape, const std::vector<std::size_t>& of,
                                       const PlaceChange& change, const PlaceChange& undo,
                                       double scale) {
  if (of.empty() || !(reach_ > 0) || !std::isfinite(reach_ * scale)) return kFarthest;
  std::vector<Eigen::Vector3d> at;
  for (const std::size_t i : of) at.push_back(change(places_[i].position));
  const auto nearest = nearest_places(shape, at, reach_ * scale);
  std::vector<double> distances;
  for (std::size_t k = 0; k < of.size(); ++k) {
    distances.push_back(nearest[k] ? distance_in_images(places_[of[k]], undo(*nearest[k]))
                                   : kFarthest);
  }
  return median_of_values(std::move(distances));
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
  result.spacing = median_of_values(std::move(spacings));
  if (!counted.empty()) result.distance = median_distance(shape, counted, unchanged, unchanged, 1);
  return result;
}

double SurfaceMeasure::changed_distance(const Shape& shape, const PlaceChange& change,
                                        const PlaceChange& undo, double scale) {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < places_.size(); ++i) all.push_back(i);
  return median_distance(shape, all, change, undo, scale);
}

}  // namespace axial::belong
