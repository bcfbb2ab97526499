// SPDX-License-Identifier: GPL-3.0-or-later
// Opens a survey and finds its photographs.
#include "base/error.h"
#include "base/first_error.h"
#include "base/parallel.h"
#include "io/images/bit_depth.h"
#include "io/images/photograph_size.h"
#include "io/openmvs/mvs_counts.h"
#include "io/openmvs/scene_files.h"
#include "scene/resolution.h"
#include "survey/colors.h"
#include "survey/masks.h"
#include "survey/memory_survey.h"
#include "survey/survey.h"
#include "survey/views_file.h"

namespace axial::survey {
namespace {

namespace fs = std::filesystem;

View view_of(const SceneImage& image, std::size_t index, const Options& options) {
  View view;
  view.image = index;
  view.id = image.id == kNoId ? static_cast<std::uint32_t>(index) : image.id;
  view.file = image.path;
  view.header = options.memory_survey ? header_of(*options.memory_survey, index)
                                      : io::read_image_header(image.path);
  const cv::Size size =
      working_size(view.header.size.width, view.header.size.height, options.resolution);
  view.camera = image.camera.resized(size.width, size.height);
  view.pose = image.pose;
  return view;
}

std::vector<std::size_t> images_to_use(const Survey& survey) {
  const fs::path& list = survey.options.views_file;
  std::vector<std::size_t> images;
  const auto named = list.empty() ? std::set<std::size_t>() : images_in(list, survey.scene);
  for (std::size_t i = 0; i < survey.scene.images.size(); ++i)
    if (survey.scene.images[i].calibrated && (list.empty() || named.contains(i)))
      images.push_back(i);
  if (images.empty()) fail_in(survey.file(), "has no calibrated image to use");
  return images;
}

void read_headers(Survey& survey) {
  const std::vector<std::size_t> images = images_to_use(survey);
  survey.views.resize(images.size());
  FirstError error;
  parallel_for(images.size(), [&](std::size_t v) {
    error.run(v, [&] {
      survey.views[v] = view_of(survey.scene.images[images[v]], images[v], survey.options);
    });
  });
  error.rethrow();
}

void check_sizes(const Survey& survey, const Context& context) {
  std::vector<io::PhotographSize> sizes;
  for (const View& view : survey.views) {
    const CameraModel& camera = survey.scene.images[view.image].camera;
    sizes.push_back({view.file, view.header.size, {camera.width, camera.height}});
  }
  io::check_photograph_sizes(sizes, context);
}

void find_bit_depth(Survey& survey, const Context& context) {
  std::vector<fs::path> photographs;
  std::vector<io::ImageHeader> headers;
  for (const View& view : survey.views) {
    photographs.push_back(view.file);
    headers.push_back(view.header);
  }
  const Options& options = survey.options;
  survey.bit_depth = io::common_bit_depth(photographs, headers, options.bit_depth, context);
}

}  // namespace

Survey open_scene(const Options& options, const Context& context) {
  const fs::path& file = options.files.scene;
  if (context.memory().is_limited())
    if (const auto counts = io::count_mvs(file))
      context.memory().require(counts->reading_bytes(), "reading " + file.string());
  Survey survey{options.memory_survey ? scene_of(*options.memory_survey)
                                      : io::read_scene_with_cameras(options.files, context),
                options,
                {},
                {},
                16,
                nullptr};
  survey.inputs = io::files_of_scene(options.files, survey.scene);
  return survey;
}

void find_photographs(Survey& survey, const Context& context) {
  read_headers(survey);
  check_sizes(survey, context);
  choose_masks(survey, context);
  find_colors(survey);
  find_bit_depth(survey, context);
  survey.add_inputs(photograph_files(survey));
  survey.inputs.push_back(survey.options.views_file);
  if (survey.options.compares_photographs)
    survey.photograph_check = std::make_shared<PhotographCheck>(survey.scene, survey.file());
}

}  // namespace axial::survey
