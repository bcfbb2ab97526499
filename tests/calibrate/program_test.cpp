// SPDX-License-Identifier: GPL-3.0-or-later
// CalibrateHousing with photographs in files.
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "base/atomic_file.h"
#include "calibrate/board_survey.h"
#include "io/bytes/json.h"
#include "io/cameras/housing.h"
#include "io/colmap/calibmar.h"
#include "io/images/image.h"
#include "support/photograph.h"
#include "support/program_run.h"

namespace axial::calibrate {
namespace {

using testing::angle_degrees;
using testing::dome_port;
using testing::flat_port;
using ::testing::HasSubstr;

// Smaller than real photographs, so that drawing takes little time.
const io::ColmapCamera kLens{1, "PINHOLE", 640, 480, {380, 380, 320, 240}};
const std::string kInput = "-i photos --board checkerboard:9x6:0.025 ";

class CalibrateHousing : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write_lens("lens.txt", {kLens});
    write_port("flat.json", flat_port(0, 0.03));
    auto dome = dome_port();
    dome.centre.setZero();
    write_port("dome.json", dome);
  }

  void write_lens(const std::string& name, const std::vector<io::ColmapCamera>& lenses) const {
    std::string text;
    for (const io::ColmapCamera& lens : lenses)
      text += fmt::format("{} {} {} {} {}\n", lens.id, lens.model, lens.width, lens.height,
                          fmt::join(lens.params, " "));
    write_atomically(folder_ / name, text);
  }

  void write_port(const std::string& name, const refractive::Port<double>& port) const {
    io::Housing housing;
    housing.ports["front"] = io::to_housing_port(port);
    housing.default_port = "front";
    io::write_housing(folder_ / name, housing);
  }

  // `grey_noise`: standard deviation of the pixels' noise, in grey levels of 255. `prefix`: of the
  // photographs' names.
  void take_photographs(const refractive::Port<double>& port, const testing::SurveyOptions& options,
                        const Board& board = testing::kBoard, double grey_noise = 0,
                        const std::string& prefix = "") const {
    make_folder(folder_ / "photos");
    const auto taken = testing::survey(kLens, port, options, board);
    cv::RNG random(1);
    for (std::size_t i = 0; i < taken.poses.size(); ++i) {
      cv::Mat1b image = test::photograph(testing::camera_of(kLens, port), taken.poses[i],
                                         test::checkerboard(board.columns, board.rows, board.size));
      cv::Mat1s noise(image.size());
      random.fill(noise, cv::RNG::NORMAL, 0, grey_noise);
      cv::add(image, noise, image, cv::noArray(), CV_8U);
      io::write_png(folder_ / "photos" / (prefix + taken.views[i].image), image);
    }
  }

  // A photograph with a margin around the board.
  static testing::SurveyOptions with_margin(int views) {
    testing::SurveyOptions options{.views = views};
    options.within = {Eigen::Vector2d(0.08, 0.08), Eigen::Vector2d(0.92, 0.92)};
    return options;
  }

  std::string succeed(const std::string& arguments, const std::string& input = kInput) const {
    return succeed_in("CalibrateHousing", input + "--lens lens.txt " + arguments);
  }

  refractive::Port<double> port_in(const std::string& name) const {
    return *io::read_housing(folder_ / name).carried_port("front");
  }
};

