// SPDX-License-Identifier: GPL-3.0-or-later
// Lengths and positions known in metres determine the scale of a bundle, or are reported if they
// cannot.
#include "pose/bundle/known.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <set>

#include "pose/refine.h"
#include "pose/survey.h"

namespace axial::pose {
namespace {

using testing::camera_behind;
using testing::flat_port;
using testing::survey;

void drop_image(Bundle& bundle, std::size_t image) {
  std::erase_if(bundle.observations,
                [&](const Observation& observation) { return observation.image == image; });
}

AdjustOptions with_distance(KnownDistance::Between between, std::size_t a, std::size_t b) {
  AdjustOptions options;
  options.distances.push_back({between, a, b, 0.5, 0.001});
  return options;
}

// Images and points with observations drawn at random.
Bundle random_bundle(std::size_t images, std::size_t points) {
  Bundle bundle;
  bundle.cameras.resize(1);
  for (std::size_t i = 0; i < images; ++i) bundle.images.push_back({std::to_string(i), 0, {}});
  for (std::size_t i = 0; i < points; ++i)
    bundle.points.push_back({Eigen::Vector3d::Zero(), 100 + i});
  for (std::size_t i = 0; i < images; ++i)
    for (std::size_t p = 0; p < points; ++p)
      if (*rc::gen::inRange(0, 4) == 0) {
        Observation observation;
        observation.image = i;
        observation.point = p;
        bundle.observations.push_back(observation);
      }
  return bundle;
}

// The images that are connected with `image` by shared points; empty if it has no observations.
std::set<std::size_t> reached_from(const Bundle& bundle, std::size_t image) {
  std::set<std::size_t> images{image}, points;
  bool seen = false;
  for (std::size_t size = 0; size != images.size() + points.size();) {
    size = images.size() + points.size();
    for (const Observation& o : bundle.observations) {
      seen = seen || o.image == image;
      if (images.contains(o.image)) points.insert(o.point);
      if (points.contains(o.point)) images.insert(o.image);
    }
  }
  return seen ? images : std::set<std::size_t>{};
}

RC_GTEST_PROP(LostKnowledge, OfImagesIsThatNoWalkJoinsThem, ()) {
  const Bundle bundle = random_bundle(6, 4);
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b) {
      if (a == b) continue;
      const auto lost = lost_knowledge(bundle, with_distance(KnownDistance::Between::images, a, b));
      RC_ASSERT(lost.empty() == reached_from(bundle, a).contains(b));
    }
}

RC_GTEST_PROP(LostKnowledge, OfPointsIsThatNoWalkJoinsThem, ()) {
  const Bundle bundle = random_bundle(4, 5);
  const auto seen_by = [&](std::size_t point) {
    std::set<std::size_t> images;
    for (const Observation& o : bundle.observations)
      if (o.point == point) images.insert(o.image);
    return images;
  };
  for (std::size_t a = 0; a < 5; ++a)
    for (std::size_t b = 0; b < 5; ++b) {
      if (a == b) continue;
      const auto from = seen_by(a), to = seen_by(b);
      bool joined = false;
      for (const std::size_t image : from)
        for (const std::size_t other : to)
          joined = joined || reached_from(bundle, image).contains(other);
      const auto lost =
          lost_knowledge(bundle, with_distance(KnownDistance::Between::points, 100 + a, 100 + b));
      RC_ASSERT(lost.empty() == joined);
    }
}

TEST(LostKnowledge, NamesTheEndThatIsLeftOut) {
  Bundle bundle = survey(camera_behind(flat_port()), {});
  const AdjustOptions images = with_distance(KnownDistance::Between::images, 2, 7);
  const AdjustOptions points = with_distance(KnownDistance::Between::points, 5, 9);
  EXPECT_TRUE(lost_knowledge(bundle, images).empty());
  EXPECT_TRUE(lost_knowledge(bundle, points).empty());
  drop_image(bundle, 7);
  ASSERT_EQ(lost_knowledge(bundle, images).size(), 1u);
  EXPECT_NE(lost_knowledge(bundle, images)[0].find("image7.jpg"), std::string::npos);
  std::erase_if(bundle.observations, [](const Observation& o) { return o.point == 9; });
  ASSERT_EQ(lost_knowledge(bundle, points).size(), 1u);
  EXPECT_NE(lost_knowledge(bundle, points)[0].find("point 9"), std::string::npos);
}

// Positions determine the scale if three of them, not on one line, belong to images with
// observations.
TEST(LostKnowledge, OfPositionsIsThatTooFewAreLeft) {
  Bundle bundle = survey(camera_behind(flat_port()), {});
  AdjustOptions options;
  for (std::size_t i = 0; i < 4; ++i)
    options.positions.push_back({i, bundle.images[i].pose.centre, Eigen::Vector3d::Constant(0.01)});
  EXPECT_TRUE(lost_knowledge(bundle, options).empty());
  drop_image(bundle, 1);
  EXPECT_TRUE(lost_knowledge(bundle, options).empty());
  EXPECT_EQ(lost_positions(bundle, options), std::vector<std::size_t>{1});
  options.positions[3].metres = (options.positions[0].metres + options.positions[2].metres) / 2;
  EXPECT_NE(lost_knowledge(bundle, options).at(0).find("one line"), std::string::npos);
  options.positions[3].metres = bundle.images[3].pose.centre;
  drop_image(bundle, 2);
  EXPECT_NE(lost_knowledge(bundle, options).at(0).find("2 positions"), std::string::npos);
}

// Refining stops when a known length can no longer be used, for any image.
TEST(LostKnowledge, EndsRefining) {
  const Bundle truth = survey(camera_behind(flat_port()), {.noise = 0.2});
  for (const std::size_t lost : {std::size_t{0}, std::size_t{6}, std::size_t{11}}) {
    Bundle bundle = truth;
    for (Observation& observation : bundle.observations)
      if (observation.image == lost) observation.pixel.x() = 1023 - observation.pixel.x();
    RefineOptions options;
    options.adjust = with_distance(KnownDistance::Between::images, lost, (lost + 5) % 12);
    options.adjust.distances[0].metres =
        (truth.images[lost].pose.centre - truth.images[(lost + 5) % 12].pose.centre).norm();
    const RefineReport report = refine(bundle, options);
    ASSERT_EQ(report.lost.size(), 1u);
    EXPECT_NE(report.lost[0].find(bundle.images[lost].name), std::string::npos);
  }
}

}  // namespace
}  // namespace axial::pose
