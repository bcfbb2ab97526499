// SPDX-License-Identifier: GPL-3.0-or-later
// Scores the neighbours of every image, and bounds the memory that this needs.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <bitset>
#include <cmath>
#include <numeric>
#include <span>
#include <unordered_map>

#include "base/error.h"
#include "base/heap_bytes.h"
#include "base/parallel.h"
#include "scene/camera_model.h"
#include "scene/view_selection.h"

namespace axial {
namespace {

constexpr int kGrid = 16;  // cells per side of the image, for the area that two views share

// One sparse point in one image. `depth` is 0 if the camera cannot have seen the point.
struct Observation {
  std::uint32_t image = 0;
  std::uint32_t point = 0;
  Eigen::Vector3f direction = Eigen::Vector3f::Zero();  // of the ray in the medium, world frame
  float footprint = 0;                                  // [px/m]
  float depth = 0;                                      // z in the camera frame
  float lambda = 0;
  std::int16_t cell = -1;  // of the kGrid x kGrid cells; -1: outside the image
  bool behind = false;     // the point is behind the camera
};

// All observations, sorted by point; by_image holds their indices, sorted by image, then by point.
struct Observations {
  std::vector<Observation> all;
  std::vector<std::size_t> point_begin;
  std::vector<std::size_t> image_begin, by_image;

