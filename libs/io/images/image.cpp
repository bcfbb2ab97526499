// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/images/image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/program/quiet_errors.h"
#include "images/private/image_codecs.h"
#include "images/private/opencv_codecs.h"
#include "scene/resolution.h"

namespace axial::io {
namespace fs = std::filesystem;

namespace {

void refuse_truncated(const std::string& bytes, const fs::path& path) {
  if (bytes.empty()) fail_in(path, "is empty, not an image");
  if (is_jpeg(bytes)) refuse_truncated_jpeg(bytes, path);
  if (is_png(bytes)) refuse_truncated_png(bytes, path);
}

std::string read_image_bytes(const fs::path& path) {
  std::string bytes = read_file(path);
  refuse_truncated(bytes, path);
  return bytes;
}

// Names common image formats that are not supported.
std::string_view unread_format(std::string_view bytes) {
  if (bytes.starts_with("GIF8")) return "GIF";
  if (bytes.substr(0, 12).ends_with("ftypheic") || bytes.substr(0, 12).ends_with("ftypmif1"))
    return "HEIF";
  if (bytes.substr(0, 12).ends_with("ftypavif")) return "AVIF";
  if (bytes.substr(0, 12).ends_with("ftypcrx ")) return "camera raw (CR3)";
  if (bytes.starts_with("%PDF")) return "PDF";
  if (bytes.starts_with("8BPS")) return "Photoshop";
  return {};
}

// WebP, BMP, JPEG 2000, Sun raster and PNM. For other formats, OpenCV would call GDAL, which prints
// messages and opens files that the bytes name.
bool is_rare_format(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("RIFF") && bytes.substr(0, 12).ends_with("WEBP")) return true;
  for (const std::string_view start :
       {"BM"sv, "\0\0\0\x0CjP  "sv, "\xFF\x4F\xFF\x51"sv, "\x59\xA6\x6A\x95"sv})
    if (bytes.starts_with(start)) return true;
  return bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '7' &&
         " \t\r\n"sv.find(bytes[2]) != std::string_view::npos;
}

void require_known_format(std::string_view bytes, const fs::path& path) {
  if (is_tiff(bytes) || is_rare_format(bytes)) return;
  if (const auto format = unread_format(bytes); !format.empty())
    fail_in(path, "is {}, a format that is not supported; supported are JPEG, PNG and TIFF",
            format);
  fail_in(path, "is not in a supported image format, such as JPEG, PNG and TIFF");
}

// Decodes formats that image_codecs.h does not handle.
cv::Mat decode_other(const std::string& bytes, const fs::path& path, int flags) {
  require_known_format(bytes, path);
  const QuietErrors quiet;  // OpenCV prints messages besides throwing exceptions
  cv::Mat image;
  try {
    image = decode_by_opencv(bytes, flags);
  } catch (const cv::Exception& error) {
    fail_in(path, "cannot be decoded: {}", error.err);
  }
  if (!image.empty()) return image;
  fail_in(path, "cannot be decoded: truncated or damaged");
}

cv::Mat read_as_stored(const fs::path& path) {
  const std::string bytes = read_image_bytes(path);
  if (!is_tiff(bytes)) fail_in(path, "is not a TIFF");
  return decode_other(bytes, path, cv::IMREAD_UNCHANGED);
}

// Returns three channels if the image may have colours.
cv::Mat decode_labels(const std::string& bytes, const fs::path& path) {
  if (is_png(bytes)) return decode_png_labels(bytes, path);
  if (is_jpeg(bytes)) return decode_jpeg(bytes, path).pixels;
  return decode_other(bytes, path, cv::IMREAD_UNCHANGED);
}

// WebP, JPEG 2000, BMP and so on.
Photograph decode_rare(const std::string& bytes, const fs::path& path) {
  // The fourth byte of a BMP pixel is not alpha.
  const int flags = bytes.starts_with("BM") ? cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION
                                            : cv::IMREAD_UNCHANGED;
  cv::Mat pixels = decode_other(bytes, path, flags);
  if (pixels.depth() != CV_8U && pixels.depth() != CV_16U)
    fail_in(path,
            "pixels are floating-point or signed numbers; photographs must have unsigned numbers "
            "of 8 or 16 bits");
  if (pixels.channels() == 1) cv::cvtColor(pixels, pixels, cv::COLOR_GRAY2BGR);
  if (pixels.channels() < 3) fail_in(path, "has {} channels", pixels.channels());
  return without_alpha(pixels);
}

Photograph decode_photograph(const std::string& bytes, const fs::path& path) {
  if (is_jpeg(bytes)) return decode_jpeg(bytes, path);
  if (is_png(bytes)) return decode_png(bytes, path);
  if (is_tiff(bytes)) return decode_tiff(bytes, path);
  return decode_rare(bytes, path);
}

// Returns one channel if all three are equal, otherwise the image.
cv::Mat without_copies(const cv::Mat& image) {
  if (image.channels() != 3) return image;
  std::array<cv::Mat, 3> channels;
  cv::split(image, channels.data());
  const bool same = cv::norm(channels[0], channels[1], cv::NORM_INF) == 0 &&
                    cv::norm(channels[0], channels[2], cv::NORM_INF) == 0;
  return same ? channels[0] : image;
}

std::vector<unsigned char> encoded(const fs::path& path, const std::string& extension,
                                   const cv::Mat& image, const std::vector<int>& parameters) {
  const QuietErrors quiet;  // OpenCV prints messages besides throwing exceptions
  try {
    std::vector<unsigned char> bytes = encode_by_opencv(extension, image, parameters);
    if (!bytes.empty()) return bytes;
  } catch (const cv::Exception& error) {
    fail_in(path, "cannot be encoded: {}", error.err);
  }
  fail_in(path, "cannot be encoded as {}", extension);
}

void write_encoded(const fs::path& path, const std::string& extension, const cv::Mat& image,
                   const std::vector<int>& parameters) {
  const auto bytes = encoded(path, extension, image, parameters);
  write_atomically(path,
                   std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

}  // namespace

void check_image_size(cv::Size size, const fs::path& path) {
  constexpr std::int64_t kMost = std::int64_t{1} << 30;
  if (size.width < 0 || size.height < 0 || std::int64_t{size.width} * size.height > kMost)
    fail_in(path, "{} x {} pixels are too many", size.width, size.height);
}

unsigned bytes_as_a_whole(const ImageHeader& header) {
  return 3 * static_cast<unsigned>(header.bits) / 8 * (header.alpha ? 4 : 3) + 4;
}

Photograph without_alpha(const cv::Mat& pixels) {
  if (pixels.channels() == 3) return {pixels, {}};
  Photograph photograph;
  cv::cvtColor(pixels, photograph.pixels, cv::COLOR_BGRA2BGR);
  cv::Mat alpha;
  cv::extractChannel(pixels, alpha, 3);
  cv::Mat1b opaque;
  cv::compare(alpha, 0, opaque, cv::CMP_GT);
  if (cv::countNonZero(opaque) < static_cast<int>(opaque.total())) photograph.opaque = opaque;
  return photograph;
}

Photograph read_photograph(const fs::path& path) {
  return decode_photograph(read_image_bytes(path), path);
}

cv::Mat3b read_color_image(const fs::path& path) {
  return in_8_bits(read_photograph(path).pixels, 16);
}

cv::Mat3b decode_color_image(const std::string& bytes, const fs::path& name) {
  refuse_truncated(bytes, name);
  return in_8_bits(decode_photograph(bytes, name).pixels, 16);
}

ImageHeader read_image_header(const fs::path& path) {
  return image_header_of(read_image_bytes(path), path);
}

ImageHeader image_header_of(const std::string& bytes, const fs::path& path) {
  if (is_jpeg(bytes)) return jpeg_header(bytes, path);
  if (is_png(bytes)) return png_header(bytes, path);
  if (is_tiff(bytes)) return tiff_header(bytes, path);
  const Photograph photograph = decode_rare(bytes, path);
  ImageHeader header{photograph.pixels.size(), photograph.pixels.depth() == CV_8U ? 8 : 16,
                     !photograph.opaque.empty()};
  header.decode_bytes = bytes_as_a_whole(header);
  return header;
}

cv::Size read_image_size(const fs::path& path) {
  return read_image_header(path).size;
}

std::uint64_t bytes_needed(const ImageHeader& header) {
  return std::uint64_t{header.decode_bytes} * static_cast<std::uint64_t>(header.size.width) *
         static_cast<std::uint64_t>(header.size.height);
}

int bits_used(const cv::Mat& pixels) {
  if (pixels.depth() == CV_8U) return 8;
  double largest = 0;
  cv::minMaxLoc(pixels.reshape(1), nullptr, &largest);
  int bits = 8;
  while (largest >= std::ldexp(1.0, bits)) ++bits;
  return bits;
}

cv::Mat3b in_8_bits(const cv::Mat& pixels, int bits) {
  if (pixels.depth() == CV_8U) return pixels;
  const cv::Mat3w wide = pixels;
  cv::Mat3b narrow(wide.size());
  const int shift = bits - 8;
  const auto level = [&](std::uint16_t value) {
    return static_cast<std::uint8_t>(std::min(value >> shift, 255));
  };
  std::transform(wide.begin(), wide.end(), narrow.begin(), [&](const cv::Vec3w& value) {
    return cv::Vec3b(level(value[0]), level(value[1]), level(value[2]));
  });
  return narrow;
}

cv::Mat1w read_label_image(const fs::path& path) {
  const cv::Mat image = without_copies(decode_labels(read_image_bytes(path), path));
  if (image.channels() != 1 || (image.depth() != CV_8U && image.depth() != CV_16U))
    fail_in(path,
            "is not a label image: it has {} channels of {} bytes, expected one channel of 1 or 2 "
            "bytes",
            image.channels(), image.elemSize1());
  cv::Mat1w labels;
  image.convertTo(labels, CV_16U);
  return labels;
}

void check_mask_shape(const fs::path& mask, cv::Size size, cv::Size image) {
  if (!same_shape(size, image))
    fail_in(mask, "is {}x{}, but its image is {}x{}", size.width, size.height, image.width,
            image.height);
}

cv::Mat1f read_float_tiff(const fs::path& path) {
  const cv::Mat image = read_as_stored(path);
  if (image.type() != CV_32FC1)
    fail_in(path, "is not an image of one float channel ({} channels of {} bytes)",
            image.channels(), image.elemSize1());
  return image;
}

void write_float_tiff(const fs::path& path, const cv::Mat& image) {
  if (image.depth() != CV_32F) fail_in(path, "only float images are written as TIFF");
  // OpenCV stores its last channel first in the file. Our first channel must be first.
  cv::Mat stored;
  if (image.channels() == 3)
    cv::cvtColor(image, stored, cv::COLOR_RGB2BGR);
  else
    stored = image;
  // Set explicitly, because OpenCV's default for three float channels is lossy (LogLuv).
  constexpr int kNoCompression = 1;
  write_encoded(path, ".tiff", stored, {cv::IMWRITE_TIFF_COMPRESSION, kNoCompression});
}

void write_jpeg(const fs::path& path, const cv::Mat3b& image, int quality) {
  write_encoded(path, ".jpg", image, {cv::IMWRITE_JPEG_QUALITY, quality});
}

void write_png(const fs::path& path, const cv::Mat& image) {
  write_encoded(path, ".png", image, {});
}

std::vector<unsigned char> png_bytes(const cv::Mat& image, const fs::path& name) {
  return encoded(name, ".png", image, {});
}

}  // namespace axial::io
