// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: decodes JPEG, PNG and TIFF images with the library of each format. OpenCV is
// not used for these formats, because it rotates images, drops alpha and lets the libraries print
// messages. Every function with an argument `path` throws an Error of one line that names `path`
// for damaged bytes and for features that are not supported.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string_view>

#include "bytes/private/only_for_io.h"
#include "io/images/image.h"

namespace axial::io {

inline unsigned byte_at(std::string_view bytes, std::size_t i) {
  return static_cast<unsigned char>(bytes[i]);
}

bool is_jpeg(std::string_view bytes);
bool is_png(std::string_view bytes);
bool is_tiff(std::string_view bytes);

// Error for a truncated file. A JPEG is truncated if it has no end marker. A PNG is truncated if it
// has no complete end chunk.
void refuse_truncated_jpeg(std::string_view bytes, const std::filesystem::path& path);
void refuse_truncated_png(std::string_view bytes, const std::filesystem::path& path);

// What read_image_header() returns for a file with these bytes. Errors begin with `path`.
ImageHeader image_header_of(const std::string& bytes, const std::filesystem::path& path);

ImageHeader jpeg_header(std::string_view bytes, const std::filesystem::path& path);
ImageHeader png_header(std::string_view bytes, const std::filesystem::path& path);
// In addition, an Error if the file is shorter than its TIFF directory says.
ImageHeader tiff_header(std::string_view bytes, const std::filesystem::path& path);

Photograph decode_jpeg(std::string_view bytes, const std::filesystem::path& path);
Photograph decode_png(std::string_view bytes, const std::filesystem::path& path);
Photograph decode_tiff(std::string_view bytes, const std::filesystem::path& path);

// Decodes a label image without alpha: one channel of 8 or 16 bits (grey values or palette
// indices), or three channels if the image has colours.
cv::Mat decode_png_labels(std::string_view bytes, const std::filesystem::path& path);

// Error if a photograph of this size has too many pixels (more than 2^30).
void check_image_size(cv::Size size, const std::filesystem::path& path);

// Returns ImageHeader::decode_bytes for a format whose decoder holds the whole image in memory. All
// pixels are first decoded, then converted, then reduced to 8 bits.
unsigned bytes_as_a_whole(const ImageHeader& header);

// Converts pixels (B G R, or B G R and alpha) of 8 or 16 bits to a photograph.
Photograph without_alpha(const cv::Mat& pixels);

}  // namespace axial::io
