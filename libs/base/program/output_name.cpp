// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program/output_name.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/file_extension.h"

namespace axial {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> kKnown{".mvs", ".ply", ".obj", ".glb", ".gltf"};

constexpr std::array<std::string_view, 16> kOtherFormats{
    ".stl", ".off", ".fbx", ".dae", ".3ds", ".3mf", ".usd", ".usdz",
    ".wrl", ".x3d", ".laz", ".e57", ".pcd", ".pts", ".xyz", ".vtk"};

}  // namespace

std::string known_extension(const fs::path& path) {
  std::string extension = lower_extension(path);
  return std::ranges::find(kKnown, extension) == kKnown.end() ? std::string() : extension;
}

fs::path without_known_extension(fs::path path) {
  return known_extension(path).empty() ? path : path.replace_extension();
}

fs::path with_extension(const fs::path& path, std::string_view extension) {
  return without_known_extension(path) += extension;
}

void refuse_control_characters(const fs::path& path, const std::string& option) {
  const std::string text = path.string();
  const bool found = std::ranges::any_of(text, [](unsigned char c) { return c < 32 || c == 127; });
  if (found)
    fail("{} {}: contains a control character, and a file with such a name cannot be read again",
         option, text);
}

void refuse_other_format(const fs::path& path, const std::string& option) {
  const std::string extension = lower_extension(path);
  if (extension == ".las")
    fail("{} {}: a .las file is written by TransformScene -i cloud.ply alone", option,
         path.string());
  if (std::ranges::find(kOtherFormats, extension) != kOtherFormats.end())
    fail("{} {}: {} files are not written", option, path.string(), extension);
}

fs::path output_in_working_folder(const CommonOptions& common, const std::string& path,
                                  const std::string& option) {
  const fs::path file = in_working_folder(common, path);
  refuse_control_characters(path, option);
  if (!file.empty() && !file.has_filename())
    fail("{} {}: must be the name of a file, not of a folder", option, path);
  return file;
}

fs::path output_or(const fs::path& given, const fs::path& otherwise, const std::string& option) {
  if (!given.empty()) return given;
  refuse_control_characters(otherwise, option);
  return otherwise;
}

fs::path folder_in_working_folder(const CommonOptions& common, const std::string& path,
                                  const std::string& option) {
  refuse_control_characters(path, option);
  return in_working_folder(common, path);
}

}  // namespace axial
