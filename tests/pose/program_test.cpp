// SPDX-License-Identifier: GPL-3.0-or-later
// RefinePoses on files: the poses, ports and lenses that it finds, and its report.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "io/bytes/json.h"
#include "pose/refine_poses.h"

namespace axial::pose {
namespace {

using testing::camera_behind;
using ::testing::ContainsRegex;
using testing::flat_port;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(RefinePoses, MakesAModelThatInterfaceColmapReads) {
  succeed(kInput + "-o out --refine none --scale-from " + baseline());
  const io::ColmapModel refined = io::read_colmap_model(io::find_colmap_model(folder_ / "out"));
  ASSERT_EQ(refined.cameras.size(), 1u);
  EXPECT_EQ(refined.cameras[0].model, "OPENCV");
  EXPECT_EQ(refined.cameras[0].params, testing::kLens.params);
  const Bundle found = found_poses(refined);
  const auto errors = testing::pose_errors(found, truth_, false);
  EXPECT_LT(errors.centre_rms, 0.001);
  EXPECT_LT(errors.largest_angle, 0.05);
  const io::Housing housing = io::read_housing(folder_ / "out" / "housing.json");
  EXPECT_EQ(std::get<refractive::FlatPort<double>>(housing.ports.at("main")).distance, 0.02);
}

TEST_F(RefinePoses, RefinesImagesBehindFlatPortsAndDomesTogether) {
  truth_ = testing::mixed_survey(camera_behind(flat_port(2)), camera_behind(testing::dome_port()),
                                 {.noise = 0.2});
  write_input();
  io::Housing housing = testing::housing();
  housing.ports["dome"] = testing::dome_port();
  for (std::size_t i = 1; i < truth_.images.size(); i += 2)
    housing.images[truth_.images[i].name] = "dome";
  io::write_housing(folder_ / "housing.json", housing);
  succeed(kInput + "-o out --refine index --index-sigma 0.001 --scale-from " + baseline());
  const io::ColmapModel refined = io::read_colmap_model(folder_ / "out" / "sparse");
  EXPECT_EQ(refined.cameras.size(), 2u);
  const Bundle found = found_poses(refined);
  const auto errors = testing::pose_errors(found, truth_, false);
  EXPECT_LT(errors.centre_rms, 0.001);
  EXPECT_LT(errors.largest_angle, 0.05);
  const auto report = io::read_json(folder_ / "out" / "report.json");
  EXPECT_NEAR(report["pixel_sigma"].get<double>(), 0.2, 0.01);
  EXPECT_EQ(report["images"].size(), 12u);
}

// Flat ports and domes in one model: each kind has its own numbers.
TEST_F(RefinePoses, FindsTheNumbersOfEachKindOfPort) {
  const auto flat = flat_port(2);
  const auto dome = testing::dome_port();
  truth_ = testing::mixed_survey(camera_behind(flat), camera_behind(dome), {.noise = 0.2});
  write("sparse", testing::model_of(truth_));
  io::Housing housing = testing::housing();
  auto wrong_flat = flat_port(0);
  wrong_flat.distance += 0.005;
  auto wrong_dome = dome;
  wrong_dome.centre += Eigen::Vector3d(0.002, -0.002, 0.003);
  housing.ports["main"] = wrong_flat;
  housing.ports["dome"] = wrong_dome;
  for (std::size_t i = 1; i < truth_.images.size(); i += 2)
    housing.images[truth_.images[i].name] = "dome";
  io::write_housing(folder_ / "housing.json", housing);
  const std::string known = "-o out --poses known --refine ";
  succeed(kInput + known + "normal,distance,centre");
  const io::Housing found = io::read_housing(folder_ / "out" / "housing.json");
  std::size_t flats = 0, domes = 0;
  for (const auto& [name, port] : found.ports) {
    if (const auto* const one = std::get_if<refractive::FlatPort<double>>(&port)) {
      EXPECT_NEAR(one->distance, flat.distance, 0.001);
      EXPECT_LT((one->normal - flat.normal).norm(), 0.003);
      ++flats;
    }
    if (const auto* const one = std::get_if<refractive::DomePort<double>>(&port)) {
      EXPECT_LT((one->centre - dome.centre).norm(), 0.001);
      ++domes;
    }
  }
  EXPECT_EQ(flats, 1u);
  EXPECT_EQ(domes, 1u);
  const auto report = io::read_json(folder_ / "out" / "report.json");
  EXPECT_EQ(report["cameras"][0]["free"].size(), 3u);
  EXPECT_EQ(report["cameras"][0]["free"][2]["name"], "distance");
  EXPECT_EQ(report["cameras"][1]["free"].size(), 3u);
  EXPECT_EQ(report["cameras"][1]["free"][2]["name"], "centre z");

  // With the number of one kind alone, the port of the other kind stays.
  succeed(kInput + known + "centre");
  bool stays = false;
  for (const auto& [name, port] : io::read_housing(folder_ / "out" / "housing.json").ports)
    if (const auto* const one = std::get_if<refractive::FlatPort<double>>(&port))
      stays = one->distance == wrong_flat.distance && one->normal == wrong_flat.normal;
  EXPECT_TRUE(stays);
}

TEST_F(RefinePoses, ReportsErrorsAndWhatItKnows) {
  const std::string said =
      succeed(kInput + "-o out --refine distance,normal --scale-from " + baseline());
  EXPECT_THAT(said, HasSubstr("distance"));
  EXPECT_THAT(said, HasSubstr("image11.jpg"));
  const auto report = io::read_json(folder_ / "out" / "report.json");
  EXPECT_NEAR(report["pixel_sigma"].get<double>(), 0.2, 0.01);  // 1 / sqrt(2 x 4000) is 1 %
  EXPECT_LT(report["rms_after_px"].get<double>(), report["rms_before_px"].get<double>());
  EXPECT_EQ(report["images"].size(), 12u);
  const auto& free = report["cameras"][0]["free"];
  ASSERT_EQ(free.size(), 3u);
  EXPECT_EQ(free[2]["name"], "distance");
  EXPECT_NEAR(free[2]["value"].get<double>(), 20, 3 * free[2]["sigma"].get<double>());
}

// Starts from poses that absorbed refraction and a badly measured port, and finds the true port.
TEST_F(RefinePoses, FindsAPortThatWasMeasuredBadly) {
  io::Housing wrong = testing::housing();
  wrong.ports["main"] = flat_port(3, 0.025);
  io::write_housing(folder_ / "housing.json", wrong);
  succeed(kInput + "-o out --refine distance,normal --scale-from " + baseline());
  const auto report = io::read_json(folder_ / "out" / "report.json");
  const auto& free = report["cameras"][0]["free"];
  const std::array<double, 3> truth{2, 0, 20};    // degrees, degrees, mm
  const std::array<double, 3> wrong_by{1, 1, 5};  // initial errors: sigmas must be smaller
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double value = free.at(i)["value"].get<double>(), sigma = free[i]["sigma"].get<double>();
    EXPECT_NEAR(value, truth[i], 3 * sigma) << free[i]["name"];
    EXPECT_LT(sigma, wrong_by[i] / 5) << free[i]["name"];
  }
}

// The lens file has a focal length 4 % too short, with the true distortion. Close range and a known
// length determine the focal length.
TEST_F(RefinePoses, FindsTheFocalLengthOfADistortingLens) {
  io::ColmapModel lens;
  lens.cameras = {testing::kLens};
  lens.cameras[0].params[0] /= 1.04;
  lens.cameras[0].params[1] /= 1.04;
  write("lens", lens);
  succeed(kInput + "-o out --refine focal --scale-from " + baseline());
  const auto report = io::read_json(folder_ / "out" / "report.json");
  const auto& factor = report["cameras"][0]["free"].at(0);
  EXPECT_NEAR(factor["value"].get<double>(), 1.04, 3 * factor["sigma"].get<double>());
  EXPECT_LT(factor["sigma"].get<double>(), 0.001);
  EXPECT_NEAR(report["pixel_sigma"].get<double>(), 0.2, 0.01);  // 1 / sqrt(2 x 4000) is 1 %
  const io::ColmapModel refined = io::read_colmap_model(folder_ / "out" / "sparse");
  EXPECT_NEAR(refined.cameras[0].params[0], testing::kLens.params[0], 1);
}

// A diver's measurements: a tilt of 2 degrees that is not stated, 4 mm of distance, the index of
// fresh water, and a lens that was focused anew. All are found, and written for the next dive.
TEST_F(RefinePoses, EstimatesWhatWasMeasuredByRuler) {
  io::Housing wrong = testing::housing();
  wrong.ports["main"] = flat_port(0, 0.024);
  std::get<refractive::FlatPort<double>>(wrong.ports["main"]).n_water = 1.328;
  io::write_housing(folder_ / "housing.json", wrong);
  io::ColmapModel lens;
  lens.cameras = {testing::kLens};
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) lens.cameras[0].params[k] *= 1.005;
  write("lens", lens);
  const std::string said = succeed(kInput + "-o out --scale-from " + baseline());
  EXPECT_THAT(said, Not(HasSubstr("warning")));
  EXPECT_THAT(said, ContainsRegex("normal to the right [0-9.]+ [+]- [0-9.]+ degrees, stated: "
                                  "0 [+]- 3 degrees, decided by the photographs"));
  const auto report = io::read_json(folder_ / "out" / "report.json");
  const auto& free = report["cameras"][0]["free"];
  ASSERT_EQ(free.size(), 5u);
  const std::array<double, 5> truth{2, 0, 20, 1.333, 1 / 1.005};
  const std::array<double, 5> before{0, 0, 24, 1.328, 1}, ruler{3, 3, 5, 0.004, 0.005};
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double sigma = free[i]["sigma"].get<double>();
    EXPECT_NEAR(free[i]["value"].get<double>(), truth[i], 3 * sigma) << free[i]["name"];
    EXPECT_NEAR(free[i]["before"].get<double>(), before[i], 1e-9);
    EXPECT_NEAR(free[i]["sigma_before"].get<double>(), ruler[i], 1e-9);
    const bool kept = free[i]["value"] == free[i]["before"];
    EXPECT_EQ(free[i]["decided_by"],
              !kept && 2 * sigma < ruler[i] ? "photographs" : "stated value");
  }
  EXPECT_EQ(free[1]["value"], 0);  // the stated value is right: it stays
  const io::Housing found = io::read_housing(folder_ / "out" / "housing.json");
  const io::PortSigmas& sigmas = found.sigmas.at("main");
  EXPECT_NEAR(sigmas.normal_degrees.value().x(), free[0]["sigma"].get<double>(), 1e-9);
  EXPECT_NEAR(1e3 * sigmas.distance.value(), free[2]["sigma"].get<double>(), 1e-9);
  EXPECT_EQ(sigmas.index, std::nullopt);  // of the water of this dive
  const auto lenses = io::read_colmap_cameras(folder_ / "out" / "sparse" / "cameras.txt");
  EXPECT_NEAR(lenses[0].focal_sigma.value(), free[4]["sigma"].get<double>(), 1e-5);
}

