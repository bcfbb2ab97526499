// SPDX-License-Identifier: GPL-3.0-or-later
#include "survey/survey.h"

#include <algorithm>

#include "base/atomic_file.h"
#include "base/same_file.h"

namespace axial::survey {

namespace fs = std::filesystem;

std::uint64_t View::decoding_bytes() const {
  const std::uint64_t own = io::bytes_needed(header);
  return colors.empty() ? own : std::max(own, io::bytes_needed(colors_header));
}

void use_mask_label(Options& options, int label) {
  options.ignore_mask_label = label;
  options.ignore_black_border = label == -1;
}

void Survey::add_inputs(std::span<const fs::path> files) {
  inputs.insert(inputs.end(), files.begin(), files.end());
}

void Survey::keep_inputs(std::span<const fs::path> outputs, const std::string& setting) const {
  survey::keep_inputs(outputs, inputs, setting);
}

void keep_inputs(std::span<const fs::path> outputs, std::span<const fs::path> inputs,
                 const std::string& setting) {
  require_no_inputs(outputs, inputs, setting);
  for (const fs::path& output : outputs) require_writable(output);
}

std::vector<fs::path> photograph_files(const Survey& survey) {
  std::vector<fs::path> files;
  for (const View& view : survey.views)
    files.insert(files.end(), {view.file, view.mask, view.colors});
  return files;
}

std::vector<geometry::PosedCamera> posed_cameras(const Survey& survey) {
  std::vector<geometry::PosedCamera> cameras;
  cameras.reserve(survey.views.size());
  for (const View& view : survey.views) cameras.push_back({view.camera, view.pose});
  return cameras;
}

}  // namespace axial::survey
