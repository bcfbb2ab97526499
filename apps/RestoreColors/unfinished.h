// SPDX-License-Identifier: GPL-3.0-or-later
// Restored photographs of a run that is not finished. They are in the folder <output>.unfinished
// until all photographs are restored. A later run with the same inputs and options takes them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "color/restore.h"
#include "photographs.h"

namespace axial::apps {

// A fingerprint of all that decides on the restored photographs: the survey, the mesh, the options
// and the findings. Reads the files of the survey and of the mesh.
std::string made_from(const Settings& settings, const survey::Survey& survey,
                      const Findings& findings, const Context& context);

class Unfinished {
 public:
  // Makes no file yet. `made_from`: of the function above.
  Unfinished(const std::filesystem::path& output, OutputNames names, std::string made_from);

  // The number of pixels whose colour is determined, if the photograph of the view, and its mask if
  // there is one in the names, are complete and made from the same; otherwise nothing.
  std::optional<std::uint64_t> known_pixels(std::size_t view) const;

  // Writes the photograph of a view and its mask.
  void write(std::size_t view, const color::Restored& restored, int jpeg_quality) const;

  // Moves all photographs and masks into `folder`, and removes what else this class wrote.
  void move_into(const std::filesystem::path& folder) const;

 private:
  std::filesystem::path folder_;
  OutputNames names_;
  std::string made_from_;
};

}  // namespace axial::apps
