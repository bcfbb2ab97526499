// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/housing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "io/housing_fixture.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::HasSubstr;

TEST_F(HousingTest, ReadsTheExample) {
  const Housing housing = read(kExample);
  ASSERT_EQ(housing.ports.size(), 2u);
  const auto& main = flat(housing.ports.at("main"));
  EXPECT_EQ(main.distance, 0.02);
  EXPECT_EQ(main.thickness, 0.014);
  EXPECT_EQ(main.n_glass, 1.52);
  EXPECT_EQ(main.n_water, 1.333);
  EXPECT_EQ(main.normal, Eigen::Vector3d(0, 0, 1));
  const auto& tilted = flat(housing.ports.at("tilted"));
  EXPECT_EQ(tilted.n_air, 1);
  EXPECT_NEAR(tilted.normal.norm(), 1, 1e-15);
  EXPECT_NEAR(tilted.normal.x() / tilted.normal.z(), 0.3, 1e-15);
  EXPECT_EQ(housing.port_of("dry_0001.jpg", 2), "none");
  EXPECT_EQ(housing.port_of("other.jpg", 2), "tilted");
  EXPECT_EQ(housing.port_of("other.jpg", 1), "main");
}

TEST_F(HousingTest, ReadsBackWhatItWrites) {
  Housing housing = read(kExample);
  flat(housing.ports["main"]).normal = Eigen::Vector3d(0.01, -0.02, 1).normalized();
  write_housing(file_, housing);
  const Housing again = read_housing(file_);
  EXPECT_EQ(again.default_port, housing.default_port);
  EXPECT_EQ(again.cameras, housing.cameras);
  EXPECT_EQ(again.images, housing.images);
  for (const auto& [name, port] : housing.ports) {
    EXPECT_EQ(flat(again.ports.at(name)).distance, flat(port).distance);
    EXPECT_EQ(flat(again.ports.at(name)).n_glass, flat(port).n_glass);
    EXPECT_LT((flat(again.ports.at(name)).normal - flat(port).normal).norm(), 1e-15);
  }
  const std::string bytes = read_file(file_);
  write_housing(file_, again);
  EXPECT_EQ(read_file(file_), bytes);
}

constexpr const char* kDome = R"({ "version": 1, "default": "main", "ports": { "main":
  { "type": "dome", "center_m": [0.001, 0, -0.002], "inner_radius_m": 0.05, "thickness_m": 0.007,
    "n_glass": 1.49, "n_water": 1.34 } } })";

TEST_F(HousingTest, ReadsAndWritesDomes) {
  Housing housing = read(kDome);
  for (int turn = 0; turn < 2; ++turn) {
    const auto& dome = std::get<refractive::DomePort<double>>(housing.ports.at("main"));
    EXPECT_EQ(dome.centre, Eigen::Vector3d(0.001, 0, -0.002));
    EXPECT_EQ(dome.inner_radius, 0.05);
    EXPECT_EQ(dome.thickness, 0.007);
    EXPECT_EQ(dome.n_air, 1);
    EXPECT_EQ(dome.n_glass, 1.49);
    EXPECT_EQ(dome.n_water, 1.34);
    write_housing(file_, housing);
    housing = read_housing(file_);
  }
}

TEST_F(HousingTest, NamesKeyAndValueOfDomes) {
  const auto error = [&](const std::string& from, const std::string& to) {
    return error_of([&] { read(replaced(kDome, from, to)); });
  };
  EXPECT_THAT(error("0.05", "50"), HasSubstr("main.inner_radius_m is 50"));
  EXPECT_THAT(error("-0.002]", "0.05]"), HasSubstr("main.center_m is 0.05"));
  EXPECT_THAT(error("-0.002]", "null]"), HasSubstr("main.center_m"));
  EXPECT_THAT(error("-0.002]", "1, 2]"), HasSubstr("3 numbers"));
  EXPECT_THAT(error("\"inner_radius_m\": 0.05,", ""), HasSubstr(".inner_radius_m is missing"));
  EXPECT_THAT(error("\"n_glass\"", "\"normal\""), HasSubstr("'normal'"));
  EXPECT_THAT(error("1.34", "0.5"), HasSubstr("n_water is 0.5"));
}

