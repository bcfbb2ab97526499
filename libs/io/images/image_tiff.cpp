// SPDX-License-Identifier: GPL-3.0-or-later
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "base/error.h"
#include "images/private/image_codecs.h"

namespace axial::io {

namespace fs = std::filesystem;

namespace {

struct Stream {
  std::string_view bytes;
  std::uint64_t next = 0;
};

tmsize_t read_stream(thandle_t handle, void* data, tmsize_t size) {
  auto& stream = *static_cast<Stream*>(handle);
  const std::uint64_t left =
      stream.bytes.size() - std::min<std::uint64_t>(stream.next, stream.bytes.size());
  const std::uint64_t taken = std::min<std::uint64_t>(left, static_cast<std::uint64_t>(size));
  if (taken > 0) std::memcpy(data, stream.bytes.data() + stream.next, taken);
  stream.next += taken;
  return static_cast<tmsize_t>(taken);
}

toff_t seek_stream(thandle_t handle, toff_t offset, int whence) {
  auto& stream = *static_cast<Stream*>(handle);
  if (whence == SEEK_CUR) offset += stream.next;
  if (whence == SEEK_END) offset += stream.bytes.size();
  return stream.next = offset;
}

int map_stream(thandle_t handle, void** data, toff_t* size) {
  const std::string_view bytes = static_cast<Stream*>(handle)->bytes;
  *data = const_cast<char*>(bytes.data());  // libtiff only reads it
  *size = bytes.size();
  return 1;
}

// The first error message of the library about a file.
using Complaint = std::array<char, 300>;

int hear_error(TIFF*, void* data, const char*, const char* format, va_list arguments) {
  auto& complaint = *static_cast<Complaint*>(data);
  if (complaint[0] == '\0') std::vsnprintf(complaint.data(), complaint.size(), format, arguments);
  return 1;  // the handler of the process is not called
}

int ignore_warning(TIFF*, void*, const char*, const char*, va_list) {
  return 1;
}

class Tiff {
 public:
  Tiff(std::string_view bytes, const fs::path& path) : stream_{bytes}, path_(path) {
    const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(
        TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), hear_error, &complaint_);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore_warning, nullptr);
    // The data must be mapped, because libtiff 4.5 misreads tiles of separate planes otherwise.
    file_.reset(TIFFClientOpenExt(
        "TIFF data", "r", &stream_, read_stream,
        [](thandle_t, void*, tmsize_t) { return tmsize_t{0}; }, seek_stream,
        [](thandle_t) { return 0; },
        [](thandle_t handle) { return toff_t{static_cast<Stream*>(handle)->bytes.size()}; },
        map_stream, [](thandle_t, void*, toff_t) {}, options.get()));
    if (!file_) give_up("no TIFF directory");
    width = number<std::uint32_t>(TIFFTAG_IMAGEWIDTH);
    height = number<std::uint32_t>(TIFFTAG_IMAGELENGTH);
    bits = number<std::uint16_t>(TIFFTAG_BITSPERSAMPLE);
    samples = number<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL);
    format = number<std::uint16_t>(TIFFTAG_SAMPLEFORMAT);
    orientation = number<std::uint16_t>(TIFFTAG_ORIENTATION);
    separate = number<std::uint16_t>(TIFFTAG_PLANARCONFIG) == PLANARCONFIG_SEPARATE;
    if (!TIFFGetField(get(), TIFFTAG_PHOTOMETRIC, &photometric))
      give_up("no photometric interpretation");
    std::uint16_t* extra = nullptr;
    std::uint16_t count = 0;
    if (TIFFGetFieldDefaulted(get(), TIFFTAG_EXTRASAMPLES, &count, &extra) && count > 0)
      extras.assign(extra, extra + count);
    check();
  }

  TIFF* get() const { return file_.get(); }
  cv::Size size() const { return {static_cast<int>(width), static_cast<int>(height)}; }
  bool grey() const {
    return photometric == PHOTOMETRIC_MINISBLACK || photometric == PHOTOMETRIC_MINISWHITE;
  }
  bool alpha() const {
    return !extras.empty() &&
           (extras[0] == EXTRASAMPLE_ASSOCALPHA || extras[0] == EXTRASAMPLE_UNASSALPHA);
  }

  [[noreturn]] void give_up(const char* otherwise) const {
    fail_in(path_, "cannot be decoded: {}", complaint_[0] != '\0' ? complaint_.data() : otherwise);
  }

  std::uint32_t width, height;
  std::uint16_t bits, samples, format, orientation, photometric = 0;
  bool separate;
  std::vector<std::uint16_t> extras;  // meaning of the samples beyond the colours

 private:
  struct Close {
    void operator()(TIFF* file) const { TIFFClose(file); }
  };

  template <class T>
  T number(std::uint32_t tag) const {
    T value = 0;
    TIFFGetFieldDefaulted(get(), tag, &value);
    return value;
  }

  void check() const {
    if (format == SAMPLEFORMAT_IEEEFP || format == SAMPLEFORMAT_COMPLEXIEEEFP)
      fail_in(path_,
              "pixels are floating-point numbers of {} bits; photographs must have whole numbers "
              "of 8 or 16",
              bits);
    if (format == SAMPLEFORMAT_INT || format == SAMPLEFORMAT_COMPLEXINT || bits == 0 || bits > 16)
      fail_in(path_,
              "pixels are {} numbers of {} bits; photographs must have unsigned numbers of 8 or 16",
              format == SAMPLEFORMAT_UINT ? "unsigned" : "signed", bits);
    check_image_size({static_cast<int>(std::min<std::uint32_t>(width, INT32_MAX)),
                      static_cast<int>(std::min<std::uint32_t>(height, INT32_MAX))},
                     path_);
    // No method compresses better than this, except fax codes, whose pixels are single bits.
    constexpr double kBestPacked = 2000, kAlways = 1 << 24;
    const double unpacked = static_cast<double>(width) * height * samples * bits / 8;
    if (samples == 0 ||
        unpacked > kBestPacked * static_cast<double>(stream_.bytes.size()) + kAlways)
      fail_in(path_, "damaged: {} bytes cannot hold {} x {} pixels of {} samples",
              stream_.bytes.size(), width, height, samples);
    check_length();
  }

  void check_length() const {
    const bool tiled = TIFFIsTiled(get());
    std::uint64_t *offsets = nullptr, *lengths = nullptr;
    if (!TIFFGetField(get(), tiled ? TIFFTAG_TILEOFFSETS : TIFFTAG_STRIPOFFSETS, &offsets) ||
        !TIFFGetField(get(), tiled ? TIFFTAG_TILEBYTECOUNTS : TIFFTAG_STRIPBYTECOUNTS, &lengths))
      return;
    const std::uint32_t parts = tiled ? TIFFNumberOfTiles(get()) : TIFFNumberOfStrips(get());
    const std::uint64_t size = stream_.bytes.size();
    for (std::uint32_t i = 0; offsets && lengths && i < parts; ++i)
      if (offsets[i] > size || lengths[i] > size - offsets[i])
        fail_in(path_, "truncated: the TIFF data ends before its pixels do");
  }

  Stream stream_;
  Complaint complaint_{};
  const fs::path& path_;
  std::unique_ptr<TIFF, Close> file_;
};

