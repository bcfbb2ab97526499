// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/cloud_sample.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/hash.h"

namespace axial::view {
namespace {

using Numbers = std::span<std::uint32_t>;

// Sorts the numbers of points randomly. The result does not depend on their order before.
void shuffle(Numbers numbers) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed(numbers.size());
  // The double scrambling makes this order independent of the choice of CloudSample.
  std::ranges::transform(numbers, keyed.begin(),
                         [](std::uint32_t i) { return std::pair(scramble(scramble(i) + 1), i); });
  std::ranges::sort(keyed);
  std::ranges::transform(keyed, numbers.begin(), [](const auto& entry) { return entry.second; });
}

// Appends chunks of `numbers` to `chunks`: halves them across the longest side of their box until
// a part has at most `largest` points.
void halve(const PointCloud& cloud, Numbers numbers, std::size_t level, std::size_t largest,
           std::vector<PointChunk>& chunks) {
  if (numbers.size() <= largest) {
    chunks.push_back({level, {numbers.begin(), numbers.end()}});
    shuffle(chunks.back().points);
    return;
  }
  Eigen::AlignedBox3f box;
  for (const std::uint32_t i : numbers) box.extend(cloud.positions[i]);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t half = numbers.size() / 2;
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(half);
  std::nth_element(numbers.begin(), middle, numbers.end(), [&](std::uint32_t a, std::uint32_t b) {
    const float at_a = cloud.positions[a][axis], at_b = cloud.positions[b][axis];
    return at_a != at_b ? at_a < at_b : a < b;
  });
  halve(cloud, numbers.first(half), level, largest, chunks);
  halve(cloud, numbers.subspan(half), level, largest, chunks);
}

void append(const PointCloud& portion, std::size_t i, PointCloud& to) {
  to.positions.push_back(portion.positions[i]);
  if (!portion.colors.empty()) to.colors.push_back(portion.colors[i]);
  if (portion.view_begin.empty()) return;
  if (to.view_begin.empty()) to.view_begin = {0};
  const auto seen_by = portion.views_of(i);
  to.view_images.insert(to.view_images.end(), seen_by.begin(), seen_by.end());
  to.view_begin.push_back(to.view_images.size());
}

}  // namespace

void CloudSample::add(const PointCloud& portion, std::size_t all_points) {
  // A point is taken if its random number is below this share of the range of numbers.
  const double share = static_cast<double>(most_) / static_cast<double>(all_points);
  const bool all = most_ >= all_points;
  const std::uint64_t limit = all ? 0 : static_cast<std::uint64_t>(share * 0x1p64);
  for (std::size_t i = 0; i < portion.size(); ++i, ++added_) {
    if (added_ == 0) append(portion, i, first_);
    if (all || scramble(added_) < limit) append(portion, i, sample_);
  }
}

PointCloud CloudSample::take() {
  if (sample_.size() == 0) std::swap(sample_, first_);
  first_ = {};
  return std::exchange(sample_, {});
}

std::vector<PointChunk> divide_into_chunks(const PointCloud& cloud, std::size_t largest) {
  if (cloud.size() >= 0xFFFFFFFFu) fail("the cloud has too many points to show");
  std::vector<std::uint32_t> order(cloud.size());
  std::iota(order.begin(), order.end(), 0u);
  shuffle(order);
  std::vector<PointChunk> chunks;
  std::size_t begin = 0;
  for (std::size_t level = 0, end = largest; begin < order.size(); ++level, end *= 4) {
    const std::size_t count = std::min(end, order.size()) - begin;
    halve(cloud, Numbers(order).subspan(begin, count), level, largest, chunks);
    begin += count;
  }
  return chunks;
}

}  // namespace axial::view
