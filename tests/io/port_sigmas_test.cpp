// SPDX-License-Identifier: GPL-3.0-or-later
// The standard deviations in housing files.
#include "io/cameras/port_sigmas.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "io/cameras/geo_offset.h"
#include "io/housing_fixture.h"

namespace axial::io {
namespace {

using testing::HasSubstr;

constexpr const char* kMeasured = R"({ "version": 1, "default": "main", "ports": {
  "main": { "type": "flat", "distance_m": 0.02, "thickness_m": 0.014, "n_glass": 1.52,
            "n_water": 1.333, "sigma": { "normal_degrees": [0.5, 1.5], "distance_m": 0.002,
            "thickness_m": 0.0001, "n_water": 0.001 } },
  "dome": { "type": "dome", "inner_radius_m": 0.05, "thickness_m": 0.007, "n_glass": 1.49,
            "n_water": 1.34, "sigma": { "center_m": [0.001, 0.002, 0.003] } },
  "bare": { "type": "flat", "distance_m": 0.02, "thickness_m": 0.014, "n_glass": 1.52,
            "n_water": 1.333 } } })";

class PortSigmasTest : public HousingTest {
 protected:
  std::string error_with(const std::string& from, const std::string& to) {
    return test::error_of([&] { read(replaced(kMeasured, from, to)); });
  }
};

TEST_F(PortSigmasTest, AreReadAndWritten) {
  Housing housing = read(kMeasured);
  for (int turn = 0; turn < 2; ++turn) {
    ASSERT_EQ(housing.sigmas.size(), 2u);
    const PortSigmas& flat = housing.sigmas.at("main");
    EXPECT_EQ(flat.normal_degrees, Eigen::Vector2d(0.5, 1.5));
    EXPECT_EQ(flat.distance, 0.002);
    EXPECT_EQ(flat.thickness, 0.0001);
    EXPECT_EQ(flat.index, 0.001);
    EXPECT_EQ(flat.centre, std::nullopt);
    const PortSigmas& dome = housing.sigmas.at("dome");
    EXPECT_EQ(dome.centre, Eigen::Vector3d(0.001, 0.002, 0.003));
    EXPECT_EQ(dome.index, std::nullopt);
    write_housing(file_, housing);
    housing = read_housing(file_);
  }
}

TEST_F(PortSigmasTest, OfAllComponentsMayBeOneNumber) {
  EXPECT_EQ(read(replaced(kMeasured, "[0.5, 1.5]", "2")).sigmas.at("main").normal_degrees,
            Eigen::Vector2d(2, 2));
  EXPECT_EQ(read(replaced(kMeasured, "[0.001, 0.002, 0.003]", "0.004")).sigmas.at("dome").centre,
            Eigen::Vector3d(0.004, 0.004, 0.004));
}

TEST_F(PortSigmasTest, FilesWithoutThemKeepTheirBytes) {
  const Housing housing = read(kExample);
  write_housing(file_, housing);
  const std::string bytes = read_file(file_);
  EXPECT_THAT(bytes, testing::Not(HasSubstr("sigma")));
  Housing empty = housing;
  empty.sigmas["main"] = {};
  write_housing(file_, empty);
  EXPECT_EQ(read_file(file_), bytes);
}

TEST_F(PortSigmasTest, ErrorsNameFileFieldAndValue) {
  EXPECT_THAT(error_with("0.002,", "-0.002,"),
              HasSubstr(file_.string() + ": housing.ports.main.sigma.distance_m is -0.002"));
  EXPECT_THAT(error_with("0.002,", "0,"), HasSubstr("sigma.distance_m is 0, expected"));
  EXPECT_THAT(error_with("0.002,", "2,"), HasSubstr("sigma.distance_m is 2, expected"));
  EXPECT_THAT(error_with("0.002,", "null,"), HasSubstr("sigma.distance_m is null"));
  EXPECT_THAT(error_with("1.5]", "95]"), HasSubstr("sigma.normal_degrees[1] is 95"));
  EXPECT_THAT(error_with("[0.5, 1.5]", "[0.5]"), HasSubstr("sigma.normal_degrees is [0.5]"));
  EXPECT_THAT(error_with("[0.5, 1.5]", "\"small\""), HasSubstr("normal_degrees is \"small\""));
  EXPECT_THAT(error_with("0.001 }", "1.1 }"), HasSubstr("main.sigma.n_water is 1.1"));
  EXPECT_THAT(error_with("0.003]", "0]"), HasSubstr("dome.sigma.center_m[2] is 0"));
  EXPECT_THAT(error_with("\"center_m\"", "\"distance_m\""), HasSubstr("unknown key 'distance_m'"));
  EXPECT_THAT(error_with("\"normal_degrees\"", "\"center_m\""),
              HasSubstr("main.sigma: unknown key 'center_m'"));
  EXPECT_THAT(error_with("{ \"center_m\": [0.001, 0.002, 0.003] }", "0.01"),
              HasSubstr("dome.sigma is 0.01, expected an object"));
  EXPECT_THAT(test::error_of([&] {
                read(replaced(kLake, "\"n_water\": 1.34", "\"n_water\": 1.34, \"sigma\": {}"));
              }),
              HasSubstr("unknown key 'sigma'"));
}

TEST_F(PortSigmasTest, ScaleWithThePorts) {
  const Housing housing = read(kMeasured);
  Similarity larger;
  larger.scale = 2;
  const Housing same = moved(larger, housing, false), twice = moved(larger, housing, true);
  EXPECT_EQ(same.sigmas, housing.sigmas);
  EXPECT_EQ(twice.sigmas.at("main").distance, 0.004);
  EXPECT_EQ(twice.sigmas.at("main").thickness, 0.0002);
  EXPECT_EQ(twice.sigmas.at("main").normal_degrees, Eigen::Vector2d(0.5, 1.5));
  EXPECT_EQ(twice.sigmas.at("main").index, 0.001);
  EXPECT_EQ(twice.sigmas.at("dome").centre, Eigen::Vector3d(0.002, 0.004, 0.006));
}

}  // namespace
}  // namespace axial::io
