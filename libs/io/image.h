// SPDX-License-Identifier: GPL-3.0-or-later
// Image files, by their contents and not by their names. Pixels are those that are stored, in their
// order: no orientation, of EXIF or TIFF, turns them. Every file that is missing, truncated,
// damaged or of a format that is not supported is an Error of one line, and no library prints lines
// of its own.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>

namespace axial::io {

struct ImageHeader {
  cv::Size size;
  int bits = 8;        // of a stored value, in whole bytes: 8 or 16
  bool alpha = false;  // there may be transparent pixels
  unsigned decode_bytes =
      4;  // for a pixel, while the file is read: the file, the library, the result
};

struct Photograph {
  cv::Mat pixels;    // B G R, CV_8UC3 or CV_16UC3
  cv::Mat1b opaque;  // empty: everywhere; else 0 where a pixel is fully transparent
};

// A photograph of 8 or 16 bits; its grey is colour, too. Error for floating-point or signed pixels.
Photograph read_photograph(const std::filesystem::path& path);

// What read_photograph will give, from the file's header alone where the format has one.
ImageHeader read_image_header(const std::filesystem::path& path);
cv::Size read_image_size(const std::filesystem::path& path);

// The bits that the largest value of a photograph needs: 8 to 16. Cameras of 10, 12 or 14 bits
// store them in 16.
int bits_used(const cv::Mat& pixels);

// A photograph's pixels in 8 bits, the upper ones of `bits` (8 to 16); larger values become 255.
// Pixels of 8 bits stay as they are.
cv::Mat3b in_8_bits(const cv::Mat& pixels, int bits);

// A photograph in 8 bits: of 16 the upper ones.
cv::Mat3b read_color_image(const std::filesystem::path& path);

// A label image of 8 or 16 bit, as 16 bit: one channel, or three that are the same, alpha aside. Of
// a PNG with a palette its indices.
cv::Mat1w read_label_image(const std::filesystem::path& path);

// Error if a mask of `size` is no resized version of its image.
void check_mask_shape(const std::filesystem::path& mask, cv::Size size, cv::Size image);

// Float TIFFs (ground truth), exact: one channel or three, the file's channels in our order.
cv::Mat1f read_float_tiff(const std::filesystem::path& path);
cv::Mat3f read_float3_tiff(const std::filesystem::path& path);
void write_float_tiff(const std::filesystem::path& path, const cv::Mat& image);

void write_jpeg(const std::filesystem::path& path, const cv::Mat3b& image, int quality);
void write_png(const std::filesystem::path& path, const cv::Mat& image);

}  // namespace axial::io
