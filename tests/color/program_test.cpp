// SPDX-License-Identifier: GPL-3.0-or-later
// RestoreColors, with photographs of SimulateUnderwater.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/atomic_file.h"
#include "base/order_statistics.h"
#include "color/chart.h"
#include "color/transfer.h"
#include "drawn_chart.h"
#include "io/bytes/json.h"
#include "io/cameras/photograph_numbers.h"
#include "io/images/image.h"
#include "support/program_run.h"

namespace axial::color {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

// The model of RestoreColors: a, b and B of red, green and blue.
constexpr const char* kPlainWater = "--water 0.9,0.5,0.3,0.8,0.4,0.3,0.05,0.15,0.2";

class RestoreColors : public axial::test::ProgramTest {
 protected:
  // Photographs under water, and the scene with the true surface.
  void photograph(const std::string& light) const {
    succeed_in("SimulateUnderwater",
               "--preset reef --coarseness 4 --views 8 --width 320 --height 240 --samples 1 "
               "--process-priority 0 "
               "--medium water -o . " +
                   light);
    succeed_in("InterfaceCOLMAP", "-i . --image-folder water --housing housing.json -o scene.mvs");
  }

  std::string restore(const std::string& options = "") const {
    return succeed_in(
        "RestoreColors",
        "-i scene.mvs -m mesh.ply --refractive -o restored --process-priority 0 " + options);
  }

  // The median angle [degrees] between the photographs' light and the surface's true colour, with
  // known white.
  double angle(const std::string& photographs) const {
    std::vector<cv::Vec3f> lights, truths;
    for (int i = 0; i < 8; ++i) {
      const std::string name = fmt::format("{:04}", i);
      cv::Mat light =
          light_of(io::read_photograph(folder_ / photographs / (name + ".jpg")).pixels, 8, {});
      cv::Mat truth;
      cv::cvtColor(
          cv::imread((folder_ / "water" / (name + ".albedo.tiff")).string(), cv::IMREAD_UNCHANGED),
          truth, cv::COLOR_BGR2RGB);
      cv::resize(light, light, {}, 0.125, 0.125, cv::INTER_AREA);
      cv::resize(truth, truth, light.size(), 0, 0, cv::INTER_AREA);
      lights.insert(lights.end(), light.begin<cv::Vec3f>(), light.end<cv::Vec3f>());
      truths.insert(truths.end(), truth.begin<cv::Vec3f>(), truth.end<cv::Vec3f>());
    }
    for (int k = 0; k < 3; ++k) {
      std::vector<float> ratios;
      for (std::size_t i = 0; i < lights.size(); ++i)
        ratios.push_back(truths[i][k] / std::max(lights[i][k], 1e-4f));
      const float gain = upper_median(std::move(ratios));
      for (cv::Vec3f& light : lights) light[k] *= gain;
    }
    std::vector<double> angles;
    for (std::size_t i = 0; i < lights.size(); ++i)
      angles.push_back(std::acos(
          std::min(1.0, lights[i].dot(truths[i]) / (cv::norm(lights[i]) * cv::norm(truths[i])))));
    return upper_median(std::move(angles)) * 180 / CV_PI;
  }

