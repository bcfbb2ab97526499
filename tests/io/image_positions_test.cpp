// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/image_positions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::ElementsAre;
using testing::HasSubstr;

using Numbers = std::vector<std::size_t>;

TEST(ImageLabels, AreEndsOfPaths) {
  const std::vector<std::string> paths{"/a/left/1.jpg", "/a/right/1.jpg", "/a/21.jpg"};
  const ImageLabels labels(paths);
  EXPECT_EQ(labels.find("left/1.jpg").images, Numbers{0});
  EXPECT_EQ(labels.find("1.jpg").images, (Numbers{0, 1}));
  EXPECT_EQ(labels.find("./left/../right/1.jpg").images, Numbers{1});
  EXPECT_EQ(labels.find("/a/right/1.jpg").images, Numbers{1});
  EXPECT_EQ(labels.find("21.jpg").images, Numbers{2});
  for (const char* other : {"ft/1.jpg", "below/1.jpg", "left", "1.jpg/", "", "a/22.jpg"})
    EXPECT_TRUE(labels.find(other).images.empty()) << other;
}

TEST(ImageLabels, MayBeWrittenAsOtherProgramsDo) {
  const std::vector<std::string> paths{"images/dive1/IMG_1.jpg", "images/dive2/IMG_1.jpg",
                                       "images/dive1/IMG_2.JPG", "DSC 3.tif"};
  const ImageLabels labels(paths);
  for (const char* label :
       {"dive1/img_1.JPG", "dive1\\IMG_1.jpg", "C:\\Users\\me\\dive1\\IMG_1.JPG",
        "/home/me/dive1/IMG_1.jpg", "dive1/IMG_1", "dive1/IMG_1.DNG"})
    EXPECT_EQ(labels.find(label).images, Numbers{0}) << label;
  for (const char* label : {"IMG_2", "img_2.jpg", "D:/x/IMG_2.JPG"})
    EXPECT_EQ(labels.find(label).images, Numbers{2}) << label;
  for (const char* label : {"dsc 3", "raw/DSC 3.tif", "DSC 3.ARW"})
    EXPECT_EQ(labels.find(label).images, Numbers{3}) << label;
  EXPECT_EQ(labels.find("IMG_1").images, (Numbers{0, 1}));
  EXPECT_TRUE(labels.find("dive3/IMG_2.JPG").images.empty());
  EXPECT_TRUE(labels.find("DSC 3.txt").images.empty());
}

using Places = std::vector<Eigen::Vector3d>;

ImagePositions read(const std::string& text, const std::vector<std::string>& paths,
                    Places centres = {}) {
  const fs::path folder = test::empty_folder();
  test::put(folder / "known.csv", text);
  centres.resize(paths.size(), Eigen::Vector3d::Zero());
  ImagePositions positions = positions_of_images(folder / "known.csv", paths, centres, "the scene");
  fs::remove_all(folder);
  return positions;
}

TEST(ImagePositions, BelongToTheBestLabel) {
  const ImagePositions positions =
      read("a.dng,9,9,9\na.JPG,1,2,3\nb,4,5,6\nlost,7,8,9\n", {"x/a.jpg", "x/b.jpg"});
  ASSERT_EQ(positions.found.size(), 2u);
  EXPECT_EQ(positions.found[0].image, 0u);
  EXPECT_EQ(positions.found[0].line, 2);
  EXPECT_EQ(positions.found[1].position, Eigen::Vector3d(4, 5, 6));
  EXPECT_THAT(positions.absent,
              ElementsAre(HasSubstr("known.csv:1: the scene has no image 'a.dng'"),
                          HasSubstr("known.csv:4: the scene has no image 'lost'")));
}

TEST(ImagePositions, AmbiguousLabelsNameBothImages) {
  EXPECT_THAT(error_of([] {
                read("b 0 0 0\na 1 2 3\n", {"a.jpg", "a.png", "b.jpg"});
              }),
              HasSubstr("known.csv:2: 'a' can be a.jpg or a.png; give more of its path"));
  EXPECT_THAT(error_of([] { read("A.jpg 1 2 3\nA.JPG 1 2 3\n", {"a.jpg"}); }),
              HasSubstr("known.csv:2: A.JPG occurs twice"));
}

// The cameras of a survey: `size` wide, with depths that vary by a tenth of it, in another frame
// and unit than the positions of the file.
class UnstatedUnit : public ::testing::Test {
 protected:
  // Positions of a survey about the origin [m].
  static Places survey(const Eigen::Vector3d& size) {
    Places places;
    for (int i = 0; i < 12; ++i) {
      const double t = i;
      places.push_back(size.cwiseProduct(
          Eigen::Vector3d(std::sin(2.1 * t), std::cos(3.7 * t + 0.4), std::sin(1.3 * t * t + 1))));
    }
    return places;
  }
  // The same places in the frame of a model without a scale.
  static Places seen(const Places& places) {
    const Eigen::Matrix3d turn =
        Eigen::Quaterniond(0.5, 0.1, -0.7, 0.5).normalized().toRotationMatrix();
    Places centres;
    for (const Eigen::Vector3d& place : places)
      centres.push_back(0.37 * (turn * place) + Eigen::Vector3d(3, -2, 8));
    return centres;
  }
  static std::string lines(const Places& places) {
    std::string text;
    for (std::size_t i = 0; i < places.size(); ++i)
      text += fmt::format("{}.jpg {:.9f} {:.9f} {:.6f}\n", i, places[i].x(), places[i].y(),
                          places[i].z());
    return text;
  }
  // Degrees of metres about a place, by the radii of curvature of the ellipsoid there.
  static Places degrees(const Places& places, double longitude, double latitude) {
    const double phi = latitude * std::numbers::pi / 180, e2 = 0.00669437999;
    const double w = std::sqrt(1 - e2 * std::sin(phi) * std::sin(phi));
    const double north = 6378137 * (1 - e2) / (w * w * w), east = 6378137 / w * std::cos(phi);
    Places result;
    for (const Eigen::Vector3d& place : places)
      result.emplace_back(longitude + place.x() / east * 180 / std::numbers::pi,
                          latitude + place.y() / north * 180 / std::numbers::pi, place.z());
    return result;
  }
  static std::vector<std::string> names(std::size_t count) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < count; ++i) names.push_back(fmt::format("{}.jpg", i));
    return names;
  }
  static ImagePositions read_survey(const Places& written, const Places& metres) {
    return read(lines(written), names(metres.size()), seen(metres));
  }
  static void expect_metres(const ImagePositions& read, const Places& places) {
    ASSERT_EQ(read.found.size(), places.size());
    for (std::size_t i = 0; i < places.size(); ++i)
      EXPECT_LT((read.found[i].position - places[i]).norm(), 1e-5) << i;
  }
};

