// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace axial {

// `text` with ASCII letters in lower case.
inline std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// The extension of a file's name in lower case, with the dot: ".png" for "A.PNG". Empty if the name
// has no extension.
inline std::string lower_extension(const std::filesystem::path& file) {
  return lower_case(file.extension().string());
}

// True if the extension is .jpg or .jpeg, in upper or lower case.
inline bool is_jpeg_name(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  return extension == ".jpg" || extension == ".jpeg";
}

}  // namespace axial