  nlohmann::json findings() const { return io::read_json(folder_ / "restored" / "colors.json"); }
};

TEST_F(RestoreColors, FindsTheCoefficientsOfPlainWater) {
  photograph(kPlainWater);
  restore("--masks 1");
  const nlohmann::json found = findings();
  EXPECT_EQ(found.at("light"), "sun");
  const std::array<std::pair<const char*, double>, 3> truth{
      {{"red", 0.9}, {"green", 0.5}, {"blue", 0.3}}};
  for (const auto& [name, a] : truth) {
    const nlohmann::json& channel = found.at("channels").at(name);
    // 8 % is the aim for a survey; 0.02 /m more for eight photographs of 320 pixels.
    EXPECT_NEAR(channel.at("a_per_m").at("value"), a, 0.08 * a + 0.02) << name;
    EXPECT_TRUE(channel.at("determined"));
  }
  EXPECT_LT(angle("restored"), 0.5 * angle("water"));
  const cv::Mat mask =
      cv::imread((folder_ / "restored/masks/0000.jpg.png").string(), cv::IMREAD_UNCHANGED);
  EXPECT_EQ(mask.size(), cv::Size(320, 240));
  EXPECT_GT(cv::countNonZero(mask), 0);
}

TEST_F(RestoreColors, TakesTheLampsOutOfThePhotographs) {
  photograph("--water II --light lamp");
  const std::string output = restore();
  EXPECT_THAT(output, HasSubstr("Light: lamp, by the photographs"));
  EXPECT_EQ(findings().at("light"), "lamp");
  // The ratios are 0.24 and 0.44 for photographs of 512 pixels (docs/colors.md, water II); small
  // photographs have more noise.
  EXPECT_LT(findings().at("spread_after"), 0.7 * findings().at("spread_before").get<double>());
  EXPECT_LT(angle("restored"), 0.7 * angle("water"));
  EXPECT_THAT(output, Not(HasSubstr("warning")));
  // Rings of light stay, and a warning names the cause.
  EXPECT_THAT(restore("--light sun"), HasSubstr("is it the light of lamps (--light lamp)"));
}

TEST_F(RestoreColors, WritesTheSameBytesForAnyNumberOfThreads) {
  photograph("--water II --light lamp");
  restore("--points 1000 --max-threads 1");
  fs::rename(folder_ / "restored", folder_ / "alone");
  restore("--points 1000");
  for (const char* name : {"0000.jpg", "0007.jpg", "colors.json"})
    EXPECT_EQ(read_file(folder_ / "alone" / name), read_file(folder_ / "restored" / name)) << name;
}

// A folder in place of a photograph stops the first run.
TEST_F(RestoreColors, GoesOnWhereAStoppedRunEnded) {
  photograph(kPlainWater);
  restore("--points 1000 --masks 1");
  fs::rename(folder_ / "restored", folder_ / "at_once");
  const fs::path unfinished = folder_ / "restored/unfinished";
  const auto stop = [&](const std::string& options) {
    fs::create_directories(unfinished / "0005.jpg");
    expect_refusal("RestoreColors",
                   "-i scene.mvs -m mesh.ply --refractive -o restored -v 0 --points 1000 "
                   "--process-priority 0 " +
                       options,
                   "0005.jpg");
    fs::remove_all(unfinished / "0005.jpg");
  };
  stop("--masks 1");
  EXPECT_FALSE(fs::exists(folder_ / "restored/0000.jpg"));
  EXPECT_THAT(restore("--points 1000 --masks 1"),
              HasSubstr("5 photographs were restored by an earlier run"));
  EXPECT_FALSE(fs::exists(unfinished));
  for (const char* name : {"0000.jpg", "0007.jpg", "masks/0000.jpg.png", "colors.json"})
    EXPECT_EQ(read_file(folder_ / "at_once" / name), read_file(folder_ / "restored" / name))
        << name;

  stop("--masks 1");
  write_atomically(unfinished / "note.txt", "not of the program");
  EXPECT_THAT(restore("--points 1000 --jpeg-quality 90"), Not(HasSubstr("by an earlier run")));
  EXPECT_FALSE(fs::exists(unfinished / "masks"));
  EXPECT_TRUE(fs::exists(unfinished / "note.txt"));
}

// The names of two photographs are exchanged after the first run was stopped.
TEST_F(RestoreColors, TakesNoPhotographOfAnotherView) {
  photograph(kPlainWater);
  fs::create_directories(folder_ / "restored/unfinished/0005.jpg");
  expect_refusal("RestoreColors",
                 "-i scene.mvs -m mesh.ply --refractive -o restored -v 0 --points 1000",
                 "0005.jpg");
  fs::remove_all(folder_ / "restored/unfinished/0005.jpg");
  for (const char* file : {"sparse/images.txt"}) {
    std::string text = read_file(folder_ / file);
    const std::size_t first = text.find("0001.jpg"), second = text.find("0002.jpg");
    ASSERT_NE(first, std::string::npos);
    text.replace(first, 8, "0002.jpg").replace(second, 8, "0001.jpg");
    write_atomically(folder_ / file, text);
  }
  fs::rename(folder_ / "water/0001.jpg", folder_ / "water/0009.jpg");
  fs::rename(folder_ / "water/0002.jpg", folder_ / "water/0001.jpg");
  fs::rename(folder_ / "water/0009.jpg", folder_ / "water/0002.jpg");
  succeed_in("InterfaceCOLMAP", "-i . --image-folder water --housing housing.json -o scene.mvs");
  restore("--points 1000");
  fs::rename(folder_ / "restored", folder_ / "after");
  restore("--points 1000");
  for (const char* name : {"0000.jpg", "0001.jpg", "0002.jpg", "0007.jpg"})
    EXPECT_EQ(read_file(folder_ / "after" / name), read_file(folder_ / "restored" / name)) << name;
}

TEST_F(RestoreColors, MakesTheGreyPatchGrey) {
  photograph(kPlainWater);
  restore("--grey 0003.jpg:150,110,24,24");
  const cv::Mat pixels = io::read_photograph(folder_ / "restored/0003.jpg").pixels;
  const cv::Scalar light = cv::mean(light_of(pixels, 8, {})(cv::Rect(150, 110, 24, 24)));
  EXPECT_NEAR(light[0] / light[1], 1, 0.05);
  EXPECT_NEAR(light[2] / light[1], 1, 0.05);
  EXPECT_EQ(findings().at("white"), "grey patch");
}

// Draws a chart into a photograph, behind kPlainWater. `cast`: its light in white light, as a share
// of that of a chart. Returns where it is.
cv::Matx33d draw_chart_behind_water(const fs::path& folder, const std::string& name,
                                    const Eigen::Array3f& cast) {
  const cv::Mat1f way =
      cv::imread((folder / (name + ".distance.tiff")).string(), cv::IMREAD_UNCHANGED);
  cv::Mat3f chart(way.size(), cv::Vec3f(-1, -1, -1));
  const cv::Matx33d map = test::place_chart({160, 120}, 200, 15, 0.05);
  test::draw_chart(map, chart);
  const fs::path file = folder / (name + ".jpg");
  cv::Mat pixels = io::read_photograph(file).pixels;
  const Eigen::Array3f a(0.9f, 0.5f, 0.3f), b(0.8f, 0.4f, 0.3f), veil(0.05f, 0.15f, 0.2f);
  for (int y = 0; y < way.rows; ++y)
    for (int x = 0; x < way.cols; ++x) {
      const cv::Vec3f& albedo = chart(y, x);
      if (albedo[0] < 0) continue;
      const Eigen::Array3f surface = Eigen::Array3f(albedo[0], albedo[1], albedo[2]) * cast;
      const Eigen::Array3f light =
          surface * (-a * way(y, x)).exp() + veil * (1 - (-b * way(y, x)).exp());
      for (int k = 0; k < 3; ++k)
        pixels.at<cv::Vec3b>(y, x)[2 - k] =
            cv::saturate_cast<uchar>(255 * Transfer().value(light[k]));
    }
  io::write_jpeg(file, pixels, 98);
  return map;
}

// CIEDE2000 of a chart with its own white, as it is in the photograph.
double chart_error_in(const fs::path& photograph, const cv::Matx33d& map) {
  const cv::Mat3f seen = light_of(io::read_photograph(photograph).pixels, 8, {});
  PatchLights lights;
  for (std::size_t i = 0; i < kPatches; ++i) {
    const cv::Vec3f light = seen(cv::Point(test::mapped(map, test::middle_of_patch(i))));
    lights[i] = {light[0], light[1], light[2]};
  }
  return chart_error(lights, gain_of(lights));
}

TEST_F(RestoreColors, TakesWhiteFromAColourChart) {
  photograph(kPlainWater);
  const Eigen::Array3f cast(0.9f, 0.6f, 0.5f);
  const cv::Matx33d map = draw_chart_behind_water(folder_ / "water", "0003", cast);
  restore("--light sun --chart 0003.jpg --jpeg-quality 98");
  EXPECT_EQ(findings().at("white"), "charts");
  const nlohmann::json charts = findings().at("charts");
  ASSERT_EQ(charts.size(), 1U);
  EXPECT_EQ(charts[0].at("photograph"), "0003.jpg");
  EXPECT_LT(charts[0].at("ciede2000"), 0.5 * chart_error_in(folder_ / "water/0003.jpg", map));
  const cv::Mat3f restored =
      light_of(io::read_photograph(folder_ / "restored/0003.jpg").pixels, 8, {});
  const cv::Point grey(test::mapped(map, test::middle_of_patch(20)));
  // The gain is the median of five grey patches, which differ by the errors of the veil: 0.02 of
  // the light of 0.36 of this patch. Values of 8 bits and JPEG add 0.02.
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(restored(grey)[k] / chart_colors()[20][k], 1, 0.1) << k;
  expect_refusal("RestoreColors",
                 "-i scene.mvs -m mesh.ply --refractive -v 0 -o other --chart 0001.jpg",
                 "no chart of 24 patches was found in this photograph");

  draw_chart_behind_water(folder_ / "water", "0005", cast / 2);  // in a shadow
  EXPECT_THAT(restore("--light sun --chart all"),
              HasSubstr("the chart in 0005.jpg gives a white that differs"));
  EXPECT_EQ(findings().at("charts").size(), 2U);
}

// The exposures are within a stop of the right one; the curve of the camera is not that of sRGB.
TEST_F(RestoreColors, FindsTheCurveOfTheCameraByExposures) {
  photograph(std::string(kPlainWater) + " --exposure-stops 0.7 --response linear");
  EXPECT_THAT(restore("--light sun"), HasSubstr("differ in exposure"));
  const std::string output = restore("--light sun --exposures water/exposures.csv");
  EXPECT_THAT(output, HasSubstr("The curve of the camera is "));
  EXPECT_THAT(output, Not(HasSubstr("differ in exposure")));
  EXPECT_EQ(findings().at("curve_from"), "exposures");
  EXPECT_EQ(findings().at("exposure"), "given");
  const std::string curve = findings().at("curve");
  // Powers are tried in steps of up to 2 %. Small photographs in JPEG add about as much.
  EXPECT_NEAR(Transfer::parse(curve).gamma().value_or(0), 1, 0.05) << curve;
  // The found curve gives the same photographs as if it was given.
  fs::rename(folder_ / "restored", folder_ / "found");
  restore("--light sun --exposures water/exposures.csv --curve " + curve);
  EXPECT_EQ(read_file(folder_ / "found/0003.jpg"), read_file(folder_ / "restored/0003.jpg"));
}

TEST_F(RestoreColors, KeepsTheCurveOfSrgbWhereExposuresAgree) {
  photograph(std::string(kPlainWater) + " --exposure-stops 0.7");
  const fs::path file = folder_ / "water/exposures.csv";
  EXPECT_THAT(restore("--light sun --exposures water/exposures.csv"),
              HasSubstr("The curve of the camera is srgb, by the exposures"));
  EXPECT_EQ(findings().at("curve"), "srgb");
  const nlohmann::json red = findings().at("channels").at("red");
  EXPECT_NEAR(red.at("a_per_m").at("value"), 0.9, 0.08 * 0.9 + 0.02);

  const auto refuses = [&](const std::string& text, const std::string& expected) {
    write_atomically(file, text);
    expect_refusal("RestoreColors",
                   "-i scene.mvs -m mesh.ply --refractive -v 0 -o other "
                   "--exposures water/exposures.csv",
                   expected);
  };
  refuses("0000.jpg,1\n", "has no exposure of the photograph 0001.jpg");
  refuses("0000.jpg,1\nwater/0000.jpg,2\n", "two lines are for the photograph 0000.jpg");
  refuses("0000.jpg,0\n", "the exposure of 0000.jpg is 0, but must be above 0");
}

// The light of a flash does not depend on the exposure time.
TEST_F(RestoreColors, UsesNoExposuresThatTheLightContradicts) {
  photograph(kPlainWater);
  std::string lines;
  for (int i = 0; i < 8; ++i) lines += fmt::format("{:04}.jpg,{}\n", i, i % 2 == 0 ? 1 : 2);
  write_atomically(folder_ / "flash.csv", lines);
  EXPECT_THAT(restore("--light sun --exposures flash.csv"),
              HasSubstr("agrees better without these exposures: they are not used"));
  EXPECT_EQ(findings().at("exposure"), "one");
  EXPECT_EQ(findings().at("curve_from"), "assumption");
  const nlohmann::json red = findings().at("channels").at("red");
  EXPECT_NEAR(red.at("a_per_m").at("value"), 0.9, 0.08 * 0.9 + 0.02);
}

// With heights, the surface becomes as bright as if it was level; a known type is used.
TEST_F(RestoreColors, RemovesTheLossOfDaylightByDepth) {
  photograph("--water IB");
  const std::string without = restore();
  EXPECT_THAT(without, HasSubstr("heights are not known"));
  EXPECT_FALSE(findings().at("channels").at("red").contains("daylight_per_m"));
  restore("--up 0,0,1 --assume jerlov-IB");
  EXPECT_EQ(findings().at("water_type"), "jerlov-IB");
  EXPECT_NEAR(findings().at("channels").at("red").at("daylight_per_m").at("value"), 0.22, 0.05);
  EXPECT_EQ(findings().at("brightness_by_way").size(), 12U);
}

TEST_F(RestoreColors, RefusesWhatIsWrongInOneLine) {
  photograph("--water 3C");
  const std::string scene = "-i scene.mvs -m mesh.ply --refractive -v 0 --process-priority 0 ";
  expect_refusal("RestoreColors", scene, "no output folder given");
  expect_refusal("RestoreColors", scene + "-o restored --curve log", "curve is 'log'");
  expect_refusal("RestoreColors", scene + "-o restored --exposures x.csv --exposure each",
                 "give one of them");
  expect_refusal("RestoreColors", scene + "-o restored --grey 0000.jpg:1,2,3",
                 "must be IMAGE:X,Y,WIDTH,HEIGHT");
  expect_refusal("RestoreColors", scene + "-o restored --grey none.jpg:1,2,3,4",
                 "no photograph has this name");
  expect_refusal("RestoreColors", scene + "-o restored --grey 0000.jpg:310,1,30,4",
                 "lies outside the photograph of 320 x 240 pixels");
  expect_refusal("RestoreColors", scene + "-o restored --grey 7.jpg:1,2,3,4",
                 "no photograph has this name");
  expect_refusal("RestoreColors", scene + "-o restored --grey 0007.jpg:1.5,2,3,4",
                 "must be IMAGE:X,Y,WIDTH,HEIGHT");
  expect_refusal("RestoreColors", scene + "-o restored --chart none.jpg",
                 "--chart none.jpg: no photograph has this name");
  expect_refusal("RestoreColors", scene + "-o restored --chart all --grey 0000.jpg:1,2,3,4",
                 "give one of them");
  expect_refusal("RestoreColors", scene + "-o water", "--output");
  expect_refusal("RestoreColors", scene + "-o restored --up 0,0,0", "up 0,0,0: is no direction");
  expect_refusal("RestoreColors", scene + "-o restored --assume jerlov-2C", "assume");
  EXPECT_FALSE(fs::exists(folder_ / "restored" / "0000.jpg"));
}

}  // namespace
}  // namespace axial::color
