// SPDX-License-Identifier: GPL-3.0-or-later
// Scoring in SIMD lanes: the results of all instruction sets are bit-identical to those of the
// scalar version, and agree with Matcher, which scores one pair at a time.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <opencv2/imgproc.hpp>
#include <random>

#include "depth/sweep/lane_matcher.h"
#include "depth/sweep/matcher.h"
#include "drawn.h"
#include "refractive/dome_port_camera.h"
#include "refractive/flat_port_camera.h"

namespace axial::depth {
namespace {

using refractive::DomePortCamera;
using refractive::FlatPortCamera;
using refractive::LensDomePortCamera;
using refractive::LensFlatPortCamera;
using refractive::LensPinholeCamera;
using refractive::PinholeCamera;
using refractive::PinholeLens;

constexpr int kWidth = 96, kHeight = 72;
constexpr std::size_t kViews = 21;  // more than one group

PinholeLens<float> lens_of(float focal) {
  return {focal, focal, 47.5f, 35.5f};
}

template <class Camera>
Camera make_camera_of(float focal, int index);

template <>
PinholeCamera<float> make_camera_of(float focal, int) {
  return PinholeCamera<float>(lens_of(focal));
}

// The ports differ from view to view, and so do their numbers of projection steps.
refractive::FlatPort<float> flat_port_of(int index) {
  refractive::FlatPort<float> port;
  port.normal = Eigen::Vector3f(0.02f * static_cast<float>(index % 3), 0.03f, 1).normalized();
  port.distance = 0.01f + 0.002f * static_cast<float>(index);
  port.thickness = 0.015f;
  port.n_glass = 1.5f;
  port.n_water = 1.333f;
  return port;
}

refractive::DomePort<float> dome_port_of(int index) {
  refractive::DomePort<float> port;
  port.centre = Eigen::Vector3f(0.01f, -0.004f, 0.002f) * static_cast<float>(index % 4);
  port.inner_radius = 0.05f + 0.002f * static_cast<float>(index);
  port.thickness = 0.008f;
  port.n_glass = 1.5f;
  port.n_water = 1.333f;
  return port;
}

// Undistorted lenses, lenses with barrel and pincushion distortion, and fisheyes in turn.
refractive::DistortedLens<float> distorted_lens_of(float focal, int index) {
  refractive::LensDistortion<double> distortion;
  if (index % 4 != 0) {
    distortion.fisheye = index % 2;
    distortion.above[1] = 0.05 * (index % 3 - 1);
    distortion.below[0] = 0.02 * (index % 5);
    distortion.p1 = 1e-3;
    distortion.prism = {0, -2e-3};
  }
  return {lens_of(focal).cast<double>(), distortion, kWidth, kHeight};
}

template <>
FlatPortCamera<float> make_camera_of(float focal, int index) {
  if (index == 4) focal *= 0.3f;
  return {lens_of(focal), flat_port_of(index), kWidth, kHeight};
}
template <>
DomePortCamera<float> make_camera_of(float focal, int index) {
  return {lens_of(focal), dome_port_of(index), kWidth, kHeight};
}
template <>
LensPinholeCamera<float> make_camera_of(float focal, int index) {
  return LensPinholeCamera<float>(distorted_lens_of(focal, index));
}
template <>
LensFlatPortCamera<float> make_camera_of(float focal, int index) {
  if (index == 4) focal *= 0.5f;
  return {distorted_lens_of(focal, index), flat_port_of(index)};
}
template <>
LensDomePortCamera<float> make_camera_of(float focal, int index) {
  return {distorted_lens_of(focal, index), dome_port_of(index)};
}

// The kinds of camera in turn.
template <>
AnyCamera<float> make_camera_of(float focal, int index) {
  switch (index % 6) {
    case 0:
      return AnyCamera<float>(make_camera_of<PinholeCamera<float>>(focal, index));
    case 1:
      return AnyCamera<float>(make_camera_of<FlatPortCamera<float>>(focal, index));
    case 2:
      return AnyCamera<float>(make_camera_of<DomePortCamera<float>>(focal, index));
    case 3:
      return AnyCamera<float>(make_camera_of<LensPinholeCamera<float>>(focal, index));
    case 4:
      return AnyCamera<float>(make_camera_of<LensFlatPortCamera<float>>(focal, index));
    default:
      return AnyCamera<float>(make_camera_of<LensDomePortCamera<float>>(focal, index));
  }
}

cv::Mat1b smooth_image(unsigned seed) {
  std::mt19937 random(seed);
  cv::Mat1b coarse(kHeight / 4, kWidth / 4), image;
  for (std::uint8_t& value : coarse) value = static_cast<std::uint8_t>(random() % 256);
  cv::resize(coarse, image, {kWidth, kHeight}, 0, 0, cv::INTER_CUBIC);
  return image;
}

template <class Camera>
struct Setup {
  cv::Mat1b image = smooth_image(1);
  std::vector<QuadImage> quads;
  std::vector<cv::Mat1f> depths;
  std::vector<SourceView<Camera>> sources;
  PatchMatchOptions options;
  Camera reference = make_camera_of<Camera>(90, 1);

