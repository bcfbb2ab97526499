// SPDX-License-Identifier: GPL-3.0-or-later
// RefinePoses --database: photographs to which COLMAP gave no pose.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "pose/refine_poses.h"
#include "support/colmap_database_file.h"

namespace axial::pose {
namespace {

using ::testing::HasSubstr;

const std::string kScaled = kInput + "-o out --database database.db --scale-from ";

// The photographs of a model, with matches between all observations of a point.
io::ColmapDatabase database_of(const io::ColmapModel& model) {
  io::ColmapDatabase database;
  database.cameras = model.cameras;
  for (const io::ColmapImage& image : model.images)
    database.images.push_back({image.id, image.camera, image.name, image.points});
  std::map<std::pair<std::uint32_t, std::uint32_t>, io::DatabasePair> pairs;
  for (const io::ColmapPoint3D& point : model.points)
    for (const io::ColmapTrackElement& one : point.track)
      for (const io::ColmapTrackElement& other : point.track) {
        if (one.image >= other.image) continue;
        io::DatabasePair& pair = pairs[{one.image, other.image}];
        pair.first = one.image;
        pair.second = other.image;
        pair.matches.push_back({one.point2d, other.point2d});
      }
  for (auto& [ids, pair] : pairs) database.pairs.push_back(std::move(pair));
  return database;
}

// Removes the images from `first` on, as if COLMAP had given no pose to them.
void leave_out_from(std::size_t first, io::ColmapModel& model) {
  model.images.resize(first);
  const std::uint32_t last = model.images.back().id;
  std::erase_if(model.points, [&](io::ColmapPoint3D& point) {
    std::erase_if(point.track, [&](const auto& element) { return element.image > last; });
    return point.track.size() < 2;
  });
  std::map<std::uint64_t, bool> kept;
  for (const io::ColmapPoint3D& point : model.points) kept[point.id] = true;
  for (io::ColmapImage& image : model.images)
    for (io::ColmapPoint2D& feature : image.points)
      if (!kept.contains(feature.point3d)) feature.point3d = io::kNoPoint3D;
}

class LeftOutPhotographs : public RefinePoses {
 protected:
  void SetUp() override {
    RefinePoses::SetUp();
    model_ = io::read_colmap_model(folder_ / "sparse");
    test::write_database(folder_ / "database.db", database_of(model_));
  }

  // Of two images that are in the model; baseline() names the last image.
  std::string length() const {
    return fmt::format("images:image0.jpg,image5.jpg,{}",
                       (truth_.images[0].pose.centre - truth_.images[5].pose.centre).norm());
  }

  void leave_out(std::size_t first) {
    leave_out_from(first, model_);
    write("sparse", model_);
  }

  nlohmann::json report() const {
    return nlohmann::json::parse(read_file(folder_ / "out" / "report.json"));
  }

  io::ColmapModel model_;
};

TEST_F(LeftOutPhotographs, GetPosesThatAreRight) {
  leave_out(9);
  const std::string said = succeed(kScaled + length());
  EXPECT_THAT(said, HasSubstr("Registered 3 of 3 photographs that COLMAP left out"));
  const io::ColmapModel refined = io::read_colmap_model(folder_ / "out" / "sparse");
  ASSERT_EQ(refined.images.size(), truth_.images.size());
  // As good as poses that COLMAP found: compared with the truth, because the frame is free.
  Bundle found = truth_;
  for (std::size_t i = 0; i < found.images.size(); ++i) {
    ASSERT_EQ(refined.images[i].name, truth_.images[i].name);
    found.images[i].pose = refined.images[i].pose;
  }
  EXPECT_LT(testing::pose_errors(found, truth_).centre_rms, 0.002);  // 0.8 m above the ground
  const auto registered = report()["registered"];
  EXPECT_EQ(registered["photographs"],
            (std::vector<std::string>{"image9.jpg", "image10.jpg", "image11.jpg"}));
  EXPECT_TRUE(registered["left_out"].empty());
}

// A length between photographs of which one has no pose yet gives the scale in the end.
TEST_F(LeftOutPhotographs, MayGiveTheScale) {
  leave_out(9);
  succeed(kScaled + baseline());
  const io::ColmapModel refined = io::read_colmap_model(folder_ / "out" / "sparse");
  ASSERT_EQ(refined.images.size(), truth_.images.size());
  const double length = (truth_.images[0].pose.centre - truth_.images[11].pose.centre).norm();
  EXPECT_NEAR((refined.images[0].pose.centre - refined.images[11].pose.centre).norm(), length,
              0.003);
}

TEST_F(LeftOutPhotographs, AreNamedIfNothingMatches) {
  io::ColmapDatabase database = database_of(model_);
  io::DatabaseImage elsewhere = database.images.back();
  elsewhere.id = 90;
  elsewhere.name = "elsewhere.jpg";
  database.images.push_back(elsewhere);
  test::write_database(folder_ / "database.db", database);
  const std::string said = succeed(kScaled + length());
  EXPECT_THAT(said, HasSubstr("Registered 0 of 1 photographs that COLMAP left out"));
  EXPECT_THAT(said, HasSubstr("elsewhere.jpg: not registered: "));
  EXPECT_EQ(io::read_colmap_model(folder_ / "out" / "sparse").images.size(), model_.images.size());
  EXPECT_EQ(report()["registered"]["left_out"][0]["name"], "elsewhere.jpg");
}

TEST_F(LeftOutPhotographs, AreNoneIfAllHavePoses) {
  succeed(kScaled + length());
  succeed(kInput + "-o plain --scale-from " + length());
  for (const char* file : {"sparse/images.txt", "sparse/points3D.txt", "report.json"})
    EXPECT_EQ(read_file(folder_ / "out" / file), read_file(folder_ / "plain" / file)) << file;
}

TEST_F(LeftOutPhotographs, ComeFromTheDatabaseOfTheModel) {
  io::ColmapDatabase database = database_of(model_);
  database.images[3].features[5].x += 2;
  test::write_database(folder_ / "moved.db", database);
  expect_refusal("RefinePoses", kInput + "-o out --database moved.db",
                 "the features of 'image3.jpg' are not those of the model");
  database.images[3].name = "other.jpg";
  test::write_database(folder_ / "other.db", database);
  expect_refusal("RefinePoses", kInput + "-o out --database other.db",
                 "has no photograph 'image3.jpg' of the model");
  expect_refusal("RefinePoses", kInput + "-o out --database nothing.db", "file not found");
}

TEST_F(LeftOutPhotographs, StayOutIfPosesAreKnown) {
  write("sparse", testing::model_of(truth_));
  const std::string said = succeed(kInput + "-o out --poses known --database nothing.db");
  EXPECT_THAT(said, HasSubstr("nothing.db is not read, because the poses are known"));
}

}  // namespace
}  // namespace axial::pose
