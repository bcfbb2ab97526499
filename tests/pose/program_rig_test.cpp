// SPDX-License-Identifier: GPL-3.0-or-later
// RefinePoses with rigs: the scale, the report and the messages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "io/bytes/json.h"
#include "pose/refine_poses.h"
#include "pose/rig_survey.h"

namespace axial::pose {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// A survey by two cameras, each behind its own port.
class RefinePosesWithRig : public RefinePoses {
 protected:
  void start(const testing::RigSurveyOptions& options) {
    truth_ = testing::rig_survey(options);
    write_input();
    io::Housing housing = testing::housing();
    housing.ports["right"] = testing::flat_port(-1, 0.03);
    for (std::size_t i = 1; i < truth_.images.size(); i += 2)
      housing.images[truth_.images[i].name] = "right";
    io::write_housing(folder_ / "housing.json", housing);
    const Pose pose = testing::right_in_rig(options);
    const Eigen::Quaterniond q(pose.rotation);
    const Eigen::Vector3d t = -pose.rotation * pose.centre;
    write_atomically(folder_ / "rig_config.json",
                     fmt::format(R"([{{"cameras": [{{"image_prefix": "left/", "ref_sensor": true}},
                    {{"image_prefix": "right/", "cam_from_rig_rotation": [{}, {}, {}, {}],
                      "cam_from_rig_translation": [{}, {}, {}]}}]}}])",
                                 q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()));
  }
};

const std::string kRig = kInput + "-o out --refine none --rig rig_config.json ";

TEST_F(RefinePosesWithRig, TakesTheScaleFromTheBase) {
  start({.points = 150, .noise = 0.3, .seed = 11});
  const std::string said = succeed(kRig);
  EXPECT_THAT(said, HasSubstr("Rig of left/, right/: 12 of 12 frames have several photographs"));
  EXPECT_THAT(said, Not(HasSubstr("only refraction determines the scale")));
  EXPECT_THAT(said, HasSubstr("take their photographs at the same time, within"));
  const Bundle found = found_poses(io::read_colmap_model(folder_ / "out" / "sparse"));
  EXPECT_NEAR(testing::pose_errors(found, truth_).scale, 1, 0.001);
  const auto camera = io::read_json(folder_ / "out" / "report.json")["rigs"][0]["cameras"][0];
  EXPECT_EQ(camera["name"], "right/");
  EXPECT_EQ(camera["pose"], "stated");
  EXPECT_NEAR(camera["base_m"].get<double>(), 0.2, 0.0006);
  EXPECT_LT(camera["sigma_translation_m"][1].get<double>(), 0.00021);
  EXPECT_EQ(camera["frames"], 12);
  EXPECT_FALSE(camera["timing"]["significant"].get<bool>());
}

TEST_F(RefinePosesWithRig, WarnsOfACameraThatIsLate) {
  start({.points = 150, .delay = 0.04, .noise = 0.3, .seed = 12});
  EXPECT_THAT(succeed(kRig + "--rig-interval 0.4"), HasSubstr("ms later than left/"));
  const auto timing =
      io::read_json(folder_ / "out" / "report.json")["rigs"][0]["cameras"][0]["timing"];
  EXPECT_NEAR(timing["delay_ms"].get<double>(), 40, 3);
  EXPECT_NEAR(timing["speed_m_per_s"].get<double>(), 0.3, 0.01);
  // Without times, the delay is a length.
  EXPECT_THAT(succeed(kRig), HasSubstr("mm of the track later than left/"));
  std::string times = "name,seconds\n";
  for (std::size_t i = 0; i < truth_.images.size(); ++i)
    times += fmt::format("{},{}\n", truth_.images[i].name, 100 + 0.4 * static_cast<double>(i / 2));
  write_atomically(folder_ / "times.csv", times);
  EXPECT_THAT(succeed(kRig + "--rig-times times.csv"), HasSubstr("ms later than left/"));
}

TEST_F(RefinePosesWithRig, EstimatesFreePoses) {
  start({.points = 150, .noise = 0.3, .seed = 13});
  succeed(kRig + "--rig-poses free --scale-from images:left/frame00.jpg,left/frame11.jpg," +
          fmt::format("{}", (truth_.images[0].pose.centre - truth_.images[22].pose.centre).norm()));
  const auto camera = io::read_json(folder_ / "out" / "report.json")["rigs"][0]["cameras"][0];
  EXPECT_NEAR(camera["base_m"].get<double>(), 0.2, 0.001);
  EXPECT_FALSE(camera.contains("stated"));
}

TEST_F(RefinePosesWithRig, RefusesWrongOptions) {
  start({});
  expect_refusal("RefinePoses", kInput + "-o out --rig-interval 1", "needs --rig");
  expect_refusal("RefinePoses", kRig + "--rig-frames '('", "is not valid");
  expect_refusal("RefinePoses", kRig + "--rig-times none.csv", "none.csv");
}

}  // namespace
}  // namespace axial::pose
