// SPDX-License-Identifier: GPL-3.0-or-later
// RefinePoses writes its model before it computes standard deviations.
#include "../../apps/RefinePoses/results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <new>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/program/out_of_memory.h"
#include "io/bytes/json.h"
#include "pose/adjust/uncertainty.h"
#include "pose/survey.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::pose {
namespace {

namespace fs = std::filesystem;
using apps::errors_by_image;
using apps::report_json;
using apps::Results;
using apps::uncertainty_lines;
using apps::write_results;
using ::testing::AllOf;
using ::testing::HasSubstr;

class WriteResults : public ::testing::Test {
 protected:
  fs::path folder_ = test::empty_folder();
  fs::path out_ = folder_ / "out";
  Bundle bundle_ = testing::survey(testing::camera_behind(testing::flat_port()), {.noise = 0.2});
  RefineReport report_;
  AdjustOptions options_;

  void TearDown() override { fs::remove_all(folder_); }

  Results results() {
    options_.free[2] = true;
    return {report_, errors_by_image(bundle_, bundle_), bundle_, {"main"}, options_, {}, false};
  }

  static void write_model(const fs::path& staging) {
    write_atomically(staging / "model.txt", "refined");
  }

  Uncertainty known() const {
    Uncertainty known;
    known.pixel_sigma = 0.2;
    known.camera_sigmas = {HousingChange<double>::Constant(0.001)};
    known.scale_sigma = 0.01;
    return known;
  }

  nlohmann::json report() const { return io::read_json(out_ / "report.json"); }
};

TEST_F(WriteResults, ModelIsThereWholeWhileStandardDeviationsAreComputed) {
  bool computed = false;
  write_results(out_, write_model, results(), [&] {
    computed = true;
    EXPECT_EQ(read_file(out_ / "model.txt"), "refined");
    EXPECT_EQ(report()["standard_deviations"], "missing");
    EXPECT_TRUE(report()["scale_sigma"].is_null());
    EXPECT_TRUE(report()["cameras"][0]["free"][0]["sigma"].is_null());
    EXPECT_EQ(report()["pixel_sigma"].get<double>(), observed_pixel_sigma(bundle_, options_));
    return known();
  });
  ASSERT_TRUE(computed);
  EXPECT_FALSE(report().contains("standard_deviations"));
  EXPECT_EQ(report()["scale_sigma"], 0.01);
  EXPECT_DOUBLE_EQ(report()["cameras"][0]["free"][0]["sigma"].get<double>(), 1);  // [mm]
}

// An earlier run may have left a folder: no report of another model remains in it.
TEST_F(WriteResults, OutOfMemoryLeavesTheModelAndOneLine) {
  for (const bool again : {false, true}) {
    if (again) write_atomically(out_ / "report.json", "{\"scale_sigma\": 7}");
    const std::string said = test::error_of([&] {
      write_results(out_, write_model, results(), []() -> Uncertainty { throw std::bad_alloc(); });
    });
    EXPECT_THAT(said, HasSubstr(out_.string()));
    EXPECT_THAT(said, HasSubstr("only its standard deviations are missing: memory ran out"));
    EXPECT_FALSE(is_out_of_memory(Error(said))) << "the program would say no more than that";
    EXPECT_EQ(read_file(out_ / "model.txt"), "refined");
    EXPECT_EQ(report()["standard_deviations"], "missing");
    EXPECT_TRUE(report()["scale_sigma"].is_null());
    for (const auto& entry : fs::directory_iterator(folder_)) EXPECT_EQ(entry.path(), out_);
  }
}

TEST_F(WriteResults, OtherFailuresAreNamed) {
  EXPECT_THAT(test::error_of([&] {
                write_results(out_, write_model, results(),
                              []() -> Uncertainty { throw Error("the matrix is odd"); });
              }),
              HasSubstr("missing: the matrix is odd"));
  EXPECT_EQ(read_file(out_ / "model.txt"), "refined");
}

TEST_F(WriteResults, WithoutAModelThereIsNoFolder) {
  EXPECT_THROW(write_results(
                   out_, [](const fs::path&) { throw Error("the disk is full"); }, results(),
                   [&] { return known(); }),
               Error);
  EXPECT_FALSE(fs::exists(out_));
}

// No percentage where nothing determines the scale, or where the given scale is not used.
TEST_F(WriteResults, AModelWithoutScaleSaysSo) {
  Uncertainty none = known();
  none.scale_sigma = none.camera_sigmas[0](2) = std::numeric_limits<double>::infinity();
  Results lost = results();
  lost.scale_lost = true;
  lost.unused = {"--scale-from"};
  for (const auto& [what, known_now] : {std::pair{results(), none}, std::pair{lost, known()}}) {
    const std::vector<std::string> lines = uncertainty_lines(what, known_now);
    EXPECT_THAT(lines.back(), HasSubstr("All lengths are unknown"));
    for (const std::string& line : lines) {
      EXPECT_THAT(line, ::testing::Not(HasSubstr("inf")));
      EXPECT_THAT(line, ::testing::Not(HasSubstr("%")));
    }
    EXPECT_TRUE(nlohmann::json::parse(report_json(what, &known_now))["scale_sigma"].is_null());
  }
  EXPECT_THAT(uncertainty_lines(results(), known()).back(), HasSubstr("known to 1 %"));
  EXPECT_EQ(nlohmann::json::parse(report_json(lost, nullptr))["unused"].size(), 1u);
}

// The warning is about a survey whose links are weak, and not about a long survey with the usual
// errors of long surveys.
TEST_F(WriteResults, WarnsOfAWeakShape) {
  Uncertainty uncertain = known();
  EXPECT_FALSE(apps::shape_warning(results(), uncertain));
  bundle_.images[2].name = "third.jpg";
  uncertain.shape_sigma = 0.01;
  uncertain.least_linked = 2;
  EXPECT_THAT(apps::shape_warning(results(), uncertain).value(),
              AllOf(HasSubstr("known to 1 % of the distance"), HasSubstr("third.jpg")));
  uncertain.shape_sigma = std::numeric_limits<double>::infinity();
  EXPECT_THAT(apps::shape_warning(results(), uncertain).value(), HasSubstr("is unknown"));
  uncertain.shape_sigma = 0.01;
  bundle_.images.back().pose.centre.x() += 1000 * median_distance(bundle_);
  EXPECT_FALSE(apps::shape_warning(results(), uncertain));
}

TEST_F(WriteResults, WarnsOfUncertainDepths) {
  Uncertainty uncertain = known();
  uncertain.depth_sigma = 0.0029;
  EXPECT_FALSE(apps::depth_warning(uncertain));
  EXPECT_THAT(apps::depth_line(uncertain), HasSubstr("known to 0.29 %"));
  uncertain.depth_sigma = 0.0034;
  EXPECT_THAT(apps::depth_warning(uncertain).value(), HasSubstr("known to 0.34 %"));
  uncertain.depth_sigma = 0.02;
  EXPECT_THAT(apps::depth_warning(uncertain).value(), HasSubstr("known to 2 %"));
  uncertain.depth_sigma = std::numeric_limits<double>::infinity();
  EXPECT_THAT(apps::depth_warning(uncertain).value(), HasSubstr("not known"));
}

}  // namespace
}  // namespace axial::pose