// The centre of the dome moves out of the dome, so that the poses are refined with a flat port.
TEST_F(RefinePoses, StartsAgainWithTheRightKindOfPort) {
  io::Housing dome;
  dome.ports["main"] =
      refractive::DomePort<double>{Eigen::Vector3d::Zero(), 0.06, 0.008, 1, 1.52, 1.333};
  dome.default_port = "main";
  io::write_housing(folder_ / "housing.json", dome);
  const std::string said = succeed(kInput + "-o out --scale-from " + baseline());
  EXPECT_THAT(said, ContainsRegex("warning: The photographs fit a flat port better than a "
                                  "dome: .* refined again, with the usual numbers of a flat"));
  const io::Housing found = io::read_housing(folder_ / "out" / "housing.json");
  const auto& port = std::get<refractive::FlatPort<double>>(found.ports.at("main"));
  EXPECT_NEAR(std::asin(port.normal.x()), 2 * testing::kDegree, 0.3 * testing::kDegree);
  Bundle poses = truth_;
  const io::ColmapModel refined = io::read_colmap_model(folder_ / "out" / "sparse");
  for (std::size_t i = 0; i < poses.images.size(); ++i)
    poses.images[i].pose = refined.images[i].pose;
  EXPECT_LT(testing::pose_errors(poses, truth_).centre_rms, 0.002);  // of 0.8 m
}

