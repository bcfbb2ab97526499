// SPDX-License-Identifier: GPL-3.0-or-later
#include "survey/photograph_options.h"

namespace axial::survey {

void declare_colors(OptionList& list, Options& options) {
  list.add("colors", &options.color_folder,
           "folder of RestoreColors: colours are taken from its photographs (default: from the "
           "scene's own photographs)")
      .sets("color_folder");
}

void declare_masks(OptionList& list, Options& options) {
  list.add_with_default(
          "ignore-mask-label", &options.ignore_mask_label,
          "mask value to leave out; -1: no masks, but the black borders that undistortion leaves "
          "are left out (default with --mask-path: 0); -2: all pixels are used")
      .range(-2, 65535)
      .add("mask-path", &options.mask_folder,
           "folder with a mask for every image: a.mask.png, a.jpg.png, a_mask.png or a.png for "
           "a.jpg, in the same subfolders as the images")
      .sets("mask_folder");
}

void take_masks(const ParsedOptions& parsed, Options& options) {
  const bool by_folder = !options.mask_folder.empty() && !given(parsed, "ignore-mask-label");
  use_mask_label(options, by_folder ? 0 : options.ignore_mask_label);
}

}  // namespace axial::survey
