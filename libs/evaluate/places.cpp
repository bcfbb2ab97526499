// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/places.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "base/error.h"
#include "geometry/sampling.h"

namespace axial::evaluate {
namespace {

constexpr std::size_t kMostDraws = 20;     // factor of the requested samples
constexpr std::uint32_t kEnoughViews = 4;  // this many views and more are one class

Places seen_places(const Mesh& truth, const geometry::Surface& surface, std::span<const View> views,
                   std::size_t samples, const PlaceDraw& draw) {
  Places places;
  places.drawn = samples;
  places.positions = geometry::sample_surface(truth, samples, draw.seed, &places.faces);
  if (views.empty()) return places;
  places.views = count_views(places.positions, views, surface);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    if (places.views[i] < draw.least_views) continue;
    places.positions[kept] = places.positions[i];
    places.faces[kept] = places.faces[i];
    places.views[kept] = places.views[i];
    ++kept;
  }
  places.positions.resize(kept);
  places.faces.resize(kept);
  places.views.resize(kept);
  return places;
}

// Counts a place in the first class for which `is_in` is true.
template <class Class, class IsIn>
void count_place(std::vector<Class>& classes, float distance, std::span<const double> tolerances,
                 IsIn is_in) {
  const auto found = std::ranges::find_if(classes, is_in);
  if (found == classes.end()) return;
  ++found->places;
  for (std::size_t k = 0; k < tolerances.size(); ++k)
    if (distance <= static_cast<float>(tolerances[k])) ++found->recall[k];
}

template <class Class>
void counts_to_shares(std::vector<Class>& classes) {
  for (Class& one : classes)
    for (double& recall : one.recall)
      if (one.places > 0) recall /= static_cast<double>(one.places);
}

// The thickness at a place: the mean of the face's corners, or 0 if not all corners belong to a
// thin structure.
double thickness_at(const Mesh& truth, std::uint32_t face, std::span<const float> thickness) {
  double sum = 0;
  for (const std::uint32_t corner : truth.faces[face]) {
    if (!(thickness[corner] > 0)) return 0;
    sum += static_cast<double>(thickness[corner]);
  }
  return sum / 3;
}

std::vector<RecallOfThickness> thickness_classes(std::size_t tolerances) {
  const std::vector<double> none(tolerances, 0);
  std::vector<RecallOfThickness> classes;
  double least = 0, most = std::numbers::sqrt2;
  for (int k = 0; k < 5; ++k) {
    classes.push_back({least, most, 0, none});
    least = most;
    most *= 2;
  }
  classes.push_back({least, 0, 0, none});
  classes.push_back({0, 0, 0, none});
  return classes;
}

}  // namespace

Places draw_places(const Mesh& truth, const geometry::Surface& surface, std::span<const View> views,
                   const PlaceDraw& draw) {
  Places places = seen_places(truth, surface, views, draw.samples, draw);
  if (views.empty()) return places;
  // If the truth reaches far beyond the photographs, more samples are needed for the same number
  // that count.
  const std::size_t factor =
      std::min(kMostDraws, draw.samples / std::max<std::size_t>(places.size(), 1));
  if (factor > 1) places = seen_places(truth, surface, views, factor * draw.samples, draw);
  if (places.size() == 0)
    fail("no sample of the truth is seen by {} of the {} views", draw.least_views, views.size());
  return places;
}

std::vector<RecallOfViews> recall_by_views(const Places& places, std::span<const float> distances,
                                           std::span<const double> tolerances,
                                           std::uint32_t least) {
  const std::vector<double> none(tolerances.size(), 0);
  std::vector<RecallOfViews> classes;
  for (std::uint32_t views = least; views < kEnoughViews; ++views)
    classes.push_back({views, views, 0, none});
  classes.push_back({std::max(least, kEnoughViews), 0, 0, none});
  for (std::size_t i = 0; i < places.size(); ++i)
    count_place(classes, distances[i], tolerances, [&](const RecallOfViews& one) {
      return places.views[i] >= one.least && (one.most == 0 || places.views[i] <= one.most);
    });
  counts_to_shares(classes);
  return classes;
}

std::vector<RecallOfThickness> recall_by_thickness(
    const Places& places, std::span<const float> distances, std::span<const double> tolerances,
    const Mesh& truth, const geometry::Surface& surface, std::span<const float> thickness,
    std::span<const View> views) {
  if (thickness.size() != truth.vertices.size())
    fail("the truth has {} values of thickness for {} vertices", thickness.size(),
         truth.vertices.size());
  const std::vector<float> widths = pixel_widths(places.positions, views, surface);
  std::vector<RecallOfThickness> classes = thickness_classes(tolerances.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double metres = thickness_at(truth, places.faces[i], thickness);
    const double pixels = metres / static_cast<double>(widths[i]);
    count_place(classes, distances[i], tolerances, [&](const RecallOfThickness& one) {
      if (one.least == 0 && one.most == 0) return metres == 0;
      return metres > 0 && pixels >= one.least && (one.most == 0 || pixels < one.most);
    });
  }
  counts_to_shares(classes);
  return classes;
}

}  // namespace axial::evaluate
