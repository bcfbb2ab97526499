// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/image_store.h"

#include <opencv2/imgproc.hpp>
#include <set>
#include <vector>

#include "base/first_error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "io/images/image.h"

namespace axial::densify {
namespace {

cv::Mat1b load_mask(const View& view, int ignored_label, LabelCheck* check) {
  const cv::Mat1w labels = io::read_label_image(view.mask);
  if (check) check->add(labels);
  io::check_mask_shape(view.mask, labels.size(), view.file.size);
  const cv::Size size(view.camera.width, view.camera.height);
  cv::Mat1b mask;
  cv::compare(resized_labels(labels, size), ignored_label, mask, cv::CMP_NE);
  return mask;
}

// Resampling mixes colours of transparent pixels into pixels at their edge: leaves these out, too.
void leave_out_transparent(const cv::Mat1b& opaque, cv::Size size, cv::Mat1b& mask) {
  cv::Mat1b resized;
  cv::resize(opaque, resized, size, 0, 0, cv::INTER_AREA);
  cv::compare(resized, 255, resized, cv::CMP_EQ);
  if (mask.empty())
    mask = resized;
  else
    cv::bitwise_and(mask, resized, mask);
}

WorkImage load(const Project& project, const Settings& settings, std::size_t image,
               LabelCheck& check) {
  const View& view = project.views[image];
  WorkImage result;
  const cv::Size size(view.camera.width, view.camera.height);
  io::Photograph photograph = io::read_photograph(project.scene.images[image].path);
  result.color = resized_image(io::in_8_bits(photograph.pixels, project.bit_depth), size);
  photograph.pixels.release();
  cv::cvtColor(result.color, result.grey, cv::COLOR_BGR2GRAY);
  if (!needs_colors(settings)) result.color.release();
  result.mask = working_mask(view, photograph.opaque, settings.ignore_mask_label, &check);
  return result;
}

}  // namespace

std::uint64_t bytes_needed(const WorkImageSize& size) {
  return (1 + (size.mask ? 1 : 0) + (size.color ? 3 : 0)) * size.pixels;
}

std::uint64_t bytes_needed_to_load(std::uint64_t decode, std::uint64_t pixels) {
  // Colours and grey levels at the working resolution.
  return decode + (3 + 1) * pixels;
}

cv::Mat1b working_mask(const View& view, const cv::Mat1b& opaque, int ignored_label,
                       LabelCheck* check) {
  cv::Mat1b mask;
  if (!view.mask.empty()) mask = load_mask(view, ignored_label, check);
  if (!opaque.empty()) leave_out_transparent(opaque, {view.camera.width, view.camera.height}, mask);
  return mask;
}

ImageStore::ImageStore(const Project& project, const Settings& settings, std::size_t capacity)
    : project_(project),
      labels_(settings),
      cache_([&](std::size_t image) { return load(project, settings, image, labels_); }, capacity) {
}

cv::Mat1b ImageStore::mask(std::size_t image) {
  return project_.views[image].masked() ? get(image)->mask : cv::Mat1b();
}

void ImageStore::check_all(std::size_t at_once) {
  std::vector<std::size_t> images;
  for (std::size_t i = 0; i < project_.views.size(); ++i)
    if (project_.scene.images[i].calibrated) images.push_back(i);
  check(images, at_once);
  labels_.warn_if_absent(project_);
}

void ImageStore::check_part(std::size_t at_once) {
  std::set<std::size_t> images(project_.part.begin(), project_.part.end());
  for (const std::size_t image : project_.part)
    for (const ViewScore& source : project_.sources[image]) images.insert(source.image);
  check(std::vector(images.begin(), images.end()), at_once);
}

void ImageStore::check(std::span<const std::size_t> images, std::size_t at_once) {
  const std::size_t count = images.size();
  ProgressCounter counter(console_progress("Read images"), count);
  FirstError error;
  for_each_in_flight(count, at_once, [&](std::size_t i) {
    const std::size_t image = images[count - 1 - i];
    error.run(image, [&] { get(image); });
    counter.add();
  });
  error.rethrow();
}

}  // namespace axial::densify
