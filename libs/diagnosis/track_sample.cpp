// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosis/track_sample.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <unordered_set>

namespace axial::diagnosis {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

// The k-th of `count` evenly spaced indices among `total`.
std::size_t spaced(std::size_t k, std::size_t count, std::size_t total) {
  return (2 * k + 1) * total / (2 * count);
}

std::unordered_set<std::uint64_t> points_of_seeds(const io::ColmapModel& model,
                                                  const SampleLimits& limits) {
  std::unordered_set<std::uint64_t> chosen;
  const std::size_t seeds = std::min(limits.seeds, model.images.size());
  for (std::size_t k = 0; k < seeds; ++k) {
    std::vector<std::uint64_t> seen;
    for (const io::ColmapPoint2D& point :
         model.images[spaced(k, seeds, model.images.size())].points)
      if (point.point3d != io::kNoPoint3D) seen.push_back(point.point3d);
    const std::size_t count = std::min(seen.size(), limits.points / seeds);
    for (std::size_t i = 0; i < count; ++i) chosen.insert(seen[spaced(i, count, seen.size())]);
  }
  return chosen;
}

// The images of the sample, in the order in which tracks name them, up to a limit.
class SampledImages {
 public:
  SampledImages(const io::ColmapModel& model, std::size_t limit) : model_(model), limit_(limit) {
    for (std::size_t i = 0; i < model.images.size(); ++i) index_of_.emplace(model.images[i].id, i);
  }

  // The index of the image in the sample; kNone if the sample is full.
  std::size_t take(std::uint32_t id) {
    const auto found = place_of_.find(id);
    if (found != place_of_.end()) return found->second;
    if (images_.size() >= limit_) return kNone;
    const io::ColmapImage& from = model_.images[index_of_.at(id)];
    images_.push_back({from.id, from.camera, from.name, from.pose, {}});
    return place_of_[id] = images_.size() - 1;
  }

  const io::ColmapPoint2D& seen(const io::ColmapTrackElement& element) const {
    return model_.images[index_of_.at(element.image)].points.at(element.point2d);
  }

  std::vector<io::ColmapImage>& images() { return images_; }

 private:
  const io::ColmapModel& model_;
  std::size_t limit_;
  std::unordered_map<std::uint32_t, std::size_t> index_of_, place_of_;
  std::vector<io::ColmapImage> images_;
};

void add_track(const io::ColmapPoint3D& from, std::size_t limit, SampledImages& images,
               std::vector<io::ColmapPoint3D>& points) {
  // With the index of the image in the sample.
  std::vector<std::pair<std::size_t, io::ColmapPoint2D>> seen;
  for (const io::ColmapTrackElement& element : from.track) {
    if (seen.size() == limit) break;
    const std::size_t place = images.take(element.image);
    if (place != kNone &&
        std::ranges::none_of(seen, [&](const auto& s) { return s.first == place; }))
      seen.emplace_back(place, images.seen(element));
  }
  if (seen.size() < 2) return;
  io::ColmapPoint3D point = from;
  point.track.clear();
  for (const auto& [place, pixel] : seen) {
    io::ColmapImage& image = images.images()[place];
    point.track.push_back({image.id, static_cast<std::uint32_t>(image.points.size())});
    image.points.push_back(pixel);
  }
  points.push_back(std::move(point));
}

// Breadth-first search from the middle image through points that two images observe.
std::vector<bool> connected_images(const pose::Bundle& bundle, std::size_t limit,
                                   bool behind_ports) {
  const auto by_image =
      observations_of_each(bundle.observations, &pose::Observation::image, bundle.images.size());
  const auto by_point =
      observations_of_each(bundle.observations, &pose::Observation::point, bundle.points.size());
  std::vector<bool> chosen(bundle.images.size()), visited(bundle.points.size());
  std::vector<std::size_t> queue;
  const auto take = [&](std::size_t image) {
    const bool usable =
        !by_image[image].empty() &&
        (!behind_ports || bundle.cameras[bundle.images[image].camera].measured.port);
    if (queue.size() >= limit || chosen[image] || !usable) return;
    queue.push_back(image);
    chosen[image] = true;
  };
  for (std::size_t k = 0; k < chosen.size() && queue.empty(); ++k)
    take((chosen.size() / 2 + k) % chosen.size());
  for (std::size_t next = 0; next < queue.size(); ++next)
    for (const std::size_t seen : by_image[queue[next]]) {
      const std::size_t point = bundle.observations[seen].point;
      if (visited[point]) continue;
      visited[point] = true;
      for (const std::size_t other : by_point[point]) take(bundle.observations[other].image);
    }
  return chosen;
}

// Leaves out images and cameras without observations: they would be unknowns of the adjustment.
pose::Bundle only_observed(pose::Bundle part) {
  std::vector<std::size_t> image_place(part.images.size(), kNone),
      camera_place(part.cameras.size(), kNone);
  pose::Bundle result{{}, {}, std::move(part.points), std::move(part.observations)};
  for (pose::Observation& observation : result.observations) {
    std::size_t& image = image_place[observation.image];
    if (image == kNone) {
      image = result.images.size();
      result.images.push_back(part.images[observation.image]);
      std::size_t& camera = camera_place[result.images.back().camera];
      if (camera == kNone) {
        camera = result.cameras.size();
        result.cameras.push_back(part.cameras[result.images.back().camera]);
      }
      result.images.back().camera = camera;
    }
    observation.image = image;
  }
  return result;
}

}  // namespace

io::ColmapModel sample_tracks(const io::ColmapModel& model, const SampleLimits& limits) {
  const auto chosen = points_of_seeds(model, limits);
  SampledImages images(model, limits.images);
  io::ColmapModel sample;
  for (const io::ColmapPoint3D& point : model.points)
    if (chosen.contains(point.id)) add_track(point, limits.track, images, sample.points);
  sample.images = std::move(images.images());
  std::unordered_set<std::uint32_t> cameras;
  for (const io::ColmapImage& image : sample.images) cameras.insert(image.camera);
  for (const io::ColmapCamera& camera : model.cameras)
    if (cameras.contains(camera.id)) sample.cameras.push_back(camera);
  return sample;
}

pose::Bundle sample_bundle(const pose::Bundle& bundle, std::size_t most_points, bool behind_ports) {
  const std::vector<bool> chosen = connected_images(bundle, 40, behind_ports);
  return only_observed(
      most_observed(bundle, most_points, 2, [&](std::size_t image) { return chosen[image]; }));
}

std::vector<pose::KnownDistance> held_length(const pose::Bundle& part) {
  const auto length = [&](std::size_t i) {
    return (part.images[i].pose.centre - part.images[0].pose.centre).norm();
  };
  std::size_t farthest = 0;
  for (std::size_t i = 1; i < part.images.size(); ++i)
    if (length(i) > length(farthest)) farthest = i;
  if (farthest == 0) return {};
  return {{pose::KnownDistance::Between::images, 0, farthest, length(farthest),
           1e-4 * length(farthest)}};
}

}  // namespace axial::diagnosis
