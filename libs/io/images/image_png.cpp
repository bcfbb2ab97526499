// SPDX-License-Identifier: GPL-3.0-or-later
#include <png.h>

#include <array>
#include <cstring>
#include <vector>

#include "base/error.h"
#include "images/private/image_codecs.h"

namespace axial::io {

namespace fs = std::filesystem;

namespace {

std::size_t four_bytes(std::string_view bytes, std::size_t i) {
  return std::size_t{byte_at(bytes, i)} << 24 | byte_at(bytes, i + 1) << 16 |
         byte_at(bytes, i + 2) << 8 | byte_at(bytes, i + 3);
}

// True if the file contains a complete chunk of this type. A chunk has a length, a type, data and a
// checksum.
bool has_chunk(std::string_view bytes, std::string_view type) {
  for (std::size_t i = 8; i + 12 <= bytes.size();) {
    const std::size_t end = i + 12 + four_bytes(bytes, i);
    if (bytes.substr(i + 4, 4) == type) return end <= bytes.size();
    i = end;
  }
  return false;
}

struct PngReading {
  std::string_view bytes;
  std::size_t next = 0;
  bool labels = false;
  png_structp png = nullptr;
  png_infop info = nullptr;
  cv::Mat pixels;
  std::vector<png_bytep> rows;
  std::array<char, 200> complaint{};

  ~PngReading() { png_destroy_read_struct(&png, &info, nullptr); }
};

[[noreturn]] void give_up(png_structp png, png_const_charp text) {
  auto& reading = *static_cast<PngReading*>(png_get_error_ptr(png));
  std::strncpy(reading.complaint.data(), text, reading.complaint.size() - 1);
  png_longjmp(png, 1);
}

void pass_over(png_structp, png_const_charp) {}

void take_bytes(png_structp png, png_bytep data, std::size_t size) {
  auto& reading = *static_cast<PngReading*>(png_get_io_ptr(png));
  if (size > reading.bytes.size() - reading.next) png_error(png, "the data ends too early");
  std::memcpy(data, reading.bytes.data() + reading.next, size);
  reading.next += size;
}

void ask_for_photograph(png_structp png, png_infop info) {
  png_set_expand(png);  // palettes, fewer than 8 bits, a transparent colour
  const int type = png_get_color_type(png, info);
  if (type == PNG_COLOR_TYPE_GRAY || type == PNG_COLOR_TYPE_GRAY_ALPHA) png_set_gray_to_rgb(png);
  png_set_bgr(png);
}

void ask_for_labels(png_structp png, png_infop info) {
  if (png_get_color_type(png, info) == PNG_COLOR_TYPE_PALETTE)
    png_set_packing(png);
  else
    png_set_expand_gray_1_2_4_to_8(png);
  png_set_strip_alpha(png);
}

void make_room(PngReading& reading) {
  const int depth = png_get_bit_depth(reading.png, reading.info) == 16 ? CV_16U : CV_8U;
  reading.pixels.create(static_cast<int>(png_get_image_height(reading.png, reading.info)),
                        static_cast<int>(png_get_image_width(reading.png, reading.info)),
                        CV_MAKETYPE(depth, png_get_channels(reading.png, reading.info)));
  for (int y = 0; y < reading.pixels.rows; ++y) reading.rows.push_back(reading.pixels.ptr(y));
}

// Returns false after an error. This function must not hold objects with destructors, because
// longjmp would skip them.
bool read_pixels(PngReading& reading) {
  reading.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reading, give_up, pass_over);
  if (!reading.png) return false;
  if (setjmp(png_jmpbuf(reading.png))) return false;
  reading.info = png_create_info_struct(reading.png);
  png_set_read_fn(reading.png, &reading, take_bytes);
  png_read_info(reading.png, reading.info);
  if (reading.labels)
    ask_for_labels(reading.png, reading.info);
  else
    ask_for_photograph(reading.png, reading.info);
  png_set_swap(reading.png);  // 16-bit values with the lower byte first
  png_set_interlace_handling(reading.png);
  png_read_update_info(reading.png, reading.info);
  make_room(reading);
  png_read_image(reading.png, reading.rows.data());
  png_read_end(reading.png, nullptr);
  return true;
}

cv::Mat decode(std::string_view bytes, const fs::path& path, bool labels) {
  const ImageHeader header = png_header(bytes, path);
  check_image_size(header.size, path);
  // Deflate compresses at most 1032 bytes to one.
  constexpr double kBestPacked = 1032;
  const double least = static_cast<double>(header.size.area()) / 8;
  if (least > kBestPacked * static_cast<double>(bytes.size()))
    fail_in(path, "damaged: {} bytes cannot hold {} x {} pixels", bytes.size(), header.size.width,
            header.size.height);
  PngReading reading;
  reading.bytes = bytes;
  reading.labels = labels;
  if (!read_pixels(reading)) fail_in(path, "cannot be decoded: {}", reading.complaint.data());
  return reading.pixels;
}

}  // namespace

bool is_png(std::string_view bytes) {
  return bytes.starts_with("\x89PNG\r\n\x1A\n");
}

void refuse_truncated_png(std::string_view bytes, const fs::path& path) {
  if (!has_chunk(bytes, "IEND") || bytes.find("IEND\xAE\x42\x60\x82") == std::string::npos)
    fail_in(path, "truncated: the PNG data has no end chunk");
}

ImageHeader png_header(std::string_view bytes, const fs::path& path) {
  if (bytes.size() < 33 || bytes.substr(12, 4) != "IHDR")
    fail_in(path, "damaged: the PNG data does not begin with its header");
  ImageHeader header;
  const auto side = [&](std::size_t at) {
    return static_cast<int>(std::min<std::size_t>(four_bytes(bytes, at), INT32_MAX));
  };
  header.size = {side(16), side(20)};
  header.bits = byte_at(bytes, 24) == 16 ? 16 : 8;
  const unsigned type = byte_at(bytes, 25);
  header.alpha = type == PNG_COLOR_TYPE_GRAY_ALPHA || type == PNG_COLOR_TYPE_RGB_ALPHA ||
                 has_chunk(bytes, "tRNS");
  if (header.bits > 8 || header.alpha) header.decode_bytes = bytes_as_a_whole(header);
  return header;
}

Photograph decode_png(std::string_view bytes, const fs::path& path) {
  return without_alpha(decode(bytes, path, false));
}

cv::Mat decode_png_labels(std::string_view bytes, const fs::path& path) {
  return decode(bytes, path, true);
}

}  // namespace axial::io
