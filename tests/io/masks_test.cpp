// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/images/masks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <set>

#include "io/images/image.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::HasSubstr;

class MasksTest : public test::FolderTest {
 protected:
  void SetUp() override { fs::create_directories(masks_); }

  fs::path touch(const fs::path& path) const {
    fs::create_directories(path.parent_path());
    std::ofstream(path) << path;
    return path;
  }

  fs::path image(const std::string& name) const { return folder_ / "images" / name; }

  std::vector<FoundMask> find(const std::vector<std::string>& names, const fs::path& folder) const {
    std::vector<MaskRequest> requests;
    for (const std::string& name : names) requests.push_back({image(name), {}});
    return find_masks(requests, folder);
  }

  fs::path masks_ = folder_ / "masks";
};

TEST_F(MasksTest, AllUsualNamesAreFoundInTheirOrder) {
  const std::vector<std::string> order{"a.mask.png", "a.jpg.png", "a_mask.png", "a.png"};
  // For every subset of candidates, the first one is used and the others are reported.
  for (unsigned subset = 0; subset < 16; ++subset)
    for (const bool beside : {false, true}) {
      fs::remove_all(masks_);
      fs::remove_all(folder_ / "images");
      fs::create_directories(masks_);
      touch(image("a.jpg"));
      std::vector<fs::path> expected;
      for (std::size_t i = 0; i < order.size(); ++i)
        if (subset >> i & 1) {
          const fs::path path = touch(beside ? image(order[i]) : masks_ / order[i]);
          if (!beside || i < 3) expected.push_back(path);  // beside a.jpg, a.png is a photograph
        }
      const FoundMask found = find({"a.jpg"}, beside ? fs::path() : masks_)[0];
      std::vector<fs::path> all = found.others;
      if (!found.path.empty()) all.insert(all.begin(), found.path);
      EXPECT_EQ(all, expected) << subset << " " << beside;
      for (std::size_t i = 0; i < (beside ? 3u : 4u); ++i)
        EXPECT_THAT(found.looked_for, HasSubstr(order[i]));
      EXPECT_THAT(found.looked_for, HasSubstr((beside ? folder_ / "images" : masks_).string()));
    }
}

// Random trees of images and masks. An image gets the mask whose path, without suffix, is the
// longest end of the image's path that is an end of no other image's path.
TEST_F(MasksTest, GoByTheLongestEndThatIsTheImagesOwn) {
  std::mt19937 random(7);
  for (int round = 0; round < 60; ++round) {
    fs::remove_all(masks_);
    fs::create_directories(masks_);
    std::set<std::string> images;
    while (images.size() < 5) {
      std::string name;
      for (auto depth = random() % 3; depth > 0; --depth)
        name += std::string("cam") + std::to_string(random() % 2) + "/";
      images.insert(name + std::to_string(random() % 3) + ".jpg");
    }
    const std::vector<std::string> names(images.begin(), images.end());
    std::set<std::string> there;  // path ends without extension
    for (const std::string& name : names) {
      std::string end = name.substr(0, name.size() - 4);
      for (auto cut = random() % 3; cut > 0 && end.find('/') != std::string::npos; --cut)
        end = end.substr(end.find('/') + 1);
      if (random() % 4) there.insert(end);
    }
    for (const std::string& end : there) touch(masks_ / (end + ".mask.png"));
    const auto has_end = [](const std::string& path, const std::string& end) {
      return ("/" + path).ends_with("/" + end + ".jpg");
    };
    const auto found = find(names, masks_);
    for (std::size_t i = 0; i < names.size(); ++i) {
      std::string expected;
      for (const std::string& end : there) {
        const auto owners = std::ranges::count_if(
            names, [&](const std::string& name) { return has_end(name, end); });
        if (has_end(names[i], end) && owners == 1 && end.size() >= expected.size()) expected = end;
      }
      EXPECT_EQ(found[i].path, expected.empty() ? fs::path() : masks_ / (expected + ".mask.png"))
          << names[i];
    }
  }
}

TEST_F(MasksTest, TellWhyABaseNameIsNotTaken) {
  touch(masks_ / "0001.mask.png");
  const auto found = find({"cam0/0001.jpg", "cam1/0001.jpg"}, masks_);
  EXPECT_TRUE(found[0].path.empty());
  EXPECT_EQ(found[0].looked_for, "0001.mask.png, 0001.jpg.png, 0001_mask.png and 0001.png in " +
                                     (masks_ / "cam0").string() + " (not in " + masks_.string() +
                                     ", because several images have the name 0001 there)");
}

TEST_F(MasksTest, ImagesAreNoMasks) {
  const fs::path named = touch(image("a.jpg.png"));
  touch(image("a.png"));
  EXPECT_TRUE(find({"a.jpg", "a.jpg.png"}, {})[0].path.empty());
  EXPECT_TRUE(find({"a.png"}, folder_ / "images")[0].path.empty());
  EXPECT_EQ(find({"a.jpg"}, {})[0].path, named);
}

TEST_F(MasksTest, AreNotSharedUnlessTheSceneSaysSo) {
  const fs::path shared = touch(image("a.mask.png"));
  const std::string message = error_of([&] { find({"a.jpg", "a.tif"}, {}); });
  for (const char* part : {"a.mask.png: ", "a.jpg", "a.tif", "a.jpg.png"})
    EXPECT_THAT(message, HasSubstr(part));
  const auto own = touch(image("a.jpg.png"));
  fs::remove(shared);
  EXPECT_EQ(find({"a.jpg", "a.tif"}, {})[0].path, own);
  const std::vector<MaskRequest> named{{image("b.jpg"), own}, {image("c.jpg"), own}};
  EXPECT_EQ(find_masks(named)[1].path, own);
}

TEST_F(MasksTest, ThatOfTheSceneGoesBeforeThatBesideTheImage) {
  const fs::path named = touch(folder_ / "elsewhere" / "m.png"),
                 beside = touch(image("a.mask.png"));
  const std::vector<MaskRequest> requests{{image("a.jpg"), named}};
  EXPECT_EQ(find_masks(requests)[0].path, named);
  EXPECT_EQ(find_masks(requests)[0].others, std::vector<fs::path>{beside});
  fs::remove(named);
  EXPECT_EQ(find_masks(requests)[0].path, beside);
  EXPECT_THAT(find_masks(requests)[0].looked_for, HasSubstr(named.string()));
}

TEST_F(MasksTest, IgnoredMasksAreThoseWithOtherLabels) {
  cv::Mat1b labels(4, 6, uchar{3});
  fs::create_directories(folder_ / "images");
  write_png(image("a.mask.png"), labels);
  cv::Mat wide;
  labels.convertTo(wide, CV_16U);
  write_png(image("a.jpg.png"), wide);  // the same labels in other bytes
  EXPECT_EQ(ignored_masks(find({"a.jpg"}, {})).count, 0u);
  labels(1, 1) = 4;
  write_png(image("a_mask.png"), labels);
  const IgnoredMasks ignored = ignored_masks(find({"a.jpg", "b.jpg"}, {}));
  EXPECT_EQ(ignored.count, 1u);
  EXPECT_EQ(ignored.used, image("a.mask.png"));
  EXPECT_EQ(ignored.other, image("a_mask.png"));
}

TEST_F(MasksTest, TheFolderMustExist) {
  EXPECT_THAT(error_of([&] { find({"a.jpg"}, folder_ / "no"); }), HasSubstr("no: is not a folder"));
}

}  // namespace
}  // namespace axial::io
