// SPDX-License-Identifier: GPL-3.0-or-later
// RefinePoses on files: observations that it leaves out, and numbers that do not fit them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/atomic_file.h"
#include "io/bytes/json.h"
#include "pose/refine_poses.h"

namespace axial::pose {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

// Repeated observations of a point in an image, at the same pixel or at others, add no information.
TEST_F(RefinePoses, CountsAnImageOnceInATrack) {
  succeed(kInput + "-o once --scale-from " + baseline());
  io::ColmapModel model = io::read_colmap_model(folder_ / "sparse");
  std::size_t added = 0;
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    io::ColmapPoint3D& point = model.points[i];
    const io::ColmapTrackElement first = point.track[i % point.track.size()];
    io::ColmapImage& image = model.images[first.image - model.images.front().id];
    for (std::size_t k = 0; k < i % 3; ++k) {
      io::ColmapPoint2D copy = image.points[first.point2d];
      copy.x += k == 0 ? 0 : 6;
      point.track.insert(point.track.begin() + static_cast<std::ptrdiff_t>(k),
                         {image.id, static_cast<std::uint32_t>(image.points.size())});
      image.points.push_back(copy);
      ++added;
    }
  }
  write("sparse", model);
  const std::string said = succeed(kInput + "-o more --scale-from " + baseline());
  EXPECT_THAT(said, HasSubstr(fmt::format("{} observations are ignored", added)));
  const auto once = nlohmann::json::parse(read_file(folder_ / "once" / "report.json"));
  const auto more = nlohmann::json::parse(read_file(folder_ / "more" / "report.json"));
  EXPECT_EQ(more["observations_after"], once["observations_after"]);
  // Adjustments end when steps are small, not with the same bits.
  for (const char* number : {"pixel_sigma", "rms_after_px", "scale_sigma"})
    EXPECT_NEAR(more[number].get<double>() / once[number].get<double>(), 1, 1e-3) << number;
}

TEST_F(RefinePoses, DropsPointsThatOneImageSees) {
  io::ColmapModel model = io::read_colmap_model(folder_ / "sparse");
  const std::size_t points = model.points.size();
  for (std::uint64_t i = 0; i < 20; ++i) {
    io::ColmapImage& image = model.images[i % model.images.size()];
    io::ColmapPoint3D alone{90000 + i, model.points[i].position, {}, 0, {}};
    for (const double shift : {0.0, 0.3, 0.6}) {
      alone.track.push_back({image.id, static_cast<std::uint32_t>(image.points.size())});
      image.points.push_back({500 + shift, 400, alone.id});
    }
    model.points.push_back(alone);
  }
  write("sparse", model);
  succeed(kInput + "-o out --min-angle 0 --scale-from " + baseline());
  const io::ColmapModel refined = io::read_colmap_model(folder_ / "out" / "sparse");
  EXPECT_LE(refined.points.size(), points);
  for (const io::ColmapPoint3D& point : refined.points) {
    EXPECT_LT(point.id, 90000u);
    std::set<std::uint32_t> images;
    for (const io::ColmapTrackElement& element : point.track) images.insert(element.image);
    EXPECT_EQ(images.size(), point.track.size());
    EXPECT_GE(images.size(), 2u);
  }
}

TEST_F(RefinePoses, LeavesOutAnImageOfWhichNothingFits) {
  io::ColmapModel model = io::read_colmap_model(folder_ / "sparse");
  for (io::ColmapPoint2D& point : model.images[11].points) point.x = 1024 - point.x;
  write("sparse", model);
  const std::string said = succeed(kInput + "-o out");
  EXPECT_THAT(said, HasSubstr("image11.jpg: left out: too few observations fit"));
  const io::ColmapModel refined = io::read_colmap_model(folder_ / "out" / "sparse");
  EXPECT_EQ(refined.images.size(), 11u);
  const auto report = io::read_json(folder_ / "out" / "report.json");
  ASSERT_TRUE(report["scale_sigma"].is_number());
  EXPECT_GT(report["scale_sigma"].get<double>(), 1e-4);
}

// Most photographs have few observations and are left out, which is no fault of the housing.
TEST_F(RefinePoses, DoesNotAskForTheHousingWhereImagesHaveFewObservations) {
  io::ColmapModel model = io::read_colmap_model(folder_ / "sparse");
  std::map<std::uint32_t, int> kept;
  for (io::ColmapPoint3D& point : model.points)
    std::erase_if(point.track, [&](const io::ColmapTrackElement& element) {
      return ++kept[element.image] > (element.image < model.images[4].id ? 80 : 24);
    });
  for (io::ColmapImage& image : model.images)
    for (io::ColmapPoint2D& point : image.points) point.point3d = io::kNoPoint3D;
  for (const io::ColmapPoint3D& point : model.points)
    for (const io::ColmapTrackElement& element : point.track)
      model.images[element.image - model.images[0].id].points[element.point2d].point3d = point.id;
  write("sparse", model);
  const std::string said = succeed(kInput + "-o out");
  EXPECT_THAT(said, HasSubstr("image11.jpg: left out: too few observations fit"));
  EXPECT_THAT(said, HasSubstr("belong to images with fewer than 30 observations that fit"));
  EXPECT_THAT(said, Not(HasSubstr("check the housing")));
}

// The stated index bends all rays by more than poses can compensate.
TEST_F(RefinePoses, WarnsOfANumberThatDoesNotFitThePhotographs) {
  for (const char* refine : {"none", "auto"}) {
    EXPECT_THAT(succeed(kInput + "-o right --refine " + refine + " --scale-from " + baseline()),
                Not(HasSubstr("warning")));
  }
  for (const double n_water : {1.0, 1.5}) {
    io::Housing wrong = testing::housing();
    std::get<refractive::FlatPort<double>>(wrong.ports["main"]).n_water = n_water;
    io::write_housing(folder_ / "wrong.json", wrong);
    const std::string from = "-i . --lens lens/cameras.txt --housing wrong.json -o out ";
    const std::string said = succeed(from + "--refine none --scale-from " + baseline());
    EXPECT_THAT(said, ContainsRegex("do not fit the photographs: with index of water at .* "
                                    "errors are .* px instead of .* px"));
    EXPECT_THAT(succeed(from + "--scale-from " + baseline()),
                ContainsRegex("the photographs give index of water .* standard "
                              "deviations from the stated .* 0.004"));
  }
}

// A model with ports, aligned to centres in another unit.
TEST_F(RefinePoses, AlignModelWarnsOfAUnitThatDoesNotFitThePorts) {
  succeed(kInput + "-o out --colmap-underwater 1 --scale-from " + baseline());
  io::ColmapModel reference = io::read_colmap_model(folder_ / "out" / "sparse");
  write("metres", reference);
  for (io::ColmapImage& image : reference.images) image.pose.centre *= 0.1;
  write("other_unit", reference);
  const auto aligned = [&](const std::string& to) {
    return succeed_in("AlignModel",
                      "-i out/colmap-underwater --reference " + to + " -o aligned_to_" + to);
  };
  EXPECT_THAT(aligned("metres"), Not(HasSubstr("do not fit")));
  EXPECT_THAT(aligned("other_unit"), HasSubstr("the model's lengths are 10 times too small"));
}

}  // namespace
}  // namespace axial::pose
