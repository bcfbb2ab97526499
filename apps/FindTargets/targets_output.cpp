// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets_output.h"

#include "base/log.h"
#include "control/read_control.h"
#include "control/write_control.h"

namespace axial::apps {
namespace {

control::TargetImage target_image(const std::string& photograph, const targets::Detection& found) {
  control::TargetImage image;
  image.label = found.label;
  image.image = photograph;
  image.pixel = found.centre.pixel;
  image.sigma = found.centre.sigma;
  image.dot = found.dot;
  return image;
}

}  // namespace

control::Control read_known(const Options& options) {
  control::Control known;
  for (const std::filesystem::path& file : options.control) {
    control::Control read = control::read_control(file, {.epsg = options.epsg});
    for (const std::string& note : read.notes) log_info("{}", note);
    control::append(known, std::move(read));
  }
  known.images.clear();
  return known;
}

void write_output(const Options& options, std::span<const targets::Photograph> found,
                  control::Control known) {
  for (const targets::Photograph& photograph : found)
    for (const targets::Detection& target : photograph.targets)
      known.images.push_back(target_image(photograph.name, target));
  switch (format_of(options.output)) {
    case OutputFormat::gcp_list:
      return control::write_gcp_list(options.output, known);
    case OutputFormat::markers:
      return control::write_metashape_markers(options.output, known);
    case OutputFormat::json:
      return targets::write_targets(options.output, options.families, found);
  }
}

}  // namespace axial::apps
