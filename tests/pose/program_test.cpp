// SPDX-License-Identifier: GPL-3.0-or-later
// RefinePoses on files.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "base/atomic_file.h"
#include "io/bytes/json.h"
#include "io/cameras/calibmar.h"
#include "pose/adjust.h"
#include "pose/colmap_survey.h"
#include "pose/refine.h"
#include "support/program_run.h"

namespace axial::pose {
namespace {

using test::Outcome;
using testing::camera_behind;
using testing::flat_port;
using testing::survey;

class RefinePoses : public test::ProgramTest {
 protected:
  Bundle truth_ = survey(camera_behind(flat_port(2)), {.noise = 0.2});

  void SetUp() override {
    ProgramTest::SetUp();
    write_input();
    io::write_housing(folder_ / "housing.json", testing::housing());
  }

  // Writes the survey as a COLMAP model, and the lens.
  void write_input() {
    Bundle absorbed = truth_;
    for (BundleCamera& camera : absorbed.cameras) camera.measured.port.reset();
    AdjustOptions options;
    options.free[kFocalNumber] = true;
    options.loss_sigmas = 10;
    adjust(absorbed, options);
    scale_places(absorbed, 7.3);
    write("sparse", testing::model_of(absorbed));
    io::ColmapModel lens;
    lens.cameras = {testing::kLens};
    write("lens", lens);
  }

  void write(const std::string& name, const io::ColmapModel& model) {
    make_folder(folder_ / name);
    io::write_colmap_text(folder_ / name, model);
  }

  Outcome run(const std::string& arguments) const { return run_program("RefinePoses", arguments); }