TEST_F(HousingTest, ReadsAndWritesWaterSurfaces) {
  Housing housing = read(kLake);
  for (int turn = 0; turn < 2; ++turn) {
    const auto& lake = std::get<WaterSurface>(housing.ports.at("lake"));
    EXPECT_EQ(lake.normal, Eigen::Vector3d(0, 0, -1));
    EXPECT_EQ(lake.point, Eigen::Vector3d(7, 8, 1.5));
    EXPECT_EQ(lake.n_air, 1);
    EXPECT_EQ(lake.n_water, 1.34);
    write_housing(file_, housing);
    housing = read_housing(file_);
  }
  const Housing tilted = read(replaced(kLake, "[0, 0, -1]", "[0.3, 0, -1]"));
  const auto& normal = std::get<WaterSurface>(tilted.ports.at("lake")).normal;
  EXPECT_NEAR(normal.norm(), 1, 1e-15);
  EXPECT_NEAR(normal.x() / normal.z(), -0.3, 1e-15);
  EXPECT_THAT(error_of([&] { refuse_water_surfaces(housing, file_); }),
              HasSubstr(file_.string() + ": housing.ports.lake is a water surface"));
  EXPECT_THAT(error_of([&] { (void)housing.carried_port("lake"); }), HasSubstr("'lake'"));
  EXPECT_EQ(housing.carried_port("none"), std::nullopt);
}

TEST_F(HousingTest, NamesKeyAndValueOfWaterSurfaces) {
  const auto error = [&](const std::string& from, const std::string& to) {
    return test::error_naming(file_, [&] { read(replaced(kLake, from, to)); });
  };
  EXPECT_THAT(error("[0, 0, -1]", "[0, 0, 0]"), HasSubstr("lake.normal is [0,0,0]"));
  EXPECT_THAT(error("[0, 0, -1]", "[0, 0]"), HasSubstr("lake.normal is [0,0], expected 3 numbers"));
  EXPECT_THAT(error("\"normal\": [0, 0, -1],", ""), HasSubstr(".normal is missing"));
  EXPECT_THAT(error("[7, 8, 1.5]", "1.5"), HasSubstr("lake.point_m is 1.5"));
  EXPECT_THAT(error("[7, 8, 1.5]", "[7, 8, \"up\"]"), HasSubstr("3 numbers"));
  EXPECT_THAT(error("[7, 8, 1.5]", "[7, 8, 1e400]"), HasSubstr("JSON"));
  EXPECT_THAT(error("\"point_m\": [7, 8, 1.5],", ""), HasSubstr(".point_m is missing"));
  EXPECT_THAT(error("\"point_m\"", "\"point\""), HasSubstr("unknown key 'point'"));
  EXPECT_THAT(error("1.34", "0.5"), HasSubstr("lake.n_water is 0.5"));
  EXPECT_THAT(error("1.34", "\"wet\""), HasSubstr("lake.n_water is \"wet\""));
  EXPECT_THAT(error(", \"n_water\": 1.34", ""), HasSubstr(".n_water is missing"));
  EXPECT_THAT(error("1.34", "1.34, \"n_air\": 1.5"), HasSubstr("lake.n_air is 1.5"));
  EXPECT_THAT(error("1.34", "1.34, \"n_glass\": 1.5"), HasSubstr("unknown key 'n_glass'"));
  EXPECT_THAT(error("1.34", "1.34, \"thickness_m\": 0"), HasSubstr("'thickness_m'"));
  EXPECT_THAT(error("water-surface", "water surface"), HasSubstr("'water-surface'"));
}

TEST_F(HousingTest, RefusesToWriteImpossibleWaterSurfaces) {
  const auto error = [&](const WaterSurface& surface) {
    Housing housing;
    housing.ports["lake"] = surface;
    return error_of([&] { write_housing(file_, housing); });
  };
  EXPECT_THAT(error({{0, 0, -2}, {0, 0, 0}, 1, 1.33}), HasSubstr("lake.normal has length 2"));
  EXPECT_THAT(error({{0, 0, -1}, {0, std::nan(""), 0}, 1, 1.33}), HasSubstr("lake.point_m"));
  EXPECT_THAT(error({{0, 0, -1}, {0, 0, 0}, 1, 0.9}), HasSubstr("lake.n_water is 0.9"));
}

