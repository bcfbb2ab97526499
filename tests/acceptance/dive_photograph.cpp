// SPDX-License-Identifier: GPL-3.0-or-later
// Changes a photograph as divers do. Usage:
//
//     dive_photograph CHANGE VALUE PHOTOGRAPH OUTPUT.png
//
// CHANGE is one of
//   blur   a Gaussian blur with the standard deviation VALUE [px]
//   dark   all values times VALUE
//   size   both sides times VALUE
//   turn   VALUE quarter turns clockwise
//   arm    draws what moves with the camera, as the arm of a strobe: a band from the lower left
//   corner
//          towards the middle, covered by blocks of random grey, the same in every photograph. It
//          takes about 10 % of the pixels. VALUE has no meaning.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string_view>

#include "base/error.h"
#include "check_program.h"
#include "io/images/image.h"

namespace {

using namespace axial;

double number_of(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= 0))
    fail("VALUE {}: must be a number, 0 or more", text);
  return value;
}

// A random number of a block: the finaliser of splitmix64.
std::uint64_t random_of(int x, int y) {
  std::uint64_t z = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u +
                    static_cast<std::uint64_t>(y) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

void draw_arm(cv::Mat3b& image) {
  const int block = std::max(2, image.cols / 200);  // [px]
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) {
      const double along = static_cast<double>(x) / image.cols;            // 0 at the left
      const double up = static_cast<double>(image.rows - y) / image.rows;  // 0 at the bottom
      if (along + up < 0.85 && std::abs(along - up) < 0.12)
        image(y, x) =
            cv::Vec3b::all(static_cast<std::uint8_t>(random_of(x / block, y / block) % 256));
    }
}

cv::Mat3b changed(const cv::Mat3b& image, std::string_view change, double value) {
  cv::Mat3b result = image.clone();
  if (change == "blur") {
    cv::GaussianBlur(image, result, {}, value);
  } else if (change == "dark") {
    image.convertTo(result, -1, value);
  } else if (change == "size") {
    cv::resize(image, result, {}, value, value, value < 1 ? cv::INTER_AREA : cv::INTER_CUBIC);
  } else if (change == "turn") {
    for (int i = 0; i < static_cast<int>(value); ++i) {
      cv::rotate(result, result, cv::ROTATE_90_CLOCKWISE);
    }
  } else if (change == "arm") {
    draw_arm(result);
  } else {
    fail("CHANGE {}: must be blur, dark, size, turn or arm", change);
  }
  return result;
}

int run(int, char** argv) {
  io::write_png(argv[4], changed(io::read_color_image(argv[3]), argv[1], number_of(argv[2])));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return axial::check_program(argc, argv, 4, 4,
                              "dive_photograph CHANGE VALUE PHOTOGRAPH OUTPUT.png", run);
}