  std::string baseline() const {
    return fmt::format("images:image0.jpg,image11.jpg,{}",
                       (truth_.images[0].pose.centre - truth_.images[11].pose.centre).norm());
  }
};

const std::string kInput = "-i . --lens lens/cameras.txt --housing housing.json ";

TEST_F(RefinePoses, MakesAModelThatInterfaceColmapReads) {
  const Outcome outcome = run(kInput + "-o out --scale-from " + baseline());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const io::ColmapModel refined = io::read_colmap_model(io::find_colmap_model(folder_ / "out"));
  ASSERT_EQ(refined.cameras.size(), 1u);
  EXPECT_EQ(refined.cameras[0].model, "OPENCV");
  EXPECT_EQ(refined.cameras[0].params, testing::kLens.params);
  Bundle found = truth_;
  for (std::size_t i = 0; i < found.images.size(); ++i)
    found.images[i].pose = refined.images[i].pose;
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
  const Outcome outcome =
      run(kInput + "-o out --refine index --index-sigma 0.001 --scale-from " + baseline());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const io::ColmapModel refined = io::read_colmap_model(folder_ / "out" / "sparse");
  EXPECT_EQ(refined.cameras.size(), 2u);
  Bundle found = truth_;
  for (std::size_t i = 0; i < found.images.size(); ++i)
    found.images[i].pose = refined.images[i].pose;
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
  const Outcome outcome = run(kInput + known + "normal,distance,centre");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
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
  ASSERT_EQ(run(kInput + known + "centre").exit_code, 0);
  bool stays = false;
  for (const auto& [name, port] : io::read_housing(folder_ / "out" / "housing.json").ports)
    if (const auto* const one = std::get_if<refractive::FlatPort<double>>(&port))
      stays = one->distance == wrong_flat.distance && one->normal == wrong_flat.normal;
  EXPECT_TRUE(stays);
}

TEST_F(RefinePoses, ReportsErrorsAndWhatItKnows) {
  const Outcome outcome =
      run(kInput + "-o out --refine distance,normal --scale-from " + baseline());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, ::testing::HasSubstr("distance"));
  EXPECT_THAT(outcome.output, ::testing::HasSubstr("image11.jpg"));
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
  const Outcome outcome =
      run(kInput + "-o out --refine distance,normal --scale-from " + baseline());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
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

TEST_F(RefinePoses, TakesTheScaleFromPositions) {
  std::string lines = "# name x y z\nwithout_a_pose.jpg 0 0 0\n";
  for (const BundleImage& image : truth_.images)
    lines += fmt::format("{} {} {} {}\n", image.name, image.pose.centre.x() + 1,
                         image.pose.centre.y(), image.pose.centre.z());
  write_atomically(folder_ / "positions.txt", lines);
  const Outcome outcome = run(kInput + "-o out --scale-from positions:positions.txt");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output,
              ::testing::HasSubstr("positions.txt:2: the model has no image 'without_a_pose.jpg'"));
  const io::ColmapModel refined = io::read_colmap_model(folder_ / "out" / "sparse");
  for (std::size_t i = 0; i < truth_.images.size(); ++i)
    EXPECT_LT(
        (refined.images[i].pose.centre - truth_.images[i].pose.centre - Eigen::Vector3d::UnitX())
            .norm(),
        0.002);
}

TEST_F(RefinePoses, LeavesKnownPosesAsTheyAre) {
  io::ColmapModel known = testing::model_of(truth_);
  for (io::ColmapPoint3D& point : known.points) point.position *= 1.1;
  write("sparse", known);
  const Outcome outcome = run(kInput + "-o out --poses known");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
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

// Repeated observations of a point in an image, at the same pixel or at others, add no information.
TEST_F(RefinePoses, CountsAnImageOnceInATrack) {
  ASSERT_EQ(run(kInput + "-o once --scale-from " + baseline()).exit_code, 0);
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
  const Outcome outcome = run(kInput + "-o more --scale-from " + baseline());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output,
              ::testing::HasSubstr(fmt::format("{} observations are ignored", added)));
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
  const Outcome outcome = run(kInput + "-o out --min-angle 0 --scale-from " + baseline());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
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

// Names with blanks, commas, '#' and quotes give the same result.
TEST_F(RefinePoses, TakesNamesWithAnySigns) {
  io::ColmapModel model = io::read_colmap_model(folder_ / "sparse");
  write("sparse", model);  // writing and reading again rounds numbers
  ASSERT_EQ(run(kInput + "-o plain --scale-from " + baseline()).exit_code, 0);
  model.images[0].name = "dive 1/a,b.jpg";
  model.images[5].name = "#5 of 7.jpg";
  model.images[7].name = "\"q\" 1 2 3.jpg";
  model.images[11].name = "c,d.jpg";
  write("sparse", model);
  const std::string metres = baseline().substr(baseline().rfind(','));
  for (const char* names : {"images:dive 1/a,b.jpg,c,d.jpg", "images:\"dive 1/a,b.jpg\",c,d.jpg",
                            "images:\"dive 1/a,b.jpg\",\"c,d.jpg\""}) {
    const Outcome outcome = run(kInput + "-o out --scale-from '" + names + metres + "'");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
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
  const Outcome outcome = run(kInput + "-o placed --scale-from positions:positions.txt");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, ::testing::Not(::testing::HasSubstr("the model has no image")));
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
  ASSERT_EQ(run(kInput + "-o out --colmap-underwater 1").exit_code, 0);
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
  const auto lines = [&](const std::string& arguments) {
    const Outcome outcome = run(wet + arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    return outcome.output;
  };
  for (const char* agreeing :
       {"", "--lens same.yaml", "--housing housing.json", "--lens lens --housing housing.json"})
    EXPECT_THAT(lines(agreeing), ::testing::Not(::testing::HasSubstr("differ"))) << agreeing;
  EXPECT_THAT(
      lines("--lens other.yaml"),
      ::testing::ContainsRegex("The ports of .*other.yaml are used; the ports of the model in "
                               ".*colmap-underwater differ and are ignored, first for image0.jpg"));
  EXPECT_THAT(lines("--lens other.yaml --housing housing.json"),
              ::testing::ContainsRegex("The ports of .*housing.json are used; the ports of "
                                       ".*other.yaml differ and are ignored"));
  EXPECT_THAT(
      lines("--lens other_lens"),
      ::testing::ContainsRegex("The lenses of .*other_lens are used; the lenses of "
                               ".*colmap-underwater differ and are ignored, first for camera 1"));
}

TEST_F(RefinePoses, RefusesAWaterSurface) {
  io::Housing lake = testing::housing();
  lake.ports["lake"] = WaterSurface{};
  io::write_housing(folder_ / "lake.json", lake);
  expect_refusal("RefinePoses", "-i . --lens lens/cameras.txt --housing lake.json -o out",
                 "lake.json: housing.ports.lake is a water surface");
}

TEST_F(RefinePoses, TakesLensAndPortFromCalibmar) {
  io::ColmapCamera camera = testing::kLens;
  camera.port = flat_port(2);
  io::write_calibmar(folder_ / "calibration.yaml", camera);
  ASSERT_EQ(run(kInput + "-o expected").exit_code, 0);
  const auto expect_the_same = [&](const std::string& from, const std::string& output) {
    const Outcome outcome = run("-i . " + from + " -o " + output);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    for (const char* name : {"sparse/cameras.txt", "sparse/images.txt", "housing.json"})
      EXPECT_EQ(read_file(folder_ / output / name), read_file(folder_ / "expected" / name))
          << from << ": " << name;
  };
  expect_the_same("--lens calibration.yaml", "one");
  expect_the_same("--lens lens/cameras.txt --housing calibration.yaml", "two");
}

// The lens file has a focal length 4 % too short, with the true distortion. Close range and a known
// length determine the focal length.
TEST_F(RefinePoses, FindsTheFocalLengthOfADistortingLens) {
  io::ColmapModel lens;
  lens.cameras = {testing::kLens};
  lens.cameras[0].params[0] /= 1.04;
  lens.cameras[0].params[1] /= 1.04;
  write("lens", lens);
  const Outcome outcome = run(kInput + "-o out --refine focal --scale-from " + baseline());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const auto report = io::read_json(folder_ / "out" / "report.json");
  const auto& factor = report["cameras"][0]["free"].at(0);
  EXPECT_NEAR(factor["value"].get<double>(), 1.04, 3 * factor["sigma"].get<double>());
  EXPECT_LT(factor["sigma"].get<double>(), 0.001);
  EXPECT_NEAR(report["pixel_sigma"].get<double>(), 0.2, 0.01);  // 1 / sqrt(2 x 4000) is 1 %
  const io::ColmapModel refined = io::read_colmap_model(folder_ / "out" / "sparse");
  EXPECT_NEAR(refined.cameras[0].params[0], testing::kLens.params[0], 1);
}

TEST_F(RefinePoses, GivesTheSameBytesEachTime) {
  ASSERT_EQ(run(kInput + "-o one --max-threads 1").exit_code, 0);
  ASSERT_EQ(run(kInput + "-o two").exit_code, 0);
  for (const char* name : {"sparse/images.txt", "sparse/points3D.txt", "report.json"})
    EXPECT_EQ(read_file(folder_ / "one" / name), read_file(folder_ / "two" / name)) << name;
}

TEST_F(RefinePoses, LeavesOutAnImageOfWhichNothingFits) {
  io::ColmapModel model = io::read_colmap_model(folder_ / "sparse");
  for (io::ColmapPoint2D& point : model.images[11].points) point.x = 1024 - point.x;
  write("sparse", model);
  const Outcome outcome = run(kInput + "-o out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output,
              ::testing::HasSubstr("image11.jpg: left out: too few observations fit"));
  const io::ColmapModel refined = io::read_colmap_model(folder_ / "out" / "sparse");
  EXPECT_EQ(refined.images.size(), 11u);
  const auto report = io::read_json(folder_ / "out" / "report.json");
  ASSERT_TRUE(report["scale_sigma"].is_number());
  EXPECT_GT(report["scale_sigma"].get<double>(), 1e-4);
}

TEST_F(RefinePoses, TakesAModelOfColmapUnderwater) {
  ASSERT_EQ(run(kInput + "-o out --colmap-underwater 1").exit_code, 0);
  const Outcome outcome = run("-i out/colmap-underwater -o again");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_EQ(io::read_housing(folder_ / "again" / "housing.json").ports.size(), 1u);
}

// The stated index bends all rays by more than poses can compensate.
TEST_F(RefinePoses, WarnsOfANumberThatDoesNotFitThePhotographs) {
  const Outcome right = run(kInput + "-o right --scale-from " + baseline());
  ASSERT_EQ(right.exit_code, 0) << right.output;
  EXPECT_THAT(right.output, ::testing::Not(::testing::HasSubstr("fit the photographs")));
  for (const double n_water : {1.0, 1.5}) {
    io::Housing wrong = testing::housing();
    std::get<refractive::FlatPort<double>>(wrong.ports["main"]).n_water = n_water;
    io::write_housing(folder_ / "wrong.json", wrong);
    const Outcome outcome =
        run("-i . --lens lens/cameras.txt --housing wrong.json -o out --scale-from " + baseline());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_THAT(outcome.output,
                ::testing::ContainsRegex("do not fit the photographs: with index of water at .* "
                                         "errors are .* px instead of .* px"));
  }
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
  const Outcome outcome = run(kInput + "-o out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output,
              ::testing::HasSubstr("image11.jpg: left out: too few observations fit"));
  EXPECT_THAT(outcome.output,
              ::testing::HasSubstr("belong to images with fewer than 30 observations that fit"));
  EXPECT_THAT(outcome.output, ::testing::Not(::testing::HasSubstr("check the housing")));
}

// A model with ports, aligned to centres in another unit.
TEST_F(RefinePoses, AlignModelWarnsOfAUnitThatDoesNotFitThePorts) {
  ASSERT_EQ(run(kInput + "-o out --colmap-underwater 1 --scale-from " + baseline()).exit_code, 0);
  io::ColmapModel reference = io::read_colmap_model(folder_ / "out" / "sparse");
  write("metres", reference);
  for (io::ColmapImage& image : reference.images) image.pose.centre *= 0.1;
  write("other_unit", reference);
  const auto aligned = [&](const std::string& to) {
    const Outcome outcome = run_program(
        "AlignModel", "-i out/colmap-underwater --reference " + to + " -o aligned_to_" + to);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    return outcome.output;
  };
  EXPECT_THAT(aligned("metres"), ::testing::Not(::testing::HasSubstr("do not fit")));
  EXPECT_THAT(aligned("other_unit"),
              ::testing::HasSubstr("the model's lengths are 10 times too small"));
}

TEST_F(RefinePoses, RefusesInOneLineThatNamesTheFault) {
  const auto refuses = [&](const std::string& arguments, const std::string& expected) {
    expect_refusal("RefinePoses", arguments, expected);
  };
  refuses("-i . --housing housing.json -o out", "--lens is missing");
  refuses("-i . --lens lens -o out", "--housing is missing");
  refuses("-i . --lens lens --housing housing.json", "--output-folder is missing");
  refuses("-i nowhere --lens lens --housing housing.json -o out", "nowhere");
  refuses(kInput + "-o out --poses perhaps", "--poses perhaps: must be adjust or known");
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
  refuses(kInput + "-o out --normal-sigma 1", "--refine does not name normal");
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
