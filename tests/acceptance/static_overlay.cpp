// SPDX-License-Identifier: GPL-3.0-or-later
// Draws what moves with the camera, as the arm of a strobe, over a photograph. Usage:
//
//     static_overlay PHOTOGRAPH OUTPUT.png
//
// The arm is a band from the lower left corner towards the middle. It is covered by blocks of
// random grey, the same in every photograph, and takes about 10 % of the pixels.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <opencv2/core.hpp>

#include "base/error.h"
#include "io/images/image.h"

namespace {

using namespace axial;

// A random number of a block: the finaliser of splitmix64.
std::uint64_t random_of(int x, int y) {
  std::uint64_t z = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u +
                    static_cast<std::uint64_t>(y) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

bool is_on_arm(int x, int y, const cv::Size& size) {
  const double along = static_cast<double>(x) / size.width;              // 0 at the left
  const double up = static_cast<double>(size.height - y) / size.height;  // 0 at the bottom
  return along + up < 0.85 && std::abs(along - up) < 0.12;
}

int run(const char* input, const char* output) {
  cv::Mat3b image = io::read_color_image(input);
  const int block = std::max(2, image.cols / 200);  // [px]
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      if (is_on_arm(x, y, image.size()))
        image(y, x) =
            cv::Vec3b::all(static_cast<std::uint8_t>(random_of(x / block, y / block) % 256));
  io::write_png(output, image);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: static_overlay PHOTOGRAPH OUTPUT.png\n";
    return 1;
  }
  try {
    return run(argv[1], argv[2]);
  } catch (const Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