// Half a millimetre and 0.05 degrees, with a common board and with noise. The angle of 0.2 px of a
// 3-megapixel camera is 0.062 px here. Pixels with a noise of 10 grey levels of 255, drawn with
// three samples a pixel in each direction, cause somewhat larger errors of corners.
TEST_F(CalibrateHousing, FindsAFlatPortInTwentyFiveNoisyPhotographs) {
  constexpr double kUsualNoise = 0.2;  // [px]
  take_photographs(flat_port(), with_margin(25), testing::kUsualBoard, 10);
  const std::string input = "-i photos --board checkerboard:14x9:0.025 ";
  succeed(
      "--housing flat.json -o housing.json --report report.json --coverage coverage.svg "
      "--calibmar calibration.yaml",
      input);
  const auto port = std::get<refractive::FlatPort<double>>(port_in("housing.json"));
  EXPECT_NEAR(port.distance, 0.025, 0.0005);
  EXPECT_LT(angle_degrees(port.normal, flat_port().normal), 0.05);
  EXPECT_EQ(port.thickness, flat_port().thickness);

  const auto report = io::read_json(folder_ / "report.json");
  EXPECT_EQ(report["photographs"].size(), 25u);
  EXPECT_GT(report["pixel_sigma"].get<double>(),
            kUsualNoise * kLens.params[0] / testing::kUsual.params[0]);
  EXPECT_LT(report["rms_px"].get<double>(), 0.2);
  ASSERT_EQ(report["free"].size(), 3u);
  EXPECT_EQ(report["free"][2]["name"], "distance");
  EXPECT_NEAR(report["free"][2]["value"].get<double>(), 1e3 * port.distance, 1e-6);
  const io::PortSigmas sigmas = io::read_housing(folder_ / "housing.json").sigmas.at("front");
  EXPECT_NEAR(1e3 * sigmas.distance.value(), report["free"][2]["sigma"].get<double>(), 1e-9);
  EXPECT_NEAR(sigmas.normal_degrees.value().x(), report["free"][0]["sigma"].get<double>(), 1e-9);
  EXPECT_EQ(sigmas.index, std::nullopt);
  EXPECT_TRUE(report["missing"].empty()) << report["missing"];
  EXPECT_THAT(read_file(folder_ / "coverage.svg"), HasSubstr("3150 corners in 25 photographs"));

  io::ColmapCamera camera = io::read_calibmar(folder_ / "calibration.yaml");
  EXPECT_EQ(camera.params, kLens.params);
  EXPECT_EQ(std::get<refractive::FlatPort<double>>(*camera.port).distance, port.distance);

  // From a calibration.yaml alone, which has the lens and an initial port, here 5 mm off. Ten
  // photographs determine the distance to 0.3 mm; three times this is allowed.
  std::get<refractive::FlatPort<double>>(*camera.port).distance += 0.005;
  io::write_calibmar(folder_ / "calibration.yaml", camera, {});
  for (int i = 10; i < 25; ++i)
    std::filesystem::remove(folder_ / "photos" / fmt::format("view{}.png", i));
  succeed_in("CalibrateHousing", input + "--lens calibration.yaml -o again.json");
  const auto same = std::get<refractive::FlatPort<double>>(
      io::read_housing(folder_ / "again.json").ports.at("main"));
  EXPECT_NEAR(same.distance, port.distance, 0.001);
}

// Behind the camera's own port, not the default port of the housing.
TEST_F(CalibrateHousing, FindsTheCentreOfADome) {
  take_photographs(dome_port(), with_margin(15));
  io::Housing housing = io::read_housing(folder_ / "dome.json");
  housing.ports["side"] = io::to_housing_port(flat_port());
  housing.default_port = "side";
  housing.cameras[kLens.id] = "front";
  io::write_housing(folder_ / "both.json", housing);
  succeed("--housing both.json -o housing.json");
  const auto side = *io::read_housing(folder_ / "housing.json").carried_port("side");
  EXPECT_EQ(std::get<refractive::FlatPort<double>>(side).distance, flat_port().distance);
  const auto port = std::get<refractive::DomePort<double>>(port_in("housing.json"));
  EXPECT_LT((port.centre - dome_port().centre).norm(), 0.0005);
}

// Expects the numbers of a report within three standard deviations of the truth.
void expect_within_three_sigmas(const nlohmann::json& report,
                                const refractive::FlatPort<double>& port) {
  const Eigen::Vector3d& normal = port.normal;
  const double truth[] = {std::atan2(normal.x(), normal.z()) / testing::kDegree,
                          std::atan2(normal.y(), normal.z()) / testing::kDegree,
                          1e3 * port.distance};
  ASSERT_EQ(report["free"].size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& number = report["free"][i];
    EXPECT_NEAR(number["value"].get<double>(), truth[i], 3 * number["sigma"].get<double>())
        << number["name"];
  }
}

