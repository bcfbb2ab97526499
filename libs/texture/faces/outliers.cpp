// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/faces/outliers.h"

#include <algorithm>
#include <cmath>

#include "base/order_statistics.h"
#include "base/parallel.h"

namespace axial::texture {
namespace {

constexpr std::size_t kFewest = 5;    // sights of which one can be an outlier
constexpr float kLeastDeviation = 6;  // [grey levels]

// The squared distances of the sights' colours from their median.
std::vector<float> distances(std::span<const Sight> sights) {
  std::vector<float> sums(sights.size(), 0), values(sights.size());
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < sights.size(); ++i) values[i] = sights[i].color[c];
    const float centre = upper_median_of_moved(values);
    for (std::size_t i = 0; i < sights.size(); ++i)
      values[i] = std::abs(static_cast<float>(sights[i].color[c]) - centre);
    const float deviation = std::max(
        kLeastDeviation, static_cast<float>(kSigmasOfMedian) * upper_median_of_moved(values));
    for (std::size_t i = 0; i < sights.size(); ++i) {
      const float d = (static_cast<float>(sights[i].color[c]) - centre) / deviation;
      sums[i] += d * d;
    }
  }
  return sums;
}

}  // namespace

std::size_t remove_outliers(FaceViews& views, double threshold) {
  if (threshold <= 0) return 0;
  const auto most = static_cast<float>(-2 * std::log(threshold));
  std::vector<std::uint64_t> kept(views.faces());
  parallel_for(
      views.faces(),
      [&](std::size_t face) {
        const std::span<Sight> sights =
            std::span(views.sights).subspan(views.begin[face], views.of(face).size());
        kept[face] = sights.size();
        if (sights.size() < kFewest || !sights.front().whole) return;
        const std::vector<float> far = distances(sights);
        std::size_t n = 0;
        for (std::size_t i = 0; i < sights.size(); ++i)
          if (far[i] <= most) sights[n++] = sights[i];
        if (n > 0) kept[face] = n;
      },
      kPointGrain);
  const std::size_t before = views.sights.size();
  std::size_t next = 0;
  for (std::size_t face = 0; face < kept.size(); ++face) {
    const std::uint64_t from = views.begin[face];
    views.begin[face] = next;
    for (std::size_t i = 0; i < kept[face]; ++i) views.sights[next++] = views.sights[from + i];
  }
  views.begin.back() = next;
  views.sights.resize(next);
  return before - next;
}

}  // namespace axial::texture
