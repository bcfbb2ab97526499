// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosis/cause_sample.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "base/order_statistics.h"

namespace axial::diagnosis {
namespace {

using Numbers = std::vector<std::size_t>;
using Lists = std::vector<Numbers>;

constexpr double kOutlierLimit = 5;  // in robust standard deviations
constexpr std::size_t kNoNumber = ~std::size_t{0};

// The observations that count, by image and by point.
struct Usable {
  Lists of_image, of_point;
};

Usable usable_observations(const TrackedPhotographs& photographs,
                           std::span<const Eigen::Vector2d> freed) {
  std::vector<std::vector<double>> values(photographs.cameras.size());
  const auto camera_of = [&](std::size_t i) {
    return photographs.images[photographs.observations[i].image].camera;
  };
  for (std::size_t i = 0; i < freed.size(); ++i)
    if (freed[i].allFinite())
      values[camera_of(i)].insert(values[camera_of(i)].end(), {freed[i].x(), freed[i].y()});
  std::vector<double> limits;
  for (auto& list : values) limits.push_back(kOutlierLimit * deviation_about_zero(std::move(list)));
  Usable usable{Lists(photographs.images.size()), Lists(photographs.points.size())};
  for (std::size_t i = 0; i < freed.size(); ++i) {
    if (!freed[i].allFinite() || freed[i].cwiseAbs().maxCoeff() > limits[camera_of(i)]) continue;
    usable.of_image[photographs.observations[i].image].push_back(i);
    usable.of_point[photographs.observations[i].point].push_back(i);
  }
  return usable;
}

std::size_t first_image(const TrackedPhotographs& photographs, const Lists& of_image,
                        std::size_t camera) {
  std::size_t best = kNoNumber;
  for (std::size_t i = 0; i < of_image.size(); ++i)
    if (photographs.images[i].camera == camera &&
        (best == kNoNumber || of_image[i].size() > of_image[best].size()))
      best = i;
  return best;
}

// The images that share points with `image`, those with the most common points first.
Numbers neighbours_of(const TrackedPhotographs& photographs, const Usable& usable,
                      std::size_t image) {
  std::map<std::size_t, std::size_t> common;
  for (const std::size_t i : usable.of_image[image])
    for (const std::size_t other : usable.of_point[photographs.observations[i].point])
      ++common[photographs.observations[other].image];
  Numbers neighbours;
  for (const auto& [number, count] : common) neighbours.push_back(number);
  std::ranges::stable_sort(neighbours, std::greater(),
                           [&](std::size_t number) { return common[number]; });
  return neighbours;
}

// The number of each image in the sample; kNoNumber: not in it.
Numbers choose_images(const TrackedPhotographs& photographs, const Usable& usable,
                      std::size_t first, std::size_t most) {
  Numbers chosen(photographs.images.size(), kNoNumber), queue{first};
  chosen[first] = 0;
  for (std::size_t at = 0; at < queue.size(); ++at)
    for (const std::size_t other : neighbours_of(photographs, usable, queue[at]))
      if (chosen[other] == kNoNumber && queue.size() < most) {
        chosen[other] = queue.size();
        queue.push_back(other);
      }
  return chosen;
}

}  // namespace

TrackedPhotographs cause_sample(const TrackedPhotographs& photographs,
                                std::span<const Eigen::Vector2d> freed, std::size_t camera,
                                std::size_t most_images, std::size_t most_observations) {
  TrackedPhotographs sample;
  sample.cameras = photographs.cameras;
  const Usable usable = usable_observations(photographs, freed);
  const std::size_t first = first_image(photographs, usable.of_image, camera);
  if (first == kNoNumber) return sample;
  const Numbers number = choose_images(photographs, usable, first, most_images);
  Lists tracks(photographs.points.size());
  for (std::size_t p = 0; p < tracks.size(); ++p)
    for (const std::size_t i : usable.of_point[p])
      if (number[photographs.observations[i].image] != kNoNumber) tracks[p].push_back(i);
  Numbers order(tracks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t p) { return tracks[p].size(); });
  sample.images.resize(static_cast<std::size_t>(
      std::ranges::count_if(number, [](std::size_t n) { return n != kNoNumber; })));
  for (std::size_t i = 0; i < number.size(); ++i)
    if (number[i] != kNoNumber) sample.images[number[i]] = photographs.images[i];
  for (const std::size_t p : order) {
    const Numbers& track = tracks[p];
    if (track.size() < 2 || sample.observations.size() + track.size() > most_observations) break;
    for (const std::size_t i : track) {
      pose::Observation observation = photographs.observations[i];
      observation.image = number[observation.image];
      observation.point = sample.points.size();
      sample.observations.push_back(observation);
    }
    sample.points.push_back(photographs.points[p]);
  }
  return sample;
}

}  // namespace axial::diagnosis
