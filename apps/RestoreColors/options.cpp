// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <array>

#include "base/error.h"
#include "base/memory.h"
#include "base/parse_number.h"
#include "base/program/option_values.h"
#include "base/split.h"
#include "base/version.h"
#include "io/images/bit_depth.h"
#include "io/openmvs/scene_files.h"
#include "io/openmvs/scene_options.h"
#include "map/up_direction.h"
#include "survey/photograph_options.h"

namespace axial::apps {
namespace {

// The values of the command line before they are checked and converted.
struct Raw {
  std::string input, light = "auto", curve = "auto", grey, up, assumed, exposure = "one";
  io::SceneOptions scene;
};

GreyPatch grey_of(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  GreyPatch grey{text.substr(0, colon), {}};
  std::array<int, 4> numbers{};
  std::size_t count = 0;
  if (colon != std::string::npos)
    for (const std::string_view word : split(std::string_view(text).substr(colon + 1), ',')) {
      const auto number = parse_number<int>(word);
      if (!number || *number < 0 || *number > 1000000 || count == numbers.size()) {
        count = 0;
        break;
      }
      numbers[count++] = *number;
    }
  grey.part = {numbers[0], numbers[1], numbers[2], numbers[3]};
  if (count != numbers.size() || grey.part.empty() || grey.image.empty())
    fail("--grey is '{}', but must be IMAGE:X,Y,WIDTH,HEIGHT in pixels", text);
  return grey;
}

void declare(OptionList& list, Raw& raw, Settings& settings) {
  list.add("input-file,i", &raw.input, "scene with cameras and images")
      .add("mesh-file,m", &settings.mesh, "mesh of the scene (<input>.ply)")
      .add("output,o", &settings.output, "folder for the photographs without water (required)")
      .output_folder()
      .add_with_default("light", &raw.light,
                        "light of the photographs: sun, lamp (lamps that move with the camera), or "
                        "auto: by the photographs")
      .one_of({"auto", "sun", "lamp"})
      .add_with_default("curve", &raw.curve,
                        "how the photographs' values stand for light: srgb, linear, gamma:G, or "
                        "auto: by --exposures if they tell it, otherwise srgb")
      .add_with_default(
          "exposure", &raw.exposure,
          "one: all photographs have the same exposure and white balance; each: every "
          "photograph has its own, which is estimated")
      .one_of({"one", "each"})
      .add("exposures", &settings.exposures,
           "file with a line NAME,EXPOSURE for each photograph: the exposure time by the "
           "sensitivity over the square of the f-number, in any unit")
      .add("grey", &raw.grey,
           "a part of a photograph that is grey in white light: IMAGE:X,Y,WIDTH,HEIGHT [px] "
           "(default: the seabed is grey in the mean)")
      .add("chart", &settings.chart,
           "white by a colour chart of 24 patches: the end of the path of a photograph that "
           "shows it, or all: it is looked for in all photographs")
      .add("assume", &raw.assumed,
           "type of water, for channels that the photographs do not determine in daylight")
      .one_of({"jerlov-I", "jerlov-IA", "jerlov-IB", "jerlov-II", "jerlov-III", "jerlov-1C",
               "jerlov-3C", "jerlov-5C", "jerlov-7C", "jerlov-9C"})
      .add("up", &raw.up,
           "direction of the heights in the world, X,Y,Z: daylight's loss by depth is removed, too "
           "(default: z if the scene has an offset, otherwise heights are not known)")
      .add_with_default("points", &settings.observe.points,
                        "points of the surface whose colours are compared between photographs")
      .range(100, 10000000)
      .add_max_memory(64 * kMegabyte)
      .add_with_default("jpeg-quality", &settings.jpeg_quality, "JPEG quality, 1 to 100")
      .range(1, 100)
      .add_with_default("masks", &settings.masks,
                        "also write masks/, with 0 for pixels whose colour is not determined");
  survey::declare_masks(list, settings.survey);
  io::declare_bit_depth(list, settings.survey.bit_depth);
  io::declare_scene_options(list, raw.scene);
}

void take_exposure(const Raw& raw, Options& options) {
  Settings& settings = options.settings;
  if (raw.exposure == "each") settings.exposure = ExposureKind::each;
  if (settings.exposures.empty()) return;
  if (given(options.parsed, "exposure"))
    fail("--exposure and --exposures both say what the exposures are; give one of them");
  settings.exposure = ExposureKind::given;
}

void convert(const Raw& raw, Options& options) {
  Settings& settings = options.settings;
  settings.survey.files = io::scene_files(raw.scene, raw.input, options.parsed);
  if (settings.mesh.empty()) settings.mesh = io::cloud_beside(settings.survey.files.scene);
  if (settings.output.empty()) fail("no output folder given (-o DIR)");
  if (raw.light == "sun") settings.light = color::Light::sun;
  if (raw.light == "lamp") settings.light = color::Light::lamp;
  if (raw.curve != "auto") settings.curve = color::Transfer::parse(raw.curve);
  take_exposure(raw, options);
  settings.up = map::parse_up(raw.up, 0);
  if (!raw.assumed.empty()) settings.assumed = color::parse_water_type(raw.assumed);
  if (!raw.grey.empty()) settings.grey = grey_of(raw.grey);
  if (settings.grey && !settings.chart.empty())
    fail("--grey and --chart both give white; give one of them");
  survey::take_masks(options.parsed, settings.survey);
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  options.settings.survey.resolution = {0, 1, 1 << 20};
  Raw raw;
  ProgramOptions program{"RestoreColors",
                         "gives photographs the colours that they have without water",
                         OptionList("Colour options")};
  program.version = version_line(program.name);
  declare(program.visible, raw, options.settings);
  options.parsed = parse_options(argc, argv, program);
  if (options.parsed.run) convert(raw, options);
  return options;
}

}  // namespace axial::apps
