// SPDX-License-Identifier: GPL-3.0-or-later
#include "picture/svg.h"

#include <fmt/format.h>

#include <vector>

#include "base/base64.h"
#include "io/images/image.h"

namespace axial::picture {
namespace {

constexpr std::string_view kStyle = R"(
text { font: 12px system-ui, sans-serif; fill: #333 }
.title { font-size: 14px; font-weight: 600 } .small { font-size: 11px }
.grid { stroke: #e3e3e3 } .axis { stroke: #888 }
image { image-rendering: pixelated }
)";

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else
      result += c;
  }
  return result;
}

const char* name(Anchor anchor) {
  return anchor == Anchor::kStart ? "start" : anchor == Anchor::kMiddle ? "middle" : "end";
}

}  // namespace

std::string png_in_base64(const cv::Mat3b& bgr) {
  const std::vector<unsigned char> png = io::png_bytes(bgr, "picture");
  return base64({reinterpret_cast<const char*>(png.data()), png.size()});
}

Svg::Svg(double width, double height) : width_(width), height_(height) {}

void Svg::text(double x, double y, std::string_view content, Anchor anchor, std::string_view kind) {
  body_ +=
      fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" class=\"{}\">{}</text>\n", x,
                  y, name(anchor), kind, escaped(content));
}

void Svg::upright_text(double x, double y, std::string_view content) {
  body_ += fmt::format(
      "<text text-anchor=\"middle\" transform=\"translate({:.1f} {:.1f}) rotate(-90)\">{}</text>\n",
      x, y, escaped(content));
}

void Svg::line(double x1, double y1, double x2, double y2, std::string_view kind) {
  body_ +=
      fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" class=\"{}\"/>\n",
                  x1, y1, x2, y2, kind);
}

void Svg::polyline(const std::vector<cv::Point2d>& points, std::string_view color) {
  body_ += "<polyline points=\"";
  for (const cv::Point2d& p : points) body_ += fmt::format("{:.1f},{:.1f} ", p.x, p.y);
  body_ += fmt::format("\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"/>\n", color);
}

void Svg::circle(double x, double y, std::string_view color, std::string_view tip) {
  body_ += fmt::format(
      "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"><title>{}</title></circle>\n", x, y,
      color, escaped(tip));
}

void Svg::box(const Rectangle& r, std::string_view color) {
  body_ += fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n", r.x,
      r.y, r.width, r.height, color);
}

void Svg::picture(const Rectangle& r, const cv::Mat3b& bgr) {
  picture(r, png_in_base64(bgr));
}

void Svg::picture(const Rectangle& r, std::string_view png_in_base64) {
  body_ += fmt::format(
      "<image x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
      "preserveAspectRatio=\"none\" href=\"data:image/png;base64,{}\"/>\n",
      r.x, r.y, r.width, r.height, png_in_base64);
}

std::string Svg::str() const {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" "
      "height=\"{1:g}\">\n<style>{2}</style>\n<rect width=\"{0:g}\" height=\"{1:g}\" "
      "fill=\"#fff\"/>\n{3}</svg>\n",
      width_, height_, kStyle, body_);
}

}  // namespace axial::picture
