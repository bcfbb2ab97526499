// SPDX-License-Identifier: GPL-3.0-or-later
// A drawing as an SVG text that refers to no other file. Coordinates are user units of the SVG
// (pixels at its own size): x to the right, y down, origin at the upper left corner.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace axial::picture {

struct Rectangle {
  double x, y, width, height;  // (x, y): the upper left corner
};

// The part of a text that is at its position x: the left end, the middle or the right end.
enum class Anchor { kStart, kMiddle, kEnd };

// Encodes an image (B G R, not empty) as a PNG file and returns the bytes of the file as base64
// text, for SVG and JSON.
std::string png_in_base64(const cv::Mat3b& bgr);

// Collects the elements of a drawing. Later elements are drawn over earlier ones. A colour is a CSS
// colour such as "steelblue" or "rgb(31, 119, 180)". Colours and kinds must contain no quotes.
// Texts and tips may contain any characters, which are escaped.
class Svg {
 public:
  // A white drawing of this size.
  Svg(double width, double height);

  // Draws one line of text. (x, y) is on its base line (see Anchor). `kind` of texts is "title"
  // (larger and bold), "small" or "" (normal).
  void text(double x, double y, std::string_view content, Anchor anchor = Anchor::kStart,
            std::string_view kind = "");
  // Draws a text that runs upwards, with its middle at (x, y).
  void upright_text(double x, double y, std::string_view content);
  // Draws a line. `kind` is "grid" (light) or "axis" (darker).
  void line(double x1, double y1, double x2, double y2, std::string_view kind);
  // Draws an open line through `points`, 1.5 units wide.
  void polyline(const std::vector<cv::Point2d>& points, std::string_view color);
  // Draws a filled circle of radius 3 around (x, y). `tip` is shown under the mouse.
  void circle(double x, double y, std::string_view color, std::string_view tip);
  // Draws a filled rectangle without a border.
  void box(const Rectangle& where, std::string_view color);
  // Draw an image, stretched to fill the rectangle, without smoothing between pixels. The
  // image is B G R, or the result of png_in_base64().
  void picture(const Rectangle& where, const cv::Mat3b& bgr);
  void picture(const Rectangle& where, std::string_view png_in_base64);

  // The whole SVG document.
  std::string str() const;

 private:
  double width_, height_;
  std::string body_;
};

}  // namespace axial::picture
