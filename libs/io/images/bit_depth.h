// SPDX-License-Identifier: GPL-3.0-or-later
// Finds how many bits the 16-bit values of a run's photographs use. One number serves the whole
// run.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "base/option_list.h"
#include "io/images/image.h"

namespace axial::io {

// Adds the option `--bit-depth`. Its default, 0, means: find the number of bits in the photographs.
void declare_bit_depth(OptionList& list, int& bit_depth);

// Error for a value that is neither 0 nor from 8 to 16. `setting`: its name in the message.
void check_bit_depth(int bit_depth, const std::string& setting = "bit_depth");

// Returns the number of bits (8 to 16) from which all `photographs` are converted to 8 bits per
// value. The result is `asked` if that is not 0. Otherwise it is the number of bits that the
// largest value in any of the photographs needs, and one line of the log states it. Messages call
// `asked` by the name `setting`.
//
// `headers[i]` is the header of `photographs[i]`. Photographs of 8 bits are not read. If all are of
// 8 bits, the result is 16 and has no effect; a warning says so if `asked` is not 0. Photographs
// are decoded in parallel, as many at a time as fit into a quarter of the free memory. Error for a
// photograph that cannot be read.
int common_bit_depth(std::span<const std::filesystem::path> photographs,
                     std::span<const ImageHeader> headers, int asked,
                     const std::string& setting = "bit_depth");

}  // namespace axial::io
