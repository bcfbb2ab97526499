// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the photographs of a survey at their working resolution, with the pixels to leave out.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "survey/masks.h"
#include "survey/survey.h"

namespace axial::survey {

// The pixels of a photograph, of the size of View::camera. `color` is that of View::colors if the
// view has such a file, and so is `grey` with Options::match_colors.
struct Pixels {
  cv::Mat1b grey;   // empty unless asked for
  cv::Mat3b color;  // B G R; empty unless asked for
  cv::Mat1b mask;   // 0: the pixel must not be used; empty: all pixels may be used
};

enum class Channels { grey, color, both };

// A photograph in its full size and in 8 bits.
struct FullPhotograph {
  cv::Mat3b color;   // B G R, of View::colors if the view has such a file
  cv::Mat1b opaque;  // 0 where the photograph is fully transparent, else 255; empty: nowhere
};

// Reads a photograph of `survey`, whose views must be found and whose photographs are files.
// `view`: index into Survey::views. The photograph is not decoded if View::colors gives all. Error
// for a file that cannot be decoded.
FullPhotograph read_full_photograph(const Survey& survey, std::size_t view);

// The pixels of a view that may be used because of its mask and its transparency: non-zero where
// the label in the file `view.mask` is not `ignored_label` and where `opaque`, resampled, is 255.
// The result has the size of `view.camera`, and is empty if `view.mask` and `opaque` are both
// empty. `opaque`: of the photograph's size, 0 where the photograph is fully transparent and 255
// elsewhere; empty: nowhere transparent. `check`: collects the labels; may be null. Error for a
// mask that cannot be read or whose shape differs from the photograph's.
cv::Mat1b working_mask(const View& view, const cv::Mat1b& opaque, int ignored_label,
                       LabelCheck* check = nullptr);

class Photographs {
 public:
  // `survey` must outlive the object, and its views must be found. The scene is not used.
  explicit Photographs(const Survey& survey);

  const Survey& survey() const { return survey_; }

  // Reads a view, and gives its grey levels, or its colours if they alone are asked for, to
  // Survey::photograph_check. The photograph is not decoded if View::colors gives all that is asked
  // for. Thread-safe. Error for files that cannot be decoded, and for a mask whose shape differs
  // from its photograph's.
  Pixels read(std::size_t view, Channels channels) const;

  // The largest memory [bytes] of read(view, Channels::color) for a view, with the result.
  std::uint64_t bytes_to_read_color() const;

  // Warns if masks were read and none has the label to ignore.
  void check_labels(const Context& context) const {
    labels_.warn_if_absent(survey_.views, context);
  }

  // Calls check_labels(), and reports photographs that do not belong to the scene
  // (PhotographCheck::report()). Call it after the photographs were read and before outputs
  // are written.
  void report(const Context& context) const;

 private:
  // Whether read() decodes the photograph itself, and View::colors.
  bool needs_photograph(const View& view, Channels channels) const;
  bool needs_colors(const View& view, Channels channels) const;

  const Survey& survey_;
  mutable LabelCheck labels_;
};

}  // namespace axial::survey
