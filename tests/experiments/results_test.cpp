// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/results.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::experiments {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

class Results : public ::testing::Test {
 protected:
  fs::path folder_ = test::empty_folder();
  std::vector<std::string> computed_;  // names of the parts, in the order of their computation

  void TearDown() override { fs::remove_all(folder_); }

  Part part(const std::string& name, int version) {
    Json inputs;
    inputs["version"] = version;
    return {name, inputs, [this, name, version] {
              computed_.push_back(name);
              Json result;
              result["value"] = fmt::format("{} of version {}", name, version);
              return result;
            }};
  }
  Experiment experiment(int version) {
    return {"two", {part("left", version), part("right", version)}};
  }
  void compute_all(const Experiment& one) { compute(one.name, one.parts, folder_, {}); }
  std::string value(const Experiment& one, const std::string& name) {
    const Json kept = kept_results(one, false, folder_);
    return kept.at("parts").at(name).at("result").at("value").get<std::string>();
  }
  std::vector<fs::path> files(const std::string& name, const std::string& extension) {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder_ / "parts" / "two"))
      if (entry.path().filename().string().starts_with(name) &&
          entry.path().extension() == extension)
        found.push_back(entry.path());
    return found;
  }
};

TEST_F(Results, AFinishedPartIsNotComputedAgain) {
  const Experiment one = experiment(1);
  compute_all(one);
  compute_all(one);
  EXPECT_THAT(computed_, ElementsAre("left", "right"));
  EXPECT_EQ(value(one, "right"), "right of version 1");
}

TEST_F(Results, APartBelongsToItsInputs) {
  for (const int version : {1, 2, 1}) compute_all(experiment(version));
  EXPECT_THAT(computed_, ElementsAre("left", "right", "left", "right"));
  for (const int version : {1, 2})
    EXPECT_EQ(value(experiment(version), "left"), fmt::format("left of version {}", version));
  EXPECT_TRUE(kept_results(experiment(3), false, folder_).is_null());
}

TEST_F(Results, AreThereOnlyWhenAllPartsAreFinished) {
  const Experiment one = experiment(1);
  compute(one.name, chosen_parts(one, "ri"), folder_, {});
  EXPECT_THAT(computed_, ElementsAre("right"));
  EXPECT_TRUE(kept_results(one, true, folder_).is_null());
  compute(one.name, chosen_parts(one, "left"), folder_, {});
  const Json results = kept_results(one, true, folder_);
  ASSERT_FALSE(results.is_null());
  EXPECT_EQ(results.at("experiment"), "two");
  EXPECT_EQ(results.at("quick"), true);
  EXPECT_EQ(results.at("parts").at("left").at("inputs").at("version"), 1);
}

TEST_F(Results, ADamagedPartIsComputedAgain) {
  const Experiment one = experiment(1);
  compute_all(one);
  const fs::path file = files("left", ".json").at(0);
  const std::string whole = read_file(file);
  for (const std::string& damaged :
       {std::string(), std::string("[1]"), std::string(R"({"inputs": {"version": 1}})"),
        whole.substr(0, whole.size() / 2)}) {
    write_atomically(file, damaged);
    EXPECT_TRUE(kept_results(one, false, folder_).is_null()) << damaged;
    computed_.clear();
    compute_all(one);
    EXPECT_THAT(computed_, ElementsAre("left")) << damaged;
    EXPECT_EQ(read_file(file), whole);
  }
}

TEST_F(Results, PartsBeforeAFailureStayFinished) {
  Experiment one = experiment(1);
  const std::function<Json()> works = one.parts[1].compute;
  one.parts[1].compute = []() -> Json { throw Error("the camera is lost"); };
  EXPECT_EQ(test::error_of([&] { compute_all(one); }), "the camera is lost");
  EXPECT_THAT(files("right", ".json"), IsEmpty());
  one.parts[1].compute = works;
  compute_all(one);
  EXPECT_THAT(computed_, ElementsAre("left", "right"));
}

TEST_F(Results, ProgressCountsPartsThatWereFinishedBefore) {
  const Experiment one = experiment(1);
  for (int run = 0; run < 2; ++run) {
    std::vector<std::pair<std::size_t, std::size_t>> told;
    compute(one.name, one.parts, folder_,
            [&](std::size_t done, std::size_t total) { told.emplace_back(done, total); });
    EXPECT_THAT(told, ElementsAre(Pair(1u, 2u), Pair(2u, 2u)));
  }
}

TEST_F(Results, TimesAreAddedAndTheLongestIsNamed) {
  const Experiment one = experiment(1);
  EXPECT_EQ(part_times(one, folder_).parts, 0u);
  compute_all(one);
  write_atomically(files("left", ".seconds").at(0), "4.25");
  write_atomically(files("right", ".seconds").at(0), "2.50");
  const PartTimes both = part_times(one, folder_);
  EXPECT_EQ(both.parts, 2u);
  EXPECT_EQ(both.sum, 6.75);
  EXPECT_EQ(both.longest, 4.25);
  EXPECT_EQ(both.longest_part, "left");
  write_atomically(files("left", ".seconds").at(0), "soon");
  EXPECT_EQ(part_times(one, folder_).parts, 1u);
  EXPECT_EQ(part_times(one, folder_).longest_part, "right");
}

}  // namespace
}  // namespace axial::experiments
