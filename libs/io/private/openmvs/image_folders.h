// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the files that the paths of images and masks in a scene name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "private/only_for_io.h"

namespace axial::io {

// Relative paths start at the working folder. That is OpenMVS's rule. If there is no such file,
// they start at the folder of the scene, or at the nearest folder above it in which the file
// exists: the scene was written in this working folder, or was moved together with its photographs.
class ImageFolders {
 public:
  // `working_folder`: absolute and normal.
  ImageFolders(const std::filesystem::path& working_folder, const std::filesystem::path& scene);

  // Returns the absolute path of the file with a name in the scene. If there is no such file in any
  // of the folders, the path starts at the folder of the file that was found before outside of the
  // working folder, or at the working folder if there is no such file. For an absolute name, the
  // other folders are searched for the part of the name below the working folder, if there is such
  // a part. The log states once that another folder than the working folder is used. Warns once if
  // both the working folder and the scene's folder have the file and the two files are different:
  // those of the working folder are used.
  std::string find(const std::filesystem::path& name);

 private:
  std::filesystem::path working_folder_, scene_;
  std::filesystem::path found_in_;  // the folder of others_ in which the last file was found
  std::vector<std::filesystem::path> others_;  // the scene's folder, and the folders above it
  bool is_told_ = false, is_warned_ = false;
};

}  // namespace axial::io
