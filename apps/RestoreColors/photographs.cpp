// SPDX-License-Identifier: GPL-3.0-or-later
#include "photographs.h"

#include <algorithm>

#include "base/atomic_file.h"
#include "base/file_extension.h"
#include "base/same_file.h"
#include "color/chart.h"
#include "io/images/image.h"
#include "survey/colors.h"
#include "survey/photograph_names.h"
#include "survey/photographs.h"
#include "unfinished.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

color::Rendering rendering_of(const survey::Survey& survey, std::size_t view,
                              const Findings& findings) {
  const survey::View& of = survey.views[view];
  return {findings.gain, findings.transfer, is_jpeg_name(of.file) ? 8 : of.header.bits,
          exposure_of(findings, view)};
}

}  // namespace

geometry::PosedCamera posed(const survey::View& view) {
  return {view.camera, view.pose};
}

Eigen::Array3f exposure_of(const Findings& findings, std::size_t view) {
  return findings.exposures[view];
}

PhotographLight read_light(const survey::Survey& survey, std::size_t view,
                           const color::Transfer& transfer) {
  const survey::View& of = survey.views[view];
  const io::Photograph photograph = io::read_photograph(of.file);
  return {color::light_of(photograph.pixels, survey.bit_depth, transfer),
          survey::working_mask(of, photograph.opaque, survey.options.ignore_mask_label)};
}

OutputNames output_names(const Settings& settings, const survey::Survey& survey) {
  OutputNames names;
  for (const fs::path& photograph : survey::photograph_names(survey)) {
    fs::path name = survey::restored_name(photograph);
    if (settings.masks) names.masks.push_back(fs::path("masks") / (name.string() + ".png"));
    names.photographs.push_back(std::move(name));
  }
  return names;
}

void check_outputs(const Settings& settings, const survey::Survey& survey,
                   const OutputNames& names) {
  const std::string option = "--output";
  std::vector<NamedOutput> outputs{{option, settings.output / "colors.json"}};
  for (const auto* list : {&names.photographs, &names.masks})
    for (const fs::path& name : *list) outputs.push_back({option, settings.output / name});
  for (const fs::path& file : Unfinished::files(settings.output, names))
    outputs.push_back({option, file});
  require_different(outputs);
  for (const NamedOutput& output : outputs)
    require_not_an_input(output.path, survey.inputs, option);
}

color::Restored restored_photograph(const survey::Survey& survey, const color::SeenSurface& surface,
                                    const Findings& findings, std::size_t view) {
  const PhotographLight photograph = read_light(survey, view, findings.transfer);
  return color::restore(photograph.light, photograph.mask,
                        surface.sights(posed(survey.views[view])), findings.choice.model,
                        rendering_of(survey, view, findings));
}

std::uint64_t bytes_to_restore(const Settings& settings, const survey::Survey& survey) {
  // Light with and without marks, sights, their copies while gaps are filled, and the result in 16
  // and 8 bits.
  std::uint64_t each_pixel = 2 * 12 + 2 * sizeof(color::Sight) + 14 + 6 + 3 + 1;
  if (!settings.chart.empty()) each_pixel += sizeof(color::Sight);
  std::uint64_t most = 0;
  for (const survey::View& view : survey.views) {
    const std::uint64_t charts =
        settings.chart.empty()
            ? 0
            : color::bytes_to_find_charts({view.camera.width, view.camera.height});
    most = std::max(most, view.pixels() * (each_pixel + view.header.decode_bytes) + charts);
  }
  return most;
}

}  // namespace axial::apps