// Boards that the borders of the photographs cut, and one of which nearly nothing is left.
TEST_F(CalibrateHousing, UsesPiecesOfBoards) {
  take_photographs(flat_port(), with_margin(6), testing::kBoard, 5);
  testing::SurveyOptions cut{.views = 8, .nearest = 0.17, .farthest = 0.25, .seed = 3};
  cut.within = {Eigen::Vector2d(-0.3, -0.3), Eigen::Vector2d(1.3, 1.3)};
  take_photographs(flat_port(), cut, testing::kBoard, 5, "cut-");
  const auto cover = folder_ / "photos" / "cut-view0.png";
  cv::Mat3b covered = io::read_photograph(cover).pixels;
  covered.colRange(60, covered.cols).setTo(cv::Scalar::all(90));
  io::write_png(cover, covered);
  const std::string said =
      succeed("--housing flat.json -o housing.json --report report.json --coverage coverage.svg");
  EXPECT_THAT(said, HasSubstr("cut-view0.png: left out: "));
  const auto report = io::read_json(folder_ / "report.json");
  EXPECT_EQ(report["photographs"].size(), 13u);
  const auto pieces = report["pieces"].get<std::size_t>();
  EXPECT_GE(pieces, 5u);
  EXPECT_THAT(said,
              HasSubstr(fmt::format("{} photographs show the whole board, {} a piece of the board",
                                    13 - pieces, pieces)));
  EXPECT_THAT(read_file(folder_ / "coverage.svg"),
              HasSubstr(fmt::format("in 13 photographs ({} of a piece)", pieces)));
  for (const auto& photograph : report["photographs"])
    if (photograph["name"].get<std::string>().starts_with("view")) {
      EXPECT_FALSE(photograph["piece"].get<bool>());
    }
  EXPECT_EQ(report["left_out"].size(), 1u);
  EXPECT_EQ(report["left_out_reasons"].size(), 1u);
  expect_within_three_sigmas(report, flat_port());
}

TEST_F(CalibrateHousing, RefusesPhotographsThatDoNotSuffice) {
  testing::SurveyOptions middle{.views = 4, .nearest = 0.7, .farthest = 0.75, .steepest = 2};
  middle.within = {Eigen::Vector2d(0.45, 0.1), Eigen::Vector2d(0.9, 0.9)};
  take_photographs(flat_port(), middle);
  const test::Outcome outcome =
      run_program("CalibrateHousing",
                  kInput +
                      "--lens lens.txt --housing flat.json -o housing.json --report report.json "
                      "--max-distance-sigma 0.0001");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.output, HasSubstr("CalibrateHousing: 4 photographs determine the "));
  EXPECT_THAT(outcome.output, HasSubstr("no photograph shows corners near the image's left edge"));
  EXPECT_THAT(outcome.output, HasSubstr("a board tilted by 20 degrees or more"));
  EXPECT_THAT(outcome.output, HasSubstr("the most useful next photograph shows the board "));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "housing.json"));
  // The report has the missing photographs, too.
  const auto report = io::read_json(folder_ / "report.json");
  EXPECT_GE(report["missing"].size(), 2u);
}

