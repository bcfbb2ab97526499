// SPDX-License-Identifier: GPL-3.0-or-later
// Image files. The format is recognised by the contents, not by the name. Pixels keep the order in
// which they are stored: orientation tags (EXIF, TIFF) are ignored. A file that is missing,
// truncated, damaged or of a format that is not supported gives an Error of one line. The image
// libraries print no messages of their own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>

namespace axial::io {

struct ImageHeader {
  cv::Size size;
  int bits = 8;        // of a stored value, rounded up to whole bytes: 8 or 16
  bool alpha = false;  // pixels may be transparent
  unsigned decode_bytes =
      4;  // memory per pixel while the file is decoded: file, library and result
};

struct Photograph {
  cv::Mat pixels;    // B G R, CV_8UC3 or CV_16UC3
  cv::Mat1b opaque;  // 0: the pixel is fully transparent; empty if no pixel is
};

// Reads a photograph of 8 or 16 bits. A grey image gives three equal channels. Error for
// floating-point or signed pixels.
Photograph read_photograph(const std::filesystem::path& path);

// Return the properties of the photograph that read_photograph will give. Only the header is read
// if the format has one; otherwise the whole image is decoded.
ImageHeader read_image_header(const std::filesystem::path& path);
cv::Size read_image_size(const std::filesystem::path& path);

// The memory [bytes] of read_photograph() for a file of this header, with its result.
std::uint64_t bytes_needed(const ImageHeader& header);

// The number of bits, 8 to 16, that the largest value in `pixels` needs. Cameras of 10, 12 or 14
// bits store their values in 16 bits.
int bits_used(const cv::Mat& pixels);

// Converts pixels to 8 bits by keeping the upper 8 of `bits` (8 to 16) bits. Larger values become
// 255. Pixels of 8 bits stay as they are.
cv::Mat3b in_8_bits(const cv::Mat& pixels, int bits);

// Reads a photograph in 8 bits. Of 16-bit values the upper 8 bits are kept.
cv::Mat3b read_color_image(const std::filesystem::path& path);

// Reads a label image of 8 or 16 bits as 16 bits. It has one channel, or three equal ones; the
// alpha of a PNG is ignored. For a PNG with a palette, the labels are the palette indices. Error
// for other images.
cv::Mat1w read_label_image(const std::filesystem::path& path);

// Error if a mask of `size` is not a resized version of an image of size `image` (the aspect ratios
// differ).
void check_mask_shape(const std::filesystem::path& mask, cv::Size size, cv::Size image);

// Read and write float TIFF files (ground truth) without loss, with one or three channels. The
// order of the channels in memory is that in the file. Error for a file with another type of
// pixels.
cv::Mat1f read_float_tiff(const std::filesystem::path& path);
cv::Mat3f read_float3_tiff(const std::filesystem::path& path);
void write_float_tiff(const std::filesystem::path& path, const cv::Mat& image);

// Write an image (B G R or grey). Error if it cannot be encoded or written. JPEG `quality`: 0 to
// 100.
void write_jpeg(const std::filesystem::path& path, const cv::Mat3b& image, int quality);
void write_png(const std::filesystem::path& path, const cv::Mat& image);

}  // namespace axial::io
