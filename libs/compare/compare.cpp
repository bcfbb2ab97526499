// SPDX-License-Identifier: GPL-3.0-or-later
#include "axial/compare.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/error.h"
#include "base/naming.h"
#include "base/order_statistics.h"
#include "base/parallel.h"
#include "compare/changes.h"
#include "compare/height_map.h"
#include "compare/noise.h"
#include "compare/registration.h"
#include "compare/same_place.h"
#include "compare/visibility.h"
#include "geometry/faces.h"
#include "geometry/surface.h"
#include "map/geotiff.h"
#include "map/pixel_width.h"
#include "scene/check_mesh.h"

namespace axial::compare {
namespace {

// The most at the same time: height, difference, standard deviation, class and whether it is seen,
// and a list of the pixels of one region, which grows by doubling.
constexpr std::uint64_t kBytesPerPixel = 4 + 4 + 4 + 1 + 1 + 24;

// The standard deviation of a height is this part of the bend of the surface: meshes with vertices
// at other places cut off other parts of edges and of furrows.
constexpr double kOfBend = 0.25;
// The largest of four bends of a level surface with noise, squared, divided by the variance of the
// difference of two such surfaces.
constexpr double kNoisyBend = 12;

// The most pixels along a side of a grid around one survey, of which the common part is a map.
constexpr double kMostOfSurvey = 2e9;

// The pixels that both grids have. Both have corners at multiples of the same pixel width. Errors
// of map::require_possible() are passed on.
map::MapGrid common_grid(const map::MapGrid& a, const map::MapGrid& b) {
  const double pixel = a.pixel;
  const double left = std::max(a.left, b.left), top = std::min(a.top, b.top);
  const double right = std::min(a.left + a.columns * pixel, b.left + b.columns * pixel);
  const double bottom = std::max(a.top - a.rows * pixel, b.top - b.rows * pixel);
  const double columns = std::round((right - left) / pixel),
               rows = std::round((top - bottom) / pixel);
  if (!(columns >= 1 && rows >= 1)) fail("the surveys do not overlap");
  map::require_possible(columns, rows, pixel);
  return {left, top, pixel, static_cast<int>(columns), static_cast<int>(rows)};
}

// vertex_distance() of a mesh that is one. Errors name the survey.
double checked_distance(const Mesh& mesh, const std::filesystem::path& name) {
  return naming(name, [&] {
    check_mesh(mesh);
    return vertex_distance(mesh);
  });
}

void require_memory(const Mesh& before, const Mesh& after, const map::MapFrame& frame,
                    const map::MapGrid& grid, const CompareOptions& options,
                    const Context& context) {
  std::uint64_t mesh =
      std::max(bytes_of_height_map(before, frame, grid), bytes_of_height_map(after, frame, grid));
  if (!options.photos.before.empty()) mesh = std::max(mesh, geometry::bytes_of_surface(before));
  if (!options.photos.after.empty()) mesh = std::max(mesh, geometry::bytes_of_surface(after));
  context.memory().require(
      map::kCacheBytes + mesh + kBytesPerPixel * static_cast<std::uint64_t>(grid.pixels()),
      fmt::format("a map of {} x {} pixels", grid.columns, grid.rows));
}

// The maps of a comparison before the noise is known.
struct Maps {
  cv::Mat1f steepness;     // sqrt(1 + slope^2) of the steeper surface
  cv::Mat1f bend;          // bend_at() of the surface that bends more [m]
  cv::Mat1f registration;  // standard deviation by the registration [m]
};

// Fills `difference`, whose pixels are at first the heights of the later survey.
Maps subtract(Comparison& comparison) {
  const cv::Mat1f after = comparison.difference;
  comparison.difference = cv::Mat1f(after.size(), std::numeric_limits<float>::quiet_NaN());
  Maps maps{comparison.difference.clone(), comparison.difference.clone(),
            comparison.difference.clone()};
  const map::MapGrid& grid = comparison.grid;
  parallel_for(static_cast<std::size_t>(after.rows), [&](std::size_t row) {
    const auto y = static_cast<int>(row);
    for (int x = 0; x < after.cols; ++x) {
      const float low = comparison.before(y, x), high = after(y, x);
      if (std::isnan(low) || std::isnan(high)) continue;
      const Eigen::Vector2d a = slope_at(comparison.before, y, x, grid.pixel);
      const Eigen::Vector2d b = slope_at(after, y, x, grid.pixel);
      const Eigen::Vector3d place = grid.centre(y, x, comparison.base + static_cast<double>(high));
      const Registration& registration = comparison.registration;
      comparison.difference(y, x) = high - low;
      maps.steepness(y, x) =
          static_cast<float>(std::sqrt(1 + std::max(a.squaredNorm(), b.squaredNorm())));
      maps.bend(y, x) =
          static_cast<float>(std::max(bend_at(comparison.before, y, x), bend_at(after, y, x)));
      maps.registration(y, x) = static_cast<float>(
          std::sqrt(std::max(0.0, registration.height_variance(place, 0.5 * (a + b)))));
    }
  });
  return maps;
}

// Fills `before`, and `difference` with the heights of the later survey.
void fill_heights(const Mesh& before, const Mesh& after, const map::MapFrame& after_frame,
                  const ProgressSink& progress, Comparison& result) {
  const auto half = [&](std::size_t first) {
    return [&progress, first](std::size_t done, std::size_t blocks) {
      progress(first * blocks + done, 2 * blocks);
    };
  };
  result.before = height_map(before, result.frame, result.grid, result.base, 1, half(0));
  result.difference = height_map(after, after_frame, result.grid, result.base, 1, half(1));
}

// 255 at the pixels that a survey with known photographs did not see; empty if there is none.
// `difference` has the heights of the later survey.
cv::Mat1b find_unseen(const Mesh& before, const Mesh& after, const map::MapFrame& after_frame,
                      const SurveyPhotos& photos, const ProgressSink& progress,
                      const Comparison& result) {
  constexpr double kSlack = 2;  // [px]
  cv::Mat1b unseen;
  if (photos.before.empty() && photos.after.empty()) return unseen;
  unseen = cv::Mat1b(result.before.size(), std::uint8_t{0});
  const double slack = kSlack * result.grid.pixel;
  if (!photos.before.empty())
    mark_unseen({before, result.frame, photos.before}, result.grid, result.base, result.before,
                result.difference, photos.least, slack, progress, unseen);
  if (!photos.after.empty())
    mark_unseen({after, after_frame, photos.after}, result.grid, result.base, result.difference,
                result.before, photos.least, slack, progress, unseen);
  return unseen;
}

// Error if the photographs see no place that both surveys have.
void require_seen_places(const cv::Mat1f& difference, const cv::Mat1b& unseen,
                         const CompareOptions& options) {
  if (unseen.empty()) return;
  for (int y = 0; y < difference.rows; ++y)
    for (int x = 0; x < difference.cols; ++x)
      if (!std::isnan(difference(y, x)) && unseen(y, x) == 0) return;
  fail(
      "{} {}: no place of both surveys is seen by so many photographs; are the scenes those of "
      "the meshes?",
      setting("min_views"), options.photos.least);
}

// Whether the heights show the same place, where photographs see it.
PlaceAgreement place_of(const cv::Mat1f& before, const cv::Mat1f& after, const cv::Mat1b& unseen) {
  if (unseen.empty()) return agreement_of_places(before, after);
  cv::Mat1f seen = after.clone();
  seen.setTo(std::numeric_limits<float>::quiet_NaN(), unseen);
  return agreement_of_places(before, seen);
}

void require_same_place(const PlaceAgreement& place, const CompareOptions& options) {
  if (place.verdict == PlaceVerdict::different && !options.allow_other_place)
    fail_in(options.name_after,
            "does not show the place of {}: the correlation of their reliefs is {:.2f} (by chance "
            "{:.2f}), and that of one place {:.2f} or more; {} compares them all the same",
            options.name_before.string(), place.correlation, place.chance, place.least,
            setting("allow_other_place"));
}

// Estimates the noise, or takes the given one.
Noise noise_of(const cv::Mat1f& difference, const cv::Mat1b& unseen, const cv::Mat1f& steepness,
               const CompareOptions& options, double pixel) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  cv::Mat1f seen = difference;
  if (!unseen.empty()) {
    seen = difference.clone();
    seen.setTo(kNone, unseen);
  }
  if (options.sigmas)
    return given_noise(seen, steepness, std::hypot(options.sigmas->before, options.sigmas->after));
  const double least = 1e-3 * pixel;  // of float rounding, for surveys without noise
  return estimate_noise(seen, steepness, least);
}

// Leaves out the places that are not inside of CompareOptions::is_inside.
void keep_inside(const CompareOptions& options, Comparison& result) {
  if (!options.is_inside) return;
  const map::MapGrid& grid = result.grid;
  parallel_for(static_cast<std::size_t>(grid.rows), [&](std::size_t row) {
    const auto y = static_cast<int>(row);
    for (int x = 0; x < grid.columns; ++x)
      if (!options.is_inside(grid.centre(y, x, 0).head<2>()))
        result.difference(y, x) = std::numeric_limits<float>::quiet_NaN();
  });
  if (std::ranges::all_of(result.difference, [](float value) { return std::isnan(value); }))
    fail_in(options.name_after,
            "no place of both surveys is inside of the boundary: they have x from {:.2f} to {:.2f} "
            "and y from {:.2f} to {:.2f} in common",
            grid.left, grid.left + grid.columns * grid.pixel, grid.top - grid.rows * grid.pixel,
            grid.top);
}

void fill_sigma(const Maps& maps, Comparison& comparison) {
  comparison.sigma = cv::Mat1f(comparison.difference.size(), 0.f);
  for (int y = 0; y < comparison.sigma.rows; ++y)
    for (int x = 0; x < comparison.sigma.cols; ++x) {
      const auto squared = [](float value) {
        return static_cast<double>(value) * static_cast<double>(value);
      };
      const double noise = squared(comparison.noise.at(y, x) * maps.steepness(y, x));
      const double bend = squared(maps.bend(y, x)) - kNoisyBend * noise;
      // NaN where there is no difference.
      comparison.sigma(y, x) = static_cast<float>(std::sqrt(
          noise + kOfBend * kOfBend * std::max(0.0, bend) + squared(maps.registration(y, x))));
    }
  comparison.registration_sigma =
      upper_median(spread_values(maps.registration.size(), [&](int y, int x) {
        return static_cast<double>(maps.registration(y, x));
      }));
}

// The area [m^2] that both surveys have, but that is not compared because of `unseen`.
double area_left_out(const cv::Mat1b& unseen, const Comparison& comparison) {
  std::size_t pixels = 0;
  for (int y = 0; y < unseen.rows; ++y)
    for (int x = 0; x < unseen.cols; ++x)
      pixels += unseen(y, x) != 0 && !std::isnan(comparison.difference(y, x)) &&
                comparison.changes.classes(y, x) == kNotCompared;
  return static_cast<double>(pixels) * comparison.grid.pixel * comparison.grid.pixel;
}

// Neighbouring pixels that are narrower than the distance of the vertices are not independent.
int least_pixels(int least, double vertex_distance, double pixel) {
  const double finer = std::max(1.0, vertex_distance / pixel);
  return static_cast<int>(std::min(std::round(least * finer * finer), 1e9));
}

// A comparison with the frame, the grid and the registration. `after_frame` becomes the frame of
// the later survey on the map.
Comparison placed(const Mesh& before, const Mesh& after, const map::MapFrame& frame,
                  const CompareOptions& options, map::MapFrame& after_frame,
                  const Context& context) {
  const double distance_before = checked_distance(before, options.name_before),
               distance_after = checked_distance(after, options.name_after);
  const double pixel = options.pixel > 0
                           ? options.pixel
                           : map::rounded_width(std::max(distance_before, distance_after));
  Comparison result;
  result.least_pixels =
      least_pixels(options.changes.least_pixels, std::max(distance_before, distance_after), pixel);
  result.frame = frame;
  result.base = frame.origin.z();
  const map::MapGrid of_before = naming(
      options.name_before, [&] { return map::grid_around(before, frame, pixel, kMostOfSurvey); });
  const auto common = [&](const map::MapFrame& of_after) {
    return naming(options.name_after, [&] {
      return common_grid(of_before, map::grid_around(after, of_after, pixel, kMostOfSurvey));
    });
  };
  result.grid = common(frame);
  require_memory(before, after, frame, result.grid, options, context);
  after_frame = frame;
  if (options.registered) {
    result.registration = *options.registered;
  } else if (options.align) {
    context.memory().require(geometry::bytes_of_surface(before), "the registration");
    result.registration = naming(options.name_after, [&] {
      return register_surveys(before, after, frame, result.grid, options.registration,
                              context.stage("Registration"));
    });
    after_frame = moved(frame, result.registration.motion);
    result.grid = common(after_frame);
    require_memory(before, after, after_frame, result.grid, options, context);
  }
  return result;
}

}  // namespace

