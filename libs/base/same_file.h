// SPDX-License-Identifier: GPL-3.0-or-later
// Checks that a program does not overwrite its inputs.
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace axial {

// Throws an Error that names `setting`, `output` and the input if `output` exists and is one of
// `inputs`. `setting`: the option or parameter that gave `output`, for the message. Files are
// compared by device and inode, so that a link to an input counts as the input. Empty paths and
// inputs that do not exist are ignored. If an input is a folder, only the folder itself is
// compared, and not the files in it.
void require_not_an_input(const std::filesystem::path& output,
                          std::span<const std::filesystem::path> inputs,
                          const std::string& setting);

// A file to write, and the name of the setting that asks for it.
struct NamedOutput {
  std::string setting;
  std::filesystem::path path;
};

// Throws an Error that names the path and both settings if two of `outputs` have the same path.
// Paths are compared as they are written. Empty paths are ignored.
void require_different(std::span<const NamedOutput> outputs);

// Calls require_not_an_input() for each of `outputs`, in their order: throws the Error for the
// first one that is an input.
void require_no_inputs(std::span<const std::filesystem::path> outputs,
                       std::span<const std::filesystem::path> inputs, const std::string& setting);

}  // namespace axial
