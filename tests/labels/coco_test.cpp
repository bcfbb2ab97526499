// SPDX-License-Identifier: GPL-3.0-or-later
#include "labels/coco.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::labels {
namespace {

using testing::HasSubstr;

// A square with a hole and a triangle beside it, and two points.
std::vector<LabelledPhotograph> photographs() {
  map::Label polygon{"a \"1\"", "coral", {}, {}};
  polygon.parts = {
      {{{10, 10}, {30, 10}, {30, 30}, {10, 30}}, {{15, 15}, {15, 20}, {20, 20}, {20, 15}}},
      {{{-0.5, -0.5}, {3.5, -0.5}, {3.5, 3.123}}}};
  map::Label points{"p", "algae", {}, {{1, 2}, {7.004, 8}}};
  return {{"left/a.jpg", 100, 80, {polygon, points}}, {"b.jpg", 64, 48, {points}}};
}

std::string text_of(const std::vector<LabelledPhotograph>& photographs) {
  std::vector<map::Label> labels;
  for (const LabelledPhotograph& photograph : photographs)
    labels.insert(labels.end(), photograph.labels.begin(), photograph.labels.end());
  return coco_text(photographs, categories_of(labels));
}

class Coco : public axial::test::FolderTest {
 protected:
  CocoLabels read(const std::string& text) const {
    write_atomically(folder_ / "labels.json", text);
    return read_coco(folder_ / "labels.json");
  }
  std::string error(const nlohmann::json& json) const {
    return axial::test::error_of([&] { read(json.dump()); });
  }
  static nlohmann::json valid() { return nlohmann::json::parse(text_of(photographs())); }
};

TEST_F(Coco, HasTheFieldsOfTheFormat) {
  const nlohmann::json json = valid();
  EXPECT_EQ(json["images"][0]["file_name"], "left/a.jpg");
  EXPECT_EQ(json["images"][1]["width"], 64);
  EXPECT_EQ(json["categories"].size(), 2U);
  EXPECT_EQ(json["categories"][0]["name"], "algae");
  EXPECT_EQ(json["categories"][0]["keypoints"], nlohmann::json::array({"point"}));
  EXPECT_FALSE(json["categories"][1].contains("keypoints"));
  const nlohmann::json& polygon = json["annotations"][0];
  EXPECT_EQ(polygon["id"], 1);
  EXPECT_EQ(polygon["image_id"], 1);
  EXPECT_EQ(polygon["category_id"], 2);
  EXPECT_EQ(polygon["iscrowd"], 0);
  EXPECT_EQ(polygon["attributes"]["name"], "a \"1\"");
  // (0, 0) is the corner of the first pixel.
  EXPECT_EQ(polygon["segmentation"][1], (std::vector<double>{0, 0, 4, 0, 4, 3.62}));
  EXPECT_EQ(polygon["bbox"], (std::vector<double>{0, 0, 30.5, 30.5}));
  EXPECT_NEAR(polygon["area"], 400 - 25 + 4 * 3.623 / 2, 0.01);
  const nlohmann::json& point = json["annotations"][2];
  EXPECT_EQ(point["keypoints"], (std::vector<double>{7.5, 8.5, 2}));
  EXPECT_EQ(point["num_keypoints"], 1);
  EXPECT_EQ(json["annotations"].size(), 5U);
  EXPECT_EQ(json["annotations"][4]["image_id"], 2);
}

// So a category keeps its id, whichever labels the photographs see.
TEST_F(Coco, HasTheCategoriesOfAllLabels) {
  const std::vector<map::Label> labels{{"1", "sponge", {}, {}}, {"2", "alga", {}, {{1, 2}}}};
  const std::vector<LabelledPhotograph> photographs{{"a.jpg", 9, 9, {{"1", "sponge", {}, {}}}}};
  const auto json = nlohmann::json::parse(coco_text(photographs, categories_of(labels)));
  ASSERT_EQ(json["categories"].size(), 2U);
  EXPECT_EQ(json["categories"][0]["name"], "alga");
  EXPECT_TRUE(json["categories"][0].contains("keypoints"));
  EXPECT_EQ(json["categories"][1]["name"], "sponge");
  EXPECT_EQ(json["categories"][1]["id"], 2);
}

TEST_F(Coco, IsReadAsItWasWritten) {
  const CocoLabels again = read(text_of(photographs()));
  EXPECT_EQ(again.left_out, 0U);
  ASSERT_EQ(again.photographs.size(), 2U);
  EXPECT_EQ(again.photographs[0].name, "left/a.jpg");
  EXPECT_EQ(again.photographs[0].height, 80);
  ASSERT_EQ(again.photographs[0].labels.size(), 3U);
  const map::Label& polygon = again.photographs[0].labels[0];
  EXPECT_EQ(polygon.name, "a \"1\"");
  EXPECT_EQ(polygon.category, "coral");
  ASSERT_EQ(polygon.parts.size(), 2U);
  EXPECT_NEAR(std::abs(geometry::signed_area(polygon.parts[0][0])), 375, 1e-9);  // without the hole
  EXPECT_EQ(polygon.parts[1][0][1], Eigen::Vector2d(3.5, -0.5));
  ASSERT_EQ(again.photographs[1].labels.size(), 2U);
  EXPECT_LT((again.photographs[1].labels[1].points.at(0) - Eigen::Vector2d(7, 8)).norm(), 0.006);
}

TEST_F(Coco, LeavesOutBitmapsBoxesAndUnseenPoints) {
  nlohmann::json json = valid();
  json["annotations"][0]["segmentation"] = {{"size", {80, 100}}, {"counts", {8000}}};
  json["annotations"][1].erase("keypoints");
  json["annotations"][2]["keypoints"] = {0, 0, 0};
  json["annotations"][3].erase("attributes");
  const CocoLabels read_again = read(json.dump());
  EXPECT_EQ(read_again.left_out, 3U);
  EXPECT_EQ(read_again.photographs[1].labels[0].name, "algae");
}

TEST_F(Coco, ErrorsNameTheEntry) {
  nlohmann::json json = valid();
  json["annotations"][0]["segmentation"][1] = {1, 2, 3, 4, 5};
  EXPECT_THAT(
      error(json),
      HasSubstr("labels.json: annotations[0].segmentation[1] is [1,2,3,4,5], expected x, y"));
  json = valid();
  json["annotations"][1]["image_id"] = 9;
  EXPECT_THAT(error(json), HasSubstr("annotations[1].image_id is 9, expected the id of an image"));
  json = valid();
  json["annotations"][1].erase("category_id");
  EXPECT_THAT(error(json), HasSubstr("annotations[1].category_id is missing"));
  json = valid();
  json["images"][1]["id"] = 1;
  EXPECT_THAT(error(json), HasSubstr("images[1].id is 1, expected an id that no entry before"));
  json = valid();
  json["images"][1]["width"] = 0;
  EXPECT_THAT(error(json), HasSubstr("images[1].width is 0"));
  json = valid();
  json["annotations"][2]["keypoints"] = {1e300, 2, 2};
  EXPECT_THAT(error(json),
              HasSubstr("annotations[2].keypoints is [1e+300,2,2], expected numbers up to 1e6"));
  json = valid();
  json.erase("categories");
  EXPECT_THAT(error(json), HasSubstr("labels.json: is no COCO file: it has no list 'categories'"));
  EXPECT_THAT(error(nlohmann::json::array()), HasSubstr("is no COCO file"));
}

}  // namespace
}  // namespace axial::labels