// The files state smaller standard deviations than a ruler's, and the options have priority.
TEST_F(RefinePoses, TakesStandardDeviationsFromFilesAndOptions) {
  io::Housing housing = testing::housing();
  housing.sigmas["main"] = {.distance = 0.001, .index = 0.0001};
  io::write_housing(folder_ / "housing.json", housing);
  io::ColmapModel lens;
  lens.cameras = {testing::kLens};
  lens.cameras[0].focal_sigma = 0.0003;
  write("lens", lens);
  succeed(kInput + "-o out --index-sigma 0.0002 --scale-from " + baseline());
  const auto report = io::read_json(folder_ / "out" / "report.json");
  const auto& free = report["cameras"][0]["free"];
  ASSERT_EQ(free.size(), 5u);
  EXPECT_NEAR(free[0]["sigma_before"].get<double>(), 3, 1e-9);
  EXPECT_NEAR(free[2]["sigma_before"].get<double>(), 1, 1e-9);
  EXPECT_EQ(free[3]["sigma_before"].get<double>(), 0.0002);
  EXPECT_EQ(free[4]["sigma_before"].get<double>(), 0.0003);
  // Numbers that stay fixed keep what the files state.
  succeed(kInput + "-o kept --refine none");
  EXPECT_EQ(read_file(folder_ / "kept" / "housing.json"), read_file(folder_ / "housing.json"));
  EXPECT_EQ(io::read_colmap_cameras(folder_ / "kept" / "sparse" / "cameras.txt").at(0).focal_sigma,
            0.0003);
}

