// SPDX-License-Identifier: GPL-3.0-or-later
// Brings a COLMAP model to the scale and place of a reference model with known centres.

#include <numbers>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "base/naming.h"
#include "base/program/program.h"
#include "base/same_file.h"
#include "base/version.h"
#include "diagnosis/import_check.h"
#include "evaluate/alignment.h"
#include "io/cameras/geo_offset.h"
#include "io/colmap/colmap.h"
#include "io/colmap/colmap_frame.h"
#include "io/colmap/colmap_scene.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

struct Options {
  ParsedOptions parsed;
  fs::path model, reference, output;
};

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  ProgramOptions program{"AlignModel",
                         "aligns a COLMAP model to known camera centres in metres, by a similarity",
                         {},
                         {}};
  program.version = version_line(program.name);
  program.visible.add("input-file,i", &options.model, "COLMAP model folder to align")
      .add("reference", &options.reference,
           "COLMAP model folder with the known camera centres; images are matched by name")
      .required("the model with the known camera centres")
      .add("output-folder,o", &options.output, "folder for the aligned model (COLMAP text)")
      .output_folder()
      .required("");
  options.parsed = parse_options(argc, argv, program);
  return options;
}

evaluate::CentreAlignment align(const io::ColmapModel& model, const io::ColmapModel& reference,
                                const fs::path& folder) {
  return naming(folder, [&] { return evaluate::align_centres(model, reference); });
}

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  const Context context = program_context(options.parsed);
  const fs::path folder = io::find_colmap_model(options.model, context);
  const fs::path reference_folder = io::find_colmap_model(options.reference, context);
  io::ColmapModel model = io::read_colmap_model(folder, context);
  auto reference = io::read_colmap_model(reference_folder, context);
  require_not_an_input(options.output, std::vector{folder, reference_folder}, "--output-folder");
  io::require_no_binary_model(options.output);
  require_writable_folder(options.output);
  io::enter_local_frame(model);
  const LocalFrame frame = io::enter_local_frame(reference);
  const evaluate::CentreAlignment alignment = align(model, reference, options.model);
  evaluate::apply(alignment.similarity, model);
  const io::Housing carried = io::housing_of(model.cameras);
  if (!carried.ports.empty())
    if (const auto line = diagnosis::import_warning(model, carried, {}, context))
      log_warning("{}", *line);
  io::leave(frame, model);
  write_folder(options.output,
               [&](const fs::path& staging) { io::write_colmap_text(staging, model); });
  for (const std::string& line : evaluate::not_matched(alignment, reference))
    log_warning("--reference {}: {}", options.reference.string(), line);
  for (const std::string& line : alignment.outliers)
    log_warning("--reference {}: {}", options.reference.string(), line);
  log_info("{} of {} images have a known centre, scale {:.9g}", alignment.names.size(),
           model.images.size(), alignment.similarity.scale);
  log_info("Centre residuals: RMS {:.3f} mm, largest {:.3f} mm", alignment.rms_of_fitting * 1e3,
           alignment.largest * 1e3);
  log_info("Rotation residuals: largest {:.4f} degrees",
           alignment.largest_turn * 180 / std::numbers::pi);
  log_info("Aligned model in {}", options.output.string());
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("AlignModel", [&] { return axial::apps::run(argc, argv); });
}
