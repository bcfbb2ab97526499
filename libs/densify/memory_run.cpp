// SPDX-License-Identifier: GPL-3.0-or-later
// The run from a survey in memory is a run of files, whose photographs and scene are in memory.
#include <cstdlib>
#include <memory>
#include <string>

#include "axial/densify.h"
#include "base/error.h"
#include "io/ply/ply.h"
#include "scene/local_frame.h"

namespace axial::densify {
namespace {

namespace fs = std::filesystem;

// A new folder in the system's folder of temporary files, which the destructor removes.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_((fs::temp_directory_path() / "axial_densify_XXXXXX").string()) {
    if (!::mkdtemp(path_.data())) fail_in(path_, "cannot be made");
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  fs::path path() const { return path_; }

 private:
  std::string path_;
};

void check_options(const Options& options) {
  if (!options.job_as<WholeRun>()) fail("job: a survey in memory needs a WholeRun");
  if (const fs::path& folder = options.output.pinhole_export; !folder.empty())
    fail("{} {}: needs the files of photographs, and the survey is in memory",
         setting("pinhole_export"), folder.string());
}

MemoryResult run_in(const fs::path& folder, Options& options, const Context& context) {
  options.survey.files.scene = "survey in memory";  // for messages; there is no such file
  options.survey.files.housing.clear();
  options.survey.files.working_folder = folder;
  options.survey.has_masks = false;
  if (options.output.scene.empty()) options.output.scene = folder / "dense.mvs";
  MemoryResult result;
  result.report = densify(options, {}, context);
  result.frame = frame_of(options.survey.memory_survey->scene);
  result.cloud = io::read_cloud_ply(result.report.cloud, result.frame);
  return result;
}

}  // namespace

MemoryResult densify(survey::MemorySurvey survey, Options options, const Context& context) {
  check_options(options);
  options.survey.memory_survey = std::make_shared<const survey::MemorySurvey>(std::move(survey));
  const fs::path folder = options.survey.files.working_folder;
  if (!folder.empty()) return run_in(folder, options, context);
  const TemporaryFolder temporary;
  MemoryResult result = run_in(temporary.path(), options, context);
  if (options.output.scene.parent_path() == temporary.path()) result.report.cloud.clear();
  return result;
}

}  // namespace axial::densify