  explicit Setup(bool geometric) {
    options.prior_texture = 1;  // so large that the prior has weight despite the images' texture
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (unsigned i = 0; i < kViews; ++i) {
      quads.emplace_back(smooth_image(1 + i % 3));
      cv::Mat1f depth(kHeight, kWidth);
      for (float& value : depth) value = 2.0f + 0.03f * unit(random);
      depths.push_back(depth);
    }
    for (int i = 0; i < static_cast<int>(kViews); ++i) {
      RelativePose pose;
      pose.rotation =
          Eigen::AngleAxisf(0.05f * unit(random), Eigen::Vector3f::UnitY()).toRotationMatrix();
      pose.translation = 0.2f * axial::test::drawn<3>(unit, random);
      const auto k = static_cast<std::size_t>(i);
      sources.push_back({make_camera_of<Camera>(85.0f + static_cast<float>(i), i), pose, &quads[k],
                         geometric && i % 4 != 0 ? &depths[k] : nullptr});
    }
  }
};

struct Question {
  int x, y;
  float prior;
  std::vector<PlaneHypothesis> planes;
  std::vector<ScorePair> pairs;
};

// Random pixels, planes and views. Some planes project outside images or lie behind cameras.
std::vector<Question> questions() {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1, 1);
  std::vector<Question> all;
  for (int i = 0; i < 150; ++i) {
    Question question{static_cast<int>(random() % kWidth),
                      static_cast<int>(random() % kHeight),
                      i % 3 ? 0.0f : 2.1f,
                      {},
                      {}};
    for (unsigned p = 0; p <= random() % 8; ++p)
      question.planes.push_back(
          {i % 10 ? 2.0f + 0.2f * unit(random) : 0.05f + std::abs(unit(random)),
           Eigen::Vector3f(0.5f * unit(random), 0.5f * unit(random), -1).normalized()});
    for (std::size_t p = 0; p < question.planes.size(); ++p)
      for (unsigned v = 0; v < kViews; ++v)
        if (random() % 3)
          question.pairs.push_back({static_cast<std::uint8_t>(p), static_cast<std::uint8_t>(v)});
    if (i % 2) std::shuffle(question.pairs.begin(), question.pairs.end(), random);
    all.push_back(question);
  }
  return all;
}

template <class Matcher>
std::vector<PlaneScore> answers(const Matcher& matcher, const std::vector<Question>& asked) {
  std::vector<PlaneScore> all;
  for (const Question& question : asked) {
    ReferencePixel pixel = matcher.pixels().prepare(question.x, question.y);
    matcher.pixels().set_prior(pixel, question.prior);
    const auto surface = [&](std::size_t k) {
      const PlaneHypothesis& plane = question.planes[k % question.planes.size()];
      const Eigen::Vector3f p = pixel.ray.at(plane.depth * 1.005f);
      return SurfacePoint{{p.x(), p.y(), p.z()},
                          {plane.normal.x(), plane.normal.y(), plane.normal.z()}};
    };
    const std::array<SurfacePoint, 3> around{surface(0), surface(1), surface(2)};
    std::vector<PlaneScore> scores(question.pairs.size());
    matcher.score(pixel, question.planes, question.pairs, around, scores);
    all.insert(all.end(), scores.begin(), scores.end());
  }
  return all;
}

template <class Matcher>
std::vector<PlaneScore> answers(const Matcher& matcher) {
  return answers(matcher, questions());
}

std::uint32_t bits(float value) {
  return std::bit_cast<std::uint32_t>(value);
}

template <class Camera>
class Lanes : public testing::Test {};
using Cameras = testing::Types<PinholeCamera<float>, FlatPortCamera<float>, DomePortCamera<float>,
                               LensPinholeCamera<float>, LensFlatPortCamera<float>,
                               LensDomePortCamera<float>, AnyCamera<float>>;
TYPED_TEST_SUITE(Lanes, Cameras);

TYPED_TEST(Lanes, GiveTheSameBytesOnEveryInstructionSet) {
  for (const bool geometric : {false, true}) {
    const Setup<TypeParam> setup(geometric);
    const auto matcher = [&](lanes::InstructionSet set) {
      return LaneMatcher<TypeParam>(setup.image, setup.reference, setup.sources, setup.options,
                                    set);
    };
    const auto expected = answers(matcher(lanes::InstructionSet::scalar));
    for (const lanes::InstructionSet set : lanes::available_instruction_sets()) {
      const auto found = answers(matcher(set));
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        ASSERT_EQ(bits(found[i].cost), bits(expected[i].cost))
            << static_cast<int>(set) << ": " << found[i].cost << " " << expected[i].cost;
        ASSERT_EQ(bits(found[i].motion), bits(expected[i].motion));
        ASSERT_EQ(bits(found[i].smoothness), bits(expected[i].smoothness));
      }
    }
  }
}

