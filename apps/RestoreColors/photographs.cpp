// SPDX-License-Identifier: GPL-3.0-or-later
#include "photographs.h"

#include <algorithm>

#include "base/atomic_file.h"
#include "base/context.h"
#include "base/error.h"
#include "base/file_extension.h"
#include "base/same_file.h"
#include "io/images/image.h"
#include "survey/colors.h"
#include "survey/photographs.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// The deepest folder that contains all photographs.
fs::path common_folder(const survey::Survey& survey) {
  fs::path common = survey.views.front().file.parent_path();
  for (const survey::View& view : survey.views) {
    const fs::path folder = view.file.parent_path();
    const auto ends = std::ranges::mismatch(common, folder);
    fs::path shared;
    for (auto part = common.begin(); part != ends.in1; ++part) shared /= *part;
    common = shared;
  }
  return common;
}

Eigen::Array3f exposure_of(const Findings& findings, std::size_t view) {
  if (findings.exposures.empty()) return Eigen::Array3f::Ones();
  return findings.exposures[view];
}

color::Rendering rendering_of(const Settings& settings, const survey::Survey& survey,
                              std::size_t view, const Findings& findings) {
  const survey::View& of = survey.views[view];
  return {findings.gain, settings.transfer, is_jpeg_name(of.file) ? 8 : of.header.bits,
          exposure_of(findings, view)};
}

geometry::PosedCamera posed(const survey::View& view) {
  return {view.camera, view.pose};
}

}  // namespace

PhotographLight read_light(const survey::Survey& survey, std::size_t view,
                           const color::Transfer& transfer) {
  const survey::View& of = survey.views[view];
  const io::Photograph photograph = io::read_photograph(of.file);
  return {color::light_of(photograph.pixels, survey.bit_depth, transfer),
          survey::working_mask(of, photograph.opaque, survey.options.ignore_mask_label)};
}

OutputNames output_names(const Settings& settings, const survey::Survey& survey) {
  const fs::path folder = common_folder(survey);
  OutputNames names;
  for (const survey::View& view : survey.views) {
    fs::path name = survey::restored_name(view.file.lexically_relative(folder));
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
  require_different(outputs);
  for (const NamedOutput& output : outputs)
    require_not_an_input(output.path, survey.inputs, option);
}

double write_restored(const Settings& settings, const survey::Survey& survey,
                      const color::SeenSurface& surface, const Findings& findings,
                      const OutputNames& names, const fs::path& folder, const Context& context) {
  ProgressCounter progress(context.stage("Restoring photographs"), survey.views.size());
  double known = 0, all = 0;
  for (std::size_t i = 0; i < survey.views.size(); ++i) {
    const survey::View& view = survey.views[i];
    const PhotographLight photograph = read_light(survey, i, settings.transfer);
    const color::Restored restored =
        color::restore(photograph.light, photograph.mask, surface.sights(posed(view)),
                       findings.choice.model, rendering_of(settings, survey, i, findings));
    const fs::path file = folder / names.photographs[i];
    make_folder(file.parent_path());
    if (is_jpeg_name(file))
      io::write_jpeg(file, restored.pixels, settings.jpeg_quality);
    else
      io::write_png(file, restored.pixels);
    if (settings.masks) {
      const fs::path mask = folder / names.masks[i];
      make_folder(mask.parent_path());
      io::write_png(mask, restored.known);
    }
    known += cv::countNonZero(restored.known);
    all += static_cast<double>(restored.known.total());
    progress.add();
  }
  return known / all;
}

std::size_t view_of_grey(const GreyPatch& grey, const survey::Survey& survey) {
  const auto has_name = [&](const survey::View& view) {
    const std::string path = view.file.generic_string();
    return path == grey.image || path.ends_with("/" + grey.image);
  };
  const auto found = std::ranges::find_if(survey.views, has_name);
  if (found == survey.views.end()) fail("--grey {}: no photograph has this name", grey.image);
  if (std::ranges::count_if(survey.views, has_name) > 1)
    fail("--grey {}: several photographs have this name; give a folder, too", grey.image);
  const cv::Rect all(0, 0, found->camera.width, found->camera.height);
  if ((grey.part & all) != grey.part)
    fail("--grey {}: the part lies outside the photograph of {} x {} pixels", grey.image, all.width,
         all.height);
  return static_cast<std::size_t>(found - survey.views.begin());
}

std::uint64_t bytes_to_restore(const survey::Survey& survey) {
  // Light, sights, their copies while gaps are filled, and the result in 16 and 8 bits.
  constexpr std::uint64_t kEachPixel = 12 + 2 * sizeof(color::Sight) + 14 + 6 + 3 + 1;
  std::uint64_t most = 0;
  for (const survey::View& view : survey.views)
    most = std::max(most, view.pixels() * (kEachPixel + view.header.decode_bytes));
  return most;
}

Eigen::Array3f grey_gain(const Settings& settings, const survey::Survey& survey,
                         const color::SeenSurface& surface, const Findings& findings) {
  const GreyPatch& grey = *settings.grey;
  const std::size_t index = view_of_grey(grey, survey);
  const survey::View& view = survey.views[index];
  PhotographLight photograph = read_light(survey, index, settings.transfer);
  color::mark_unusable(photograph.light, photograph.mask, settings.transfer);
  const cv::Mat3f& light = photograph.light;
  const color::SightImage sights = surface.sights(posed(view));
  Eigen::Array3f sum = Eigen::Array3f::Zero();
  int count = 0;
  for (int y = grey.part.y; y < grey.part.br().y; ++y)
    for (int x = grey.part.x; x < grey.part.br().x; ++x) {
      const cv::Vec3f& l = light(y, x);
      const Eigen::Array3f color = Eigen::Array3f(l[0], l[1], l[2]) / exposure_of(findings, index);
      if (!color.isFinite().all() || !(sights.at(x, y).way > 0)) continue;
      sum += color::surface_light(findings.choice.model, sights.at(x, y), color);
      ++count;
    }
  if (count == 0 || !(sum > 0).all())
    fail("--grey {}: the light of this part is not known: it is clipped, or no surface is there",
         grey.image);
  const Eigen::Array3f gain = count / sum;
  return gain * (findings.gain.mean() / gain.mean());
}

}  // namespace axial::apps