TEST_F(HousingTest, NamesKeyAndValue) {
  EXPECT_THAT(error("\"version\": 1", "\"version\": 2"), HasSubstr("version is 2"));
  EXPECT_THAT(error("\"version\": 1,", ""), HasSubstr(".version is missing"));
  EXPECT_THAT(error("\"default\": \"main\",", ""), HasSubstr(".default is missing"));
  EXPECT_THAT(error("\"default\"", "\"defualt\""), HasSubstr("defualt"));
  EXPECT_THAT(error("\"distance_m\": 0.020", "\"distance_mm\": 20"), HasSubstr("distance"));
  EXPECT_THAT(error("0.020", "20"), HasSubstr("ports.main.distance_m is 20"));
  EXPECT_THAT(error("0.020", "-0.02"), HasSubstr("distance_m is -0.02"));
  EXPECT_THAT(error("0.020", "\"2 cm\""), HasSubstr("2 cm"));
  EXPECT_THAT(error("0.014", "-0.014"), HasSubstr("thickness_m is -0.014"));
  EXPECT_THAT(error("0.014", "null"), HasSubstr("thickness_m is null"));
  EXPECT_THAT(error("1.52", "0.9"), HasSubstr("n_glass is 0.9"));
  EXPECT_THAT(error("1.333", "1333"), HasSubstr("n_water is 1333"));
  EXPECT_THAT(error("\"n_air\": 1.0", "\"n_air\": 1.4"), HasSubstr("n_air is 1.4"));
  EXPECT_THAT(error("[0, 0, 1]", "[0, 0, 0]"), HasSubstr("main.normal"));
  EXPECT_THAT(error("[0, 0, 1]", "[0, 0, -1]"), HasSubstr("backwards"));
  EXPECT_THAT(error("[0, 0, 1]", "[0, 1, 0]"), HasSubstr("backwards"));
  EXPECT_THAT(error("[0, 0, 1]", "[0, 0]"), HasSubstr("3 numbers"));
  EXPECT_THAT(error("[0, 0, 1]", "[0, 0, 1e400]"), HasSubstr("JSON"));
  EXPECT_THAT(error("\"type\": \"flat\"", "\"type\": \"dome\""), HasSubstr("distance_m"));
  EXPECT_THAT(error("\"type\": \"flat\"", "\"type\": \"cube\""), HasSubstr("cube"));
  EXPECT_THAT(error("\"default\": \"main\"", "\"default\": \"mian\""), HasSubstr("mian"));
  EXPECT_THAT(error("\"2\": \"tilted\"", "\"2\": \"x\""), HasSubstr("cameras.2 is 'x'"));
  EXPECT_THAT(error("\"2\": \"tilted\"", "\"two\": \"tilted\""), HasSubstr("two"));
  EXPECT_THAT(error("\"2\": \"tilted\"", "\"2\": 3"), HasSubstr("expected a text"));
  EXPECT_THAT(error("jpg\": \"none\"", "jpg\": \"nona\""), HasSubstr("nona"));
  EXPECT_THAT(error("\"tilted\": {", "\"main\": {"), HasSubstr("occurs twice"));
  EXPECT_THAT(error("\"tilted\": {", "\"none\": {"), HasSubstr("none"));
  EXPECT_THAT(error("{ \"version\"", "[ \"version\""), HasSubstr("JSON"));
}

TEST_F(HousingTest, RefusesToWriteWhatCannotBeRead) {
  Housing housing = read(kExample);
  housing.default_port = "gone";
  EXPECT_THAT(error_of([&] { write_housing(file_, housing); }), HasSubstr("gone"));
  housing = read(kExample);
  flat(housing.ports["main"]).thickness = -1;
  EXPECT_THAT(error_of([&] { write_housing(file_, housing); }), HasSubstr("thickness_m is -1"));
  housing = read(kExample);
  housing.images["\xFF.jpg"] = "none";
  EXPECT_THAT(error_of([&] { write_housing(file_, housing); }), HasSubstr(file_.string()));
}

TEST_F(HousingTest, StandsBesideTheScene) {
  EXPECT_EQ(housing_beside("/a/scene.mvs"), "/a/scene.housing.json");
  EXPECT_EQ(housing_beside("/a/b.c/scene"), "/a/b.c/scene.housing.json");
}

TEST_F(HousingTest, SurvivesWrongInput) {
  const auto reader = [](const fs::path& file) { read_housing(file); };
  // The last byte is a newline, which JSON does not need.
  test::expect_prefixes_refused(file_, kExample, reader, kExample.size() - 1);
  test::expect_damage_survived(file_, kExample, reader);
  test::expect_damage_survived(file_, kLake, reader);
  const std::string deep(100000, '[');
  EXPECT_THAT(error_of([&] { read(deep); }), HasSubstr("JSON"));
  EXPECT_THAT(error_of([&] { read(deep + std::string(100000, ']')); }),
              HasSubstr("lie inside one another"));
}

}  // namespace
}  // namespace axial::io