// Converts palettes, YCbCr, bilevel and other images to colours with the library, but keeps the
// order of the rows in the file.
cv::Mat read_by_library(const Tiff& tiff) {
  cv::Mat packed(tiff.size(), CV_8UC4);
  if (!TIFFReadRGBAImageOriented(tiff.get(), tiff.width, tiff.height,
                                 reinterpret_cast<std::uint32_t*>(packed.data), tiff.orientation,
                                 1))
    tiff.give_up("damaged pixels");
  cv::Mat pixels;
  cv::cvtColor(packed, pixels, tiff.alpha() ? cv::COLOR_RGBA2BGRA : cv::COLOR_RGBA2BGR);
  return pixels;
}

// The samples of one row, of 8 to 16 bits each: bytes, 16-bit words, or packed with the highest bit
// first.
class SampleRow {
 public:
  SampleRow(const unsigned char* row, unsigned bits) : row_(row), bits_(bits) {}

  std::uint16_t operator[](std::size_t i) const {
    if (bits_ == 8) return row_[i];
    std::uint16_t word;
    if (bits_ == 16) {
      std::memcpy(&word, row_ + 2 * i, 2);
      return word;
    }
    unsigned value = 0;
    for (std::size_t bit = i * bits_; bit < (i + 1) * bits_; ++bit)
      value = value << 1 | (row_[bit / 8] >> (7 - bit % 8) & 1u);
    return static_cast<std::uint16_t>(value);
  }

 private:
  const unsigned char* row_;
  unsigned bits_;
};

// Reads all samples of a file in their order.
template <class Sample>
class SampleReader {
 public:
  explicit SampleReader(const Tiff& tiff)
      : tiff_(tiff),
        samples_(tiff.size(), CV_MAKETYPE(cv::DataType<Sample>::depth, tiff.samples)) {}

  cv::Mat read() {
    const std::uint16_t planes = tiff_.separate ? tiff_.samples : 1;
    for (std::uint16_t plane = 0; plane < planes; ++plane)
      TIFFIsTiled(tiff_.get()) ? read_tiles(plane) : read_lines(plane);
    return samples_;
  }

