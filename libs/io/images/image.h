// SPDX-License-Identifier: GPL-3.0-or-later
// Reads and writes image files. The format of a file is recognised by its contents, not by its
// name. Pixels keep the order in which they are stored: orientation tags (EXIF, TIFF) are ignored.
// Every function that reads gives an Error of one line for a file that is missing, truncated,
// damaged or of a format that is not supported. The image libraries print no messages of their own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "axial/io.h"

namespace axial::io {

// The properties of a photograph that are known without its pixels.
struct ImageHeader {
  cv::Size size;       // [px]
  int bits = 8;        // bits of a stored value, rounded up to whole bytes: 8 or 16
  bool alpha = false;  // pixels may be transparent
  unsigned decode_bytes =
      4;  // memory [bytes per pixel] during decoding, for the file, the library and the result
};

// Reads a photograph of 8 or 16 bits. A grey image gives three equal channels. Error for
// floating-point or signed pixels, and for more than 2^30 pixels.
Photograph read_photograph(const std::filesystem::path& path);

// Return the header or the size of the photograph that read_photograph() would return. The pixels
// of JPEG, PNG and TIFF files are not decoded, except for a JPEG whose header states no size.
// Images of other formats are decoded.
ImageHeader read_image_header(const std::filesystem::path& path);
cv::Size read_image_size(const std::filesystem::path& path);

// Returns the memory [bytes] that read_photograph() needs for a file with this header. The memory
// of the result is included.
std::uint64_t bytes_needed(const ImageHeader& header);

// Returns the number of bits (8 to 16) that the largest value in all channels of `pixels` needs.
// `pixels` has 8 or 16 bits, and for 8 bits the result is 8. Images of 16 bits may use fewer bits,
// because the values of cameras with 10, 12 or 14 bits are stored in 16 bits.
int bits_used(const cv::Mat& pixels);

// Converts `pixels` of three channels to 8 bits by keeping the upper 8 of `bits` (8 to 16) bits of
// each value. A value that needs more than `bits` bits becomes 255. If `pixels` has 8 bits, `bits`
// has no effect, and the result shares the pixels.
cv::Mat3b in_8_bits(const cv::Mat& pixels, int bits);

// Reads a photograph (read_photograph) and converts it to 8 bits. Of values of 16 bits, the upper 8
// bits are kept. Transparency is ignored.
cv::Mat3b read_color_image(const std::filesystem::path& path);

// The same for an image file that is part of another file. `bytes` are the bytes of the image file.
// Errors begin with `name`.
cv::Mat3b decode_color_image(const std::string& bytes, const std::filesystem::path& name);

// Reads a label image of 8 or 16 bits and returns its labels in 16 bits. The image must have one
// channel or three equal channels. The alpha of a PNG is ignored. The labels of a PNG with a
// palette are the palette indices. Error for other images.
cv::Mat1w read_label_image(const std::filesystem::path& path);

// Error that names the file `mask` if the size of the mask, `size`, has another aspect ratio than
// the size of its image, `image`. A mask may have another resolution than its image. Differences of
// the aspect ratio by rounding to whole pixels are accepted (same_shape in scene/resolution.h).
void check_mask_shape(const std::filesystem::path& mask, cv::Size size, cv::Size image);

// Read float TIFF files (ground truth) with one channel, and write them with one or three channels,
// without loss. The channels have the same order in memory and in the file. Reading gives an Error
// for a file with another type of pixels. Writing gives an Error for pixels that are not float, and
// for a file that cannot be written.
cv::Mat1f read_float_tiff(const std::filesystem::path& path);
void write_float_tiff(const std::filesystem::path& path, const cv::Mat& image);

// Write an image and replace an existing file. PNG: B G R, B G R alpha or grey, 8 or 16 bits. The
// JPEG `quality` is from 0 (worst) to 100 (best). Error if the image cannot be encoded or the file
// cannot be written.
void write_jpeg(const std::filesystem::path& path, const cv::Mat3b& image, int quality);
void write_png(const std::filesystem::path& path, const cv::Mat& image);

// Returns the bytes that write_png() would write. Errors begin with `name`.
std::vector<unsigned char> png_bytes(const cv::Mat& image, const std::filesystem::path& name);

}  // namespace axial::io
