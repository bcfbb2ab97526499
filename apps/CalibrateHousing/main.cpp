// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "base/same_file.h"
#include "calibrate/coverage.h"
#include "calibrate/photographs.h"
#include "io/cameras/housing.h"
#include "io/colmap/calibmar.h"
#include "io/colmap/other_ports.h"
#include "options.h"
#include "report.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

io::ColmapCamera load_lens(const fs::path& path, const Context& context) {
  const std::vector<io::ColmapCamera> cameras = io::read_colmap_cameras(path, context);
  if (cameras.size() != 1)
    fail_in(path, "has {} cameras, expected one: the camera to calibrate", cameras.size());
  return cameras.front();
}

// The name of the port to calibrate: --port, or the port of the lens's camera. A calibration.yaml
// does not tell the camera's id.
std::string port_to_calibrate(const Options& options, const io::Housing& housing,
                              const io::ColmapCamera& lens) {
  if (!options.port.empty()) return options.port;
  if (housing.ports.size() > 1 && io::is_calibmar(options.lens))
    fail("--port is missing: {} has {} ports", options.housing.string(), housing.ports.size());
  return housing.port_of("", lens.id);
}

// The housing before the calibration.
io::Housing load_housing(const Options& options, const io::ColmapCamera& lens,
                         const Context& context) {
  if (options.housing.empty()) {
    if (!lens.port) fail("--housing is missing: the approximate port");
    return io::housing_with(io::to_housing_port(*lens.port));
  }
  io::Housing housing = io::read_housing(options.housing, io::PortValues::checked, context);
  io::refuse_water_surfaces(housing, options.housing);
  return housing;
}

refractive::Port<double> known_port(const Options& options, const io::Housing& housing,
                                    const std::string& name, std::uint32_t camera) {
  if (!options.port.empty() && !housing.ports.contains(name))
    fail("--port {}: {} has no such port", name, options.housing.string());
  const auto port = housing.carried_port(name);
  if (!port)
    fail_in(options.housing, "camera {} is behind port 'none', expected the port to calibrate",
            camera);
  return *port;
}

// Error for a limit of a number that is not adjusted, or that the port does not have.
void check_limits(const Options& options, const refractive::Port<double>& port) {
  const auto& free = options.calibrate.adjust.free;
  const bool dome = std::holds_alternative<refractive::DomePort<double>>(port);
  constexpr std::size_t kTilt = 0, kDistance = 2;
  const std::pair<const char*, bool> limits[] = {
      {"max-normal-sigma", !dome && free[kTilt]},
      {"max-distance-sigma", free[kDistance]},
      {"max-index-sigma", free[pose::kIndexNumber]},
      {"max-thickness-sigma", free[pose::kThicknessNumber]}};
  for (const auto& [name, used] : limits)
    if (!used && given(options.parsed, name))
      fail("--{}: limits a value that {} does not name", name, "--refine " + options.refine_list);
}

// Sets the unknowns of `options`.
void set_unknown(Options& options, const refractive::Port<double>& port) {
  if (options.refine_list.empty()) options.refine_list = pose::place_words(port);
  pose::Bundle camera;
  camera.cameras.resize(1);
  camera.cameras[0].measured.port = port;
  pose::AdjustOptions& adjust = options.calibrate.adjust;
  adjust.points_known = true;
  pose::set_free_numbers(options.refine_list, options.sigmas, camera, adjust);
  check_limits(options, port);
  if (adjust.free[pose::kFocalNumber])
    fail("--refine {}: the focal length cannot be refined, it stays as calibrated in air",
         options.refine_list);
}

// Called before the work.
void check_outputs(const Options& options, std::vector<fs::path> inputs) {
  inputs.insert(inputs.end(), {options.lens, options.housing});
  const std::pair<const char*, const fs::path&> outputs[] = {{"--output-file", options.output},
                                                             {"--calibmar", options.calibmar},
                                                             {"--report", options.report},
                                                             {"--coverage", options.coverage}};
  for (const auto& [option, path] : outputs) {
    if (path.empty()) continue;
    require_not_an_input(path, inputs, option);
    require_writable(path);
  }
}

