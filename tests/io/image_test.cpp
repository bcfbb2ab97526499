// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/images/image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/atomic_file.h"
#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::HasSubstr;

class ImageTest : public test::FolderTest {
 protected:
};

// A smooth gradient of 37x23 pixels, which JPEG hardly changes.
cv::Mat3b picture() {
  cv::Mat3b image(23, 37);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      image(y, x) = {static_cast<uchar>(6 * x), static_cast<uchar>(10 * y),
                     static_cast<uchar>(3 * (x + y))};
  return image;
}

template <class A, class B>
double max_difference(const A& a, const B& b) {
  return cv::norm(cv::Mat(a), cv::Mat(b), cv::NORM_INF);
}

TEST_F(ImageTest, ReadsBackWhatItWrites) {
  write_png(folder_ / "a.png", picture());
  EXPECT_EQ(max_difference(read_color_image(folder_ / "a.png"), picture()), 0);
  write_jpeg(folder_ / "a.jpg", picture(), 95);
  // JPEG stores chroma at half the resolution.
  EXPECT_LT(max_difference(read_color_image(folder_ / "a.jpg"), picture()), 16);
  EXPECT_EQ(read_image_size(folder_ / "a.png"), cv::Size(37, 23));
  EXPECT_EQ(read_image_size(folder_ / "a.jpg"), cv::Size(37, 23));
}

TEST_F(ImageTest, GoesByContentsNotByName) {
  write_png(folder_ / "a.jpg", picture());
  EXPECT_EQ(max_difference(read_color_image(folder_ / "a.jpg"), picture()), 0);
}

// Inserts an Exif segment with "rotate by 90 degrees" after the start-of-image marker.
TEST_F(ImageTest, IgnoresExifRotation) {
  write_jpeg(folder_ / "a.jpg", picture(), 95);
  const std::string bytes = read_file(folder_ / "a.jpg");
  using namespace std::string_literals;
  const std::string exif =
      "\xFF\xE1\x00\x22"s +
      "Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0"s;
  ASSERT_EQ(exif.size(), 36u);
  test::put(folder_ / "b.jpg", bytes.substr(0, 2) + exif + bytes.substr(2));
  EXPECT_EQ(read_color_image(folder_ / "b.jpg").size(), cv::Size(37, 23));
  EXPECT_EQ(read_image_size(folder_ / "b.jpg"), cv::Size(37, 23));
  EXPECT_EQ(
      max_difference(read_color_image(folder_ / "b.jpg"), read_color_image(folder_ / "a.jpg")), 0);
}

TEST_F(ImageTest, KeepsFloats) {
  cv::Mat1f one(5, 7);
  cv::Mat3f three(5, 7);
  cv::randu(one, -3, 3);
  cv::randu(three, -3, 3);
  one(2, 3) = 0;
  one(1, 1) = std::numeric_limits<float>::denorm_min();
  write_float_tiff(folder_ / "one.tiff", one);
  write_float_tiff(folder_ / "three.tiff", three);
  EXPECT_EQ(max_difference(read_float_tiff(folder_ / "one.tiff"), one), 0);
  cv::Mat read = cv::imread(folder_ / "three.tiff", cv::IMREAD_UNCHANGED);
  cv::cvtColor(read, read, cv::COLOR_BGR2RGB);  // OpenCV reverses the channels of the file
  EXPECT_EQ(max_difference(read, three), 0);
  write_float_tiff(folder_ / "order.tiff", cv::Mat3f(1, 1, cv::Vec3f(1.25f, 2.5f, 3.75f)));
  const std::string pixel("\0\0\xA0\x3F\0\0\x20\x40\0\0\x70\x40", 12);
  EXPECT_THAT(read_file(folder_ / "order.tiff"), HasSubstr(pixel));
  EXPECT_THAT(error_of([&] { read_float_tiff(folder_ / "three.tiff"); }), HasSubstr("3 channels"));
  EXPECT_THAT(error_of([&] { write_float_tiff(folder_ / "x.tiff", picture()); }),
              HasSubstr("only float"));
  EXPECT_THAT(error_of([&] { read_image_size(folder_ / "one.tiff"); }),
              HasSubstr("one.tiff: pixels are floating-point numbers of 32 bits"));
}

TEST_F(ImageTest, ReadsLabelsOfOneOrTwoBytes) {
  cv::Mat1b narrow(4, 6, uchar{0});
  narrow(1, 2) = 255;
  cv::Mat1w wide(4, 6, std::uint16_t{0});
  wide(3, 5) = 40000;
  write_png(folder_ / "narrow.png", narrow);
  write_png(folder_ / "wide.png", wide);
  write_png(folder_ / "color.png", picture());
  EXPECT_EQ(read_label_image(folder_ / "narrow.png")(1, 2), 255);
  EXPECT_EQ(read_label_image(folder_ / "wide.png")(3, 5), 40000);
  EXPECT_THAT(error_of([&] { read_label_image(folder_ / "color.png"); }), HasSubstr("label"));
}

TEST_F(ImageTest, RefusesMissingFilesAndFolders) {
  EXPECT_THAT(error_of([&] { read_color_image(folder_ / "no.jpg"); }), HasSubstr("no.jpg"));
  EXPECT_THAT(error_of([&] { read_image_size(folder_ / "no.jpg"); }), HasSubstr("no.jpg"));
  EXPECT_THAT(error_of([&] { read_color_image(folder_); }), HasSubstr("folder"));
  EXPECT_THAT(error_of([&] { write_png(folder_ / "no" / "a.png", picture()); }),
              HasSubstr("a.png"));
}

TEST_F(ImageTest, SurvivesWrongInput) {
  write_png(folder_ / "a.png", picture());
  write_jpeg(folder_ / "a.jpg", picture(), 80);
  write_float_tiff(folder_ / "a.tiff", cv::Mat1f(5, 7, 1.5f));
  const std::string png = read_file(folder_ / "a.png");
  const std::string jpeg = read_file(folder_ / "a.jpg");
  const std::string tiff = read_file(folder_ / "a.tiff");
  const auto color = [](const fs::path& file) { read_color_image(file); };
  const auto size = [](const fs::path& file) { read_image_size(file); };
  const auto floats = [](const fs::path& file) { read_float_tiff(file); };
  const fs::path file = folder_ / "wrong";
  test::expect_prefixes_refused(file, jpeg, color);
  test::expect_prefixes_refused(file, jpeg, size);
  test::expect_prefixes_refused(file, png, color);
  // The last four bytes state that no second image follows. The first image is complete without
  // them.
  test::expect_prefixes_refused(file, tiff, floats, tiff.size() - 4);
  test::expect_damage_survived(file, png, color);
  test::expect_damage_survived(file, tiff, floats);
}

}  // namespace
}  // namespace axial::io
