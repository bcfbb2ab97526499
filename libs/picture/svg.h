// SPDX-License-Identifier: GPL-3.0-or-later
// A drawing as an SVG text that refers to no other file.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace axial::picture {

struct Rectangle {
  double x, y, width, height;
};

enum class Anchor { kStart, kMiddle, kEnd };

// Encodes an image (B G R) as a PNG file and returns the file as base64 text, for SVG and JSON.
std::string png_in_base64(const cv::Mat3b& bgr);

class Svg {
 public:
  Svg(double width, double height);

  // `kind` is a class of the style sheet: "title", "small", "grid" or "axis".
  void text(double x, double y, std::string_view content, Anchor anchor = Anchor::kStart,
            std::string_view kind = "");
  void upright_text(double x, double y, std::string_view content);  // runs upwards, centred
  void line(double x1, double y1, double x2, double y2, std::string_view kind);
  void polyline(const std::vector<cv::Point2d>& points, std::string_view color);
  void circle(double x, double y, std::string_view color, std::string_view tip);
  void box(const Rectangle& where, std::string_view color);
  // Draw an image, stretched to fill the rectangle.
  void picture(const Rectangle& where, const cv::Mat3b& bgr);
  void picture(const Rectangle& where, std::string_view png_in_base64);

  std::string str() const;

 private:
  double width_, height_;
  std::string body_;
};

}  // namespace axial::picture
