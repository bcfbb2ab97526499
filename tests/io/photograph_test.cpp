// SPDX-License-Identifier: GPL-3.0-or-later
// Compares photographs with pixels that the test stores itself, and with OpenCV where OpenCV is
// right.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tiffio.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "base/atomic_file.h"
#include "base/program/quiet_errors.h"
#include "io/images/image.h"
#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::HasSubstr;

class PhotographTest : public test::FolderTest {
 protected:
  std::mt19937 random_{11};
};

cv::Mat random_pixels(cv::Size size, int type, int bits, std::mt19937& random) {
  cv::Mat pixels(size, type);
  cv::Mat flat = pixels.reshape(1);
  for (int y = 0; y < flat.rows; ++y)
    for (int x = 0; x < flat.cols; ++x) {
      const auto value = static_cast<std::uint16_t>(random() % (1u << bits));
      if (pixels.depth() == CV_8U)
        flat.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(value);
      else
        flat.at<std::uint16_t>(y, x) = value;
    }
  return pixels;
}

bool equal(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

struct TiffKind {
  std::uint16_t bits = 8, orientation = 1, compression = COMPRESSION_NONE;
  bool separate = false, tiled = false, alpha = false;
};

// One plane or all planes of `area`, in the layout of a TIFF's rows.
std::vector<std::uint8_t> packed(const cv::Mat& samples, cv::Rect area, int plane, unsigned bits) {
  const int channels = samples.channels();
  std::vector<std::uint8_t> bytes;
  for (int y = area.y; y < area.y + area.height; ++y) {
    std::vector<bool> row;
    for (int x = area.x; x < area.x + area.width; ++x)
      for (int c = plane < 0 ? 0 : plane; c < (plane < 0 ? channels : plane + 1); ++c) {
        unsigned value = 0;
        if (y < samples.rows && x < samples.cols)
          value = samples.depth() == CV_8U ? samples.ptr<std::uint8_t>(y)[x * channels + c]
                                           : samples.ptr<std::uint16_t>(y)[x * channels + c];
        if (bits == 16) value = (value & 0xFF) << 8 | value >> 8;  // the machine's order
        for (unsigned b = bits; b-- > 0;) row.push_back(value >> b & 1);
      }
    while (row.size() % 8) row.push_back(false);
    for (std::size_t i = 0; i < row.size(); i += 8) {
      unsigned byte = 0;
      for (std::size_t b = 0; b < 8; ++b) byte = byte << 1 | row[i + b];
      bytes.push_back(static_cast<std::uint8_t>(byte));
    }
  }
  return bytes;
}

// `samples` are in the file's order: R G B A, or grey.
void write_tiff(const fs::path& path, const cv::Mat& samples, const TiffKind& kind) {
  TIFF* file = TIFFOpen(path.c_str(), "w");
  const int channels = samples.channels();
  TIFFSetField(file, TIFFTAG_IMAGEWIDTH, samples.cols);
  TIFFSetField(file, TIFFTAG_IMAGELENGTH, samples.rows);
  TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, kind.bits);
  TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, channels);
  TIFFSetField(file, TIFFTAG_PHOTOMETRIC, channels > 2 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
  TIFFSetField(file, TIFFTAG_ORIENTATION, kind.orientation);
  TIFFSetField(file, TIFFTAG_COMPRESSION, kind.compression);
  TIFFSetField(file, TIFFTAG_PLANARCONFIG,
               kind.separate ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
  const std::uint16_t extra = EXTRASAMPLE_UNASSALPHA;
  if (kind.alpha) TIFFSetField(file, TIFFTAG_EXTRASAMPLES, 1, &extra);
  constexpr int kTile = 16;
  if (kind.tiled) {
    TIFFSetField(file, TIFFTAG_TILEWIDTH, kTile);
    TIFFSetField(file, TIFFTAG_TILELENGTH, kTile);
  } else {
    TIFFSetField(file, TIFFTAG_ROWSPERSTRIP, 5);
  }
  for (int plane = kind.separate ? 0 : -1; plane < (kind.separate ? channels : 0); ++plane) {
    const auto sample = static_cast<std::uint16_t>(std::max(plane, 0));
    if (kind.tiled) {
      for (int y = 0; y < samples.rows; y += kTile)
        for (int x = 0; x < samples.cols; x += kTile) {
          auto tile = packed(samples, {x, y, kTile, kTile}, plane, kind.bits);
          TIFFWriteTile(file, tile.data(), static_cast<std::uint32_t>(x),
                        static_cast<std::uint32_t>(y), 0, sample);
        }
    } else {
      for (int y = 0; y < samples.rows; ++y) {
        auto row = packed(samples, {0, y, samples.cols, 1}, plane, kind.bits);
        TIFFWriteScanline(file, row.data(), static_cast<std::uint32_t>(y), sample);
      }
    }
  }
  TIFFClose(file);
}

// The expected photograph for samples in a TIFF's order: B G R, opaque where alpha is not 0.
Photograph expected_of(const cv::Mat& samples, bool alpha) {
  Photograph expected;
  const int colors = samples.channels() > 2 ? 3 : 1;
  std::vector<cv::Mat> channels;
  cv::split(samples, channels);
  const std::vector<cv::Mat> bgr{channels[colors > 1 ? 2u : 0u], channels[colors > 1 ? 1u : 0u],
                                 channels[0]};
  cv::merge(bgr, expected.pixels);
  if (alpha) expected.opaque = channels[static_cast<std::size_t>(colors)] > 0;
  return expected;
}

TEST_F(PhotographTest, TiffPixelsAreThoseStored) {
  const fs::path path = folder_ / "a.tif";
  for (int round = 0; round < 150; ++round) {
    TiffKind kind;
    kind.bits = std::vector<std::uint16_t>{8, 8, 16, 16, 12, 10, 14}[random_() % 7];
    kind.orientation = static_cast<std::uint16_t>(1 + round % 8);
    kind.tiled = random_() % 2;
    kind.alpha = random_() % 2;
    kind.compression = std::vector<std::uint16_t>{COMPRESSION_NONE, COMPRESSION_LZW,
                                                  COMPRESSION_ADOBE_DEFLATE}[random_() % 3];
    const int channels = (random_() % 2 ? 3 : 1) + (kind.alpha ? 1 : 0);
    kind.separate = channels > 1 && random_() % 3 == 0;
    const cv::Size size(static_cast<int>(1 + random_() % 40), static_cast<int>(1 + random_() % 40));
    cv::Mat samples = random_pixels(size, CV_MAKETYPE(kind.bits == 8 ? CV_8U : CV_16U, channels),
                                    kind.bits, random_);
    if (kind.alpha) {  // a quarter of the pixels is transparent here
      cv::Mat alpha;
      cv::extractChannel(samples, alpha, channels - 1);
      alpha.setTo(0, random_pixels(size, CV_8U, 8, random_) < 64);
      alpha.at<std::uint8_t>(0, 0) = 1;
      cv::insertChannel(alpha, samples, channels - 1);
    }
    write_tiff(path, samples, kind);
    const auto said = fmt::format("{} bits, orientation {}, {} channels, separate {}, tiled {}",
                                  kind.bits, kind.orientation, channels, kind.separate, kind.tiled);
    const Photograph expected = expected_of(samples, kind.alpha);
    const ImageHeader header = read_image_header(path);
    EXPECT_EQ(header.size, size) << said;
    EXPECT_EQ(header.bits, kind.bits == 8 ? 8 : 16) << said;
    EXPECT_EQ(header.alpha, kind.alpha) << said;
    Photograph read;
    ASSERT_NO_THROW(read = read_photograph(path)) << said << " " << size;
    ASSERT_TRUE(equal(read.pixels, expected.pixels)) << said;
    const bool any = kind.alpha && cv::countNonZero(expected.opaque == 0) > 0;
    ASSERT_EQ(!read.opaque.empty(), any) << said;
    if (any) {
      EXPECT_TRUE(equal(read.opaque, expected.opaque)) << said;
    }
  }
}

TEST_F(PhotographTest, UsualFilesGiveWhatOpencvGives) {
  const fs::path path = folder_ / "a";
  for (int round = 0; round < 120; ++round) {
    const cv::Size size(static_cast<int>(1 + random_() % 70), static_cast<int>(1 + random_() % 70));
    const int channels = std::vector<int>{1, 3, 4}[static_cast<std::size_t>(round) % 3];
    cv::Mat pixels = random_pixels(size, CV_MAKETYPE(CV_8U, channels), 8, random_);
    if (round % 2) cv::GaussianBlur(pixels, pixels, {9, 9}, 3);
    std::vector<unsigned char> bytes;
    if (channels == 4 || round % 4 < 2)
      cv::imencode(".png", pixels, bytes);
    else
      cv::imencode(".jpg", pixels, bytes,
                   {cv::IMWRITE_JPEG_QUALITY, 20 + round % 80, cv::IMWRITE_JPEG_PROGRESSIVE,
                    round % 8 < 4, cv::IMWRITE_JPEG_RST_INTERVAL, round % 3});
    test::put(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    EXPECT_TRUE(equal(read_color_image(path), cv::imdecode(bytes, cv::IMREAD_COLOR))) << round;
    EXPECT_EQ(read_image_header(path).alpha, channels == 4);
    EXPECT_EQ(read_image_header(path).bits, 8);
  }
  for (const char* extension : {".bmp", ".webp", ".ppm"}) {
    const cv::Mat pixels = random_pixels({31, 17}, CV_8UC3, 8, random_);
    std::vector<unsigned char> bytes;
    cv::imencode(extension, pixels, bytes);
    test::put(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    EXPECT_TRUE(equal(read_color_image(path), cv::imdecode(bytes, cv::IMREAD_COLOR))) << extension;
  }
}

TEST_F(PhotographTest, PngPixelsAreThoseStored) {
  const fs::path path = folder_ / "a.png";
  for (int round = 0; round < 40; ++round) {
    const bool wide = round % 2;
    const int bits = wide ? 9 + static_cast<int>(random_() % 8) : 8;
    const cv::Size size(static_cast<int>(2 + random_() % 40), static_cast<int>(2 + random_() % 40));
    cv::Mat pixels = random_pixels(size, wide ? CV_16UC4 : CV_8UC4, bits, random_);
    cv::Mat alpha;
    cv::extractChannel(pixels, alpha, 3);
    cv::max(alpha, 1, alpha);
    cv::Mat1b opaque(size, uchar{255});
    if (round % 4 < 2) opaque(size.height / 2, size.width / 2) = 0;
    alpha.setTo(0, opaque == 0);
    cv::insertChannel(alpha, pixels, 3);
    write_png(path, pixels);
    const Photograph read = read_photograph(path);
    cv::Mat colors;
    cv::cvtColor(pixels, colors, cv::COLOR_BGRA2BGR);
    EXPECT_TRUE(equal(read.pixels, colors)) << "hidden colours, too";
    EXPECT_EQ(read.opaque.empty(), round % 4 >= 2);
    if (!read.opaque.empty()) {
      EXPECT_TRUE(equal(read.opaque, opaque));
    }
    EXPECT_EQ(read_image_header(path).bits, wide ? 16 : 8);
  }
}

// A PNG of two pixels: the indices 1 and 0 of a palette whose colour 0 is transparent.
TEST_F(PhotographTest, PalettesAreColorsInPhotographsAndLabelsInMasks) {
  using namespace std::string_literals;
  const auto number = [](std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8)
      bytes.push_back(static_cast<char>(value >> shift & 0xFF));
    return bytes;
  };
  const auto crc = [](const std::string& bytes) {
    std::uint32_t value = 0xFFFFFFFFu;
    for (const char c : bytes) {
      value ^= static_cast<unsigned char>(c);
      for (int k = 0; k < 8; ++k) value = value & 1 ? 0xEDB88320u ^ value >> 1 : value >> 1;
    }
    return ~value;
  };
  const auto chunk = [&](const std::string& type, const std::string& data) {
    return number(static_cast<std::uint32_t>(data.size())) + type + data + number(crc(type + data));
  };
  // One row with filter 0 and the bits 10, stored without compression.
  const std::string row = "\x78\x01\x01\x02\0\xFD\xFF\0\x80\0\x82\0\x81"s;
  const fs::path path = folder_ / "a.png";
  test::put(path, "\x89PNG\r\n\x1A\n"s + chunk("IHDR", number(2) + number(1) + "\x01\x03\0\0\0"s) +
                      chunk("PLTE", "\x0A\x14\x1E\x28\x32\x3C"s) + chunk("tRNS", "\0"s) +
                      chunk("IDAT", row) + chunk("IEND", ""));
  const cv::Mat1w labels = read_label_image(path);
  EXPECT_EQ(labels(0, 0), 1);
  EXPECT_EQ(labels(0, 1), 0);
  const Photograph read = read_photograph(path);
  EXPECT_EQ(read.pixels.at<cv::Vec3b>(0, 0), cv::Vec3b(60, 50, 40));
  EXPECT_EQ(read.opaque(0, 0), 255);
  EXPECT_EQ(read.opaque(0, 1), 0);
}

TEST_F(PhotographTest, LabelsMayBeStoredAsGreyColors) {
  const cv::Mat grey = random_pixels({8, 6}, CV_8UC1, 8, random_);
  cv::Mat colors;
  cv::cvtColor(grey, colors, cv::COLOR_GRAY2BGRA);
  write_png(folder_ / "a.png", colors);
  cv::Mat wide;
  grey.convertTo(wide, CV_16U);
  EXPECT_TRUE(equal(read_label_image(folder_ / "a.png"), wide));
}

// The entropy-coded data is truncated or overwritten, but the end marker is correct.
TEST_F(PhotographTest, DamagedJpegIsRefused) {
  cv::Mat pixels = random_pixels({64, 48}, CV_8UC3, 8, random_);
  write_jpeg(folder_ / "a.jpg", pixels, 90);
  const std::string whole = read_file(folder_ / "a.jpg");
  const std::size_t scan = whole.find("\xFF\xDA") + 14;
  const fs::path path = folder_ / "b.jpg";
  for (int round = 0; round < 30; ++round) {
    const std::size_t kept = scan + random_() % (whole.size() - scan - 40);
    test::put(path, whole.substr(0, kept) + "\xFF\xD9");
    EXPECT_THAT(error_of([&] { read_photograph(path); }),
                HasSubstr("b.jpg: cannot be decoded: Corrupt JPEG data"));
  }
  // Some cameras write such padding.
  test::put(path, whole.substr(0, whole.size() - 2) + std::string(20, '\0') + "\xFF\xD9");
  EXPECT_TRUE(equal(read_photograph(path).pixels, read_photograph(folder_ / "a.jpg").pixels));
}

TEST_F(PhotographTest, NoLibraryPrints) {
  const cv::Mat pixels = random_pixels({20, 15}, CV_8UC3, 8, random_);
  std::vector<std::string> files;
  for (const char* extension : {".jpg", ".png", ".tiff", ".webp", ".bmp"}) {
    std::vector<unsigned char> bytes;
    cv::imencode(extension, pixels, bytes);
    files.emplace_back(bytes.begin(), bytes.end());
  }
  std::vector<unsigned char> floats;
  cv::imencode(".tiff", cv::Mat1f(5, 7, 1.5f), floats);
  files.emplace_back(floats.begin(), floats.end());
  files.emplace_back("NITF02.10 and other formats of GDAL");
  const fs::path path = folder_ / "wrong";
  std::string message;
  filter_errors();  // as a program does
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const auto attempt = [&](const std::function<void()>& read) {
    try {
      read();
    } catch (const Error& error) {
      message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      EXPECT_NE(message.find(path.string()), std::string::npos) << message;
    }
  };
  for (const std::string& file : files)
    for (int round = 0; round < 120; ++round) {
      std::string wrong = file;
      if (round % 3 == 0) wrong.resize(random_() % wrong.size());
      for (auto k = round % 3 == 0 ? 0 : 1 + random_() % 4; k > 0; --k)
        wrong[random_() % wrong.size()] = static_cast<char>(random_());
      test::put(path, wrong);
      attempt([&] { read_photograph(path); });
      attempt([&] { read_image_header(path); });
      attempt([&] { read_label_image(path); });
      attempt([&] { read_float_tiff(path); });
    }
  const std::string errors = testing::internal::GetCapturedStderr();
  const std::string output = testing::internal::GetCapturedStdout();
  EXPECT_EQ(errors.substr(0, 1000), "");
  EXPECT_EQ(output.substr(0, 1000), "");
}

TEST_F(PhotographTest, MessagesTellCutFilesFromOtherFormats) {
  const fs::path path = folder_ / "a.jpg";
  const auto says = [&](const std::string& bytes) {
    test::put(path, bytes);
    return error_of([&] { read_photograph(path); });
  };
  EXPECT_THAT(says("GIF89a and so on"), HasSubstr("a.jpg: is GIF, a format that is not supported"));
  for (const char* other : {"Dear diary, today", "NITF02.10 and so on"})
    EXPECT_THAT(says(other), HasSubstr("a.jpg: is not in a supported image format"));
  for (const char* extension : {".jpg", ".png", ".tiff", ".webp", ".bmp"}) {
    std::vector<unsigned char> bytes;
    cv::imencode(extension, random_pixels({40, 30}, CV_8UC3, 8, random_), bytes);
    const std::string message =
        says(std::string(bytes.begin(), bytes.end()).substr(0, bytes.size() / 2));
    EXPECT_EQ(message.find("supported"), std::string::npos) << extension << ": " << message;
  }
  write_float_tiff(path, cv::Mat1f(5, 7, 1.5f));
  for (const auto& read : std::vector<std::function<void()>>{[&] { read_photograph(path); },
                                                             [&] { read_image_size(path); },
                                                             [&] { read_image_header(path); }})
    EXPECT_EQ(error_of(read), path.string() +
                                  ": pixels are floating-point numbers of 32 bits; photographs "
                                  "must have whole numbers of 8 or 16");
}

}  // namespace
}  // namespace axial::io
