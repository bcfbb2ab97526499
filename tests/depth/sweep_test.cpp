// SPDX-License-Identifier: GPL-3.0-or-later
// In which views a sweep scores its planes, seen by a matcher that answers from a formula.
#include "depth/sweep.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "refractive/pinhole_camera.h"

namespace axial::depth {
namespace {

using Camera = refractive::PinholeCamera<float>;

constexpr int kSide = 40;
constexpr std::size_t kViews = 12;
constexpr float kDepth = 2;
// All others see the surface badly, but not so badly that a pixel starts anew.
constexpr std::array<std::uint8_t, 2> kGoodViews{7, 9};

cv::Mat1b noise() {
  std::mt19937 random(1);
  cv::Mat1b image(kSide, kSide);
  for (std::uint8_t& value : image) value = static_cast<std::uint8_t>(random() % 256);
  return image;
}

class FormulaMatcher {
 public:
  std::size_t views() const { return kViews; }
  const PixelSampler<Camera>& pixels() const { return pixels_; }
  void rays(int x, int y, RayTile& tile) const { RayCaster(pixels_.camera()).rays(x, y, tile); }

  void score(const ReferencePixel&, std::span<const PlaneHypothesis> planes,
             std::span<const ScorePair> pairs, std::span<const SurfacePoint>,
             std::span<ViewScore> scores) const {
    calls.emplace_back(pairs.begin(), pairs.end());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const bool good =
          std::find(kGoodViews.begin(), kGoodViews.end(), pairs[i].view) != kGoodViews.end();
      const float off = std::abs(planes[pairs[i].plane].depth - kDepth);
      scores[i] = {std::min(off + (good ? 0.1f : 0.8f), 0.9f), 100, 1};
    }
  }

  mutable std::vector<std::vector<ScorePair>> calls;  // one thread

 private:
  cv::Mat1b image_ = noise();
  PatchMatchOptions options_;
  PixelSampler<Camera> pixels_{image_, Camera(refractive::PinholeLens<float>{40, 40, 20, 20}),
                               options_};
};

// A wall across the axis, all of its views unknown.
PlaneMap wall() {
  PlaneMap map(kSide, kSide);
  const FormulaMatcher matcher;
  for (int y = kPatchRadius; y < kSide - kPatchRadius; ++y)
    for (int x = kPatchRadius; x < kSide - kPatchRadius; ++x) {
      PlanePixel& pixel = map.at(x, y);
      pixel.plane = {kDepth, -Eigen::Vector3f::UnitZ()};
      pixel.point = matcher.pixels().prepare(x, y).ray.at(kDepth);
      pixel.cost = 0.5f;
    }
  return map;
}

SweepInput input(int trial_pairs) {
  SweepInput sweep;
  sweep.min_depth = 1;
  sweep.max_depth = 4;
  sweep.trial_pairs = trial_pairs;
  return sweep;
}

std::uint64_t run(const FormulaMatcher& matcher, PlaneMap& map, const SweepInput& sweep) {
  const ThreadLimit one(1);
  return Sweep(matcher, map, PatchMatchOptions(), sweep).run();
}

TEST(SweepScores, AreCounted) {
  const FormulaMatcher matcher;
  PlaneMap map = wall();
  map.at(kSide / 2, kSide / 2).plane.depth = 3.9f;  // hopeless: tries planes at random
  const std::uint64_t counted = run(matcher, map, input(2));
  std::uint64_t asked = 0;
  for (const auto& pairs : matcher.calls) asked += pairs.size();
  EXPECT_EQ(counted, asked);
}

TEST(SweepViews, AreFewHoweverManyThereAre) {
  const FormulaMatcher matcher;
  PlaneMap map = wall();
  run(matcher, map, input(2));
  constexpr std::size_t kInner = (kSide - 2 * kPatchRadius) * (kSide - 2 * kPatchRadius);
  ASSERT_GE(matcher.calls.size(), kInner);
  for (const auto& pairs : matcher.calls) {
    std::array<std::set<int>, kMaxCandidates> of_plane;
    for (const ScorePair& pair : pairs) {
      ASSERT_LT(pair.view, kViews);
      ASSERT_TRUE(of_plane.at(pair.plane).insert(pair.view).second);
    }
    ASSERT_LE(of_plane[0].size(), kOwnViews);
    for (std::size_t plane = 1; plane < of_plane.size(); ++plane)
      ASSERT_LE(of_plane[plane].size(), 2u);
    ASSERT_LE(pairs.size(), 16u);
  }
}

// How often a sweep asks the matcher, of pixels that a sweep has visited before.
std::size_t calls_of_later_sweep(int trial_pairs) {
  const FormulaMatcher matcher;
  PlaneMap map = wall();
  run(matcher, map, input(0));
  matcher.calls.clear();
  run(matcher, map, input(trial_pairs));
  return matcher.calls.size();
}

TEST(SweepTrials, AreScoredAtOnceWithTheOtherPlanesWhereTheyAreFew) {
  constexpr std::size_t kInner = (kSide - 2 * kPatchRadius) * (kSide - 2 * kPatchRadius);
  EXPECT_EQ(calls_of_later_sweep(0), kInner);
  EXPECT_EQ(calls_of_later_sweep(2), kInner);
  EXPECT_EQ(calls_of_later_sweep(4), 2 * kInner);
}

TEST(SweepViews, TurnUntilThoseAreFoundThatSeeThePixel) {
  const FormulaMatcher matcher;
  PlaneMap map = wall();
  SweepInput sweep = input(0);
  for (sweep.sweep = 0; sweep.sweep < 3; ++sweep.sweep) run(matcher, map, sweep);
  for (int y = kPatchRadius; y < kSide - kPatchRadius; ++y)
    for (int x = kPatchRadius; x < kSide - kPatchRadius; ++x) {
      const BestViews& views = map.at(x, y).views;
      ASSERT_EQ((std::set<int>{views[0], views[1]}), (std::set<int>{7, 9})) << x << " " << y;
    }
}

TEST(SweepViews, AreAllOnCoarseLevels) {
  const FormulaMatcher matcher;
  PlaneMap map = wall();
  SweepInput sweep = input(0);
  sweep.all_views = true;
  run(matcher, map, sweep);
  for (const auto& pairs : matcher.calls) {
    std::array<std::set<int>, kMaxCandidates> of_plane;
    for (const ScorePair& pair : pairs) of_plane.at(pair.plane).insert(pair.view);
    for (const auto& views : of_plane) ASSERT_TRUE(views.empty() || views.size() == kViews);
    ASSERT_EQ(of_plane[0].size(), kViews);
  }
}

TEST(SweepViews, AreFourForThePixelsOwnPlane) {
  const FormulaMatcher matcher;
  PlaneMap map = wall();
  run(matcher, map, input(0));
  for (const auto& pairs : matcher.calls) {
    std::set<int> own;
    for (const ScorePair& pair : pairs)
      if (pair.plane == 0) own.insert(pair.view);
    ASSERT_EQ(own.size(), kOwnViews);
  }
}

}  // namespace
}  // namespace axial::depth
