// SPDX-License-Identifier: GPL-3.0-or-later
// --scale-from positions: of RefinePoses, for positions that determine no similarity.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../apps/RefinePoses/scale_from.h"
#include "base/atomic_file.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::pose {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// Longitude and latitude fit a line of cameras as well in either order.
TEST(StraightTransectInDegrees, IsReportedAsUnusedIfNoLineStatesTheOrder) {
  const fs::path folder = test::empty_folder();
  Bundle bundle;
  std::string text;
  for (int i = 0; i < 8; ++i) {
    BundleImage image;
    image.name = fmt::format("{}.jpg", i);
    image.pose.centre = {double(i), 0, 0};
    bundle.images.push_back(image);
    text += fmt::format("{} {:.6f} {:.6f} -5\n", image.name, 16.5 + 1e-4 * i, 54.25 + 5e-5 * i);
  }
  write_atomically(folder / "known.txt", text);
  AdjustOptions adjust;
  const auto add = [&](UnusedInput& unused) {
    return apps::add_known("positions:known.txt", {0.01, true}, folder, bundle, adjust, unused, {});
  };
  UnusedInput unused(false), allowed(true);
  EXPECT_THAT(test::error_of([&] { add(unused); }), HasSubstr("allow_missing"));
  EXPECT_THAT(add(allowed), IsEmpty());
  ASSERT_THAT(allowed.lines(), SizeIs(1));
  EXPECT_THAT(allowed.lines()[0], HasSubstr("known.txt: "));
  EXPECT_THAT(allowed.lines()[0], HasSubstr("label,longitude,latitude,altitude"));
  EXPECT_THAT(adjust.positions, IsEmpty());
  fs::remove_all(folder);
}

// Cameras on a line, and one beside it.
class OneOffTheLine : public ::testing::Test {
 protected:
  fs::path folder_ = test::empty_folder();
  Bundle bundle_;
  AdjustOptions adjust_;

  OneOffTheLine() {
    for (int i = 0; i < 8; ++i) {
      BundleImage image;
      image.name = fmt::format("{}.jpg", i);
      image.pose.centre = {double(i), i == 5 ? 1.0 : 0.0, 0.001 * (i % 3)};
      bundle_.images.push_back(image);
    }
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Adds positions of the cameras, of which the one beside the line is moved.
  std::vector<std::string> add(const Eigen::Vector3d& moved, UnusedInput& unused) {
    std::string text;
    for (std::size_t i = 0; i < bundle_.images.size(); ++i) {
      const Eigen::Vector3d place =
          2 * bundle_.images[i].pose.centre + (i == 5 ? moved : Eigen::Vector3d(0, 0, 0));
      text += fmt::format("{}.jpg {} {} {}\n", i, place.x(), place.y(), place.z());
    }
    write_atomically(folder_ / "known.txt", text);
    return apps::add_known("positions:known.txt", {0.01, true}, folder_, bundle_, adjust_, unused,
                           {});
  }
};

TEST_F(OneOffTheLine, CountsIfItFits) {
  UnusedInput unused(false);
  EXPECT_THAT(add({0, 0, 0}, unused), IsEmpty());
  EXPECT_THAT(adjust_.positions, SizeIs(8));
}

TEST_F(OneOffTheLine, IsNamedIfItDoesNotFit) {
  UnusedInput unused(false), allowed(true);
  EXPECT_THAT(test::error_of([&] {
                add({20, 30, 0}, unused);
              }),
              HasSubstr("known.txt: the position of 5.jpg does not fit the 7 others that are used, "
                        "and these lie on one line"));
  add({20, 30, 0}, allowed);
  EXPECT_THAT(adjust_.positions, IsEmpty());
  EXPECT_THAT(allowed.lines(), SizeIs(1));
}

}  // namespace
}  // namespace axial::pose