// Bit-identical, because both compute the same formula without fused multiply-add.
TYPED_TEST(Lanes, GiveTheRaysOfTheReferenceCamera) {
  const Setup<TypeParam> setup(false);
  for (const lanes::InstructionSet set : lanes::available_instruction_sets()) {
    RayTile found;
    RayCaster<TypeParam>(setup.reference, set).rays(32, 17, found);
    for (std::size_t k = 0; k < found.size(); ++k) {
      refractive::AxialRayJacobian<float> jacobian;
      const auto ray = setup.reference.ray({32.0f + static_cast<float>(k), 17.0f}, jacobian);
      ASSERT_EQ(found[k].ray.origin, ray.origin);
      ASSERT_EQ(found[k].ray.direction, ray.direction);
      ASSERT_EQ(found[k].jacobian.origin, jacobian.origin);
      ASSERT_EQ(found[k].jacobian.direction, jacobian.direction);
    }
  }
}

TYPED_TEST(Lanes, AgreeWithOnePairAtATime) {
  for (const bool geometric : {false, true}) {
    const Setup<TypeParam> setup(geometric);
    const Matcher<TypeParam, AffineWarp> single(setup.image, setup.reference, setup.sources,
                                                setup.options);
    const LaneMatcher<TypeParam> lanes(setup.image, setup.reference, setup.sources, setup.options);
    const auto expected = answers(single);
    const auto found = answers(lanes);
    ASSERT_EQ(found.size(), expected.size());
    std::size_t seen = 0;
    float smoothest = 1;
    for (std::size_t i = 0; i < found.size(); ++i) {
      // Sums of 25 products in another order differ by some 1e-6 of the variance, which matters
      // for nearly flat patches. In SIMD lanes, all views take the largest number of projection
      // steps.
      ASSERT_NEAR(found[i].cost, expected[i].cost, 1e-3);
      ASSERT_NEAR(found[i].motion, expected[i].motion, 1e-4f * expected[i].motion + 1e-5f);
      ASSERT_NEAR(found[i].smoothness, expected[i].smoothness, 1e-5f);
      ASSERT_LE(found[i].smoothness, 1.0f);
      smoothest = std::min(smoothest, found[i].smoothness);
      seen += expected[i].cost < kOutsideCost - 0.01f ? 1 : 0;
    }
    EXPECT_GT(seen, found.size() / 4);       // many pairs have a correlation,
    EXPECT_LT(seen, found.size() * 9 / 10);  // and some have none
    EXPECT_LT(smoothest, 0.9f);
  }
}

