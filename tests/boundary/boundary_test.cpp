// SPDX-License-Identifier: GPL-3.0-or-later
#include "boundary/boundary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "axial/map.h"
#include "base/atomic_file.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::boundary {
namespace {

using testing::HasSubstr;

class BoundaryFiles : public axial::test::FolderTest {
 protected:
  // Four targets at the corners of a square of 2 m about (500010, 2500020), as RefinePoses writes
  // them; nothing determines target 5.
  void write_places() const {
    std::string covariance;
    for (int i = 0; i < 15; ++i) {
      covariance += i ? ",[" : "[";
      for (int j = 0; j < 15; ++j)
        covariance += std::string(j ? "," : "") + (i != j ? "0" : i < 12 ? "1e-6" : "null");
      covariance += "]";
    }
    write("target_places.json", R"({"targets": [)" + target(1, 500009, 2500019) + "," +
                                    target(2, 500011, 2500019) + "," + target(3, 500011, 2500021) +
                                    "," + target(4, 500009, 2500021) + "," + target(5, 0, 0) +
                                    R"(], "covariance_m2": [)" + covariance + "]}");
  }

  static std::string target(int number, int x, int y) {
    return R"({"label": "target )" + std::to_string(number) + R"(", "x": )" + std::to_string(x) +
           R"(, "y": )" + std::to_string(y) + R"(, "z": -7, "photographs": 3})";
  }

  void write(const std::string& name, const std::string& text) const {
    write_atomically(folder_ / name, text);
  }

  Boundary read(const Options& options, const LocalFrame& frame = {}) const {
    return read_boundary(options, {}, "", frame, folder_ / "mesh.ply");
  }

  std::string error(const Options& options) const {
    return axial::test::error_of([&] { read(options); });
  }

  static Options targets(std::vector<std::string> labels,
                         const std::filesystem::path& places = {}) {
    Options options;
    options.targets = std::move(labels);
    options.places = places;
    return options;
  }
};

TEST_F(BoundaryFiles, OfTargetsInTheFrameOfTheMesh) {
  write_places();
  const LocalFrame frame{{500000, 2500000, 0}};
  const Boundary boundary = read(targets({"1", "Target_02", "target 3", "4"}), frame);
  EXPECT_TRUE(boundary.contains(boundary.plan_of({9.1, 19.1, 100})));
  EXPECT_TRUE(boundary.contains(boundary.plan_of({10.9, 20.9, -100})));
  EXPECT_FALSE(boundary.contains(boundary.plan_of({8.9, 20, 0})));
  EXPECT_FALSE(boundary.contains(boundary.plan_of({10, 21.1, 0})));
  EXPECT_EQ(boundary.extent().min(), Eigen::Vector2d(500009, 2500019));
  EXPECT_EQ(boundary.extent().max(), Eigen::Vector2d(500011, 2500021));
}

TEST_F(BoundaryFiles, OfControlPoints) {
  write("control.csv", "label,x,y,z\n1,0,0,0\n2,2,0,0\n3,0,2,1\n");
  const Boundary boundary = read(targets({"1", "2", "3"}, folder_ / "control.csv"));
  EXPECT_TRUE(boundary.contains({0.5, 0.5}));
  EXPECT_FALSE(boundary.contains({1.5, 1.5}));
}

// The map's axes are those of the world turned by a quarter about z.
TEST_F(BoundaryFiles, OfAFileAreMeantOnTheMap) {
  write("plot.geojson", R"({"type": "Polygon", "coordinates": [[[1,5],[3,5],[3,6],[1,6],[1,5]]]})");
  map::WorldAxes axes;
  axes.axes << 0, 1, 0, -1, 0, 0, 0, 0, 1;  // map's x: the world's y; map's y: the world's -x
  Options options;
  options.file = folder_ / "plot.geojson";
  const Boundary boundary = read_boundary(options, axes, "", {{-5, 1, 0}}, "mesh.ply");
  EXPECT_TRUE(boundary.contains(boundary.plan_of({-0.5, 1, 0})));  // world (-5.5, 2): map (2, 5.5)
  EXPECT_FALSE(boundary.contains(boundary.plan_of({1, -0.5, 0})));
}

TEST_F(BoundaryFiles, WrongTargetsAreErrors) {
  EXPECT_THAT(error(targets({"1", "2", "3"})),
              HasSubstr("mesh.ply: no target_places.json in its folder or in refined/ there"));
  write_places();
  EXPECT_THAT(error(targets({"1", "2", "9"})), HasSubstr("target_places.json: has no target '9'"));
  EXPECT_THAT(error(targets({"1", "2", "5"})),
              HasSubstr("does not determine the place of the target '5'"));
  EXPECT_THAT(error(targets({"1", "2", "target 1"})), HasSubstr("which is a corner already"));
  EXPECT_THAT(error(targets({"1", "3", "2", "4"})),
              HasSubstr("1,3,2,4: the outline crosses itself at (500010.000, 2500020.000)"));
  EXPECT_THAT(error(targets({"1", "2", "3"}, folder_ / "none.csv")), HasSubstr("none.csv: "));
}

}  // namespace
}  // namespace axial::boundary