TEST_F(UnstatedUnit, IsTheMetreForAVerticalScan) {
  Places scan = survey({0.003, 0.003, 2});
  for (Eigen::Vector3d& place : scan) place += Eigen::Vector3d(12.5, 48.25, -3);
  const ImagePositions read = read_survey(scan, scan);
  expect_metres(read, scan);
  EXPECT_THAT(read.notes, ElementsAre(HasSubstr("they fit the cameras as metres")));
}

TEST_F(UnstatedUnit, IsTheMetreForCloseUps) {
  Places scan = survey({0.04, 0.03, 0.01});
  for (Eigen::Vector3d& place : scan) place += Eigen::Vector3d(2, 48.25, -3);
  expect_metres(read_survey(scan, scan), scan);
}

TEST_F(UnstatedUnit, IsTheMetreForOrdinaryLocalPositions) {
  Places places = survey({5, 3, 0.5});
  for (Eigen::Vector3d& place : places) place += Eigen::Vector3d(10, 20, -3);
  const ImagePositions read = read_survey(places, places);
  expect_metres(read, places);
  EXPECT_TRUE(read.notes.empty());
}

TEST_F(UnstatedUnit, IsTheDegreeOverAnyDistance) {
  for (const double size : {5.0, 40.0, 1500.0}) {
    const Places metres = survey({size, 0.8 * size, 0.002 * size});
    const ImagePositions read = read_survey(degrees(metres, 16.5, 54.25), metres);
    ASSERT_EQ(read.found.size(), metres.size());
    for (std::size_t i = 1; i < metres.size(); ++i)
      EXPECT_NEAR((read.found[i].position - read.found[0].position).norm(),
                  (metres[i] - metres[0]).norm(), 1e-3 * size)
          << size;
    EXPECT_NEAR(read.found[0].position.x(), 597730 + metres[0].x(), 0.05 * size + 1);
    EXPECT_THAT(read.notes,
                ElementsAre(HasSubstr("they fit the cameras as longitude and latitude in degrees"),
                            HasSubstr("WGS 84 / UTM zone 33N (EPSG:32633)")));
  }
}

TEST_F(UnstatedUnit, IsTheDegreeWithTheLatitudeFirst) {
  const Places metres = survey({30, 20, 2});
  Places written = degrees(metres, 16.5, 54.25);
  for (Eigen::Vector3d& place : written) std::swap(place.x(), place.y());
  const ImagePositions read = read_survey(written, metres);
  EXPECT_NEAR(read.found.at(0).position.x(), 597730, 40);
  EXPECT_THAT(read.notes, testing::Contains(HasSubstr("as latitude and longitude in degrees")));
}

TEST_F(UnstatedUnit, IsTheDegreeThoughAFixWasLost) {
  const Places metres = survey({30, 20, 2});
  Places written = degrees(metres, 16.5, 54.25);
  written[3].setZero();
  const ImagePositions survey =
      read(lines(written) + "x.jpg 0 0 0\n", names(metres.size()), seen(metres));
  ASSERT_EQ(survey.found.size(), metres.size() - 1);
  EXPECT_EQ(survey.found[3].image, 4u);
  EXPECT_NEAR((survey.found[3].position - survey.found[0].position).norm(),
              (metres[4] - metres[0]).norm(), 0.03);
  EXPECT_THAT(survey.absent, ElementsAre(HasSubstr("the scene has no image 'x.jpg'")));
  EXPECT_THAT(survey.notes,
              ElementsAre(HasSubstr("as longitude and latitude in degrees"), HasSubstr("UTM"),
                          HasSubstr("1 lines have longitude and latitude 0 and are skipped")));
}

TEST_F(UnstatedUnit, MustBeStatedIfTheCamerasDoNotTell) {
  // Near the equator, a degree has nearly the same length in all directions. The positions are
  // noisy.
  const Places plane = survey({30, 20, 0});
  Places noisy = plane;
  for (std::size_t i = 0; i < noisy.size(); ++i)
    noisy[i] += Eigen::Vector3d(std::sin(7.0 * double(i)), std::cos(9.0 * double(i)), 0);
  EXPECT_THAT(error_of([&] { read_survey(degrees(noisy, 101.5, 2), plane); }),
              HasSubstr("known.csv: no line states whether the positions are metres or degrees"));
  // Cameras that have nothing to do with the positions.
  const Places other = survey({1, 2, 3});
  Places shuffled(other.rbegin(), other.rend());
  EXPECT_THAT(error_of([&] { read_survey(degrees(plane, 16.5, 54.25), shuffled); }),
              HasSubstr("label,x (m),y (m),z (m) or label,longitude,latitude,altitude"));
}

}  // namespace
}  // namespace axial::io
