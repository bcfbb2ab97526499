// SPDX-License-Identifier: GPL-3.0-or-later
// Which planes a sweep scores, and in which views. A mock matcher computes the scores by a formula.
#include "depth/sweep/sweep.h"

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
// All other views give high costs, but below PatchMatchOptions::bad_cost.
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
             std::span<PlaneScore> scores) const {
    calls.emplace_back(pairs.begin(), pairs.end());
    planes_asked.emplace_back(planes.begin(), planes.end());
    for (std::size_t i = 0; i < pairs.size(); ++i)
      scores[i] = score_of(planes[pairs[i].plane].depth, pairs[i].view);
  }

  static PlaneScore score_of(float depth, std::uint8_t view) {
    const bool good = std::find(kGoodViews.begin(), kGoodViews.end(), view) != kGoodViews.end();
    const float off = std::abs(depth - kDepth);
    return {std::min(off + (good ? 0.1f : 0.8f), 0.9f), 50 * depth + view, 1};
  }

  mutable std::vector<std::vector<ScorePair>> calls;               // not thread-safe
  mutable std::vector<std::vector<PlaneHypothesis>> planes_asked;  // of each call

 private:
  cv::Mat1b image_ = noise();
  PatchMatchOptions options_;
  PixelSampler<Camera> pixels_{image_, Camera(refractive::PinholeLens<float>{40, 40, 20, 20}),
                               options_};
};

