// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/images/photograph_size.h"

#include <gmock/gmock.h>

#include <vector>

#include "support/captured_events.h"
#include "support/error_of.h"

namespace axial::io {
namespace {

using test::error_of;
using testing::HasSubstr;

PhotographSize photograph(const char* file, cv::Size stored) {
  return {file, stored, {1600, 1200}};
}

std::string log_of(const std::vector<PhotographSize>& photographs) {
  test::CapturedEvents log;
  check_photograph_sizes(photographs, log.context);
  return log.lines;
}

std::string error_for(cv::Size stored) {
  return error_of([&] {
    check_photograph_sizes(
        std::vector{photograph("a.jpg", {1600, 1200}), photograph("b.jpg", stored)}, {});
  });
}

TEST(PhotographSize, OfTheCameraRaisesNoAlarm) {
  EXPECT_EQ(log_of({}), "");
  EXPECT_EQ(log_of({photograph("a.jpg", {1600, 1200})}), "");
  EXPECT_EQ(log_of({photograph("a.jpg", {3200, 2400})}), "");
  EXPECT_EQ(log_of({photograph("a.jpg", {1440, 1080})}), "");  // 0.9 of the camera's
}

TEST(PhotographSize, SmallerPhotographsAreOneWarning) {
  const std::string text =
      log_of({photograph("a.jpg", {1600, 1200}), photograph("b.jpg", {1400, 1050}),
              photograph("c.jpg", {800, 600}), photograph("d.jpg", {200, 150})});
  EXPECT_THAT(text, HasSubstr("b.jpg: is 1400x1050, but its camera is 1600x1200: 3 of 4 "
                              "photographs are smaller than their cameras"));
  EXPECT_EQ(text.find("c.jpg"), std::string::npos);
}

TEST(PhotographSize, PreviewsAndOtherShapesAreErrors) {
  EXPECT_THAT(error_for({196, 147}), HasSubstr("b.jpg: is 196x147, too small for its camera"));
  EXPECT_THAT(error_for({1, 1}), HasSubstr("b.jpg: is 1x1, too small for its camera"));
  EXPECT_THAT(error_for({0, 0}), HasSubstr("b.jpg: is 0x0, too small"));
  EXPECT_THAT(error_for({1600, 900}), HasSubstr("b.jpg: is 1600x900, but its camera is 1600x1200"));
  EXPECT_THAT(error_for({1200, 1600}), HasSubstr("b.jpg: is 1200x1600, but its camera is"));
}

}  // namespace
}  // namespace axial::io
