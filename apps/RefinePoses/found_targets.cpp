// SPDX-License-Identifier: GPL-3.0-or-later
#include "found_targets.h"

#include <algorithm>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "targets/search.h"

namespace axial::apps {
namespace {

std::vector<targets::NamedPhotograph> photographs_of(const io::ColmapModel& model,
                                                     const std::filesystem::path& folder) {
  std::vector<targets::NamedPhotograph> photographs;
  for (const io::ColmapImage& image : model.images) {
    photographs.push_back({folder / image.name, image.name});
    if (!std::filesystem::is_regular_file(photographs.back().file))
      fail("--images {}: has no photograph {}", folder.string(), image.name);
  }
  return photographs;
}

}  // namespace

void find_targets(const Options& options, Input& input, const Context& context) {
  const ControlOptions& control = options.control;
  const std::vector<targets::Family> families = targets::parse_families(control.families);
  const std::vector<targets::Photograph> found =
      search_photographs(photographs_of(input.model, control.images), families, context);
  const auto places = std::ranges::count_if(
      found, [](const targets::Photograph& photograph) { return !photograph.targets.empty(); });
  if (places == 0)
    fail("--targets find: no photograph of {} shows a target of --families {}",
         control.images.string(), control.families);
  log_info("{} of {} photographs show targets", places, found.size());
  make_folder(options.output);
  ControlOptions read = control;
  read.targets = options.output / kFoundTargets;
  targets::write_targets(read.targets, families, found);
  input.control = read_control(read);
}

}  // namespace axial::apps
