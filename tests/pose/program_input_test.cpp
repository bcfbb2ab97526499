// SPDX-License-Identifier: GPL-3.0-or-later
// RefinePoses on files: the files and options that it takes and refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "io/colmap/calibmar.h"
#include "pose/refine_poses.h"

namespace axial::pose {
namespace {

using ::testing::ContainsRegex;
using testing::flat_port;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(RefinePoses, TakesTheScaleFromPositions) {
  std::string lines = "# name x y z\nwithout_a_pose.jpg 0 0 0\n";
  for (const BundleImage& image : truth_.images)
    lines += fmt::format("{} {} {} {}\n", image.name, image.pose.centre.x() + 1,
                         image.pose.centre.y(), image.pose.centre.z());
  write_atomically(folder_ / "positions.txt", lines);
  const std::string said = succeed(kInput + "-o out --scale-from positions:positions.txt");
  EXPECT_THAT(said, HasSubstr("positions.txt:2: the model has no image 'without_a_pose.jpg'"));
  const io::ColmapModel refined = io::read_colmap_model(folder_ / "out" / "sparse");
  for (std::size_t i = 0; i < truth_.images.size(); ++i)
    EXPECT_LT(
        (refined.images[i].pose.centre - truth_.images[i].pose.centre - Eigen::Vector3d::UnitX())
            .norm(),
        0.002);
}

// Names with blanks, commas, '#' and quotes give the same result.
TEST_F(RefinePoses, TakesNamesWithAnySigns) {
  io::ColmapModel model = io::read_colmap_model(folder_ / "sparse");
  write("sparse", model);  // writing and reading again rounds numbers
  succeed(kInput + "-o plain --scale-from " + baseline());
  model.images[0].name = "dive 1/a,b.jpg";
  model.images[5].name = "#5 of 7.jpg";
  model.images[7].name = "\"q\" 1 2 3.jpg";
  model.images[11].name = "c,d.jpg";
  write("sparse", model);
  const std::string metres = baseline().substr(baseline().rfind(','));
  for (const char* names : {"images:dive 1/a,b.jpg,c,d.jpg", "images:\"dive 1/a,b.jpg\",c,d.jpg",
                            "images:\"dive 1/a,b.jpg\",\"c,d.jpg\""}) {
    succeed(kInput + "-o out --scale-from '" + names + metres + "'");
    EXPECT_EQ(read_file(folder_ / "out" / "sparse" / "points3D.txt"),
              read_file(folder_ / "plain" / "sparse" / "points3D.txt"));
  }
  expect_refusal("RefinePoses", kInput + "-o out --scale-from 'images:a,b,c,d,0.5'",
                 "put names with commas in double quotes");
  std::string lines = "\xEF\xBB\xBF# name x y z\n#image1.jpg 9 9 9\n";
  for (std::size_t i = 0; i < truth_.images.size(); ++i)
    lines += fmt::format("{} {} {} {} # seen\n", model.images[i].name,
                         truth_.images[i].pose.centre.x() + 1, truth_.images[i].pose.centre.y(),
                         truth_.images[i].pose.centre.z());
  write_atomically(folder_ / "positions.txt", lines);
  const std::string said = succeed(kInput + "-o placed --scale-from positions:positions.txt");
  EXPECT_THAT(said, Not(HasSubstr("the model has no image")));
  const io::ColmapModel refined = io::read_colmap_model(folder_ / "placed" / "sparse");
  for (std::size_t i = 0; i < truth_.images.size(); ++i) {
    EXPECT_EQ(refined.images[i].name, model.images[i].name);
    EXPECT_LT(
        (refined.images[i].pose.centre - truth_.images[i].pose.centre - Eigen::Vector3d::UnitX())
            .norm(),
        0.002);
  }
}

// If two files have a port or a lens, a line names both if they differ, and no line if they agree.
TEST_F(RefinePoses, SaysWhichOfTwoPortsItTakes) {
  succeed(kInput + "-o out --refine none --colmap-underwater 1");
  io::ColmapCamera camera = testing::kLens;
  camera.port = flat_port(2);
  io::write_calibmar(folder_ / "same.yaml", camera);
  camera.port = flat_port(2, 0.03);
  io::write_calibmar(folder_ / "other.yaml", camera);
  camera.port.reset();
  camera.params[0] += 2;
  io::ColmapModel lens;
  lens.cameras = {camera};
  write("other_lens", lens);
  const std::string wet = "-i out/colmap-underwater -o again ";
  const auto lines = [&](const std::string& arguments) { return succeed(wet + arguments); };
  for (const char* agreeing :
       {"", "--lens same.yaml", "--housing housing.json", "--lens lens --housing housing.json"})
    EXPECT_THAT(lines(agreeing), Not(HasSubstr("differ"))) << agreeing;
  EXPECT_THAT(lines("--lens other.yaml"),
              ContainsRegex("The ports of .*other.yaml are used; the ports of the model in "
                            ".*colmap-underwater differ and are ignored, first for image0.jpg"));
  EXPECT_THAT(lines("--lens other.yaml --housing housing.json"),
              ContainsRegex("The ports of .*housing.json are used; the ports of "
                            ".*other.yaml differ and are ignored"));
  EXPECT_THAT(lines("--lens other_lens"),
              ContainsRegex("The lenses of .*other_lens are used; the lenses of "
                            ".*colmap-underwater differ and are ignored, first for camera 1"));
}

TEST_F(RefinePoses, TakesLensAndPortFromCalibmar) {
  io::ColmapCamera camera = testing::kLens;
  camera.port = flat_port(2);
  io::write_calibmar(folder_ / "calibration.yaml", camera);
  succeed(kInput + "-o expected");
  const auto expect_the_same = [&](const std::string& from, const std::string& output) {
    succeed("-i . " + from + " -o " + output);
    for (const char* name : {"sparse/cameras.txt", "sparse/images.txt", "housing.json"})
      EXPECT_EQ(read_file(folder_ / output / name), read_file(folder_ / "expected" / name))
          << from << ": " << name;
  };
  expect_the_same("--lens calibration.yaml", "one");
  expect_the_same("--lens lens/cameras.txt --housing calibration.yaml", "two");
}

TEST_F(RefinePoses, TakesAModelOfColmapUnderwater) {
  succeed(kInput + "-o out --colmap-underwater 1");
  succeed("-i out/colmap-underwater -o again");
  EXPECT_EQ(io::read_housing(folder_ / "again" / "housing.json").ports.size(), 1u);
}

TEST_F(RefinePoses, RefusesAWaterSurface) {
  io::Housing lake = testing::housing();
  lake.ports["lake"] = WaterSurface{};
  io::write_housing(folder_ / "lake.json", lake);
  expect_refusal("RefinePoses", "-i . --lens lens/cameras.txt --housing lake.json -o out",
                 "lake.json: housing.ports.lake is a water surface");
}

TEST_F(RefinePoses, RefusesInOneLineThatNamesTheFault) {
  const auto refuses = [&](const std::string& arguments, const std::string& expected) {
    expect_refusal("RefinePoses", arguments, expected);
  };
  refuses("-i . --housing housing.json -o out", "--lens is missing");
  refuses("-i . --lens lens -o out", "--housing is missing");
  refuses("-i . --lens lens --housing housing.json", "--output-folder is missing");
  refuses("-i nowhere --lens lens --housing housing.json -o out", "nowhere");
  refuses(kInput + "-o out --poses perhaps", "--poses perhaps: must be one of adjust, known");
  refuses(kInput + "-o out --poses known --scale-from " + baseline(), "contradicts --poses known");
  refuses(kInput + "-o out --refine tilt", "'tilt' is not one of normal, distance");
  refuses(kInput + "-o out --scale-from 3", "must begin with images:, points: or positions:");
  refuses(kInput + "-o out --scale-from images:image0.jpg,lost.jpg,1", "no image 'lost.jpg'");
  refuses(kInput + "-o out --scale-from images:image0.jpg,image1.jpg,-1", "-1 m is not a distance");
  refuses(kInput + "-o out --scale-from points:1000,7,1", "point 7 is not in the model");
  refuses(kInput + "-o out --scale-from positions:lost.txt", "lost.txt");
  refuses(kInput + "-o out --refine centre", "there is a flat port");
  refuses(kInput + "-o out --refine distance",
          "needs --distance-sigma, --scale-from or --poses known");
  refuses(kInput + "-o out --refine none --normal-sigma 1", "--refine none does not name normal");
  refuses(kInput + "-o out --refine index --normal-sigma 1", "--refine does not name normal");
  refuses(kInput + "-o out --centre-sigma 1", "--refine auto does not name centre");
  refuses(kInput + "-o . ", "is the model that is read");
  refuses(kInput + "-o out --scale-from images:image0.jpg,image1.jpg,inf", "'inf' is not finite");
  refuses(kInput + "-o out --max-error 0", "--max-error 0: must be positive");
  refuses(kInput + "-o out --scale-sigma nan", "--scale-sigma");
  write_atomically(folder_ / "two.txt", "image0.jpg 1 2 3\nimage1.jpg 1 2\n");
  refuses(kInput + "-o out --scale-from positions:two.txt", "two.txt:2: must be NAME X Y Z");
  write_atomically(folder_ / "few.txt", "image0.jpg 1 0 0\nlost.jpg 2 0 1\nimage2.jpg 3 0 0\n");
  refuses(kInput + "-o out --scale-from positions:few.txt",
          "few.txt: contains 2 positions of images of the model");
  write_atomically(folder_ / "line.txt", "image0.jpg 1 0 0\nimage1.jpg 2 0 0\nimage2.jpg 3 0 0\n");
  refuses(kInput + "-o out --scale-from positions:line.txt", "lie on one line");
  write_atomically(folder_ / "dry.json", "{\"version\": 1, \"ports\": {}, \"default\": \"none\"}");
  refuses("-i . --lens lens --housing dry.json -o out", "no image is behind a port");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "sparse"));
}

}  // namespace
}  // namespace axial::pose
