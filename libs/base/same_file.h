// SPDX-License-Identifier: GPL-3.0-or-later
// Outputs that are not the files a program reads.
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace axial {

// Error that names `option`, `output` and the input if `output` exists and is one of `inputs`: the
// same file by device and inode, whatever its name, so links count too. Inputs that do not exist
// and empty paths are passed over; of a folder among the inputs only the folder itself counts, not
// the files in it.
void require_not_an_input(const std::filesystem::path& output,
                          std::span<const std::filesystem::path> inputs, const std::string& option);

// The same for each of many outputs.
void require_no_inputs(std::span<const std::filesystem::path> outputs,
                       std::span<const std::filesystem::path> inputs, const std::string& option);

}  // namespace axial
