// SPDX-License-Identifier: GPL-3.0-or-later
#include "photographs.h"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>
#include <string_view>

#include "base/error.h"
#include "base/file_extension.h"
#include "base/parallel.h"
#include "io/image.h"

namespace fs = std::filesystem;
using namespace axial;

namespace {

bool is_image_name(const fs::path& path) {
  const std::string extension = lower_extension(path);
  constexpr std::array<std::string_view, 6> kExtensions{".jpg", ".jpeg", ".png",
                                                        ".tif", ".tiff", ".bmp"};
  return std::ranges::find(kExtensions, extension) != kExtensions.end();
}

std::vector<fs::path> images_of(const fs::path& folder) {
  std::vector<fs::path> images;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && is_image_name(entry.path())) images.push_back(entry.path());
  std::ranges::sort(images);
  if (images.empty()) fail("{}: no photographs in it", folder.string());
  return images;
}

}  // namespace

std::vector<fs::path> photographs_in(std::span<const fs::path> input) {
  std::vector<fs::path> photographs;
  for (const fs::path& path : input) {
    if (!fs::exists(path)) fail("{}: does not exist", path.string());
    if (fs::is_directory(path))
      std::ranges::copy(images_of(path), std::back_inserter(photographs));
    else
      photographs.push_back(path);
  }
  return photographs;
}

std::vector<calibrate::View> find_views(std::span<const fs::path> photographs,
                                        const calibrate::Board& board,
                                        const io::ColmapCamera& lens) {
  std::vector<calibrate::View> views(photographs.size());
  parallel_for(photographs.size(), [&](std::size_t i) {
    const cv::Mat3b image = io::read_color_image(photographs[i]);
    if (static_cast<std::uint64_t>(image.cols) != lens.width ||
        static_cast<std::uint64_t>(image.rows) != lens.height)
      fail("{}: is {} x {}, the lens {} x {}", photographs[i].string(), image.cols, image.rows,
           lens.width, lens.height);
    cv::Mat1b grey;
    cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
    views[i] = {photographs[i].filename().string(), calibrate::find_corners(grey, board)};
  });
  return views;
}