void warn(const calibrate::Calibration& calibration) {
  for (const auto& [image, reason] : calibration.left_out)
    log_warning("{}: left out: {}", image, reason);
  for (const std::string& gap : calibrate::gaps(calibration))
    log_warning("No photograph shows {}", gap);
}

std::vector<std::string> comments_for(const std::vector<std::string>& lines) {
  std::vector<std::string> comments{"By CalibrateHousing of AxialMVS."};
  comments.insert(comments.end(), lines.begin(), lines.end());
  return comments;
}

// The standard deviations of the calibrated port: those of the adjusted numbers, and those of the
// other numbers as `housing` states them.
io::PortSigmas sigmas_of(const calibrate::Calibration& calibration, const io::Housing& housing,
                         const std::string& port_name) {
  pose::Bundle bundle = calibration.bundle.bundle;
  bundle.cameras[0].stated_sigma =
      pose::stated_sigma(calibration.bundle.lenses[0], housing, port_name);
  const auto sigmas = pose::present_sigmas(bundle, calibration.adjust, &calibration.uncertainty);
  return pose::port_sigmas(*calibration.camera().measured.port, sigmas[0]);
}

// Writes report and drawing always, since they show what is missing, and the port only if it is
// precise enough.
void write(const Options& options, const calibrate::Calibration& calibration, io::Housing housing,
           const std::string& port_name, const std::vector<std::string>& lines) {
  if (!options.report.empty())
    write_atomically(options.report, report_json(calibration, options.limits));
  if (!options.coverage.empty())
    write_atomically(options.coverage, calibrate::coverage_svg(calibration));
  calibrate::require_known(calibration, options.limits);
  if (!calibration.last.converged)
    fail(
        "not converged after {} iterations: check the board, the lens calibrated in air and the "
        "kind of port",
        calibration.last.iterations);
  const refractive::Port<double> port = *calibration.camera().now().port;
  io::check_port(port, "The calibrated port");
  housing.sigmas[port_name] = sigmas_of(calibration, housing, port_name);
  housing.ports[port_name] = io::to_housing_port(port);
  if (options.calibmar.empty()) return io::write_housing(options.output, housing);
  io::ColmapCamera camera = calibration.bundle.lenses[0];
  camera.port = port;
  write_together({options.calibmar, options.output}, [&](const std::vector<fs::path>& files) {
    io::write_calibmar(files[0], camera, comments_for(lines));
    io::write_housing(files[1], housing);
  });
}

int run(int argc, char** argv) {
  Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  const Context context = program_context(options.parsed);
  const io::ColmapCamera lens = load_lens(options.lens, context);
  const io::Housing housing = load_housing(options, lens, context);
  const std::string port_name = port_to_calibrate(options, housing, lens);
  const refractive::Port<double> port = known_port(options, housing, port_name, lens.id);
  if (lens.port && !io::same_port(io::to_housing_port(*lens.port), io::to_housing_port(port)))
    log_warning("The port of {} is used; the port of {} differs and is ignored",
                options.housing.string(), options.lens.string());
  set_unknown(options, port);
  const std::vector<fs::path> photographs = calibrate::photographs_in(options.input);
  check_outputs(options, photographs);
  const auto views =
      calibrate::find_views(photographs, options.board, lens, options.bit_depth, context);
  const auto calibration = calibrate::calibrate(
      lens, port, views, calibrate::corners_of(options.board), options.calibrate);
  const std::vector<std::string> lines = report_lines(calibration, port_name);
  for (const std::string& line : lines) log_info("{}", line);
  warn(calibration);
  write(options, calibration, housing, port_name, lines);
  log_info("Housing in {}", options.output.string());
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("CalibrateHousing", [&] { return axial::apps::run(argc, argv); });
}
