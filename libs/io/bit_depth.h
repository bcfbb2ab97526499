// SPDX-License-Identifier: GPL-3.0-or-later
// One answer for all photographs of a run to how many bits their 16-bit values use.
#pragma once

#include <filesystem>
#include <span>

#include "base/option_list.h"
#include "io/image.h"

namespace axial::io {

// `--bit-depth`, whose default 0 is: find it.
void declare_bit_depth(OptionList& list, int& bit_depth);
// Error for a value that is neither 0 nor from 8 to 16.
void check_bit_depth(int bit_depth);

// The bits by which all `photographs` are brought to 8: `asked`, unless it is 0, or else as many as
// the largest value in any of them needs, which one line of the log states. `headers` are the
// photographs' own. Those of 8 bits are not read; without others the result is 16, and means
// nothing. Photographs are decoded as many at a time as fit into a quarter of the free memory.
int common_bit_depth(std::span<const std::filesystem::path> photographs,
                     std::span<const ImageHeader> headers, int asked);

}  // namespace axial::io