  std::span<const std::size_t> of_image(std::size_t image) const {
    return std::span(by_image).subspan(image_begin[image],
                                       image_begin[image + 1] - image_begin[image]);
  }
};

// Calls `visit` for each calibrated image that sees the point, once.
template <class Visit>
void each_image(const Scene& scene, std::size_t p, const Visit& visit) {
  if (!scene.points[p].position.allFinite()) return;
  std::uint32_t previous = kNoId;
  for (const SparseView& view : scene.points[p].views) {
    if (view.image >= scene.images.size()) {
      fail("points[{}]: refers to image {}, but there are {} images", p, view.image,
           scene.images.size());
    }
    if (view.image == previous || !scene.images[view.image].calibrated) continue;
    previous = view.image;
    visit(view.image);
  }
}

// Where each image's part begins in a list of observations sorted by image, and the list's length.
std::vector<std::size_t> image_begins(const Scene& scene) {
  std::vector<std::size_t> begin(scene.images.size() + 1);
  for (std::size_t p = 0; p < scene.points.size(); ++p)
    each_image(scene, p, [&](std::uint32_t image) { ++begin[image + 1]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  return begin;
}

// All lists get their final size at once: a list that grows needs its memory twice for a moment.
Observations collect(const Scene& scene) {
  Observations result;
  result.image_begin = image_begins(scene);
  result.by_image.resize(result.image_begin.back());
  result.all.reserve(result.image_begin.back());
  result.point_begin.reserve(scene.points.size() + 1);
  std::vector<std::size_t> next = result.image_begin;
  for (std::size_t p = 0; p < scene.points.size(); ++p) {
    result.point_begin.push_back(result.all.size());
    each_image(scene, p, [&](std::uint32_t image) {
      result.by_image[next[image]++] = result.all.size();
      Observation observation;
      observation.image = image;
      observation.point = static_cast<std::uint32_t>(p);
      result.all.push_back(observation);
    });
  }
  result.point_begin.push_back(result.all.size());
  return result;
}

// The smaller singular value of d(pixel)/dX, with the second row scaled to fx. For a pinhole it is
// exactly fx / z, because J J^T = (fx/z)^2 (I + b b^T) with b = (x/z, y/z).
double footprint_of(refractive::Matrix23<double> jacobian, const CameraModel& camera) {
  jacobian.row(1) *= camera.lens.fx / camera.lens.fy;
  const refractive::Matrix2<double> square = jacobian * jacobian.transpose();
  const double half_trace = square.trace() / 2;
  const double half_difference = (square(0, 0) - square(1, 1)) / 2;
  const double larger = half_trace + std::hypot(half_difference, square(0, 1));
  return std::sqrt(std::max(0.0, square.determinant() / larger));
}

// Ignores the half pixel at the image's corner, as the scores stored in OpenMVS scenes do.
std::int16_t cell_of(const Eigen::Vector2d& pixel, const CameraModel& camera) {
  const double x = pixel.x() / camera.width;
  const double y = pixel.y() / camera.height;
  if (!(x >= 0 && x < 1 && y >= 0 && y < 1)) return -1;
  return static_cast<std::int16_t>(static_cast<int>(y * kGrid) * kGrid +
                                   static_cast<int>(x * kGrid));
}

template <class Camera>
void observe(const SceneImage& image, const Camera& camera, const Eigen::Vector3d& position,
             Observation& observation) {
  const Eigen::Vector3d X = image.pose.to_camera(position);
  refractive::Matrix23<double> jacobian;
  observation.behind = !(X.z() > 0);
  const auto projection = camera.project(X, &jacobian);
  if (!projection.visible || !(X.z() > 0)) return;
  const auto ray = camera.ray(projection.pixel);
  observation.direction = (image.pose.rotation.transpose() * ray.direction).template cast<float>();
  observation.footprint = static_cast<float>(footprint_of(jacobian, image.camera));
  observation.depth = static_cast<float>(X.z());
  observation.lambda = static_cast<float>((X - ray.origin).dot(ray.direction));
  observation.cell = cell_of(projection.pixel, image.camera);
}

std::vector<CameraVariant<double>> cameras_of(const Scene& scene) {
  std::vector<CameraVariant<double>> cameras;
  cameras.reserve(scene.images.size());
  for (const SceneImage& image : scene.images)
    cameras.push_back(image.calibrated ? make_camera<double>(image.camera)
                                       : CameraVariant<double>());
  return cameras;
}

// Fills the observations of one point.
void observe_point(const Scene& scene, const std::vector<CameraVariant<double>>& cameras,
                   std::size_t point, Observations& observations) {
  const Eigen::Vector3d position = scene.points[point].position.cast<double>();
  for (std::size_t i = observations.point_begin[point]; i < observations.point_begin[point + 1];
       ++i) {
    Observation& observation = observations.all[i];
    std::visit(
        [&](const auto& camera) {
          observe(scene.images[observation.image], camera, position, observation);
        },
        cameras[observation.image]);
  }
}

double angle_weight(double angle, double optimal) {
  const double sigma = (angle < optimal ? 0.38 : 0.7) * optimal;
  const double x = (angle - optimal) / sigma;
  return std::max(0.1, std::exp(-x * x / 2));
}

double scale_weight(double ratio) {
  constexpr double kLargest = 1.6;
  if (ratio > kLargest) return (kLargest / ratio) * (kLargest / ratio);
  return ratio < 1 ? ratio * ratio : 1;
}

// Sums over the points that one image and one candidate share.
struct Pair {
  std::uint32_t points = 0;
  double weight = 0, scale = 0, angle = 0;
  std::bitset<kGrid * kGrid> cells;

  ViewScore score(std::uint32_t image) const {
    const double area = static_cast<double>(cells.count()) / (kGrid * kGrid);
    ViewScore result;
    result.image = image;
    result.points = points;
    result.scale = static_cast<float>(scale / points);
    result.angle = static_cast<float>(angle / points);
    result.area = static_cast<float>(area);
    result.score = static_cast<float>(weight * std::max(area, 0.01));
    return result;
  }
};

void add_observation(const Observation& a, const Observation& b, double region_weight,
                     const ViewSelectionOptions& options, Pair& pair) {
  const Eigen::Vector3d da = a.direction.cast<double>(), db = b.direction.cast<double>();
  const double angle = std::atan2(da.cross(db).norm(), da.dot(db));
  const double ratio = static_cast<double>(a.footprint) / static_cast<double>(b.footprint);
  pair.weight += angle_weight(angle, options.optimal_angle) * scale_weight(ratio) * region_weight;
  pair.scale += ratio;
  pair.angle += angle;
  ++pair.points;
  if (a.cell >= 0 && b.cell >= 0) pair.cells.set(static_cast<std::size_t>(a.cell));
}

std::vector<ViewScore> neighbours_of(const Scene& scene, std::size_t image,
                                     const Observations& observations,
                                     const ViewSelectionOptions& options) {
  // An image shares points with few of a survey's images: a list of all would make the time grow
  // with the square of their number.
  std::unordered_map<std::uint32_t, Pair> pairs;
  for (const std::size_t i : observations.of_image(image)) {
    const Observation& a = observations.all[i];
    if (!(a.depth > 0)) continue;
    const bool inside =
        !scene.region || scene.region->contains(scene.points[a.point].position.cast<double>());
    const double region_weight = inside ? 1 : options.weight_outside_region;
    for (std::size_t j = observations.point_begin[a.point];
         j < observations.point_begin[a.point + 1]; ++j) {
      const Observation& b = observations.all[j];
      if (j == i || !(b.depth > 0)) continue;
      add_observation(a, b, region_weight, options, pairs[b.image]);
    }
  }
  std::vector<ViewScore> neighbours;
  for (const auto& [other, pair] : pairs)
    if (pair.points >= std::max(1u, options.min_shared_points))
      neighbours.push_back(pair.score(other));
  neighbours.shrink_to_fit();
  std::ranges::sort(neighbours, [](const ViewScore& x, const ViewScore& y) {
    return x.score != y.score ? x.score > y.score : x.image < y.image;
  });
  return neighbours;
}

// Fills the depths of the image, and returns its init points and their range of depths.
ViewPreparation depths_and_points(SceneImage& image, std::size_t index,
                                  const Observations& observations,
                                  const ViewSelectionOptions& options) {
  ViewPreparation result;
  result.init_points.reserve(observations.of_image(index).size());
  double sum = 0;
  std::size_t count = 0;
  for (const std::size_t i : observations.of_image(index)) {
    const Observation& a = observations.all[i];
    if (!(a.depth > 0)) continue;
    image.min_depth = count == 0 ? a.depth : std::min(image.min_depth, a.depth);
    image.max_depth = count == 0 ? a.depth : std::max(image.max_depth, a.depth);
    sum += static_cast<double>(a.depth);
    ++count;
    const auto first = observations.all.begin();
    const auto views =
        std::count_if(first + static_cast<std::ptrdiff_t>(observations.point_begin[a.point]),
                      first + static_cast<std::ptrdiff_t>(observations.point_begin[a.point + 1]),
                      [](const Observation& observation) { return observation.depth > 0; });
    if (static_cast<std::size_t>(views) < options.min_trusted_views) continue;
    const bool is_first = result.init_points.empty();
    result.min_depth = is_first ? a.lambda : std::min(result.min_depth, a.lambda);
    result.max_depth = is_first ? a.lambda : std::max(result.max_depth, a.lambda);
    result.init_points.push_back(a.point);
  }
  image.average_depth = count > 0 ? static_cast<float>(sum / static_cast<double>(count)) : 0.0f;
  if (count == 0) image.min_depth = image.max_depth = 0;
  result.min_depth *= 0.9f;
  result.max_depth *= 1.1f;
  return result;
}

// For a message: why all but `trusted` observations of an image do not count. Empty if all count.
std::string of_others(std::size_t image, std::size_t trusted, const Observations& observations) {
  const std::span<const std::size_t> own = observations.of_image(image);
  std::size_t behind = 0, outside = 0;
  for (const std::size_t i : own) {
    const Observation& observation = observations.all[i];
    behind += observation.behind ? 1 : 0;
    outside += !observation.behind && !(observation.depth > 0) ? 1 : 0;
  }
  std::string reasons;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) reasons += fmt::format("{}{} {}", reasons.empty() ? "" : ", ", count, what);
  };
  add(behind, "behind the camera");
  add(outside, "not visible to the camera");
  add(own.size() - behind - outside - trusted, "seen by no other image");
  return reasons.empty()
             ? ""
             : fmt::format(" ({} more do not count: {})", own.size() - trusted, reasons);
}

ViewPreparation prepare_image(Scene& scene, std::size_t index, const Observations& observations,
                              std::size_t enough_views, const ViewSelectionOptions& options) {
  SceneImage& image = scene.images[index];
  if (!image.calibrated) {
    ViewPreparation result;
    result.problem = "it is not calibrated";
    return result;
  }
  ViewPreparation result = depths_and_points(image, index, observations, options);
  image.neighbours = neighbours_of(scene, index, observations, options);
  if (result.init_points.size() < options.min_init_points) {
    result.problem = fmt::format("it sees only {} sparse points{}", result.init_points.size(),
                                 of_others(index, result.init_points.size(), observations));
  } else if (image.neighbours.empty() || image.neighbours.size() < enough_views) {
    result.problem =
        fmt::format("it shares sparse points with only {} other images", image.neighbours.size());
  }
  return result;
}

// Fills all observations. Observations lie in memory by point: going through them by image would
// wait for memory at each of them.
void observe_all(const Scene& scene, Observations& observations, ProgressCounter& counter) {
  const std::vector<CameraVariant<double>> cameras = cameras_of(scene);
  const std::size_t portions = scene.images.size(), points = scene.points.size();
  parallel_for(portions, [&](std::size_t i) {
    for (std::size_t p = points * i / portions; p < points * (i + 1) / portions; ++p)
      observe_point(scene, cameras, p, observations);
    counter.add();
  });
}

}  // namespace

ScoringMemory scoring_memory(const ScoringSize& size) {
  constexpr std::uint64_t kIndex = sizeof(std::size_t);
  const std::uint64_t lists = (size.points + size.observations + 3 * size.images) * kIndex;
  // Each entry of a hash table is a block, and has a place in the list of buckets.
  const std::uint64_t entry = heap_bytes(sizeof(Pair) + 2 * kIndex) + 2 * kIndex;
  const std::uint64_t working =
      size.images * std::max<std::uint64_t>(sizeof(CameraVariant<double>),
                                            thread_count() * (entry + 2 * sizeof(ViewScore)));
  ScoringMemory memory;
  memory.work = size.observations * sizeof(Observation) + lists + working;
  memory.kept = size.images * (sizeof(ViewPreparation) + 2 * heap_bytes(1)) +
                size.observations * sizeof(std::uint32_t) + size.neighbours * sizeof(ViewScore);
  return memory;
}

ScoringSize scoring_size(const Scene& scene, const ViewSelectionOptions& options) {
  ScoringSize size{scene.images.size(), scene.points.size(), 0, 0};
  std::uint64_t pairs = 0;
  for (const SparsePoint& point : scene.points) {
    const std::uint64_t views = point.views.size();
    size.observations += views;
    pairs += views > 0 ? views * (views - 1) : 0;
  }
  size.neighbours = most_neighbours(size.images, pairs, options);
  return size;
}

std::uint64_t most_neighbours(std::uint64_t images, std::uint64_t pairs,
                              const ViewSelectionOptions& options) {
  const std::uint64_t all = images > 0 ? images * (images - 1) : 0;
  return std::min(all, pairs / std::max(1u, options.min_shared_points));
}

std::uint64_t count_neighbours(const Scene& scene, const ViewSelectionOptions& options) {
  const std::vector<std::size_t> begin = image_begins(scene);
  std::vector<std::uint32_t> seen(begin.back());
  std::vector<std::size_t> next = begin;
  for (std::size_t p = 0; p < scene.points.size(); ++p)
    each_image(scene, p,
               [&](std::uint32_t image) { seen[next[image]++] = static_cast<std::uint32_t>(p); });
  std::atomic<std::uint64_t> total = 0;
  parallel_for(scene.images.size(), [&](std::size_t image) {
    std::unordered_map<std::uint32_t, std::uint32_t> shared;
    for (std::size_t k = begin[image]; k < begin[image + 1]; ++k)
      each_image(scene, seen[k], [&](std::uint32_t other) { ++shared[other]; });
    shared.erase(static_cast<std::uint32_t>(image));
    const std::uint32_t enough = std::max(1u, options.min_shared_points);
    total += static_cast<std::uint64_t>(
        std::ranges::count_if(shared, [&](const auto& entry) { return entry.second >= enough; }));
  });
  return total;
}

std::vector<ViewPreparation> score_neighbours(Scene& scene, const ViewSelectionOptions& options,
                                              const ProgressSink& progress) {
  Observations observations = collect(scene);
  const std::size_t count = scene.images.size();
  // Projecting the points takes about half as long as comparing the images: images count in thirds.
  ProgressCounter counter(
      [&](std::size_t thirds, std::size_t) {
        if (progress) progress(thirds / 3, count);
      },
      3 * count);
  observe_all(scene, observations, counter);

  const auto calibrated =
      static_cast<std::size_t>(std::count_if(scene.images.begin(), scene.images.end(),
                                             [](const auto& image) { return image.calibrated; }));
  const std::size_t enough_views = std::min(options.min_views, calibrated > 0 ? calibrated - 1 : 0);
  std::vector<ViewPreparation> result(count);
  parallel_for(count, [&](std::size_t i) {
    result[i] = prepare_image(scene, i, observations, enough_views, options);
    for (int thirds = 0; thirds < 2; ++thirds) counter.add();
  });
  return result;
}

}  // namespace axial
