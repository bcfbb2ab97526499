// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap/colmap_masks.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/first_error.h"
#include "base/parallel.h"
#include "base/same_file.h"
#include "io/images/image.h"
#include "io/images/masks.h"
#include "scene/resolution.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

// A photograph and its mask.
struct MaskedPhotograph {
  fs::path image, mask;
  cv::Size size{};           // of the photograph [px]
  std::size_t left_out = 0;  // pixels
};

std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    std::error_code error;
    if (entry.is_regular_file(error)) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

// The size of a photograph; empty for another file.
std::optional<cv::Size> size_of(const fs::path& file) {
  try {
    return read_image_size(file);
  } catch (const Error&) {
    return {};
  }
}

std::vector<MaskedPhotograph> photographs_in(const fs::path& folder) {
  std::vector<MaskedPhotograph> photographs;
  for (const fs::path& file : files_below(folder))
    if (const auto size = size_of(file)) photographs.push_back({file, {}, *size});
  if (photographs.empty()) fail_in(folder, "has no photographs");
  return photographs;
}

void choose_mask_files(const ColmapMasks& masks, std::vector<MaskedPhotograph>& photographs) {
  std::error_code error;
  if (!fs::is_directory(masks.masks, error)) {
    for (MaskedPhotograph& one : photographs) one.mask = masks.masks;
    return;
  }
  std::vector<MaskRequest> requests;
  for (const MaskedPhotograph& one : photographs) requests.push_back({one.image, {}});
  const std::vector<FoundMask> found = find_masks(requests, masks.masks);
  for (std::size_t i = 0; i < found.size(); ++i) {
    photographs[i].mask = found[i].path;
    if (found[i].path.empty())
      fail("{} {}: no mask for image {}: looked for {}", setting("mask_folder"),
           masks.masks.string(), photographs[i].image.string(), found[i].looked_for);
  }
}

fs::path output_of(const MaskedPhotograph& photograph, const ColmapMasks& masks) {
  return masks.output / (photograph.image.lexically_relative(masks.images).string() + ".png");
}

void refuse_masks_among_photographs(const ColmapMasks& masks) {
  std::error_code error;
  const fs::path output = fs::weakly_canonical(masks.output, error);
  const fs::path part = output.lexically_relative(fs::weakly_canonical(masks.images, error));
  if (!error && !part.empty() && *part.begin() != "..")
    fail("{} {}: is in the folder of the photographs, {}, where masks would count as photographs",
         setting("output"), masks.output.string(), masks.images.string());
}

void check_mask_outputs(const ColmapMasks& masks, std::span<const MaskedPhotograph> photographs) {
  std::vector<fs::path> inputs, outputs;
  for (const MaskedPhotograph& one : photographs) {
    inputs.insert(inputs.end(), {one.image, one.mask});
    outputs.push_back(output_of(one, masks));
  }
  require_no_inputs(outputs, inputs, setting("output"));
}

void write_one(const ColmapMasks& masks, MaskedPhotograph& photograph) {
  const cv::Mat1w labels = read_label_image(photograph.mask);
  check_mask_shape(photograph.mask, labels.size(), photograph.size);
  cv::Mat1b kept;
  cv::compare(resized_labels(labels, photograph.size), masks.label, kept, cv::CMP_NE);
  photograph.left_out = kept.total() - static_cast<std::size_t>(cv::countNonZero(kept));
  const fs::path file = output_of(photograph, masks);
  make_folder(file.parent_path());
  write_png(file, kept);
}

void tell(const ColmapMasks& masks, std::span<const MaskedPhotograph> photographs,
          const Context& context) {
  double left_out = 0;
  for (const MaskedPhotograph& one : photographs)
    left_out += static_cast<double>(one.left_out) / one.size.area();
  const double percent = 100 * left_out / static_cast<double>(photographs.size());
  context.info("{}: {} masks, which leave out {:.1f} % of the pixels", masks.output.string(),
               photographs.size(), percent);
  if (left_out == 0)
    context.warning("{} {}: no mask has this label", setting("ignore_mask_label"), masks.label);
}

}  // namespace

std::size_t write_colmap_masks(const ColmapMasks& masks, const ProgressSink& progress,
                               const Context& context) {
  refuse_masks_among_photographs(masks);
  std::vector<MaskedPhotograph> photographs = photographs_in(masks.images);
  choose_mask_files(masks, photographs);
  check_mask_outputs(masks, photographs);
  FirstError error;
  ProgressCounter written(progress, photographs.size());
  parallel_for(photographs.size(), [&](std::size_t i) {
    error.run(i, [&] { write_one(masks, photographs[i]); });
    written.add();
  });
  error.rethrow();
  tell(masks, photographs, context);
  return photographs.size();
}

}  // namespace axial::io
