// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth/patch_match.h"

#include <gtest/gtest.h>

#include <cstring>

#include "base/context.h"
#include "base/error.h"
#include "base/parallel.h"
#include "depth/matching_survey.h"

namespace axial::depth {
namespace {

bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  if (a.size() != b.size() || a.type() != b.type()) return false;
  return std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

bool same_maps(const DepthMap& a, const DepthMap& b) {
  return same_bytes(a.depth, b.depth) && same_bytes(a.normal, b.normal) &&
         same_bytes(a.confidence, b.confidence);
}

class PatchMatchOn : public testing::TestWithParam<Kind> {};

std::string name_of(const testing::TestParamInfo<Kind>& test) {
  if (test.param == Kind::pinhole) return "Pinhole";
  if (test.param == Kind::fisheye_behind_flat_port) return "FisheyeBehindFlatPort";
  if (test.param == Kind::flat_ports_and_domes) return "FlatPortsAndDomes";
  return test.param == Kind::flat_port ? "FlatPort" : "DomePort";
}

INSTANTIATE_TEST_SUITE_P(Cameras, PatchMatchOn,
                         testing::Values(Kind::pinhole, Kind::flat_port, Kind::dome_port,
                                         Kind::flat_ports_and_domes,
                                         Kind::fisheye_behind_flat_port),
                         name_of);

TEST_P(PatchMatchOn, FindsTheSurface) {
  const Survey survey = make_survey(GetParam());
  std::vector<const MatchImage*> sources;
  const MatchInput input = survey.input(0, sources);
  const DepthMap map = estimate_depth_map(input, {});
  const Errors errors = compare(map, survey.truth[0]);
  // Baseline 0.25 m, depth 2 m, focal length 150 px: 0.1 px of disparity is 0.5 % of depth.
  EXPECT_LT(errors.median_relative, 0.005);
  EXPECT_GT(errors.valid_fraction, 0.85);
  EXPECT_EQ(map.ids, (std::vector<std::uint32_t>{10, 11, 12, 13}));
}

TEST(PatchMatch, StopsWithinARowOfPixels) {
  const Survey survey = make_survey(Kind::flat_port);
  std::vector<const MatchImage*> sources;
  MatchInput input = survey.input(0, sources);
  const DepthMap map = estimate_depth_map(input, {});
  std::stop_source stop;
  std::uint64_t scores = 0;
  input.stop = stop.get_token();
  input.scores = &scores;
  stop.request_stop();
  EXPECT_THROW(estimate_depth_map(input, {}), Stopped);
  EXPECT_THROW(refine_depth_map(input, map, {}, 0, true, {}), Stopped);
  EXPECT_EQ(scores, 0u);
}

// Pixels whose window lies partly outside the image must be found as well as pixels farther inside.
TEST_P(PatchMatchOn, FindsTheSurfaceUpToTheBorder) {
  const Survey survey = make_survey(GetParam());
  std::vector<const MatchImage*> sources;
  const DepthMap map = estimate_depth_map(survey.input(0, sources), {});
  const Errors inside = compare_ring(map, survey.truth[0], 4, 8);
  const Errors border = compare_ring(map, survey.truth[0], 0, 4);
  // A window at the border has 15 texels instead of 25; at a corner of the image it has 9.
  EXPECT_LT(border.median_relative, std::max(0.005, 1.5 * inside.median_relative));
  EXPECT_GT(border.valid_fraction, 0.9 * inside.valid_fraction);
}

TEST_P(PatchMatchOn, GeometricPassImprovesAndNormalsFaceTheCamera) {
  const Survey survey = make_survey(GetParam());
  std::vector<DepthMap> maps;
  std::vector<const MatchImage*> sources;
  for (std::size_t i = 0; i < survey.views.size(); ++i)
    maps.push_back(estimate_depth_map(survey.input(i, sources), {}));
  const MatchInput input = survey.input(0, sources);
  const std::vector<const DepthMap*> source_maps{&maps[1], &maps[2], &maps[3]};
  const DepthMap refined = refine_depth_map(input, maps[0], source_maps, 0, true, {});
  EXPECT_LE(compare(refined, survey.truth[0]).median_relative,
            compare(maps[0], survey.truth[0]).median_relative * 1.02);
  std::visit(
      [&](const auto& camera) {
        for (int y = 0; y < refined.height(); ++y)
          for (int x = 0; x < refined.width(); ++x) {
            if (!(refined.depth(y, x) > 0)) continue;
            const cv::Vec3f& n = refined.normal(y, x);
            const auto d = camera.ray({static_cast<float>(x), static_cast<float>(y)}).direction;
            ASSERT_LT(n[0] * d.x() + n[1] * d.y() + n[2] * d.z(), 0);
            ASSERT_NEAR(cv::norm(n), 1, 1e-4);
          }
      },
      make_camera<float>(refined.camera));
}

TEST_P(PatchMatchOn, GivesTheSameBytesForAnyNumberOfThreads) {
  const Survey survey = make_survey(GetParam());
  std::vector<const MatchImage*> sources;
  const MatchInput input = survey.input(1, sources);
  const auto run = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    return estimate_depth_map(input, {});
  };
  EXPECT_TRUE(same_maps(run(1), run(2)));
}

// The share of the pixels showing the bar whose depth is correct to 1 %.
double share_of_bar_found(const DepthMap& map, const cv::Mat1f& truth) {
  int shown = 0, found = 0;
  for (int y = 8; y < map.height() - 8; ++y)
    for (int x = 8; x < map.width() - 8; ++x) {
      if (!(truth(y, x) < 1.45f)) continue;  // the other surfaces are farther away
      ++shown;
      found += std::abs(map.depth(y, x) - truth(y, x)) < 0.01f * truth(y, x);
    }
  EXPECT_GT(shown, 300);
  return static_cast<double>(found) / shown;
}

TEST_P(PatchMatchOn, FindsAThinBarBeforeTheFloor) {
  test::TexturedScene scene;
  scene.bar_width = 0.04;  // 5 px
  Survey survey = make_survey(GetParam(), scene);
  survey.points.push_back({0.35f, 0.3f, 1.2f});  // as near as the bar, but not on it
  const auto found = [&](const PatchMatchOptions& options) {
    std::vector<const MatchImage*> sources;
    double sum = 0;
    for (std::size_t i = 0; i < survey.views.size(); ++i)
      sum += share_of_bar_found(estimate_depth_map(survey.input(i, sources), options),
                                survey.truth[i]);
    return sum / static_cast<double>(survey.views.size());
  };
  PatchMatchOptions without_search;
  without_search.search_planes = 0;
  EXPECT_GT(found({}), 0.6);
  EXPECT_GT(found({}), found(without_search) + 0.3);
}

TEST(PatchMatch, ThePinholeModelIsWrongUnderWater) {
  Survey survey = make_survey(Kind::flat_port);
  for (MatchImage& view : survey.views) view.camera.port.reset();
  std::vector<const MatchImage*> sources;
  const DepthMap map = estimate_depth_map(survey.input(0, sources), {});
  EXPECT_GT(compare(map, survey.truth[0]).median_relative, 0.05);
}

TEST(PatchMatch, APortOfIndexOneIsThePinhole) {
  const Survey dry = make_survey(Kind::pinhole);
  Survey wet = dry;
  for (MatchImage& view : wet.views) {
    refractive::FlatPort<double> port = thick_port();
    port.n_glass = port.n_water = 1;
    view.camera.port = port;
  }
  std::vector<const MatchImage*> sources;
  const Errors a = compare(estimate_depth_map(dry.input(0, sources), {}), dry.truth[0]);
  const Errors b = compare(estimate_depth_map(wet.input(0, sources), {}), wet.truth[0]);
  // Because of rounding, the random search takes other paths, to results of the same quality.
  EXPECT_NEAR(a.median_relative, b.median_relative, 3e-4);
  EXPECT_NEAR(a.valid_fraction, b.valid_fraction, 0.01);
}

TEST(PatchMatch, ThePublishedMethodsFindTheSurfaceToo) {
  const Survey survey = make_survey(Kind::flat_port);
  std::vector<const MatchImage*> sources;
  MatchInput input = survey.input(0, sources);
  PatchMatchOptions options;
  const double ours = compare(estimate_depth_map(input, options), survey.truth[0]).median_relative;
  input.projection = ProjectionMethod::line_search;
  options.warp = Warp::homography;
  const double theirs =
      compare(estimate_depth_map(input, options), survey.truth[0]).median_relative;
  // The paper's methods round to pixels. An error of 0.25 px is 1.3 % of depth here.
  EXPECT_LT(theirs, 0.02);
  EXPECT_LT(ours, theirs);
}

TEST(PatchMatch, ThePublishedMethodsAreForStraightLenses) {
  const Survey survey = make_survey(Kind::fisheye_behind_flat_port);
  std::vector<const MatchImage*> sources;
  MatchInput input = survey.input(0, sources);
  PatchMatchOptions options;
  options.warp = Warp::homography;
  EXPECT_THROW(estimate_depth_map(input, options), Error);
  options.warp = Warp::affine;
  input.projection = ProjectionMethod::line_search;
  EXPECT_THROW(estimate_depth_map(input, options), Error);
}

TEST(PatchMatch, ThePublishedMethodsAreForOneKindOfPort) {
  const Survey survey = make_survey(Kind::flat_ports_and_domes);
  std::vector<const MatchImage*> sources;
  MatchInput input = survey.input(0, sources);
  PatchMatchOptions options;
  options.warp = Warp::homography;
  EXPECT_THROW(estimate_depth_map(input, options), Error);
  options.warp = Warp::affine;
  input.projection = ProjectionMethod::line_search;
  EXPECT_THROW(estimate_depth_map(input, options), Error);
}

// The lens maps e to e (1 - e^2), at most 57.7 px from the centre (for e = 1/sqrt(3)).
TEST(PatchMatch, LeavesPixelsBeyondTheLensAlone) {
  const Survey survey = make_survey(Kind::folding_lens);
  std::vector<const MatchImage*> sources;
  const DepthMap map = estimate_depth_map(survey.input(0, sources), {});
  int found_inside = 0, inside = 0;
  for (int y = 8; y < map.height() - 8; ++y)
    for (int x = 0; x < map.width(); ++x) {
      const double radius = std::hypot(x - 79.5, y - 59.5);
      if (radius > 58) {
        EXPECT_EQ(map.depth(y, x), 0) << x << " " << y;
      }
      if (radius > 50) continue;
      ++inside;
      found_inside += map.depth(y, x) > 0;
    }
  EXPECT_GT(found_inside, inside / 2);
}

TEST(PatchMatch, LeavesMaskedPixelsAlone) {
  const Survey survey = make_survey(Kind::pinhole);
  std::vector<const MatchImage*> sources;
  MatchInput input = survey.input(0, sources);
  cv::Mat1b mask(120, 160, std::uint8_t{1});
  mask(cv::Rect(40, 30, 50, 40)) = 0;
  input.mask = &mask;
  const DepthMap map = estimate_depth_map(input, {});
  EXPECT_EQ(cv::countNonZero(map.depth(cv::Rect(40, 30, 50, 40))), 0);
  EXPECT_GT(cv::countNonZero(map.depth), 160 * 120 / 2);
}

TEST(PatchMatch, RefusesInputThatCannotBeMatched) {
  const Survey survey = make_survey(Kind::pinhole);
  std::vector<const MatchImage*> sources;
  MatchInput input = survey.input(0, sources);
  input.sparse_points = {};
  EXPECT_THROW(estimate_depth_map(input, {}), Error);
  input = survey.input(0, sources);
  input.sources = {};
  EXPECT_THROW(estimate_depth_map(input, {}), Error);
  PatchMatchOptions options;
  options.search_planes = 6;
  EXPECT_THROW(estimate_depth_map(survey.input(0, sources), options), Error);
}

}  // namespace
}  // namespace axial::depth
