// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "base/memory.h"
#include "base/parallel.h"
#include "scene/view_selection.h"
#include "support/analytic_scene.h"

namespace axial {
namespace {

// A row of cameras and `points` points. Each point is seen by `track` cameras next to each other.
Scene row_of_cameras(std::size_t images, std::size_t points, std::size_t track) {
  std::vector<Pose> poses(images);
  for (std::size_t i = 0; i < images; ++i) poses[i].centre.x() = 0.1 * static_cast<double>(i);
  Scene scene = test::scene_of(test::dry_camera(), poses);
  for (std::size_t p = 0; p < points; ++p) {
    const auto first = static_cast<std::uint32_t>(p * 7919 % (images - track + 1));
    SparsePoint point;
    point.position = {0.1f * static_cast<float>(first + track / 2), 0, 1.5f};
    for (std::uint32_t k = 0; k < track; ++k) point.views.push_back({first + k, 0});
    scene.points.push_back(point);
  }
  return scene;
}

// Tolerance: large blocks are allocated in whole pages.
constexpr std::uint64_t kPages = 1 << 16;

// Scoring uses at most the memory of scoring_memory(), and not much less.
TEST(ScoringMemory, IsWhatScoringTakes) {
  const ThreadLimit threads(2);
  struct Case {
    std::size_t images, points, track;
  };
  for (const Case& c : {Case{20, 100'000, 2}, Case{20, 40'000, 12}, Case{800, 60'000, 6}}) {
    Scene scene = row_of_cameras(c.images, c.points, c.track);
    ScoringSize size = scoring_size(scene);
    EXPECT_EQ(size.observations, c.points * c.track);
    size.neighbours = count_neighbours(scene);
    const ScoringMemory planned = scoring_memory(size);
    const std::uint64_t before = allocated_memory();
    std::uint64_t most = before;
    const auto views = score_neighbours(
        scene, {}, [&](std::size_t, std::size_t) { most = std::max(most, allocated_memory()); });
    EXPECT_LE(most - before, planned.work + planned.kept + kPages);
    EXPECT_GE(most - before, (planned.work + planned.kept) / 10 * 8);
    EXPECT_LE(allocated_memory() - before, planned.kept + kPages);
    EXPECT_GE(allocated_memory() - before, planned.kept / 2);
  }
}

}  // namespace
}  // namespace axial
