// SPDX-License-Identifier: GPL-3.0-or-later
// Restored photographs of a run that is not finished. They are in the folder "unfinished" of the
// output until all photographs are restored. A later run with the same inputs and options takes
// them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "color/restore.h"
#include "photographs.h"

namespace axial::apps {

// A fingerprint of all that decides on the restored photographs but their names: the survey, the
// mesh, the options and the findings. Reads the photographs and masks. Error for a file that cannot
// be read.
std::string made_from(const Settings& settings, const survey::Survey& survey, const Mesh& mesh,
                      const Findings& findings, const Context& context);

class Unfinished {
 public:
  // Makes no file yet. `made_from`: of the function above.
  Unfinished(const std::filesystem::path& output, OutputNames names, std::string made_from);

  // The files that write() writes for the photographs and masks `names`.
  static std::vector<std::filesystem::path> files(const std::filesystem::path& output,
                                                  const OutputNames& names);

  // The number of pixels whose colour is determined, if the photograph of the view, and its mask if
  // there is one in the names, are complete and made from the same; otherwise nothing.
  std::optional<std::uint64_t> known_pixels(std::size_t view) const;

  // Writes the photograph of a view and its mask. Error that names a file that cannot be written.
  void write(std::size_t view, const color::Restored& restored, int jpeg_quality) const;

  // Gives all photographs and masks a second name below `folder`, or copies them where the file
  // system has no such names. Error that names a file that cannot be written.
  void give_to(const std::filesystem::path& folder) const;

  // Removes all files that write() wrote, also in earlier runs, and the folders that become empty.
  void remove() const;

 private:
  std::string mark_of(std::size_t view) const;

  std::filesystem::path folder_;
  OutputNames names_;
  std::string made_from_;
};

}  // namespace axial::apps
