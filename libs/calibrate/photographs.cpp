// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/photographs.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "base/first_error.h"
#include "base/parallel.h"
#include "calibrate/see_board.h"
#include "io/images/bit_depth.h"
#include "io/images/image.h"
#include "io/images/photograph_files.h"

namespace axial::calibrate {
namespace {

namespace fs = std::filesystem;

void check_size(const fs::path& photograph, cv::Size size, const io::ColmapCamera& lens) {
  if (static_cast<std::uint64_t>(size.width) != lens.width ||
      static_cast<std::uint64_t>(size.height) != lens.height)
    fail_in(photograph, "is {} x {} pixels, but the lens is calibrated for {} x {}", size.width,
            size.height, lens.width, lens.height);
}

// Transparent pixels become black, so that no corners are found there.
cv::Mat1b read_grey(const fs::path& path, int bits) {
  const io::Photograph photograph = io::read_photograph(path);
  cv::Mat1b grey;
  cv::cvtColor(io::in_8_bits(photograph.pixels, bits), grey, cv::COLOR_BGR2GRAY);
  if (!photograph.opaque.empty()) grey.setTo(0, photograph.opaque == 0);
  return grey;
}

template <class Body>
void for_each_photograph(std::span<const fs::path> photographs, const Body& body) {
  FirstError error;
  parallel_for(photographs.size(), [&](std::size_t i) { error.run(i, [&] { body(i); }); });
  error.rethrow();
}

}  // namespace

std::vector<fs::path> photographs_in(std::span<const fs::path> input) {
  std::vector<fs::path> photographs;
  for (const fs::path& path : input) {
    if (!fs::exists(path)) fail_in(path, "does not exist");
    if (fs::is_directory(path))
      std::ranges::copy(io::photographs_in_folder(path, false), std::back_inserter(photographs));
    else
      photographs.push_back(path);
  }
  return photographs;
}

std::vector<View> find_views(std::span<const fs::path> photographs, const Board& board,
                             const io::ColmapCamera& lens, int bit_depth, const Context& context) {
  std::vector<io::ImageHeader> headers(photographs.size());
  for_each_photograph(photographs, [&](std::size_t i) {
    headers[i] = io::read_image_header(photographs[i]);
    check_size(photographs[i], headers[i].size, lens);
  });
  const int bits = io::common_bit_depth(photographs, headers, bit_depth, context);
  std::vector<View> views(photographs.size());
  for_each_photograph(photographs, [&](std::size_t i) {
    views[i] =
        see_board(photographs[i].filename().string(), read_grey(photographs[i], bits), board);
  });
  return views;
}

}  // namespace axial::calibrate
