// SPDX-License-Identifier: GPL-3.0-or-later
// A survey: a scene with its frame, housing and lenses, and the photographs of the scene. Every
// program that works on a scene opens the scene here, once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "axial/survey.h"
#include "base/context.h"
#include "geometry/posed_camera.h"
#include "io/images/image.h"
#include "io/openmvs/scene_with_cameras.h"
#include "survey/photograph_check.h"

namespace axial::survey {

// A photograph that is used. Its camera has the resolution at which the photograph is read, and its
// pose is in the frame of the survey.
struct View {
  CameraModel camera;
  Pose pose;
  std::size_t image = 0;               // index into Scene::images
  std::uint32_t id = 0;                // SceneImage::id, or the index of the image if that is kNoId
  std::filesystem::path file;          // the photograph; of a survey in memory: SceneImage::path
  io::ImageHeader header;              // of the photograph
  std::filesystem::path mask;          // file of the mask; empty: none
  std::filesystem::path colors = {};   // file of Options::color_folder; empty: the photograph
  io::ImageHeader colors_header = {};  // of `colors`

  // The number of pixels of the camera.
  std::uint64_t pixels() const {
    return static_cast<std::uint64_t>(camera.width) * static_cast<std::uint64_t>(camera.height);
  }

  // Whether pixels may be left out because of a mask or of transparency.
  bool masked() const { return !mask.empty() || header.alpha; }

  // The memory [bytes] to decode the photograph, or the file of its colours if that needs more.
  std::uint64_t decoding_bytes() const;
};

// A program that no longer needs the scene may replace `scene` by an empty one, to free its memory.
struct Survey : io::SceneWithCameras {
  Options options;
  std::vector<std::filesystem::path> inputs;  // files that are read; a path may be empty
  // The next three are filled by find_photographs().
  std::vector<View> views;
  int bit_depth = 16;  // number of bits that the values of 16-bit photographs use, 8 to 16
  // Compares the photographs with each other while they are read, to report photographs that do not
  // belong to the scene. Null: Options::compares_photographs is false.
  std::shared_ptr<PhotographCheck> photograph_check;

  const std::filesystem::path& file() const { return options.files.scene; }

  // Adds files that the program reads.
  void add_inputs(std::span<const std::filesystem::path> files);

  // keep_inputs() for `inputs`.
  void keep_inputs(std::span<const std::filesystem::path> outputs,
                   const std::string& setting) const;
};

// Error if one of `outputs` is one of `inputs` or cannot be written. `setting`: the setting that
// gives the outputs, for messages.
void keep_inputs(std::span<const std::filesystem::path> outputs,
                 std::span<const std::filesystem::path> inputs, const std::string& setting);

// Sets what is left out by the label of a program whose label -1 means black borders, and whose
// labels below -1 mean that all pixels are used.
void use_mask_label(Options& options, int label);

// Reads the scene with its frame, lenses and ports, or takes Options::memory_survey, of which it
// checks check() and makes a copy. No photograph is read. `inputs` are the files that belong to the
// scene (io::files_of_scene). Errors as for io::read_scene_with_cameras(), and for too little
// memory.
Survey open_scene(const Options& options, const Context& context = {});

// Finds the photographs and their masks, and reads the headers of the photographs. All calibrated
// images are used, or only the images that Options::views_file names. Photographs, masks and the
// views file are added to Survey::inputs, and so are the files of colours. Photographs of more than
// 8 bits may be decoded, to find the bit depth. Error for
// - a photograph that is missing, or has another shape than its camera
//   (io::check_photograph_sizes),
// - a missing mask in Options::mask_folder,
// - a photograph without a file in Options::color_folder, or one of another size (find_colors()),
// - a line of the views file that names no image,
// - a scene without an image to use.
void find_photographs(Survey& survey, const Context& context);

// The photographs, masks and colours of the views. A path may be empty.
std::vector<std::filesystem::path> photograph_files(const Survey& survey);

// The cameras of `survey.views`.
std::vector<geometry::PosedCamera> posed_cameras(const Survey& survey);

}  // namespace axial::survey
