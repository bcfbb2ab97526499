// SPDX-License-Identifier: GPL-3.0-or-later
#include "survey/black_border.h"

#include <opencv2/imgproc.hpp>

namespace axial::survey {

cv::Mat1b outside_black_border(const cv::Mat3b& image, int darkest, int margin) {
  constexpr std::uint8_t kDarkPixel = 1, kBorderPixel = 2;
  cv::Mat1b state;
  cv::inRange(image, cv::Scalar::all(0), cv::Scalar::all(darkest), state);
  state.setTo(kDarkPixel, state);
  bool any = false;
  const auto start = [&](int x, int y) {
    if (state(y, x) != kDarkPixel) return;
    cv::floodFill(state, {x, y}, kBorderPixel);
    any = true;
  };
  for (int x = 0; x < state.cols; ++x) start(x, 0), start(x, state.rows - 1);
  for (int y = 0; y < state.rows; ++y) start(0, y), start(state.cols - 1, y);
  if (!any) return {};
  cv::Mat1b usable;
  cv::compare(state, kBorderPixel, usable, cv::CMP_NE);
  const cv::Size window(2 * margin + 1, 2 * margin + 1);
  cv::erode(usable, usable, cv::getStructuringElement(cv::MORPH_RECT, window), {-1, -1}, 1,
            cv::BORDER_CONSTANT, cv::Scalar::all(255));
  return usable;
}

}  // namespace axial::survey
