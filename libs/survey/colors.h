// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures that give the colours of photographs, such as those of RestoreColors.
#pragma once

#include <filesystem>

#include "survey/survey.h"

namespace axial::survey {

// The number of bits that the values of pictures of 16 bits use: all of them.
inline constexpr int kBitsOfColors = 16;

// The name of the picture without water of a photograph: its own for JPEG and PNG, otherwise with
// the extension .png.
std::filesystem::path restored_name(const std::filesystem::path& photograph);

// Sets View::colors and View::colors_header of all views if Options::color_folder is set. The file
// of a photograph has its restored_name(). It lies in the subfolder of color_folder whose path is
// an end of the path of the photograph's folder. The longest end that has the file is used, as for
// masks (io::find_masks). Error of one line if the folder is none, for a photograph without a file,
// for a file that two photographs would share, and for a file whose size is not that of its
// photograph. No picture is decoded.
void find_colors(Survey& survey);

}  // namespace axial::survey