// Tiles must not overlap each other or exceed the width.
TYPED_TEST(Lanes, VisitTheRayOfEveryPixelOnce) {
  const Setup<TypeParam> setup(false);
  constexpr int kOddWidth = 37;
  int visited = 0;
  each_ray(setup.reference, kOddWidth, 3, [&](int x, int y, const auto& ray) {
    ASSERT_EQ(y * kOddWidth + x, visited++);
    const auto expected = setup.reference.ray({static_cast<float>(x), static_cast<float>(y)});
    ASSERT_LT((ray.direction - expected.direction).norm(), 1e-6f);
    ASSERT_LT((ray.origin - expected.origin).norm(), 1e-7f);
  });
  EXPECT_EQ(visited, kOddWidth * 3);
}

// The source views of one kind of camera, selected from views of all kinds.
template <class Camera>
struct OneOfKinds {
  std::vector<std::size_t> numbers;  // indices among all views
  std::vector<SourceView<Camera>> views;

  explicit OneOfKinds(const Setup<AnyCamera<float>>& all) {
    for (std::size_t i = 0; i < all.sources.size(); ++i) {
      const SourceView<AnyCamera<float>>& view = all.sources[i];
      const Camera* camera = std::get_if<Camera>(&view.camera.kind());
      if (!camera) continue;
      numbers.push_back(i);
      views.push_back({*camera, view.from_reference, view.image, view.depth});
    }
  }
};

template <class Camera>
class MixedKinds : public testing::Test {};
using Kinds =
    testing::Types<PinholeCamera<float>, FlatPortCamera<float>, DomePortCamera<float>,
                   LensPinholeCamera<float>, LensFlatPortCamera<float>, LensDomePortCamera<float>>;
TYPED_TEST_SUITE(MixedKinds, Kinds);

// The scores of views of one kind are bit-identical with and without views of other kinds.
TYPED_TEST(MixedKinds, LeaveThePairsOfOneKindAsTheyAre) {
  for (const bool geometric : {false, true}) {
    const Setup<AnyCamera<float>> setup(geometric);
    const auto reference = make_camera_of<TypeParam>(90, 1);
    const OneOfKinds<TypeParam> one(setup);
    ASSERT_GE(one.views.size(), 3u);
    std::vector<Question> among_all, alone;
    for (Question question : questions()) {
      question.pairs.clear();
      Question of_one = question;
      for (std::size_t p = 0; p < question.planes.size(); ++p)
        for (std::size_t v = 0; v < one.views.size(); ++v) {
          const auto plane = static_cast<std::uint8_t>(p);
          question.pairs.push_back({plane, static_cast<std::uint8_t>(one.numbers[v])});
          of_one.pairs.push_back({plane, static_cast<std::uint8_t>(v)});
        }
      among_all.push_back(question);
      alone.push_back(of_one);
    }
    const LaneMatcher<AnyCamera<float>> mixed(setup.image, AnyCamera<float>(reference),
                                              setup.sources, setup.options);
    const LaneMatcher<TypeParam> single(setup.image, reference, one.views, setup.options);
    const auto expected = answers(single, alone), found = answers(mixed, among_all);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_EQ(bits(found[i].cost), bits(expected[i].cost));
      ASSERT_EQ(bits(found[i].motion), bits(expected[i].motion));
      ASSERT_EQ(bits(found[i].smoothness), bits(expected[i].smoothness));
    }
  }
}

TEST(Fading, IsCloseToTheExponential) {
  for (float x = 0; x < 40; x += 0.01f) {
    EXPECT_NEAR(fading<float>(x), std::exp(-x), 0.018f);
    EXPECT_LE(fading<float>(x + 0.01f), fading<float>(x));
  }
  EXPECT_EQ(fading<float>(0), 1);
  EXPECT_EQ(fading<float>(16), 0);
}

}  // namespace
}  // namespace axial::depth
