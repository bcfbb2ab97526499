// SPDX-License-Identifier: GPL-3.0-or-later
#include "survey/photographs.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "io/images/image.h"
#include "scene/resolution.h"
#include "survey/black_border.h"
#include "survey/colors.h"
#include "survey/memory_survey.h"

namespace axial::survey {
namespace {

cv::Size size_of(const View& view) {
  return {view.camera.width, view.camera.height};
}

// Decoded pixels in 8 bits at the resolution of the camera.
cv::Mat3b at_working_size(cv::Mat pixels, int bit_depth, const View& view) {
  return resized_image(io::in_8_bits(pixels, bit_depth), size_of(view));
}

// The memory [bytes] to decode a picture and to convert it to 8 bits.
std::uint64_t bytes_to_convert(const io::ImageHeader& header) {
  const auto stored = static_cast<std::uint64_t>(header.size.width) *
                      static_cast<std::uint64_t>(header.size.height);
  return io::bytes_needed(header) + (header.bits > 8 ? 3 * stored : 0);
}

// Whether the colours and the transparency of a view are in its photograph, in part at least.
bool is_needed_for_color(const View& view) {
  return view.colors.empty() || view.header.alpha;
}

void leave_out(const cv::Mat1b& mask, cv::Mat1b& usable) {
  if (mask.empty()) return;
  if (usable.empty())
    usable = mask;
  else
    cv::bitwise_and(mask, usable, usable);
}

cv::Mat1b without_label(const View& view, int ignored_label, LabelCheck* check) {
  const cv::Mat1w labels = io::read_label_image(view.mask);
  if (check) check->add(labels);
  io::check_mask_shape(view.mask, labels.size(), view.header.size);
  cv::Mat1b mask;
  cv::compare(resized_labels(labels, size_of(view)), ignored_label, mask, cv::CMP_NE);
  return mask;
}

// Resampling mixes colours of transparent pixels into pixels at their edge: leaves these out, too.
cv::Mat1b opaque_at(const cv::Mat1b& opaque, cv::Size size) {
  if (opaque.empty()) return {};
  cv::Mat1b resized;
  cv::resize(opaque, resized, size, 0, 0, cv::INTER_AREA);
  cv::compare(resized, 255, resized, cv::CMP_EQ);
  return resized;
}

}  // namespace

cv::Mat1b working_mask(const View& view, const cv::Mat1b& opaque, int ignored_label,
                       LabelCheck* check) {
  cv::Mat1b mask;
  if (!view.mask.empty()) mask = without_label(view, ignored_label, check);
  leave_out(opaque_at(opaque, size_of(view)), mask);
  return mask;
}

FullPhotograph read_full_photograph(const Survey& survey, std::size_t view) {
  const View& from = survey.views[view];
  FullPhotograph result;
  if (is_needed_for_color(from)) {
    io::Photograph photograph = io::read_photograph(from.file);
    result.opaque = photograph.opaque;
    if (from.colors.empty()) result.color = io::in_8_bits(photograph.pixels, survey.bit_depth);
  }
  if (!from.colors.empty())
    result.color = io::in_8_bits(io::read_photograph(from.colors).pixels, kBitsOfColors);
  return result;
}

Photographs::Photographs(const Survey& survey)
    : survey_(survey), labels_(survey.options.ignore_mask_label) {}

bool Photographs::needs_photograph(const View& view, Channels channels) const {
  const bool gives_grey = channels != Channels::color && !survey_.options.match_colors;
  return is_needed_for_color(view) || gives_grey || survey_.options.ignore_black_border;
}

bool Photographs::needs_colors(const View& view, Channels channels) const {
  return !view.colors.empty() && (channels != Channels::grey || survey_.options.match_colors);
}

Pixels Photographs::read(std::size_t view, Channels channels) const {
  const View& from = survey_.views[view];
  const Options& options = survey_.options;
  const auto set_grey = [&](Pixels& pixels) {
    if (channels != Channels::color) cv::cvtColor(pixels.color, pixels.grey, cv::COLOR_BGR2GRAY);
  };
  Pixels result;
  cv::Mat1b opaque, inside;
  if (needs_photograph(from, channels)) {
    io::Photograph photograph = options.memory_survey
                                    ? photograph_of(*options.memory_survey, from.image)
                                    : io::read_photograph(from.file);
    opaque = photograph.opaque;
    result.color = at_working_size(std::move(photograph.pixels), survey_.bit_depth, from);
    set_grey(result);
    if (options.ignore_black_border) inside = outside_black_border(result.color);
  }
  if (needs_colors(from, channels)) {
    result.color = at_working_size(io::read_photograph(from.colors).pixels, kBitsOfColors, from);
    if (options.match_colors) set_grey(result);
  }
  if (channels == Channels::grey) result.color.release();
  if (survey_.photograph_check && channels == Channels::color)
    survey_.photograph_check->take(from.image, result.color);
  else if (survey_.photograph_check)
    survey_.photograph_check->take(from.image, result.grey);
  result.mask = working_mask(from, opaque, options.ignore_mask_label, &labels_);
  leave_out(inside, result.mask);
  return result;
}

std::uint64_t Photographs::bytes_to_read_color() const {
  std::uint64_t largest = 0;
  for (const View& view : survey_.views) {
    const auto stored = static_cast<std::uint64_t>(view.header.size.width) *
                        static_cast<std::uint64_t>(view.header.size.height);
    // While the photograph or its colours are decoded and converted to 8 bits; while its black
    // border is found, or while its labels are decoded and resized.
    std::uint64_t decoded = 0;
    if (needs_photograph(view, Channels::color)) decoded = bytes_to_convert(view.header);
    if (!view.colors.empty())
      decoded = std::max(decoded,
                         bytes_to_convert(view.colors_header) + (view.header.alpha ? stored : 0));
    const std::uint64_t marked = 4 * view.pixels() + (view.mask.empty() ? 0 : 6 * stored);
    largest = std::max(largest, 4 * view.pixels() + std::max(decoded, marked));
  }
  return largest;
}

void Photographs::report(const Context& context) const {
  check_labels(context);
  if (survey_.photograph_check) survey_.photograph_check->report(context);
}

}  // namespace axial::survey