// Without a known length, the doubt of the port is in the scale, fixed or not.
TEST_F(RefinePoses, SaysThatRefractionHardlyTellsTheScale) {
  for (const char* refine : {"auto", "none"}) {
    const std::string said = succeed(kInput + "-o out --refine " + refine);
    EXPECT_THAT(said, HasSubstr("because only refraction determines the scale"));
    EXPECT_GT(io::read_json(folder_ / "out" / "report.json")["scale_sigma"].get<double>(), 0.02);
  }
  EXPECT_THAT(succeed(kInput + "-o out --scale-from " + baseline()),
              Not(HasSubstr("only refraction")));
}

TEST_F(RefinePoses, LeavesKnownPosesAsTheyAre) {
  io::ColmapModel known = testing::model_of(truth_);
  for (io::ColmapPoint3D& point : known.points) point.position *= 1.1;
  write("sparse", known);
  succeed(kInput + "-o out --poses known");
  const io::ColmapModel placed = io::read_colmap_model(folder_ / "out" / "sparse");
  for (std::size_t i = 0; i < known.images.size(); ++i) {
    const Pose &kept = placed.images[i].pose, &given = known.images[i].pose;
    EXPECT_LT((kept.centre - given.centre).norm(), 1e-12);
    EXPECT_LT((kept.rotation - given.rotation).norm(), 1e-12);
  }
  const auto report = io::read_json(folder_ / "out" / "report.json");
  EXPECT_NEAR(report["pixel_sigma"].get<double>(), 0.2, 0.01);  // 1 / sqrt(2 x 4000) is 1 %
  EXPECT_EQ(report["scale_sigma"], 0);
}

TEST_F(RefinePoses, GivesTheSameBytesEachTime) {
  succeed(kInput + "-o one --max-threads 1");
  succeed(kInput + "-o two");
  for (const char* name : {"sparse/images.txt", "sparse/points3D.txt", "report.json"})
    EXPECT_EQ(read_file(folder_ / "one" / name), read_file(folder_ / "two" / name)) << name;
}

}  // namespace
}  // namespace axial::pose
