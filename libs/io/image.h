// SPDX-License-Identifier: GPL-3.0-or-later
// Image files, through OpenCV. EXIF rotation is ignored everywhere.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>

namespace axial::io {

// 8-bit colour, channel order B G R. Error for a missing, truncated or unreadable file.
cv::Mat3b read_color_image(const std::filesystem::path& path);

// Size from the file, without keeping the pixels.
cv::Size read_image_size(const std::filesystem::path& path);

// A label image of one channel, 8 or 16 bit, as 16 bit.
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
