// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: images out of the bytes of a file, by the library of each format. OpenCV
// reads these formats, too, but it turns pixels, drops alpha and lets the libraries print. Every
// function throws an Error of one line that names `path` for damaged bytes and for what is not
// supported.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string_view>

#include "io/image.h"

namespace axial::io {

bool is_jpeg(std::string_view bytes);
bool is_png(std::string_view bytes);
bool is_tiff(std::string_view bytes);

// JPEG files that end before their end marker, and PNG files without a whole end chunk, are
// truncated.
void refuse_truncated_jpeg(std::string_view bytes, const std::filesystem::path& path);
void refuse_truncated_png(std::string_view bytes, const std::filesystem::path& path);

ImageHeader jpeg_header(std::string_view bytes, const std::filesystem::path& path);
ImageHeader png_header(std::string_view bytes, const std::filesystem::path& path);
// Error, too, if the file is shorter than its directory says.
ImageHeader tiff_header(std::string_view bytes, const std::filesystem::path& path);

Photograph decode_jpeg(std::string_view bytes, const std::filesystem::path& path);
Photograph decode_png(std::string_view bytes, const std::filesystem::path& path);
Photograph decode_tiff(std::string_view bytes, const std::filesystem::path& path);

// One channel of 8 or 16 bits: grey values, or the indices of a palette. Where there are colours,
// three channels. Without alpha.
cv::Mat decode_png_labels(std::string_view bytes, const std::filesystem::path& path);

// Error if a photograph of this size cannot be held.
void check_image_size(cv::Size size, const std::filesystem::path& path);

// ImageHeader::decode_bytes where all pixels are decoded, converted and brought to 8 bits one after
// the other.
unsigned bytes_as_a_whole(const ImageHeader& header);

// B G R and alpha, of 8 or 16 bits, as a photograph.
Photograph without_alpha(const cv::Mat& pixels);

}  // namespace axial::io
