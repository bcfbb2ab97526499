// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/survey_call.h"

#include <pybind11/stl/filesystem.h>

#include <memory>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "scene/local_frame.h"
#include "src/records.h"

namespace axial::python {
namespace {

io::Photograph photograph_of(const SurveyCall& call, std::size_t image) {
  const py::gil_scoped_acquire locked;
  io::Photograph photograph;
  const cv::Mat3b rgb = image_argument<cv::Vec3b>(call.photographs(image), "photograph");
  if (!rgb.empty()) cv::cvtColor(rgb, photograph.pixels, cv::COLOR_RGB2BGR);
  if (!call.masks.is_none())
    photograph.opaque = image_argument<std::uint8_t>(call.masks(image), "mask");
  return photograph;
}

}  // namespace

survey::MemorySurvey memory_survey(const SurveyCall& call) {
  const auto fields = call.scene.cast<py::dict>();
  survey::MemorySurvey survey;
  survey.scene = to_scene(fields);
  enter({-frame_of(fields).origin}, survey.scene);  // back into the world
  survey.read = [&call](std::size_t image) { return photograph_of(call, image); };
  survey.has_masks = !call.masks.is_none();
  return survey;
}

void take_files(const SurveyCall& call, survey::Options& options) {
  options.files.scene = std::filesystem::absolute(call.scene.cast<std::filesystem::path>());
  if (options.files.working_folder.empty())
    options.files.working_folder = options.files.scene.parent_path();
}

void take_survey(const SurveyCall& call, const py::dict& keywords, survey::Options& options) {
  use_given_masks(keywords, options);
  if (!call.in_memory()) return take_files(call, options);
  refuse_in_memory(keywords);
  options.files.scene = "survey in memory";  // for messages
  options.has_masks = false;                 // in files
  options.memory_survey = std::make_shared<const survey::MemorySurvey>(memory_survey(call));
}

void add_survey_keywords(Keywords& keywords, survey::Options& options) {
  using io::PortChoice;
  keywords.add("housing", options.files.housing)
      .add("ports", options.files.ports,
           {{"automatic", PortChoice::automatic},
            {"ignored", PortChoice::ignored},
            {"required", PortChoice::required},
            {"flat", PortChoice::flat}})
      .add("allow_missing", options.files.allow_missing)
      .add("mask_folder", options.mask_folder)
      .add("ignore_mask_label", options.ignore_mask_label, -1, 65535)
      .add("color_folder", options.color_folder)
      .add("match_colors", options.match_colors)
      .add_zero_or("bit_depth", options.bit_depth, 8, 16)
      .add("resolution_level", options.resolution.level, 0, 16)
      .add("resolution_min", options.resolution.min, 1, 1 << 16)
      .add("resolution_max", options.resolution.max, 16, 1 << 16);
}

void refuse_in_memory(const py::dict& keywords, std::initializer_list<const char*> more) {
  std::vector<const char*> names{"housing", "ports", "allow_missing", "mask_folder",
                                 "ignore_mask_label"};
  names.insert(names.end(), more.begin(), more.end());
  for (const char* name : names)
    if (keywords.contains(name)) fail("{}: is only for a scene in a file", setting(name));
}

void use_given_masks(const py::dict& keywords, survey::Options& options) {
  if (!options.mask_folder.empty() && !keywords.contains("ignore_mask_label"))
    options.ignore_mask_label = 0;
}

}  // namespace axial::python
