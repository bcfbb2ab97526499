// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/images/bit_depth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "base/program/program.h"
#include "io/images/image.h"
#include "support/captured_events.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// Random values of `bits` bits, including the largest.
cv::Mat3w picture(int bits, unsigned seed) {
  std::mt19937 random(seed);
  cv::Mat3w pixels(9, 13);
  for (cv::Vec3w& pixel : pixels)
    for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint16_t>(random() % (1u << bits));
  pixels(4, 4)[seed % 3] = static_cast<std::uint16_t>((1u << bits) - 1);
  return pixels;
}

TEST(BitDepth, TheSamePictureInAnyNumberOfBitsGivesTheSameEightBits) {
  for (int bits = 8; bits <= 16; ++bits) {
    const cv::Mat3w pixels = picture(bits, static_cast<unsigned>(bits));
    EXPECT_EQ(bits_used(pixels), bits);
    const cv::Mat3b narrow = in_8_bits(pixels, bits);
    for (int shift = 0; bits + shift <= 16; ++shift) {
      const cv::Mat3w shifted = cv::Mat(pixels * (1 << shift));
      EXPECT_EQ(cv::norm(in_8_bits(shifted, bits + shift), narrow, cv::NORM_INF), 0);
    }
    EXPECT_EQ(narrow(4, 4)[bits % 3], 255);
  }
  EXPECT_EQ(in_8_bits(picture(12, 1), 10)(4, 4)[1], 255) << "values above are the brightest";
}

TEST(BitDepth, IsFoundOverTheWholeSetAndStatedOnce) {
  const fs::path folder = test::empty_folder();
  for (int most = 8; most <= 16; ++most) {
    std::vector<fs::path> paths;
    for (int i = 0; i < 6; ++i) {
      paths.push_back(folder / fmt::format("{}.png", i));
      if (i == 5)
        write_png(paths.back(), cv::Mat3b(4, 4, cv::Vec3b(255, 255, 255)));
      else
        write_png(paths.back(), picture(i == most % 5 ? most : 8, static_cast<unsigned>(i)));
    }
    std::vector<ImageHeader> headers;
    for (const fs::path& path : paths) headers.push_back(read_image_header(path));
    test::CapturedEvents log;
    EXPECT_EQ(common_bit_depth(paths, headers, 0, log.context), most);
    EXPECT_EQ(log.lines,
              fmt::format("The values of 5 images of 16 bits use {} bits (see bit_depth)\n", most));
    EXPECT_EQ(common_bit_depth(paths, headers, 14, log.context), 14);
  }
  fs::remove_all(folder);
}

TEST(BitDepth, EightBitFilesAreNotRead) {
  const std::vector<fs::path> nowhere{"/no/such/file.png"};
  const std::vector<ImageHeader> headers{{{10, 10}, 8, false, 4}};
  test::CapturedEvents log;
  EXPECT_EQ(common_bit_depth(nowhere, headers, 0, log.context), 16);
  EXPECT_EQ(log.lines, "");
  common_bit_depth(nowhere, headers, 12, log.context);
  EXPECT_THAT(log.lines, HasSubstr("bit_depth 12: is not used"));
}

int parsed_bit_depth(int value) {
  int bit_depth = 0;
  ProgramOptions program;
  program.name = "Test";
  declare_bit_depth(program.visible, bit_depth);
  const std::string word = fmt::format("--bit-depth={}", value);
  const char* const arguments[] = {"Test", word.c_str()};
  parse_options(2, arguments, program);
  return bit_depth;
}

TEST(BitDepth, OptionIsChecked) {
  for (const int wrong : {-1, 7, 17})
    EXPECT_THAT(test::error_of([&] { parsed_bit_depth(wrong); }),
                testing::StartsWith(fmt::format("--bit-depth {}: ", wrong)));
  for (const int right : {0, 8, 16}) EXPECT_EQ(parsed_bit_depth(right), right);
}

}  // namespace
}  // namespace axial::io
