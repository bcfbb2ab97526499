// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "scene/resolution.h"

namespace axial::io {
namespace {

unsigned byte_at(std::string_view bytes, std::size_t i) {
  return static_cast<unsigned char>(bytes[i]);
}

unsigned big_endian(std::string_view bytes, std::size_t i, std::size_t size) {
  unsigned value = 0;
  for (std::size_t k = 0; k < size; ++k) value = value << 8 | byte_at(bytes, i + k);
  return value;
}

bool is_jpeg(std::string_view bytes) {
  return bytes.starts_with("\xFF\xD8\xFF");
}
bool is_png(std::string_view bytes) {
  return bytes.starts_with("\x89PNG\r\n\x1A\n");
}

// What the marker segments of a JPEG file say (ISO 10918-1, annex B).
struct JpegOutline {
  cv::Size size;
  bool complete = false;  // the end-of-image marker is there
};

// Position of the next marker's code byte at or after `i`, past the entropy-coded data.
std::size_t next_marker(std::string_view bytes, std::size_t i) {
  for (; i + 1 < bytes.size(); ++i) {
    if (byte_at(bytes, i) != 0xFF) continue;
    const unsigned code = byte_at(bytes, i + 1);
    const bool restart = code >= 0xD0 && code <= 0xD7;
    if (code != 0x00 && code != 0xFF && !restart) return i + 1;
  }
  return bytes.size();
}

JpegOutline jpeg_outline(std::string_view bytes) {
  JpegOutline outline;
  std::size_t i = next_marker(bytes, 2);
  while (i < bytes.size()) {
    const unsigned code = byte_at(bytes, i);
    if (code == 0xD9) {
      outline.complete = true;
      break;
    }
    if (i + 2 >= bytes.size()) break;
    const std::size_t length = big_endian(bytes, i + 1, 2);
    const bool frame = code >= 0xC0 && code <= 0xCF && code != 0xC4 && code != 0xC8 && code != 0xCC;
    // code, length (2), precision (1), height (2), width (2)
    if (frame && i + 7 < bytes.size())
      outline.size = cv::Size(static_cast<int>(big_endian(bytes, i + 6, 2)),
                              static_cast<int>(big_endian(bytes, i + 4, 2)));
    i = next_marker(bytes, i + 1 + length);
  }
  return outline;
}

// Whether the chunks of a PNG file (length, type, data, checksum) go up to its end chunk.
bool png_complete(std::string_view bytes) {
  for (std::size_t i = 8; i + 12 <= bytes.size();) {
    const std::size_t end = i + 12 + big_endian(bytes, i, 4);
    if (bytes.substr(i + 4, 4) == "IEND") return end <= bytes.size();
    i = end;
  }
  return false;
}

std::string read_image_bytes(const std::filesystem::path& path) {
  std::string bytes = read_file(path);
  if (bytes.empty()) fail("{}: is empty, not an image", path.string());
  // OpenCV decodes what is there of a cut file and paints the rest grey.
  if (is_jpeg(bytes) && !jpeg_outline(bytes).complete)
    fail("{}: truncated: the JPEG data has no end marker", path.string());
  if (is_png(bytes) && !png_complete(bytes))
    fail("{}: truncated: the PNG data has no end chunk", path.string());
  // libpng would add a line of its own to standard error.
  if (is_png(bytes) && bytes.find("IEND\xAE\x42\x60\x82") == std::string::npos)
    fail("{}: truncated: the PNG data has no end chunk", path.string());
  return bytes;
}

cv::Mat decode(const std::string& bytes, const std::filesystem::path& path, int flags) {
  const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
  cv::Mat image;
  try {
    image = cv::imdecode(raw, flags);
  } catch (const cv::Exception& error) {
    fail("{}: cannot be decoded: {}", path.string(), error.err);
  }
  if (image.empty()) fail("{}: is no image that can be read, or is truncated", path.string());
  return image;
}

cv::Mat read_as_stored(const std::filesystem::path& path) {
  return decode(read_image_bytes(path), path, cv::IMREAD_UNCHANGED);
}

void write_encoded(const std::filesystem::path& path, const std::string& extension,
                   const cv::Mat& image, const std::vector<int>& parameters) {
  std::vector<unsigned char> bytes;
  bool encoded = false;
  try {
    encoded = cv::imencode(extension, image, bytes, parameters);
  } catch (const cv::Exception& error) {
    fail("{}: cannot be encoded: {}", path.string(), error.err);
  }
  if (!encoded) fail("{}: cannot be encoded as {}", path.string(), extension);
  write_atomically(path, std::string_view(reinterpret_cast<char*>(bytes.data()), bytes.size()));
}

}  // namespace

cv::Mat3b read_color_image(const std::filesystem::path& path) {
  return decode(read_image_bytes(path), path, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
}

cv::Size read_image_size(const std::filesystem::path& path) {
  const std::string bytes = read_image_bytes(path);
  cv::Size size;
  if (is_jpeg(bytes)) {
    size = jpeg_outline(bytes).size;
  } else if (is_png(bytes) && bytes.size() >= 24) {
    size = cv::Size(static_cast<int>(big_endian(bytes, 16, 4)),
                    static_cast<int>(big_endian(bytes, 20, 4)));
  }
  if (size.width > 0 && size.height > 0) return size;
  return decode(bytes, path, cv::IMREAD_UNCHANGED).size();
}

cv::Mat1w read_label_image(const std::filesystem::path& path) {
  const cv::Mat image = read_as_stored(path);
  if (image.channels() != 1 || (image.depth() != CV_8U && image.depth() != CV_16U))
    fail("{}: is no label image: {} channels of {} bytes, expected one of 1 or 2 bytes",
         path.string(), image.channels(), image.elemSize1());
  cv::Mat1w labels;
  image.convertTo(labels, CV_16U);
  return labels;
}

void check_mask_shape(const std::filesystem::path& mask, cv::Size size, cv::Size image) {
  if (!same_shape(size, image))
    fail("{}: is {}x{}, but its image is {}x{}", mask.string(), size.width, size.height,
         image.width, image.height);
}

cv::Mat1f read_float_tiff(const std::filesystem::path& path) {
  const cv::Mat image = read_as_stored(path);
  if (image.type() != CV_32FC1)
    fail("{}: is no image of one float channel ({} channels of {} bytes)", path.string(),
         image.channels(), image.elemSize1());
  return image;
}

cv::Mat3f read_float3_tiff(const std::filesystem::path& path) {
  const cv::Mat image = read_as_stored(path);
  if (image.type() != CV_32FC3)
    fail("{}: is no image of three float channels ({} channels of {} bytes)", path.string(),
         image.channels(), image.elemSize1());
  cv::Mat3f channels_in_order;
  cv::cvtColor(image, channels_in_order, cv::COLOR_BGR2RGB);
  return channels_in_order;
}

void write_float_tiff(const std::filesystem::path& path, const cv::Mat& image) {
  if (image.depth() != CV_32F) fail("{}: only float images are written as TIFF", path.string());
  // The file's first channel is the first of ours, not the last as OpenCV has it.
  cv::Mat stored;
  if (image.channels() == 3)
    cv::cvtColor(image, stored, cv::COLOR_RGB2BGR);
  else
    stored = image;
  // Said explicitly because OpenCV's default for three float channels is lossy (LogLuv).
  constexpr int kNoCompression = 1;
  write_encoded(path, ".tiff", stored, {cv::IMWRITE_TIFF_COMPRESSION, kNoCompression});
}

void write_jpeg(const std::filesystem::path& path, const cv::Mat3b& image, int quality) {
  write_encoded(path, ".jpg", image, {cv::IMWRITE_JPEG_QUALITY, quality});
}

void write_png(const std::filesystem::path& path, const cv::Mat& image) {
  write_encoded(path, ".png", image, {});
}

}  // namespace axial::io
