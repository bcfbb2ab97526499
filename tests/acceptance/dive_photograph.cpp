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
#include <charconv>
#include <iostream>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string_view>

#include "base/error.h"
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
  } else {
    fail("CHANGE {}: must be blur, dark, size or turn", change);
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr << "usage: dive_photograph CHANGE VALUE PHOTOGRAPH OUTPUT.png\n";
    return 1;
  }
  try {
    io::write_png(argv[4], changed(io::read_color_image(argv[3]), argv[1], number_of(argv[2])));
  } catch (const Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
