// SPDX-License-Identifier: GPL-3.0-or-later
// Options about photographs that several programs have.
#pragma once

#include "base/program/option_list.h"
#include "base/program/program.h"
#include "survey/survey.h"

namespace axial::survey {

// Adds the option `--colors` to `list`. Its value is stored in Options::color_folder. `options`
// must exist until parse_options() has returned.
void declare_colors(OptionList& list, Options& options);

// Adds the options `--ignore-mask-label` and `--mask-path` of a program whose label -1 means black
// borders to `list`. `options` must exist until parse_options() has returned. The program then
// calls take_masks().
void declare_masks(OptionList& list, Options& options);

// Calls use_mask_label() with the label that was given: by default 0 with --mask-path, and
// otherwise -1.
void take_masks(const ParsedOptions& parsed, Options& options);

}  // namespace axial::survey
