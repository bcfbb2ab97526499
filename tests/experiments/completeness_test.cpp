// SPDX-License-Identifier: GPL-3.0-or-later
// The table of an experiment's stored numbers.
#include "experiments/completeness.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace axial::experiments {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// A report in which `recall` of the places are complete that two cameras see, and in which no place
// is seen by four.
Json report(double recall) {
  Json result;
  const auto seen = [&](const Json& share) {
    Json one;
    one["recall"].push_back(share);
    result["by_views"].push_back(one);
  };
  seen(recall);
  seen(0.5);
  seen(nullptr);
  Json score;
  score["precision"] = 0.875;
  score["f_score"] = 0.8;
  result["scores"].push_back(score);
  result["accuracy"]["mean"] = 0.00125;
  result["accuracy"]["count"] = 1000;
  result["gross"]["share"] = 0.01;
  result["gross"]["distance"] = 0.008;
  result["cpu_seconds"] = 60;
  return result;
}

Document document_of(const CompletenessOptions& options, const std::vector<Json>& reports) {
  Json results;
  for (std::size_t k = 0; k < reports.size(); ++k)
    results["parts"]["seed" + std::to_string(options.seeds[k])]["result"] = reports[k];
  return completeness_documents(options, results).at(0);
}

std::string table_of(const CompletenessOptions& options, const std::vector<Json>& reports) {
  return document_of(options, reports).text;
}

TEST(Completeness, OneRowForEachSeedAndTheirMedian) {
  CompletenessOptions options;
  options.seeds = {3, 8, 5};
  const std::string table = table_of(options, {report(0.2), report(0.9), report(0.3)});
  for (const char* row : {"\n| 3 | 20.0 | 50.0 | - | 87.5 | 0.800 | 1.250 | 1.000 | 1000 | 60.0 |",
                          "\n| 8 | 90.0 |", "\n| 5 | 30.0 |", "\n| median | 30.0 | 50.0 | - |"})
    EXPECT_THAT(table, HasSubstr(row));
}

TEST(Completeness, AMissingNumberDoesNotCountForTheMedian) {
  CompletenessOptions options;
  options.seeds = {1, 2, 3};
  Json none = report(0);
  none["by_views"][0]["recall"][0] = nullptr;
  const std::string table = table_of(options, {report(0.2), none, report(0.4)});
  EXPECT_THAT(table, HasSubstr("\n| 2 | - | 50.0 |"));
  EXPECT_THAT(table, HasSubstr("\n| median | 30.0 |"));
}

TEST(Completeness, ColumnsForWhatTheReportsHold) {
  CompletenessOptions options;
  options.seeds = {1};
  Json more = report(0.5);
  EXPECT_THAT(table_of(options, {more}), Not(HasSubstr("density")));
  more["strip"]["ratio"] = 1.5;
  EXPECT_THAT(table_of(options, {more}), HasSubstr("density, most / least"));
  EXPECT_THAT(table_of(options, {more}), HasSubstr("| 1.50 | 60.0 |"));
}

TEST(Completeness, ToleranceOfThePresetUnlessItIsGiven) {
  CompletenessOptions options;
  options.seeds = {1};
  const auto head = [&] {
    const std::string table = table_of(options, {report(0.5)});
    return table.substr(0, table.find('\n'));
  };
  EXPECT_EQ(head(), "closeup, water, true poses, tolerance 2 mm; gross: beyond 8 mm");
  options.preset = "reef";
  options.poses = "colmap";
  EXPECT_EQ(head(), "reef, water, colmap poses, tolerance 5 mm; gross: beyond 8 mm");
  options.tolerance = 0.007;
  EXPECT_THAT(head(), HasSubstr("tolerance 7 mm"));
  EXPECT_EQ(document_of(options, {report(1)}).file, "completeness_reef_water_colmap.md");
}

}  // namespace
}  // namespace axial::experiments