// Names the first damaged photograph in the order of names, for any number of threads.
TEST_F(CalibrateHousing, RefusesADamagedPhotograph) {
  take_photographs(flat_port(), {.views = 4});
  for (const int view : {1, 3}) {
    const auto photograph = folder_ / "photos" / fmt::format("view{}", view);
    cv::Mat3b noise(480, 640);
    cv::randu(noise, 0, 256);
    io::write_jpeg(photograph.string() + ".jpg", noise, 90);
    const std::string whole = read_file(photograph.string() + ".jpg");
    write_atomically(photograph.string() + ".jpg", whole.substr(0, whole.size() / 2) + "\xFF\xD9");
    std::filesystem::remove(photograph.string() + ".png");
  }
  for (const int threads : {1, 8, 8, 8})
    expect_refusal("CalibrateHousing",
                   kInput + "--lens lens.txt --housing flat.json -o out.json --max-threads " +
                       std::to_string(threads),
                   "view1.jpg: cannot be decoded: Corrupt JPEG data: premature end");
}

TEST_F(CalibrateHousing, RefusesInOneLineThatNamesTheFault) {
  take_photographs(flat_port(), {.views = 1});
  const auto refuses = [&](const std::string& arguments, const std::string& expected) {
    expect_refusal("CalibrateHousing", arguments, expected);
  };
  const std::string lens = "--lens lens.txt ", housing = "--housing flat.json ";
  const std::string all = kInput + lens + housing;
  refuses(kInput + housing + "-o out.json", "--lens is missing");
  refuses(kInput + lens + "-o out.json", "--housing is missing");
  refuses(kInput + lens + housing, "--output-file is missing");
  refuses("-i photos -o out.json " + lens + housing, "--board is missing");
  refuses("-i photos -o out.json --board chess " + lens + housing,
          "--board chess: must begin with checkerboard:");
  refuses("-i nowhere -o out.json --board checkerboard:9x6:0.025 " + lens + housing,
          "nowhere: does not exist");
  refuses(all + "-o out.json", "1 photographs show 8 or more corners of the board, at least 3");
  refuses(all + "-o out.json --refine tilt", "'tilt' is not one of normal, distance");
  refuses(all + "-o out.json --refine centre", "there is a flat port");
  refuses(all + "-o out.json --refine focal", "stays as calibrated in air");
  refuses(all + "-o out.json --refine thickness", "needs --thickness-sigma");
  refuses(all + "-o out.json --index-sigma 0.1", "--refine does not name index");
  refuses(all + "-o out.json --max-index-sigma 0.1", "--refine normal,distance does not name");
  refuses(all + "-o out.json --refine distance --max-normal-sigma 1",
          "--refine distance does not name");
  refuses(all + "-o out.json --max-normal-sigma 0", "--max-normal-sigma 0: must be positive");
  refuses(all + "-o nowhere/out.json", "nowhere/out.json");
  write_lens("two.txt", {kLens, {2, "PINHOLE", 640, 480, {380, 380, 320, 240}}});
  refuses(kInput + housing + "--lens two.txt -o out.json", "two.txt: has 2 cameras");
  write_lens("large.txt", {{1, "PINHOLE", 1280, 960, {760, 760, 640, 480}}});
  refuses(kInput + housing + "--lens large.txt -o out.json",
          "view0.png: is 640 x 480 pixels, but the lens is calibrated for 1280 x 960");
  refuses(all + "-o out.json --port side", "--port side: ");
  io::Housing two = io::read_housing(folder_ / "dome.json");
  two.ports["side"] = io::to_housing_port(flat_port());
  io::write_housing(folder_ / "two.json", two);
  io::ColmapCamera unnamed = kLens;
  unnamed.port = dome_port();
  io::write_calibmar(folder_ / "lens.yaml", unnamed, {});
  refuses(kInput + "--housing two.json --lens lens.yaml -o out.json",
          "--port is missing: " + (folder_ / "two.json").string() + " has 2 ports");
  write_atomically(folder_ / "dry.json", "{\"version\": 1, \"ports\": {}, \"default\": \"none\"}");
  refuses(kInput + lens + "--housing dry.json -o out.json",
          "dry.json: camera 1 is behind port 'none'");
  write_atomically(folder_ / "photos" / "cut.png", "\x89PNG\r\n\x1A\n");
  refuses(all + "-o out.json", "cut.png");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.json"));
}

}  // namespace
}  // namespace axial::calibrate
