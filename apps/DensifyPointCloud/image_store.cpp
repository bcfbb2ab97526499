// SPDX-License-Identifier: GPL-3.0-or-later
#include "image_store.h"

#include <mutex>
#include <opencv2/imgproc.hpp>

#include "base/parallel.h"
#include "base/progress.h"
#include "io/image.h"

namespace densify {
namespace {

cv::Mat1b load_mask(const View& view, int ignored_label, LabelCheck& check) {
  const cv::Mat1w labels = axial::io::read_label_image(view.mask);
  check.add(labels);
  axial::io::check_mask_shape(view.mask, labels.size(), view.file_size);
  const cv::Size size(view.camera.width, view.camera.height);
  cv::Mat1b mask;
  cv::compare(axial::resized_labels(labels, size), ignored_label, mask, cv::CMP_NE);
  return mask;
}

WorkImage load(const Project& project, const Options& options, std::size_t image,
               LabelCheck& check) {
  const View& view = project.views[image];
  WorkImage result;
  result.color = axial::resized_image(axial::io::read_color_image(project.scene.images[image].path),
                                      {view.camera.width, view.camera.height});
  cv::cvtColor(result.color, result.grey, cv::COLOR_BGR2GRAY);
  if (!needs_colors(options)) result.color.release();
  if (!view.mask.empty()) result.mask = load_mask(view, options.ignore_mask_label, check);
  return result;
}

}  // namespace

ImageStore::ImageStore(const Project& project, const Options& options, std::size_t capacity)
    : project_(project),
      labels_(options.ignore_mask_label),
      cache_([&](std::size_t image) { return load(project, options, image, labels_); }, capacity) {}

void ImageStore::check_all(std::size_t at_once) {
  const std::size_t count = project_.views.size();
  const axial::ProgressSink progress = axial::console_progress("Read images");
  std::mutex reporting;
  std::size_t done = 0;
  axial::for_each_in_flight(count, at_once, [&](std::size_t i) {
    const std::size_t image = count - 1 - i;
    if (project_.scene.images[image].calibrated) get(image);
    const std::lock_guard lock(reporting);
    progress(++done, count);
  });
  labels_.warn_if_absent(project_);
}

}  // namespace densify