double vertex_distance(const Mesh& mesh) {
  return std::sqrt(geometry::area_of(mesh) / static_cast<double>(mesh.vertices.size()));
}

Eigen::Vector3d upward_direction(const Mesh& mesh, const Eigen::Vector3d& facing) {
  if (!(facing.norm() > 1e-6)) fail("the mesh does not show which side of it is up");
  const Eigen::Vector3d normal = map::fitted_plane(mesh).normal;
  return normal.dot(facing) > 0 ? normal : Eigen::Vector3d(-normal);
}

Comparison compare_surveys(const Mesh& before, const Mesh& after, const map::MapFrame& frame,
                           const CompareOptions& options, const Context& context) {
  map::MapFrame after_frame;
  Comparison result = placed(before, after, frame, options, after_frame, context);
  fill_heights(before, after, after_frame, context.stage("Heights"), result);
  const cv::Mat1b unseen =
      find_unseen(before, after, after_frame, options.photos, context.stage("Sights"), result);
  result.place = place_of(result.before, result.difference, unseen);
  Maps maps = subtract(result);
  if (std::ranges::all_of(result.difference, [](float value) { return std::isnan(value); }))
    fail_in(options.name_after, "the surveys do not overlap");
  require_seen_places(result.difference, unseen, options);
  require_same_place(result.place, options);
  result.noise = noise_of(result.difference, unseen, maps.steepness, options, result.grid.pixel);
  keep_inside(options, result);
  fill_sigma(maps, result);
  maps = {};
  ChangeOptions changes = options.changes;
  changes.least_pixels = result.least_pixels;
  result.changes =
      find_changes(result.difference, result.sigma,
                   {result.grid, result.registration, result.noise.correlation, unseen}, changes);
  cv::Mat1b left_out;
  cv::compare(result.changes.classes, kNotCompared, left_out, cv::CMP_EQ);
  result.area_unseen = area_left_out(unseen, result);
  for (cv::Mat1f* map : {&result.difference, &result.sigma})
    map->setTo(std::numeric_limits<float>::quiet_NaN(), left_out);
  return result;
}

}  // namespace axial::compare