 private:
  // Stores `count` pixels starting at (x, y), with all samples or with the sample `plane` only.
  void put(const unsigned char* row, std::uint32_t x, std::uint32_t y, std::uint32_t count,
           std::uint16_t plane) {
    const SampleRow from(row, tiff_.bits);
    const std::size_t here = tiff_.separate ? 1 : tiff_.samples;
    auto* to =
        samples_.template ptr<Sample>(static_cast<int>(y)) + std::size_t{x} * tiff_.samples + plane;
    for (std::size_t i = 0; i < count; ++i, to += tiff_.samples)
      for (std::size_t k = 0; k < here; ++k) to[k] = static_cast<Sample>(from[i * here + k]);
  }

  void read_lines(std::uint16_t plane) {
    std::vector<unsigned char> row(static_cast<std::size_t>(TIFFScanlineSize(tiff_.get())));
    require(row.size(), tiff_.width);
    for (std::uint32_t y = 0; y < tiff_.height; ++y) {
      if (TIFFReadScanline(tiff_.get(), row.data(), y, plane) < 0) tiff_.give_up("damaged pixels");
      put(row.data(), 0, y, tiff_.width, plane);
    }
  }

  void read_tiles(std::uint16_t plane) {
    std::uint32_t width = 0, height = 0;
    TIFFGetField(tiff_.get(), TIFFTAG_TILEWIDTH, &width);
    TIFFGetField(tiff_.get(), TIFFTAG_TILELENGTH, &height);
    const auto row_size = static_cast<std::size_t>(TIFFTileRowSize(tiff_.get()));
    require(row_size, width);
    std::vector<unsigned char> tile(static_cast<std::size_t>(TIFFTileSize(tiff_.get())));
    if (width == 0 || height == 0 || tile.size() < row_size * height) tiff_.give_up("wrong tiles");
    for (std::uint32_t y = 0; y < tiff_.height; y += height)
      for (std::uint32_t x = 0; x < tiff_.width; x += width) {
        if (TIFFReadTile(tiff_.get(), tile.data(), x, y, 0, plane) < 0)
          tiff_.give_up("damaged pixels");
        for (std::uint32_t i = 0; i < std::min(height, tiff_.height - y); ++i)
          put(tile.data() + i * row_size, x, y + i, std::min(width, tiff_.width - x), plane);
      }
  }

  void require(std::size_t row_bytes, std::size_t pixels) const {
    const std::size_t here = tiff_.separate ? 1 : tiff_.samples;
    if (row_bytes < (pixels * here * tiff_.bits + 7) / 8) tiff_.give_up("rows are too short");
  }

  const Tiff& tiff_;
  cv::Mat samples_;
};

// Grey or RGB of 8 bits or more.
cv::Mat read_samples(const Tiff& tiff, const fs::path& path) {
  const int colors = tiff.grey() ? 1 : 3;
  if (tiff.samples < colors + (tiff.alpha() ? 1 : 0) || tiff.samples > 16)
    fail_in(path, "has {} samples in a pixel", tiff.samples);
  const cv::Mat samples = tiff.bits > 8 ? SampleReader<std::uint16_t>(tiff).read()
                                        : SampleReader<std::uint8_t>(tiff).read();
  const bool grey = tiff.grey();
  std::vector<int> from_to{grey ? 0 : 2, 0, grey ? 0 : 1, 1, 0, 2};
  if (tiff.alpha()) from_to.insert(from_to.end(), {colors, 3});
  cv::Mat pixels(tiff.size(), CV_MAKETYPE(samples.depth(), tiff.alpha() ? 4 : 3));
  cv::mixChannels(&samples, 1, &pixels, 1, from_to.data(), from_to.size() / 2);
  const double white = (1 << tiff.bits) - 1;
  if (tiff.photometric == PHOTOMETRIC_MINISWHITE)
    cv::absdiff(pixels, cv::Scalar(white, white, white, 0), pixels);
  return pixels;
}

}  // namespace

bool is_tiff(std::string_view bytes) {
  using namespace std::string_view_literals;
  for (const std::string_view start : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv})
    if (bytes.starts_with(start)) return true;
  return false;
}

ImageHeader tiff_header(std::string_view bytes, const fs::path& path) {
  const Tiff tiff(bytes, path);
  ImageHeader header{tiff.size(), tiff.bits > 8 ? 16 : 8, tiff.alpha()};
  header.decode_bytes = bytes_as_a_whole(header);
  return header;
}

Photograph decode_tiff(std::string_view bytes, const fs::path& path) {
  const Tiff tiff(bytes, path);
  const bool samples = tiff.bits >= 8 && (tiff.grey() || tiff.photometric == PHOTOMETRIC_RGB);
  if (tiff.bits > 8 && !samples)
    fail_in(path, "pixels of {} bits are grey or RGB, not of photometric interpretation {}",
            tiff.bits, tiff.photometric);
  return without_alpha(samples ? read_samples(tiff, path) : read_by_library(tiff));
}

}  // namespace axial::io
