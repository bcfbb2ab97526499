// SPDX-License-Identifier: GPL-3.0-or-later
// Determines how many bits the 16-bit values of photographs use. A run of a program uses one number
// of bits for all photographs.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "axial/base.h"
#include "base/program/option_list.h"
#include "io/images/image.h"

namespace axial::io {

// Adds the option `--bit-depth` to `list`. Its value is stored in `bit_depth`, which must exist
// until parse_options() has returned. The default is the present value of `bit_depth`. 0 means: as
// many bits as the largest value in all photographs needs (common_bit_depth). parse_options()
// refuses a value that is neither 0 nor from 8 to 16 (both ends included).
void declare_bit_depth(OptionList& list, int& bit_depth);

// Returns the number of bits (8 to 16) that the values of 16-bit photographs use. in_8_bits needs
// this number to convert the photographs to 8 bits. `headers[i]` is the header of `photographs[i]`.
// `asked` is the number of bits that the user asks for (8 to 16), or 0: the photographs decide. The
// first rule that applies is used:
// 1. If no photograph has more than 8 bits, the result is 16. The result then has no effect,
//    because pixels of 8 bits are not converted. A warning of `context` says that `asked` is not
//    used if `asked` is not 0.
// 2. If `asked` is not 0, the result is `asked`.
// 3. Otherwise the result is the number of bits that the largest value in all photographs needs, at
//    least 8. A line of `context` states the result.
//
// Messages call `asked` the setting "bit_depth". Precondition: `asked` is 0, or from 8 to 16.
// Photographs are decoded only under rule 3, and only those of more than 8 bits. They are decoded
// in parallel, as many at a time as fit into a quarter of the free memory, and at least one. Error
// for a photograph that cannot be read.
int common_bit_depth(std::span<const std::filesystem::path> photographs,
                     std::span<const ImageHeader> headers, int asked, const Context& context = {});

}  // namespace axial::io
