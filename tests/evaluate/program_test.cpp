// SPDX-License-Identifier: GPL-3.0-or-later
// Tests EvaluateReconstruction and AlignModel from the command line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "base/atomic_file.h"
#include "base/error.h"
#include "evaluate/alignment.h"
#include "evaluate/program_fixture.h"
#include "io/cameras/housing.h"
#include "io/images/image.h"
#include "io/openmvs/dmap.h"
#include "io/ply/ply.h"

namespace axial::evaluate {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST_F(Programs, EvaluateACloud) {
  write_scene();
  const Outcome outcome =
      run("EvaluateReconstruction",
          "-i cloud.ply -m truth.ply --tolerance 0.001,0.005 --cameras true --samples 20000 --json "
          "out.json --error-cloud errors.ply --picture errors.png");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("points to truth"));
  const auto json = read_json("out.json");
  EXPECT_EQ(json["kind"], "cloud");
  EXPECT_EQ(json["views"], 4);
  EXPECT_LT(json["counted_samples"], json["samples"]);
  // The cloud is 2 mm higher. Measured along the normals of the slopes this is a little less.
  EXPECT_NEAR(json["accuracy"]["mean"].get<double>(), 0.0018, 0.0002);
  EXPECT_LE(json["accuracy"]["max"].get<double>(), 0.002001);
  EXPECT_EQ(json["scores"][1]["precision"], 1.0);
  const PointCloud errors = io::read_cloud_ply(folder_ / "errors.ply");
  EXPECT_EQ(errors.size(), 20000u);
  EXPECT_EQ(errors.colors.size(), 20000u);
  EXPECT_EQ(io::read_image_size(folder_ / "errors.png").width, 1024);
}

// Points with view lists, errors and confidences.
std::string cloud_with_worth(const PointCloud& cloud) {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty "
      "float "
      "z\nproperty list uchar uint view_indices\nproperty float error\nproperty float "
      "confidence\nend_header\n",
      cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& x = cloud.positions[i];
    text += fmt::format("{} {} {} {} 0.0018 0.95\n", x.x(), x.y(), x.z(),
                        i % 4 == 0 ? "2 0 1" : "3 0 1 2");
  }
  return text;
}

TEST_F(Programs, EvaluateByViewsThicknessAndExpectedErrors) {
  write_scene();
  const Mesh truth = io::read_mesh_ply(folder_ / "truth.ply");
  // A pixel is about 5 mm wide, so everything is about 4 pixels thick.
  const std::vector<float> thickness(truth.vertices.size(), 0.02f);
  io::write_mesh_ply(folder_ / "thin.ply", truth, io::VertexProperty{"thickness", thickness});
  write_atomically(folder_ / "uncertainty.ply",
                   cloud_with_worth(io::read_cloud_ply(folder_ / "cloud.ply")));
  const Outcome outcome = run("EvaluateReconstruction",
                              "-i uncertainty.ply -m thin.ply --tolerance 0.02 --gross 0.001 "
                              "--cameras true --samples 20000 --json out.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  for (const char* title :
       {"seen by views", "thickness [px]", "points of views", "expected error", "confidence"})
    EXPECT_THAT(outcome.output, HasSubstr(title));
  const auto json = read_json("out.json");
  EXPECT_EQ(json["gross"]["distance"], 0.001);
  EXPECT_GT(json["gross"]["share"], 0.9) << "2 mm off but on slopes";
  ASSERT_EQ(json["by_views"].size(), 3u);
  std::size_t places = 0;
  for (const auto& one : json["by_views"]) places += one["places"].get<std::size_t>();
  EXPECT_EQ(json["counted_samples"], places);
  EXPECT_GT(json["by_views"][0]["recall"][0], 0.9);
  EXPECT_GT(json["by_thickness"][2]["places"], 0.8 * static_cast<double>(places));
  EXPECT_EQ(json["by_thickness"][6]["recall"][0], nullptr) << "nothing is not thin";
  EXPECT_EQ(json["points_by_views"][0]["share"], 0.25);
  EXPECT_EQ(json["points_by_views"][1]["share"], 0.75);
  EXPECT_NEAR(json["calibration"]["rms"].get<double>(), 1, 0.1);
  EXPECT_EQ(json["calibration"]["by_views"][0]["points"], 5000);
  EXPECT_EQ(json["calibration"]["by_views"][2]["rms"], nullptr) << "no point of four maps";
  EXPECT_EQ(json["calibration"]["reliability"][9]["points"], 20000);
  EXPECT_FALSE(json.contains("strip"));
}