// A plane perpendicular to the camera's axis. The best views of all pixels are unknown.
PlaneMap wall() {
  PlaneMap map(kSide, kSide);
  const FormulaMatcher matcher;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
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

std::uint64_t run(const FormulaMatcher& matcher, PlaneMap& map, const SweepInput& sweep,
                  const PatchMatchOptions& options = {}) {
  const ThreadLimit one(1);
  return Sweep(matcher, map, options, sweep).run();
}

TEST(SweepScores, AreCounted) {
  const FormulaMatcher matcher;
  PlaneMap map = wall();
  map.at(kSide / 2, kSide / 2).plane.depth = 3.9f;  // far behind the wall
  const std::uint64_t counted = run(matcher, map, input(2));
  std::uint64_t asked = 0;
  for (const auto& pairs : matcher.calls) asked += pairs.size();
  EXPECT_EQ(counted, asked);
}

TEST(SweepViews, AreFewHoweverManyThereAre) {
  const FormulaMatcher matcher;
  PlaneMap map = wall();
  run(matcher, map, input(2));
  constexpr std::size_t kPixels = kSide * kSide;
  ASSERT_GE(matcher.calls.size(), kPixels);
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

// The number of calls of the matcher in a sweep after an earlier one.
std::size_t calls_of_later_sweep(int trial_pairs) {
  const FormulaMatcher matcher;
  PlaneMap map = wall();
  run(matcher, map, input(0));
  matcher.calls.clear();
  run(matcher, map, input(trial_pairs));
  return matcher.calls.size();
}

TEST(SweepTrials, AreScoredAtOnceWithTheOtherPlanesWhereTheyAreFew) {
  constexpr std::size_t kPixels = kSide * kSide;
  EXPECT_EQ(calls_of_later_sweep(0), kPixels);
  EXPECT_EQ(calls_of_later_sweep(2), kPixels);
  EXPECT_EQ(calls_of_later_sweep(4), 2 * kPixels);
}

// A pixel stores cost, views and motion of its plane, whichever way it got the plane.
TEST(SweepTrials, LeaveCostViewsAndMotionOfThePlaneThatWon) {
  for (const int pairs : {0, 2, 4}) {
    const FormulaMatcher matcher;
    PlaneMap map = wall();
    for (PlanePixel& pixel : map.pixels)
      if (pixel.plane.depth > 0) pixel.plane.depth = 2.1f;
    for (int sweep = 0; sweep < 3; ++sweep) run(matcher, map, input(pairs));
    for (const PlanePixel& pixel : map.pixels) {
      if (!(pixel.plane.depth > 0)) continue;
      const PlaneScore first = FormulaMatcher::score_of(pixel.plane.depth, pixel.views[0]);
      const PlaneScore second = FormulaMatcher::score_of(pixel.plane.depth, pixel.views[1]);
      ASSERT_EQ(pixel.cost, aggregate(first.cost, second.cost));
      ASSERT_EQ(pixel.motion, first.motion);
    }
  }
}

// Tests the first pixel of the second strip. Of its neighbours only the pixel above has been
// scored. Its plane lies behind the wall and has a lower cost than all other planes.
TEST(SweepTrials, GoAroundTheNeighbourThatCostLess) {
  const FormulaMatcher matcher;
  PlaneMap map = wall();
  PlanePixel& above = map.at(0, kStripHeight - 1);
  above.plane.depth = 2.4f;
  above.point = matcher.pixels().prepare(0, kStripHeight - 1).ray.at(2.4f);
  above.cost = 0.01f;
  above.views = {3, 4};
  above.motion = 100;
  run(matcher, map, input(1));
  std::size_t found = 0;
  for (std::size_t call = 0; call < matcher.calls.size(); ++call) {
    const std::vector<PlaneHypothesis>& planes = matcher.planes_asked[call];
    const std::size_t last = planes.size() - 1;
    if (planes.size() < 4 || std::abs(planes[last - 2].depth - 2.4f) > 0.1f) continue;
    ++found;
    const float of_neighbour = planes[last - 2].depth;  // where its plane meets this pixel's ray
    EXPECT_NE(planes[last].depth, planes[last - 1].depth);
    EXPECT_NEAR((planes[last].depth + planes[last - 1].depth) / 2, of_neighbour, 1e-5f);
    for (const ScorePair& pair : matcher.calls[call]) {
      const bool of_trial = planes[pair.plane].depth == planes[last].depth ||
                            planes[pair.plane].depth == planes[last - 1].depth;
      EXPECT_TRUE(!of_trial || pair.view == 3 || pair.view == 4);
    }
  }
  EXPECT_EQ(found, 1u);
}

TEST(SweepViews, TurnUntilThoseAreFoundThatSeeThePixel) {
  const FormulaMatcher matcher;
  PlaneMap map = wall();
  SweepInput sweep = input(0);
  for (sweep.sweep = 0; sweep.sweep < 3; ++sweep.sweep) run(matcher, map, sweep);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const BestViews& views = map.at(x, y).views;
      ASSERT_EQ((std::set<int>{views[0], views[1]}), (std::set<int>{7, 9})) << x << " " << y;
    }
}

// The number of planes in a call whose normal differs from the wall's: those of the search.
std::size_t searched(const FormulaMatcher& matcher, std::size_t call,
                     const Eigen::Vector3f& of_wall) {
  std::size_t count = 0;
  const std::vector<PlaneHypothesis>& planes = matcher.planes_asked[call];
  for (std::size_t plane = 0; plane < planes.size(); ++plane) {
    if (planes[plane].normal == of_wall) continue;
    std::set<int> views;
    for (const ScorePair& pair : matcher.calls[call])
      if (pair.plane == plane) views.insert(pair.view);
    EXPECT_EQ(views.size(), 2u);
    EXPECT_LT(*views.rbegin(), 5);  // from the first five source views
    ++count;
  }
  return count;
}

TEST(SweepSearch, TriesPlanesOfAllDepthsWhereThePlaneIsNotCertain) {
  const Eigen::Vector3f normal =
      Eigen::Vector3f(0.13f, 0.07f, -1).normalized();  // parallel to no ray
  PatchMatchOptions options;
  options.certain_cost = 0.05f;  // all costs of FormulaMatcher are higher
  options.search_pairs = 0;      // all other planes asked about are the neighbours'
  for (const bool first : {true, false})
    for (const float cost : {0.01f, 0.5f}) {
      const FormulaMatcher matcher;
      PlaneMap map = wall();
      for (PlanePixel& pixel : map.pixels) {
        pixel.cost = cost;
        pixel.plane.normal = normal;
      }
      SweepInput sweep = input(0);
      sweep.first = first;
      run(matcher, map, sweep, options);
      const std::size_t expected = first && cost > options.certain_cost ? 4 : 0;
      float nearest = sweep.max_depth, farthest = sweep.min_depth;
      for (std::size_t call = 0; call < matcher.calls.size(); ++call) {
        ASSERT_EQ(searched(matcher, call, normal), expected);
        ASSERT_LE(matcher.calls[call].size(), 16u);
        for (const PlaneHypothesis& plane : matcher.planes_asked[call]) {
          nearest = std::min(nearest, plane.depth);
          farthest = std::max(farthest, plane.depth);
        }
      }
      if (expected == 0) continue;
      EXPECT_NEAR(nearest, sweep.min_depth, 0.01f);
      EXPECT_NEAR(farthest, sweep.max_depth, 0.1f);
    }
}

TEST(SweepSearch, AddsNoScoresToACoarseLevelsFirstSweep) {
  const auto scores = [](float cost) {
    const FormulaMatcher matcher;
    PlaneMap map = wall();
    for (PlanePixel& pixel : map.pixels) pixel.cost = cost;
    SweepInput sweep = input(PatchMatchOptions().coarse_pairs);
    sweep.first = true;
    return run(matcher, map, sweep);
  };
  EXPECT_LE(scores(0.5f), scores(0.1f));
}

// The views of the search give high costs for the wall, but no pixel reaches bad_cost, at which it
// would try other random planes.
TEST(SweepSearch, FindsASurfaceFarFromWhatWasKnown) {
  const FormulaMatcher matcher;
  PlaneMap map = wall();
  for (PlanePixel& pixel : map.pixels)
    if (pixel.plane.depth > 0) pixel.plane.depth = 3.5f;
  SweepInput sweep = input(2);
  sweep.first = true;
  run(matcher, map, sweep);
  int found = 0, all = 0;
  for (const PlanePixel& pixel : map.pixels) {
    if (!(pixel.plane.depth > 0)) continue;
    ++all;
    found += std::abs(pixel.plane.depth - kDepth) < 0.1f;
  }
  EXPECT_GT(found, 9 * all / 10);
}

TEST(SweepViews, AreManyInTurnOnCoarseLevels) {
  const FormulaMatcher matcher;
  PlaneMap map = wall();
  SweepInput sweep = input(0);
  sweep.many_views = true;
  run(matcher, map, sweep);
  std::set<int> asked;
  for (const auto& pairs : matcher.calls) {
    std::array<std::set<int>, kMaxCandidates> of_plane;
    for (const ScorePair& pair : pairs) of_plane.at(pair.plane).insert(pair.view);
    for (const auto& views : of_plane) ASSERT_TRUE(views.empty() || views.size() == kManyViews);
    ASSERT_EQ(of_plane[0].size(), kManyViews);
    for (const ScorePair& pair : pairs) asked.insert(pair.view);
  }
  EXPECT_EQ(asked.size(), kViews);
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
