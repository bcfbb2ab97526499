// SPDX-License-Identifier: GPL-3.0-or-later
// Photographs, masks and TIFFs of floats.
#include <array>
#include <cstdint>
#include <opencv2/imgcodecs.hpp>

#include "images/private/image_codecs.h"
#include "io/images/image.h"
#include "reader.h"

namespace axial::fuzz {
namespace {

// True if the reader decodes the format itself. Other formats are decoded as a whole by OpenCV's
// libraries, with the memory that a header of a few bytes declares.
bool is_decoded_by_us(const fs::path& file) {
  const std::string bytes = read_file(file);
  return io::is_jpeg(bytes) || io::is_png(bytes) || io::is_tiff(bytes);
}

// A photograph needs memory for its pixels, and a small file may declare many pixels.
bool is_large(cv::Size size) {
  return std::int64_t{size.width} * size.height > 1'000'000;
}

void read_photograph_file(const fs::path& file) {
  if (!is_decoded_by_us(file)) return;
  const io::ImageHeader header = io::read_image_header(file);
  if (is_large(header.size)) return;
  const io::Photograph photograph = io::read_photograph(file);
  require(photograph.pixels.size() == header.size, "the header has another size than the pixels");
  io::in_8_bits(photograph.pixels, header.bits);
}

void read_label_file(const fs::path& file) {
  if (is_decoded_by_us(file) && !is_large(io::read_image_size(file))) io::read_label_image(file);
}

void read_float_file(const fs::path& file) {
  io::read_float_tiff(file);
}

cv::Mat3b picture() {
  cv::Mat3b pixels(6, 8);
  for (int v = 0; v < 6; ++v)
    for (int u = 0; u < 8; ++u)
      pixels(v, u) =
          cv::Vec3b(cv::saturate_cast<uchar>(40 * v), 99, cv::saturate_cast<uchar>(30 * u));
  return pixels;
}

bool write_photograph_seed(const fs::path& file, int variant) {
  const fs::path folder = file.parent_path();
  const cv::Mat3b pixels = picture();
  cv::Mat3w deep;
  pixels.convertTo(deep, CV_16U, 257);
  const auto stored = [&](const char* name) { return folder / name; };
  if (variant == 0) io::write_jpeg(stored("a.jpg"), pixels, 90);
  if (variant == 1) io::write_png(stored("a.png"), pixels);
  if (variant == 2) io::write_png(stored("a.png"), deep);
  if (variant == 3) cv::imwrite(stored("a.tif"), pixels);
  if (variant == 4) cv::imwrite(stored("a.tif"), deep, {cv::IMWRITE_TIFF_COMPRESSION, 1});
  if (variant > 4) return false;
  fs::rename(stored(variant == 0 ? "a.jpg" : variant < 3 ? "a.png" : "a.tif"), file);
  return true;
}

bool write_label_seed(const fs::path& file, int variant) {
  const fs::path png = file.parent_path() / "a.png";
  if (variant == 0) io::write_png(png, cv::Mat1b(6, 8, uchar{3}));
  if (variant == 1) io::write_png(png, cv::Mat1w(6, 8, ushort{300}));
  if (variant > 1) return false;
  fs::rename(png, file);
  return true;
}

bool write_float_seed(const fs::path& file, int variant) {
  const fs::path tiff = file.parent_path() / "a.tif";
  if (variant == 0) io::write_float_tiff(tiff, cv::Mat1f(6, 8, 1.5f));
  if (variant == 1) io::write_float_tiff(tiff, cv::Mat3f(6, 8, cv::Vec3f(1, 2, 3)));
  if (variant > 1) return false;
  fs::rename(tiff, file);
  return true;
}

}  // namespace

std::span<const Reader> image_readers() {
  static constexpr std::array kReaders{
      Reader{"photograph", "image", read_photograph_file, write_photograph_seed},
      Reader{"label-image", "image", read_label_file, write_label_seed},
      Reader{"float-tiff", "image", read_float_file, write_float_seed}};
  return kReaders;
}

}  // namespace axial::fuzz