TEST_F(Programs, CountTheWorthOfThePointsThatCount) {
  write_scene();
  write_atomically(folder_ / "uncertainty.ply",
                   cloud_with_worth(io::read_cloud_ply(folder_ / "cloud.ply")));
  ASSERT_EQ(run("EvaluateReconstruction",
                "-i uncertainty.ply -m truth.ply --framed-only --cameras true --samples 5000 "
                "--json o.json")
                .exit_code,
            0);
  const auto json = read_json("o.json");
  EXPECT_LT(json["accuracy"]["count"], 15000) << "of 20000";
  EXPECT_EQ(json["calibration"]["points"], json["accuracy"]["count"]);
  EXPECT_NEAR(json["points_by_views"][0]["share"].get<double>(), 0.25, 0.03);
  refuses("not a strip", "-i cloud.ply -m truth.ply --cameras true --samples 5000 --strip");
  refuses("--strip needs --cameras", "-i cloud.ply -m truth.ply --strip");
  refuses("--gross -1: must be", "-i cloud.ply -m truth.ply --gross -1");
}

TEST_F(Programs, WarnOfHousingEntriesWithoutAnImage) {
  write_scene();
  io::Housing housing;
  housing.ports["main"] = refractive::FlatPort<double>{.distance = 0.02};
  housing.cameras = {{1, "main"}, {9, "main"}};
  housing.images = {{"0001.jpg", "none"}, {"0001.png", "none"}};
  io::write_housing(folder_ / "housing.json", housing);
  const Outcome outcome = run("EvaluateReconstruction",
                              "-i cloud.ply -m truth.ply --cameras true --samples 5000 --housing "
                              "housing.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("housing.json: no image matches images.0001.png"));
  EXPECT_THAT(outcome.output, HasSubstr("housing.json: no image matches cameras.9"));
  EXPECT_THAT(outcome.output, testing::Not(HasSubstr("0001.jpg")));
}

TEST_F(Programs, EvaluateTheSameBytesForAnyNumberOfThreads) {
  write_scene();
  const std::string common = "-i cloud.ply -m truth.ply --cameras true --samples 5000 --align icp ";
  ASSERT_EQ(run("EvaluateReconstruction", common + "--max-threads 1 --json a.json").exit_code, 0);
  ASSERT_EQ(run("EvaluateReconstruction", common + "--max-threads 2 --json b.json").exit_code, 0);
  EXPECT_EQ(read_file(folder_ / "a.json"), read_file(folder_ / "b.json"));
}

TEST_F(Programs, AlignWhatCameInAnotherScale) {
  write_scene();
  const Similarity away{
      3.7,
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix(),
      {5, -4, 2}};
  io::ColmapModel moved = model();
  apply(away, moved);
  fs::create_directories(folder_ / "moved");
  io::write_colmap_text(folder_ / "moved", moved);
  PointCloud cloud = io::read_cloud_ply(folder_ / "cloud.ply");
  apply(away, cloud);
  io::write_cloud_ply(folder_ / "moved.ply", cloud);

  const Outcome outcome = run("EvaluateReconstruction",
                              "-i moved.ply -m truth.ply --align centres --estimated moved "
                              "--cameras true --samples 5000 --json out.json --transform-out t.txt "
                              "--aligned back.ply");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_NEAR(read_json("out.json")["accuracy"]["mean"].get<double>(), 0.0018, 0.0002);
  const PointCloud back = io::read_cloud_ply(folder_ / "back.ply");
  const PointCloud original = io::read_cloud_ply(folder_ / "cloud.ply");
  EXPECT_LT((back.positions[77] - original.positions[77]).norm(), 1e-5f);
  EXPECT_THAT(read_file(folder_ / "t.txt"), testing::EndsWith("\n0 0 0 1\n"));

  ASSERT_EQ(run("AlignModel", "-i moved --reference true -o aligned").exit_code, 0);
  const io::ColmapModel aligned = io::read_colmap_model(folder_ / "aligned");
  ASSERT_EQ(aligned.images.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_LT((aligned.images[i].pose.centre - model().images[i].pose.centre).norm(), 1e-9);
}

TEST_F(Programs, EvaluateAMeshAndADepthMap) {
  write_scene();
  ASSERT_EQ(
      run("EvaluateReconstruction", "-i truth.ply -m truth.ply --samples 5000 --json mesh.json")
          .exit_code,
      0);
  EXPECT_EQ(read_json("mesh.json")["kind"], "mesh");
  EXPECT_EQ(read_json("mesh.json")["normals"]["within_10_20_30"][0], 1.0);
  EXPECT_EQ(read_json("mesh.json")["topology"]["border_loops"], 1);
  EXPECT_FALSE(read_json("mesh.json").contains("seen"));
  EXPECT_LT(read_json("mesh.json")["accuracy"]["max"].get<double>(), 1e-6);

  DepthMap map;
  map.image_path = "0000.jpg";
  map.ids = {0, 1};
  map.camera = {64, 48, {60, 60, 31.5, 23.5}, {}};
  map.min_depth = 1;
  map.max_depth = 3;
  map.depth = cv::Mat1f(48, 64, 2.003f);
  map.normal = cv::Mat3f(48, 64, cv::Vec3f(0, 0, -1));
  io::write_dmap(folder_ / "depth0000.dmap", map, "");
  io::write_float_tiff(folder_ / "0000.distance.tiff", cv::Mat1f(96, 128, 2.0f));
  const Outcome outcome = run("EvaluateReconstruction",
                              "-i depth0000.dmap -m 0000.distance.tiff --json map.json --picture "
                              "map.png");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const auto json = read_json("map.json");
  EXPECT_NEAR(json["signed_median"].get<double>(), 0.003, 1e-6);
  EXPECT_EQ(json["completeness"], 1.0);
  EXPECT_EQ(json["rings"].size(), 8u);
  EXPECT_TRUE(fs::exists(folder_ / "map.png"));
}

TEST_F(Programs, EvaluateTheSeenPartOfAMesh) {
  write_scene();
  const Outcome outcome = run("EvaluateReconstruction",
                              "-i truth.ply -m truth.ply --cameras true --samples 5000 --json "
                              "mesh.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  for (const char* title : {"over seen surface", "normals [degrees]", "unseen space", "topology"})
    EXPECT_THAT(outcome.output, HasSubstr(title));
  const auto json = read_json("mesh.json");
  EXPECT_EQ(json["seen"]["scores"][0]["f_score"], 1.0);
  EXPECT_NEAR(json["seen"]["share"].get<double>() + json["unseen"]["share"].get<double>(), 1, 1e-9);
  EXPECT_GT(json["unseen"]["no_view"], 0.05);
  EXPECT_EQ(json["unseen"]["far"], 0.0);
}

TEST_F(Programs, RefuseWrongInput) {
  write_scene();
  write_atomically(folder_ / "empty.ply",
                   "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float "
                   "y\nproperty float z\nend_header\n");
  write_atomically(folder_ / "garbage.ply", "no cloud");
  Mesh spike = height_field(4, 2, ripples);
  spike.vertices[3] = {1e30f, 0, 0};
  io::write_mesh_ply(folder_ / "spike.ply", spike);
  const std::string truth = " -m truth.ply --samples 1000 ";
  refuses("spike.ply: vertex 3 is more than 100 km away", "-i spike.ply" + truth);
  refuses("missing.ply", "-i missing.ply" + truth);
  refuses("missing.ply", "-i cloud.ply -m missing.ply");
  refuses("empty.ply: the cloud has no points", "-i empty.ply" + truth);
  refuses("garbage.ply", "-i garbage.ply" + truth);
  refuses("cloud.ply", "-i truth.ply -m cloud.ply");
  refuses("--truth-file is missing", "-i cloud.ply");
  refuses("--tolerance", "-i cloud.ply --tolerance 0.1,x" + truth);
  refuses("--tolerance", "-i cloud.ply --tolerance 0.1," + truth);
  refuses("--tolerance", "-i cloud.ply --tolerance -1" + truth);
  refuses("--align", "-i cloud.ply --align somehow" + truth);
  refuses("--estimated", "-i cloud.ply --align centres" + truth);
  refuses("--housing", "-i cloud.ply --housing h.json" + truth);
  refuses("--samples", "-i cloud.ply -m truth.ply --samples 0");
  refuses("nowhere", "-i cloud.ply --cameras nowhere" + truth);
  refuses("no sample of the truth", "-i cloud.ply --cameras true --min-views 5" + truth);
  refuses("a.png: is also a file of --json", "-i cloud.ply --json a.png --picture a.png" + truth);
  refuses("missing.dmap", "-i missing.dmap -m a.tiff");
  refuses("--align", "-i missing.dmap -m a.tiff --align icp");
  EXPECT_EQ(
      run("EvaluateReconstruction", "-i cloud.ply --json no/such/folder/x.json" + truth).exit_code,
      1);
  Mesh point = height_field(2, 2, ripples);
  for (Eigen::Vector3f& x : point.vertices) x.setOnes();
  io::write_mesh_ply(folder_ / "point.ply", point);
  refuses("point.ply: the mesh has no area", "-i cloud.ply -m point.ply");
}

TEST_F(Programs, AlignModelRefusesWhatFixesNoSimilarity) {
  io::write_colmap_text(folder_ / "true", model());
  io::ColmapModel line = model();
  for (std::size_t i = 0; i < 4; ++i)
    line.images[i].pose.centre = {static_cast<double>(i), 2.0 * static_cast<double>(i), 1};
  io::ColmapModel renamed = model();
  renamed.images[0].name = "a.jpg";
  renamed.images[1].name = "b.jpg";
  for (const auto& [name, wrong] : {std::pair{"line", &line}, std::pair{"renamed", &renamed}}) {
    fs::create_directories(folder_ / name);
    io::write_colmap_text(folder_ / name, *wrong);
  }
  refuses("lie on one line", "-i line --reference true -o out", "AlignModel");
  refuses("renamed: the models have 2 images with the same name",
          "-i renamed --reference true -o out", "AlignModel");
  refuses("nowhere", "-i nowhere --reference true -o out", "AlignModel");
  refuses("--reference is missing", "-i line -o out", "AlignModel");
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

}  // namespace
}  // namespace axial::evaluate
