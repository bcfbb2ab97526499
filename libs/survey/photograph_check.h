// SPDX-License-Identifier: GPL-3.0-or-later
// Checks that the photographs of a scene are its own.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "base/context.h"
#include "scene/scene.h"
#include "survey/photograph_agreement.h"

namespace axial::survey {

// Looks at the photographs of a scene while a program reads them, and then reports the photographs
// that do not belong to it.
//
// Measured on correct scenes of all presets and cameras, and on the photographs of a fountain,
// PhotographFacts::agreement is at least 0.74. Two photographs whose names were exchanged have at
// most 0.1, and the photographs that share most of their points with these two at least 0.25.
class PhotographCheck {
 public:
  // `scene` is not used afterwards. `scene_file`: its file, for messages.
  PhotographCheck(const Scene& scene, std::filesystem::path scene_file);

  // Takes the photograph of an image, as PhotographSamples::take().
  void take(std::size_t image, const cv::Mat3b& pixels) { samples_.take(image, pixels); }
  void take(std::size_t image, const cv::Mat1b& grey) { samples_.take(image, grey); }

  // Warns of each photograph, by its name, that is blank, or that has 100 samples and an agreement
  // below 0.15. If more than half of the photographs that can be judged are such photographs, one
  // warning names the scene instead: its photographs, lenses or ports may be wrong. Error if more
  // than half of the photographs that were taken are blank. Call this after the photographs were
  // taken and before outputs are written.
  void report(const Context& context) const;

 private:
  PhotographSamples samples_;
  std::filesystem::path scene_file_;
  std::vector<std::string> names_;
};

}  // namespace axial::survey
