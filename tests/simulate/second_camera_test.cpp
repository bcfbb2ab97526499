// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/second_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/error_of.h"

namespace axial::simulate {
namespace {

using testing::HasSubstr;

class TwoCameras : public testing::Test {
 protected:
  Preset preset_ = make_preset({.name = "reef", .views = 6, .coarseness = 8});
};

TEST_F(TwoCameras, TheSecondIsToTheRightAndBehindItsOwnPort) {
  const Port first = preset_.port;
  add_second_camera(preset_, {.base = 0.3, .port_distance = 0.05});
  ASSERT_EQ(preset_.views.size(), 12u);
  for (std::size_t i = 0; i < 6; ++i) {
    const View &left = preset_.views[i], &right = preset_.views[i + 6];
    EXPECT_LT((left.rotation * (right.centre - left.centre) - Eigen::Vector3d(0.3, 0, 0)).norm(),
              1e-12);
    EXPECT_EQ(left.rotation, right.rotation);
    EXPECT_EQ(port_of_view(preset_, left).distance, first.distance);
    EXPECT_EQ(port_of_view(preset_, right).distance, 0.05);
    EXPECT_EQ(port_of_view(preset_, right).thickness, first.thickness);
  }
}

TEST_F(TwoCameras, ALateCameraIsFartherAlongTheTrack) {
  Preset at_once = preset_;
  add_second_camera(at_once, {.base = 0.3});
  add_second_camera(preset_, {.base = 0.3, .delay = 0.1});
  for (std::size_t i = 0; i < 6; ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1, after = i == 5 ? 5 : i + 1;
    const Eigen::Vector3d step = (preset_.views[after].centre - preset_.views[before].centre) /
                                 static_cast<double>(after - before);
    EXPECT_LT((preset_.views[i + 6].centre - at_once.views[i + 6].centre - 0.1 * step).norm(),
              1e-12);
  }
}

TEST_F(TwoCameras, OtherPortsAndSingleViewsAreRefused) {
  const auto refusal = [](Preset preset) {
    return test::error_of([&] { add_second_camera(preset, {}); });
  };
  Preset surface = preset_, dome = preset_, single = preset_;
  surface.water_level = 1;
  dome.port.dome = Dome{{0, 0, 0}, 0.06};
  single.views.resize(1);
  EXPECT_THAT(refusal(surface), HasSubstr("water surface"));
  EXPECT_THAT(refusal(dome), HasSubstr("dome"));
  EXPECT_THAT(refusal(single), HasSubstr("at least two views"));
}

}  // namespace
}  // namespace axial::simulate
