// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
// jpeglib.h needs FILE and size_t.
#include <jpeglib.h>
// jerror.h needs jpeglib.h.
#include <jerror.h>

#include <array>
#include <csetjmp>
#include <opencv2/imgcodecs.hpp>

#include "base/error.h"
#include "images/private/image_codecs.h"
#include "images/private/opencv_codecs.h"

namespace axial::io {

namespace fs = std::filesystem;

namespace {

unsigned two_bytes(std::string_view bytes, std::size_t i) {
  return byte_at(bytes, i) << 8 | byte_at(bytes, i + 1);
}

// Contents of the marker segments of a JPEG file (ISO 10918-1, annex B).
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
    const std::size_t length = two_bytes(bytes, i + 1);
    const bool frame = code >= 0xC0 && code <= 0xCF && code != 0xC4 && code != 0xC8 && code != 0xCC;
    // code, length (2), precision (1), height (2), width (2)
    if (frame && i + 7 < bytes.size())
      outline.size = cv::Size(static_cast<int>(two_bytes(bytes, i + 6)),
                              static_cast<int>(two_bytes(bytes, i + 4)));
    i = next_marker(bytes, i + 1 + length);
  }
  return outline;
}

// True for warnings of the library after which pixels are invented. Superfluous bytes before a
// marker, which some cameras write, give another warning and are harmless.
bool loses_pixels(int code) {
  return code == JWRN_HIT_MARKER || code == JWRN_JPEG_EOF || code == JWRN_HUFF_BAD_CODE ||
         code == JWRN_ARITH_BAD_CODE || code == JWRN_MUST_RESYNC;
}

struct JpegError {
  jpeg_error_mgr manager;  // must be the first member: the library has a pointer to it
  std::jmp_buf jump;
  std::array<char, JMSG_LENGTH_MAX> text;
};

[[noreturn]] void give_up(j_common_ptr info) {
  auto* error = reinterpret_cast<JpegError*>(info->err);
  error->manager.format_message(info, error->text.data());
  std::longjmp(error->jump, 1);
}

void hear_warning(j_common_ptr info, int level) {
  if (level < 0 && loses_pixels(info->err->msg_code)) give_up(info);
}

struct JpegReading {
  jpeg_decompress_struct info{};
  JpegError error{};
  cv::Mat pixels;

  ~JpegReading() { jpeg_destroy_decompress(&info); }
};

// Returns false after an error. This function must not hold objects with destructors, because
// longjmp would skip them.
bool read_pixels(JpegReading& reading, std::string_view bytes) {
  jpeg_decompress_struct& info = reading.info;
  info.err = jpeg_std_error(&reading.error.manager);
  info.err->error_exit = give_up;
  info.err->emit_message = hear_warning;
  if (setjmp(reading.error.jump)) return false;
  jpeg_create_decompress(&info);
  jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&info, TRUE);
  const bool four_inks = info.num_components == 4;
  info.out_color_space = four_inks ? JCS_CMYK : JCS_EXT_BGR;
  jpeg_start_decompress(&info);
  reading.pixels.create(static_cast<int>(info.output_height), static_cast<int>(info.output_width),
                        four_inks ? CV_8UC4 : CV_8UC3);
  while (info.output_scanline < info.output_height) {
    JSAMPROW row = reading.pixels.ptr(static_cast<int>(info.output_scanline));
    jpeg_read_scanlines(&info, &row, 1);
  }
  jpeg_finish_decompress(&info);
  return true;
}

}  // namespace

bool is_jpeg(std::string_view bytes) {
  return bytes.starts_with("\xFF\xD8\xFF");
}

void refuse_truncated_jpeg(std::string_view bytes, const fs::path& path) {
  if (!jpeg_outline(bytes).complete) fail_in(path, "truncated: the JPEG data has no end marker");
}

ImageHeader jpeg_header(std::string_view bytes, const fs::path& path) {
  ImageHeader header;
  header.size = jpeg_outline(bytes).size;
  if (header.size.empty()) header.size = decode_jpeg(bytes, path).pixels.size();
  return header;
}

Photograph decode_jpeg(std::string_view bytes, const fs::path& path) {
  check_image_size(jpeg_outline(bytes).size, path);
  JpegReading reading;
  if (!read_pixels(reading, bytes))
    fail_in(path, "cannot be decoded: {}", reading.error.text.data());
  if (reading.pixels.channels() == 4) {  // CMYK: OpenCV converts it
    return {decode_by_opencv(bytes, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION), {}};
  }
  return {reading.pixels, {}};
}

}  // namespace axial::io
