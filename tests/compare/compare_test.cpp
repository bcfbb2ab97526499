// SPDX-License-Identifier: GPL-3.0-or-later
#include "axial/compare.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/parallel.h"
#include "compare/draw_changes.h"
#include "compare/write_changes.h"
#include "geometry/faces.h"
#include "map/geotiff.h"
#include "support/empty_folder.h"
#include "support/error_of.h"
#include "two_surveys.h"

namespace axial::test {
namespace {

using namespace compare;
using testing::HasSubstr;

const map::MapFrame kFrame;

CompareOptions options_of(bool align) {
  CompareOptions options;
  options.pixel = 0.0125;
  options.align = align;
  return options;
}

// The ground that changed, with a border of 5 cm.
bool is_near_change(double x, double y) {
  Boulder a = kBoulderBefore, b = kBoulderAfter;
  for (Boulder* boulder : {&a, &b}) boulder->a += 0.05, boulder->b += 0.05;
  return a(x, y) > 0 || b(x, y) > 0 || (std::abs(x - 2.7) < 0.55 && std::abs(y - 0.6) < 0.2);
}

// The share of changed pixels of the ground that did not change.
double false_change(const Comparison& comparison) {
  const map::MapGrid& grid = comparison.grid;
  double pixels = 0, changed = 0;
  for (int y = 0; y < grid.rows; ++y)
    for (int x = 0; x < grid.columns; ++x) {
      const std::uint8_t kind = comparison.changes.classes(y, x);
      if (kind == kNotCompared ||
          is_near_change(grid.left + (x + 0.5) * grid.pixel, grid.top - (y + 0.5) * grid.pixel))
        continue;
      ++pixels;
      changed += kind != kUnchanged;
    }
  return changed / pixels;
}

void expect_true_changes(const Comparison& comparison) {
  const Changes& changes = comparison.changes;
  const double gone = kBoulderBefore.volume();
  const double grown = kGrowth * Coral::kArea, came = kBoulderAfter.volume() + grown;
  const auto record = [](const char* name, double value) {
    testing::Test::RecordProperty(name, fmt::format("{:.6f}", value));  // for docs/compare.md
  };
  record("came", changes.came.volume), record("came_sigma", changes.came.sigma);
  record("gone", changes.gone.volume), record("gone_sigma", changes.gone.sigma);
  record("false_change_percent", 100 * false_change(comparison));
  record("noise_mm", comparison.noise.typical * 1e3);
  EXPECT_NEAR(changes.gone.volume, gone, 0.05 * gone);
  EXPECT_NEAR(changes.came.volume, came, 0.05 * came);
  EXPECT_NEAR(changes.gone.volume, gone, 4 * changes.gone.sigma);
  EXPECT_NEAR(changes.came.volume, came, 4 * changes.came.sigma);
  EXPECT_LT(changes.gone.sigma, 0.03 * gone);
  ASSERT_GE(changes.regions.size(), 3u);
  const Region& coral = changes.regions[2];  // the boulders are larger
  record("coral", coral.size.volume), record("coral_sigma", coral.size.sigma);
  EXPECT_TRUE(coral.came);
  EXPECT_NEAR(coral.size.volume, grown, 0.05 * grown);
  EXPECT_NEAR(coral.x, 2.7, 0.02);
  EXPECT_NEAR(coral.y, 0.6, 0.02);
  EXPECT_LT(false_change(comparison), 0.01);
}

TEST(Compare, FindsTheBoulderAndTheCoral) {
  const Comparison comparison =
      compare_surveys(survey_before(), survey_after(), kFrame, options_of(false));
  expect_true_changes(comparison);
  EXPECT_EQ(comparison.registration_sigma, 0);
  // Pixels interpolate the noise of three vertices of both surveys: by sqrt(1/2) on average.
  EXPECT_GT(comparison.noise.typical, 0.0015);
  EXPECT_LT(comparison.noise.typical, 0.0028);
}

TEST(Compare, FindsThemInAMovedSurvey) {
  const Mesh after = moved_back(survey_after(), small_motion());
  const Comparison aligned = compare_surveys(survey_before(), after, kFrame, options_of(true));
  expect_true_changes(aligned);
  EXPECT_GT(aligned.registration_sigma, 0);
  EXPECT_LT(aligned.registration_sigma, 2e-4);
  // The motion of 2.5 cm would hide the coral.
  const Comparison given = compare_surveys(survey_before(), after, kFrame, options_of(false));
  EXPECT_GT(false_change(given), 0.1);
}

TEST(Compare, FindsLittleWhereNothingChanged) {
  for (std::uint64_t seed = 10; seed < 13; ++seed) {
    const Comparison comparison =
        compare_surveys(survey_before(seed), survey_before(seed + 100), kFrame, options_of(true));
    EXPECT_LT(comparison.changes.came.area + comparison.changes.gone.area,
              0.01 * comparison.changes.area_compared);
  }
}

TEST(Compare, StatesTheUncertaintyOfVolumes) {
  constexpr int kRuns = 40;
  const Boulder boulder{0.8, 0.7};
  double sum = 0, squares = 0, stated = 0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const Plot plot{.high = {1.6, 1.4}, .spacing = 0.02, .noise = 0.003, .seed = 200 + 2 * run};
    Plot later = plot;
    later.low += Eigen::Vector2d(0.007, 0.003), later.seed += 1;
    const Comparison comparison = compare_surveys(
        surveyed(plot, [&](double x, double y) { return hills(x, y) + boulder(x, y); }),
        surveyed(later, hills), kFrame, options_of(false));
    const Volume& gone = comparison.changes.regions.at(0).size;
    sum += gone.volume, squares += gone.volume * gone.volume, stated += gone.sigma / kRuns;
  }
  const double mean = sum / kRuns;
  const double scatter = std::sqrt((squares - kRuns * mean * mean) / (kRuns - 1));
  EXPECT_NEAR(mean, boulder.volume(), 0.02 * boulder.volume());
  // The scatter of 40 values is known to 11 %. The stated one includes what meshes cut off at the
  // edge of the boulder, which does not differ from run to run.
  EXPECT_GT(scatter, 0.3 * stated);
  EXPECT_LT(scatter, 1.5 * stated);
}

// Both meshes cut off the edge of a roof, each at its own vertices.
TEST(Compare, EdgesDoNotChange) {
  const auto roofs = [](double x, double) { return std::abs(std::remainder(x, 0.5)); };
  const Plot first{.high = {2, 2}, .spacing = 0.02, .noise = 2e-4, .seed = 1};
  Plot second = first;
  second.seed = 2, second.low.x() += 0.01;
  const Comparison comparison =
      compare_surveys(surveyed(first, roofs), surveyed(second, roofs), kFrame, options_of(false));
  EXPECT_LT(comparison.changes.came.area + comparison.changes.gone.area,
            0.002 * comparison.changes.area_compared);
}

TEST(Compare, UsesGivenStandardDeviations) {
  CompareOptions options = options_of(false);
  options.sigmas = {0.003, 0.004};
  const Comparison comparison = compare_surveys(survey_before(), survey_after(), kFrame, options);
  EXPECT_NEAR(comparison.noise.typical, 0.005, 1e-9);
  cv::Mat1f sigma = comparison.sigma.clone();
  double least = 0;
  cv::patchNaNs(sigma, 1);
  cv::minMaxLoc(sigma, &least);
  EXPECT_GE(least, 0.005 * (1 - 1e-6));
  EXPECT_LT(least, 0.0051);
}

TEST(Compare, PlacesWithoutSurfaceAreNotCompared) {
  Mesh before = survey_before(), after = survey_after();
  const auto cut = [](Mesh& mesh, double x0, double x1) {
    std::erase_if(mesh.faces, [&](const auto& face) {
      const Eigen::Vector3f& v = mesh.vertices[face[0]];
      return v.x() > x0 && v.x() < x1 && v.y() > 1 && v.y() < 1.5;
    });
  };
  cut(before, 0.5, 1), cut(after, 3, 3.4);
  const Comparison whole =
      compare_surveys(survey_before(), survey_after(), kFrame, options_of(false));
  const Comparison comparison = compare_surveys(before, after, kFrame, options_of(false));
  EXPECT_NEAR(whole.changes.area_compared - comparison.changes.area_compared, 0.45, 0.03);
  for (const double x : {0.75, 3.2}) {
    const auto column = static_cast<int>((x - comparison.grid.left) / comparison.grid.pixel);
    const auto row = static_cast<int>((comparison.grid.top - 1.25) / comparison.grid.pixel);
    EXPECT_EQ(comparison.changes.classes(row, column), kNotCompared);
    EXPECT_TRUE(std::isnan(comparison.difference(row, column)));
    EXPECT_TRUE(std::isnan(comparison.sigma(row, column)));
  }
}

TEST(Compare, RefusesSurveysOfDifferentPlaces) {
  const Mesh before = survey_before();
  const Mesh far = surveyed({.low = {10, 10}, .high = {12, 12}}, hills);
  EXPECT_EQ(error_of([&] { compare_surveys(before, far, kFrame, options_of(true)); }),
            "the later survey: the surveys do not overlap");
  Mesh hollow = before;  // a frame without surface in the middle
  std::erase_if(hollow.faces, [&](const auto& face) {
    return hollow.vertices[face[0]].x() > 0.1f || hollow.vertices[face[0]].y() > 0.1f;
  });
  Mesh other = before;
  std::erase_if(other.faces, [&](const auto& face) {
    return other.vertices[face[0]].x() < 1.f || other.vertices[face[0]].y() < 1.f;
  });
  EXPECT_EQ(error_of([&] { compare_surveys(hollow, other, kFrame, options_of(false)); }),
            "the later survey: the surveys do not overlap");
}

TEST(Compare, NeedsMemory) {
  const Context context({}, {}, {MemoryBudget::of_program(1)});
  const std::string message = error_of([&] {
    compare_surveys(survey_before(), survey_after(), kFrame, options_of(false), context);
  });
  EXPECT_THAT(message, HasSubstr("max_memory"));
  EXPECT_THAT(message, HasSubstr("pixels"));
}

TEST(UpwardDirection, IsOnTheSideOfTheFaces) {
  const Mesh mesh = survey_before();
  EXPECT_GT(upward_direction(mesh, geometry::mean_normal(mesh)).z(), 0.99);
  Mesh turned = mesh;
  for (auto& face : turned.faces) std::swap(face[0], face[1]);
  EXPECT_LT(upward_direction(turned, geometry::mean_normal(turned)).z(), -0.99);
  // The side that cameras see counts, if it is known.
  EXPECT_GT(upward_direction(turned, {0, 0, 0.5}).z(), 0.99);
  EXPECT_NEAR(vertex_distance(surveyed({.noise = 0}, [](double, double) { return 0.0; })), 0.0125,
              0.0002);
}

TEST(WriteChanges, GivesTheSameBytesForAnyNumberOfThreads) {
  const auto folder = empty_folder();
  const Mesh before = survey_before(), after = moved_back(survey_after(), small_motion());
  std::vector<std::string> first;
  for (const unsigned threads : {1u, 2u}) {
    const ThreadLimit limit(threads);
    const Comparison comparison = compare_surveys(before, after, kFrame, options_of(true));
    const auto named = [&](const char* name) { return folder / name; };
    const ChangeFiles files{named("d.tif"), named("c.tif"), named("s.tif"), named("r.json"),
                            named("p.jpg")};
    write_changes(files, comparison, {"before.ply", "after.ply", false, true});
    std::vector<std::string> bytes;
    for (const auto& file : files.all()) bytes.push_back(read_file(file));
    if (threads == 1) first = bytes;
    for (std::size_t i = 0; i < bytes.size(); ++i) EXPECT_TRUE(bytes[i] == first[i]) << i;
    const map::StoredMap difference = map::read_map(files.difference);
    const map::StoredMap classes = map::read_map(files.significant);
    EXPECT_EQ(classes.no_value, kNotCompared);
    EXPECT_EQ(cv::countNonZero(cv::Mat1b(classes.pixels) != comparison.changes.classes), 0);
    for (int y = 0; y < comparison.grid.rows; ++y)
      for (int x = 0; x < comparison.grid.columns; ++x) {
        const float value = comparison.difference(y, x);
        ASSERT_EQ(difference.pixels.at<float>(y, x), std::isnan(value) ? map::kNoHeight : value);
      }
    const auto json = nlohmann::json::parse(bytes[3]);
    EXPECT_EQ(json["came"]["volume"], comparison.changes.came.volume);
    EXPECT_EQ(json["registration"]["matrix"].size(), 4u);
  }
}

TEST(DrawChanges, ShowsWhatCameAndWent) {
  const Comparison comparison =
      compare_surveys(survey_before(), survey_after(), kFrame, options_of(false));
  const cv::Mat3b picture = draw_changes(comparison, false);
  EXPECT_GT(picture.rows, comparison.grid.rows);
  EXPECT_GE(picture.cols, 480);
  const auto color = [&](const Boulder& boulder) {
    return picture(static_cast<int>((comparison.grid.top - boulder.y) / comparison.grid.pixel),
                   static_cast<int>((boulder.x - comparison.grid.left) / comparison.grid.pixel));
  };
  EXPECT_GT(color(kBoulderAfter)[0], color(kBoulderAfter)[2]);    // blue
  EXPECT_LT(color(kBoulderBefore)[0], color(kBoulderBefore)[2]);  // orange
  EXPECT_LT(draw_changes(comparison, false, 100).rows, picture.rows);
  EXPECT_NEAR(darkest_difference(comparison), 0.149, 0.005);
}

}  // namespace
}  // namespace axial::test
