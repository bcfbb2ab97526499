// SPDX-License-Identifier: GPL-3.0-or-later
// The folder that ViewScene writes: which folders it may replace, and its data files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace axial::apps {

// Returns the folder that holds index.html, style.css and viewer.js. Error if this build of
// AxialMVS does not have them.
std::filesystem::path page_folder();

// Error that names --report if `folder` is a file, cannot be written, or contains files but was not
// written by ViewScene.
void require_own_folder(const std::filesystem::path& folder);

// Writes the files of `folder` by write_folder() (base/atomic_file.h), with a list of them. Then
// removes the files of an earlier run that `write` did not write again. Files that were changed
// since then stay. Precondition: require_own_folder() accepts `folder`.
void write_own_folder(const std::filesystem::path& folder,
                      const std::function<void(const std::filesystem::path& staging)>& write);

// Writes data files, which are scripts (page/src/data.js): entries with the same `kind` follow each
// other in files of about 8 MB.
class DataFiles {
 public:
  // `staging`: the folder in which the files "data/<kind>-0000.js" and so on are created.
  DataFiles(std::filesystem::path staging, std::string kind);

  // Appends an entry and returns the name of its file, relative to `staging`. Error if the file
  // cannot be written.
  std::string add(std::string_view bytes);

 private:
  std::filesystem::path staging_;
  std::string kind_;
  std::size_t entries_ = 0, files_ = 0, room_ = 0;
};

// Writes the file data/scene.js, which describes all other files.
void write_scene_file(const std::filesystem::path& staging, const nlohmann::ordered_json& scene);

}  // namespace axial::apps
