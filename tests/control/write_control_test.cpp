// SPDX-License-Identifier: GPL-3.0-or-later
// Each format is read back to the same numbers.
#include "control/write_control.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numeric>

#include "control/control_fixture.h"
#include "control/labels.h"

namespace axial::control {
namespace {

using testing::HasSubstr;

using WriteControl = ControlFiles;

double some(double low, double high) {
  constexpr int kSteps = 1'000'000'000;
  return low + (high - low) * *rc::gen::inRange(0, kSteps) / kSteps;
}

Control some_control() {
  Control control;
  control.crs = "EPSG:32617";
  for (int i = 0; i < *rc::gen::inRange(1, 6); ++i) {
    ControlPoint point;
    point.label = fmt::format("target {}", i);
    point.metres = {some(400'000, 600'000), some(2e6, 3e6), some(-30, 0)};
    point.sigma = {some(0.001, 0.1), some(0.001, 0.1), some(0.001, 0.1)};
    point.check = *rc::gen::arbitrary<bool>();
    if (*rc::gen::inRange(0, 3) == 0) {
      point.metres.z() = 0;
      point.sigma.z() = kNotKnown;
    }
    control.points.push_back(point);
    Bar bar{point.label, fmt::format("tag {}", i), some(0.1, 2), some(0.0001, 0.01), false, {}};
    bar.check = *rc::gen::arbitrary<bool>();
    control.bars.push_back(bar);
    for (const char* image : {"a.jpg", "left/b.jpg"}) {
      TargetImage seen;
      seen.label = point.label;
      seen.image = image;
      seen.pixel = {some(0, 6000), some(0, 4000)};
      seen.sigma = some(0.01, 0.1);
      seen.dot << 0.1, 0.01, 0.01, some(0.1, 0.2);
      control.images.push_back(seen);
    }
  }
  return control;
}

void expect_same_points(const Control& a, const Control& b, double tolerance = 0) {
  RC_ASSERT(a.crs == b.crs);
  RC_ASSERT(a.points.size() == b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    RC_ASSERT(same_label(a.points[i].label, b.points[i].label));
    RC_ASSERT((a.points[i].metres - b.points[i].metres).cwiseAbs().maxCoeff() <= tolerance);
  }
}

void expect_same_sigmas(const Control& a, const Control& b) {
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    RC_ASSERT(a.points[i].sigma == b.points[i].sigma);
    RC_ASSERT(a.points[i].check == b.points[i].check);
  }
}

void expect_same_images(const Control& a, const Control& b) {
  RC_ASSERT(a.images.size() == b.images.size());
  for (const TargetImage& image : a.images)
    RC_ASSERT(std::ranges::any_of(b.images, [&](const TargetImage& other) {
      return same_label(image.label, other.label) && image.image == other.image &&
             image.pixel == other.pixel;
    }));
}

void expect_same_bars(const Control& a, const Control& b) {
  RC_ASSERT(a.bars.size() == b.bars.size());
  for (std::size_t i = 0; i < a.bars.size(); ++i) {
    RC_ASSERT(a.bars[i].first == b.bars[i].first);
    RC_ASSERT(a.bars[i].second == b.bars[i].second);
    RC_ASSERT(a.bars[i].metres == b.bars[i].metres);
    RC_ASSERT(a.bars[i].sigma == b.bars[i].sigma);
    RC_ASSERT(a.bars[i].check == b.bars[i].check);
  }
}

RC_GTEST_FIXTURE_PROP(WriteControl, JsonIsReadBack, ()) {
  const Control control = some_control();
  write_control_json(folder_ / "c.json", control);
  const Control again = read_control(folder_ / "c.json", {});
  expect_same_points(control, again);
  expect_same_sigmas(control, again);
  expect_same_bars(control, again);
  expect_same_images(control, again);
  RC_ASSERT(again.images.front().sigma == control.images.front().sigma);
  RC_ASSERT(again.images.front().dot == control.images.front().dot);
}

RC_GTEST_FIXTURE_PROP(WriteControl, MarkersAreReadBack, ()) {
  const Control control = some_control();
  write_metashape_markers(folder_ / "c.xml", control);
  const Control again = read_control(folder_ / "c.xml", {});
  expect_same_points(control, again);
  expect_same_sigmas(control, again);
  expect_same_bars(control, again);
  expect_same_images(control, again);
}

RC_GTEST_FIXTURE_PROP(WriteControl, GcpListIsReadBack, ()) {
  const Control control = some_control();
  write_gcp_list(folder_ / "gcp_list.txt", control);
  const Control again = read_control(folder_ / "gcp_list.txt", {});
  expect_same_points(control, again);
  expect_same_images(control, again);
}

RC_GTEST_FIXTURE_PROP(WriteControl, ReferenceIsReadBack, ()) {
  const Control control = some_control();
  write_metashape_reference(folder_ / "c.csv", control);
  const Control again = read_control(folder_ / "c.csv", {});
  expect_same_points(control, again);
  expect_same_sigmas(control, again);
}

RC_GTEST_FIXTURE_PROP(WriteControl, BarsOfReefShapeAreReadBack, ()) {
  const Control control = some_control();
  write_reefshape_bars(folder_ / "bars.txt", control);
  expect_same_bars(control, read_control(folder_ / "bars.txt", {}));
}

// Two transformations: of PROJ's accuracy, far below 0.001 mm.
RC_GTEST_FIXTURE_PROP(WriteControl, ControlOfReefShapeIsReadBack, ()) {
  Control control = some_control();
  for (ControlPoint& point : control.points) point.sigma.y() = point.sigma.x();
  write_reefshape_control(folder_ / "c.csv", control);
  const Control again = read_control(folder_ / "c.csv", {.epsg = 32617});
  expect_same_points(control, again, 1e-6);
  expect_same_sigmas(control, again);
}

TEST_F(WriteControl, PointsWithoutASystemStayLocal) {
  Control control;
  ControlPoint point{.label = "a, \"b\"", .where = {}};
  point.metres = {1, 2, 3};
  point.sigma.setConstant(0.1);
  control.points.push_back(point);
  write_metashape_markers(folder_ / "c.xml", control);
  write_metashape_reference(folder_ / "c.csv", control);
  write_control_json(folder_ / "c.json", control);
  for (const char* name : {"c.xml", "c.csv", "c.json"}) {
    const Control again = read_control(folder_ / name, {});
    EXPECT_EQ(again.crs, "") << name;
    ASSERT_EQ(again.points.size(), 1u) << name;
    EXPECT_EQ(again.points[0].label, point.label) << name;
    EXPECT_EQ(again.points[0].metres, point.metres) << name;
  }
}

TEST_F(WriteControl, FormatsRefuseWhatTheyCannotHold) {
  Control control;
  ControlPoint point{.label = "target 1", .where = {}};
  point.metres = {500'000, 2'500'000, 1};
  point.sigma.setConstant(0.1);
  control.points.push_back(point);
  TargetImage image;
  image.label = "target 1";
  image.image = "a b.jpg";
  control.images.push_back(image);
  const auto message_of = [&](auto write, const char* name) {
    const auto file = folder_ / name;
    const std::string message = test::error_naming(file, [&] { write(file, control); });
    EXPECT_FALSE(std::filesystem::exists(file));
    return message;
  };
  EXPECT_THAT(message_of(write_gcp_list, "g.txt"), HasSubstr("'a b.jpg' must be one word"));
  control.images[0].image = "a.jpg";
  EXPECT_THAT(message_of(write_gcp_list, "g.txt"), HasSubstr("no coordinate reference system"));
  EXPECT_THAT(message_of(write_reefshape_control, "c.csv"), HasSubstr("system"));
  control.crs = "EPSG:32617";
  EXPECT_THAT(message_of(write_reefshape_control, "c.csv"), HasSubstr("above the surface"));
  control.points[0].label = "other";
  EXPECT_THAT(message_of(write_gcp_list, "g.txt"), HasSubstr("is a control point"));
}

}  // namespace
}  // namespace axial::control
