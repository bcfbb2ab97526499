// SPDX-License-Identifier: GPL-3.0-or-later
// The kind of port that tracks fit, on simulated surveys.
#include "diagnosis/port_kind.h"

#include <gtest/gtest.h>

#include "diagnosis/words.h"
#include "pose/refine.h"
#include "pose/survey.h"

namespace axial::diagnosis {
namespace {

using namespace pose;
namespace testing = pose::testing;

using testing::camera_behind;
using testing::dome_port;
using testing::flat_port;
using testing::survey;

using Port = std::optional<refractive::Port<double>>;

constexpr double kNoise = 0.3;  // per axis [px]

// A survey through `port` as a pinhole engine with a free focal length reconstructs it, in metres,
// with the stated port.
Bundle brought_up(const Port& port, const Port& stated, double distance, double focal = 1) {
  const Bundle truth =
      survey(camera_behind(port), {.distance = distance, .points = 400, .noise = kNoise});
  Bundle bundle = testing::absorbed(truth, 1);
  for (BundleCamera& camera : bundle.cameras) {
    camera.measured.port = stated;
    camera.measured.lens.pinhole.fx *= focal;
    camera.measured.lens.pinhole.fy *= focal;
  }
  scale_places(bundle, testing::known_length(truth).metres / testing::known_length(bundle).metres);
  return bundle;
}

AdjustOptions with_length() {
  AdjustOptions options;
  options.distances.push_back({KnownDistance::Between::images, 0, 11, 1, 0.001});
  return options;
}

std::optional<KindFit> better(const Bundle& bundle) {
  return better_kind(fits_of_kinds(bundle, with_length()));
}

// Wrong numbers of the right kind are no other kind.
TEST(PortKind, OfARulerIsRight) {
  for (const double distance : {0.8, 2.5}) {
    EXPECT_FALSE(better(brought_up(flat_port(), flat_port(), distance)));
    EXPECT_FALSE(better(brought_up(flat_port(3), flat_port(0, 0.03), distance, 1.01)));
    EXPECT_FALSE(better(brought_up(flat_port(0, 0.1), flat_port(0, 0.08), distance, 0.995)));
    EXPECT_FALSE(better(brought_up(dome_port(), dome_port(), distance)));
    auto centred = dome_port();
    centred.centre.setZero();
    EXPECT_FALSE(better(brought_up(dome_port(), centred, distance, 1.005)));
  }
}

// An index of the wrong medium is no other kind, although a dome can look like this flat port.
TEST(PortKind, OfAWrongIndexIsRight) {
  for (const double n_water : {1.0, 1.5}) {
    refractive::FlatPort<double> wrong = flat_port(2);
    wrong.n_water = n_water;
    EXPECT_FALSE(better(brought_up(flat_port(2), wrong, 0.8))) << n_water;
  }
}

TEST(PortKind, FlatIsFoundWhereADomeIsStated) {
  for (const double distance : {0.8, 2.5}) {
    const auto found = better(brought_up(flat_port(), dome_port(), distance));
    ASSERT_TRUE(found) << distance;
    EXPECT_EQ(found->kind, PortKind::flat);
    // The noise of both axes, and the unknowns take a part of it.
    EXPECT_LT(found->error, kNoise * std::sqrt(2.0));
  }
}

TEST(PortKind, DomeIsFoundWhereAFlatPortIsStated) {
  for (const double distance : {0.8, 2.5}) {
    const auto found = better(brought_up(dome_port(), flat_port(), distance));
    ASSERT_TRUE(found) << distance;
    EXPECT_EQ(found->kind, PortKind::dome);
  }
}

TEST(PortKind, NoPortIsFoundWhereAFlatPortIsStated) {
  const auto found = better(brought_up({}, flat_port(), 0.8));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kind, PortKind::none);
}

TEST(PortKind, OfFewImagesIsNotJudged) {
  Bundle bundle = brought_up(flat_port(), dome_port(), 0.8);
  std::erase_if(bundle.observations, [](const Observation& seen) { return seen.image > 1; });
  EXPECT_TRUE(fits_of_kinds(bundle, with_length()).empty());
}

TEST(PortKind, UsualPortsAreOfTheirKind) {
  for (const PortKind kind : {PortKind::none, PortKind::flat, PortKind::dome})
    EXPECT_EQ(kind_of(usual_port(kind)), kind) << words_for(kind);
}

}  // namespace
}  // namespace axial::diagnosis
