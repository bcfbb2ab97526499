// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of port, lens, scale and poses on generated surveys: no warning for correct surveys, and
// the right cause for surveys with one fault.
#include "diagnosis/port_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "diagnosis/import_check.h"
#include "diagnosis/track_sample.h"
#include "diagnosis/words.h"
#include "pose/colmap_survey.h"
#include "pose/refine.h"

namespace axial::diagnosis {
namespace {

using namespace pose;
namespace testing = pose::testing;

using Of = PortChange::Of;
using testing::camera_behind;
using testing::dome_port;
using testing::flat_port;
using ::testing::HasSubstr;
using testing::kLens;
using testing::model_of;
using testing::survey;
using testing::SurveyOptions;

using MaybePort = std::optional<refractive::Port<double>>;

const std::vector<MaybePort> kPorts{std::nullopt,      flat_port(0),        flat_port(3),
                                    flat_port(0, 0.1), flat_port(17, 0.03), dome_port()};

io::ColmapModel modelled(const Bundle& bundle) {
  io::ColmapModel model = model_of(bundle);
  model.cameras = {kLens};
  return model;
}

io::Housing behind(const MaybePort& port) {
  return port ? io::housing_with(io::to_housing_port(*port)) : io::Housing{};
}

// Air, flat and tilted ports, a dome; close and far; few and many views; noise of 0 to 1 px.
TEST(ImportWarning, SaysNothingOfWhatBelongsTogether) {
  for (const MaybePort& port : kPorts)
    for (const double distance : {0.8, 2.5})
      for (const int images : {3, 5, 12})
        for (const double noise : {0.0, 0.5, 1.0}) {
          const Bundle truth =
              survey(camera_behind(port), {distance, images, 150, noise, unsigned(images)});
          const auto line = import_warning(modelled(truth), behind(port), {});
          EXPECT_FALSE(line) << *line;
        }
}

struct Fault {
  const char* name;
  MaybePort given;
  double scale = 1;  // of the poses: factor
  double focal = 1;  // of the lens: factor
  Of cause = Of::nothing;
};

std::ostream& operator<<(std::ostream& out, const Fault& fault) {
  return out << fault.name;
}

refractive::FlatPort<double> with_index(double n_water) {
  refractive::FlatPort<double> port = flat_port(3, 0.03);
  port.n_water = n_water;
  return port;
}

// The survey is taken through a port 3 cm away, tilted by 3 degrees.
class ImportWarningOf : public ::testing::TestWithParam<Fault> {};

TEST_P(ImportWarningOf, NamesTheCause) {
  const Fault& fault = GetParam();
  for (const double noise : {0.0, 0.5, 1.0}) {
    Bundle bundle = survey(camera_behind(flat_port(3, 0.03)), {.distance = 0.7, .noise = noise});
    scale_places(bundle, fault.scale);
    bundle.cameras[0].measured.port = fault.given;
    bundle.cameras[0].measured.lens.pinhole.fx *= fault.focal;
    bundle.cameras[0].measured.lens.pinhole.fy *= fault.focal;
    const PortCheck check = check_ports(bundle, {});
    ASSERT_TRUE(check.tells());
    EXPECT_FALSE(check.fits()) << check.residual;
    EXPECT_TRUE(check.explained()) << check.residual << " " << check.best_residual;
    EXPECT_EQ(check.best.of, fault.cause) << check.best.cause << " noise " << noise << ": "
                                          << check.residual << " " << check.best_residual;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Faults, ImportWarningOf,
    ::testing::Values(Fault{"DistanceTenfold", flat_port(3, 0.3), 1, 1, Of::distance},
                      Fault{"NormalOff", flat_port(45, 0.03), 1, 1, Of::normal},
                      Fault{"NoRefraction", with_index(1.0), 1, 1, Of::index},
                      Fault{"IndexOfGlass", with_index(1.49), 1, 1, Of::index},
                      Fault{"FocalTwice", flat_port(3, 0.03), 1, 2, Of::focal},
                      Fault{"FocalOfWater", flat_port(3, 0.03), 1, 1.333, Of::focal},
                      Fault{"TenTimesTooSmall", flat_port(3, 0.03), 0.1, 1, Of::scale},
                      Fault{"HundredTimesTooSmall", flat_port(3, 0.03), 0.01, 1, Of::scale},
                      Fault{"Forgotten", std::nullopt, 1, 1, Of::thin_port}),
    [](const auto& tested) { return tested.param.name; });

// Poses at too large a scale have the effect of a port close to the lens: this is found if the port
// is far enough from the lens.
TEST(PortCheckOfScale, TellsPosesThatAreTooLarge) {
  for (const double scale : {10.0, 100.0, 1000.0}) {
    Bundle bundle = survey(camera_behind(flat_port(3, 0.1)), {.distance = 0.8, .noise = 0.5});
    scale_places(bundle, scale);
    const PortCheck check = check_ports(bundle, {});
    EXPECT_FALSE(check.fits()) << check.residual;
    // A port at ten times the distance has nearly the same effect.
    EXPECT_TRUE(check.best.of == Of::scale || (scale == 10 && check.best.of == Of::distance))
        << check.best.cause;
  }
}

// Port and scene at twice the size give the same photographs, and a dome centred at the lens does
// not determine the scale.
TEST(PortCheckOfScale, SaysNothingWhereNothingCanBeTold) {
  const auto centred = refractive::DomePort<double>{{0, 0, 0}, 0.05, 0.007, 1, 1.52, 1.333};
  Bundle bundle = survey(camera_behind(centred), {.distance = 2.5, .noise = 0.5});
  scale_places(bundle, 10);
  EXPECT_TRUE(check_ports(bundle, {}).fits());
}

TEST(ImportWarning, TellsPinholePosesWithTheLensInAir) {
  const Bundle truth = survey(camera_behind(flat_port(0)), {.distance = 2.5, .noise = 0.3});
  Bundle bundle = testing::absorbed(truth, 1);
  const auto line = import_warning(modelled(bundle), behind(flat_port(0)), {});
  ASSERT_TRUE(line);
  EXPECT_THAT(*line, HasSubstr("computed without the port"));
  EXPECT_THAT(*line, HasSubstr("RefinePoses"));
}

TEST(ImportWarning, GivesBothNumbersAndTheCause) {
  const Bundle truth = survey(camera_behind(flat_port(3, 0.03)), {.noise = 0.5});
  const auto line = import_warning(modelled(truth), behind(flat_port(3, 0.3)), {});
  ASSERT_TRUE(line);
  EXPECT_THAT(*line, HasSubstr("px behind the ports"));
  EXPECT_THAT(*line, HasSubstr("without them"));
  EXPECT_THAT(*line, HasSubstr("distance is 10 times too large"));
  EXPECT_EQ(std::ranges::count(*line, '\n'), 0);
}

TEST(ImportWarning, SaysNothingOfModelsThatTellNothing) {
  io::ColmapModel model = modelled(survey(camera_behind(flat_port()), {.points = 5}));
  EXPECT_FALSE(import_warning(model, behind(flat_port(0, 0.5)), {}));
  model.points.clear();
  for (io::ColmapImage& image : model.images) image.points.clear();
  EXPECT_FALSE(import_warning(model, behind(flat_port()), {}));
  EXPECT_FALSE(import_warning({}, behind(flat_port()), {}));
}

// 20,000 images, each with its own camera, that observe the same points as their neighbours.
TEST(SampleTracks, IsBoundedWhateverTheModel) {
  io::ColmapModel model;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    io::ColmapCamera camera = kLens;
    camera.id = i + 1;
    model.cameras.push_back(camera);
    io::ColmapImage image;
    image.id = image.camera = i + 1;
    image.name = std::to_string(i) + ".jpg";
    model.images.push_back(image);
  }
  for (std::uint64_t p = 0; p + 12 < 20000; ++p) {
    io::ColmapPoint3D point{p + 1, {0, 0, 1}, {}, 0, {}};
    for (std::uint32_t k = 0; k < 12; ++k) {
      io::ColmapImage& image = model.images[p + k];
      point.track.push_back({image.id, static_cast<std::uint32_t>(image.points.size())});
      image.points.push_back({double(k), 1, point.id});
    }
    model.points.push_back(point);
  }
  const SampleLimits limits;
  const io::ColmapModel sample = sample_tracks(model);
  EXPECT_LE(sample.points.size(), limits.points);
  EXPECT_GE(sample.points.size(), 100u);
  EXPECT_LE(sample.images.size(), limits.images);
  EXPECT_EQ(sample.cameras.size(), sample.images.size());
  for (const io::ColmapPoint3D& point : sample.points) {
    EXPECT_GE(point.track.size(), 2u);
    EXPECT_LE(point.track.size(), limits.track);
  }
}

// Refines behind `given` a survey that was taken through `true_port`.
std::optional<FreedNumber> after_refining(const refractive::Port<double>& true_port,
                                          const refractive::Port<double>& given, double noise,
                                          SurveyOptions of = {.distance = 0.7, .points = 400}) {
  of.noise = noise;
  const Bundle truth = survey(camera_behind(true_port), of);
  Bundle bundle = testing::absorbed(truth, 1);
  bundle.cameras[0].measured.port = given;
  RefineOptions options;
  options.adjust.distances.push_back(testing::known_length(truth));
  bring_to_metres(bundle, options.adjust);
  refine(bundle, options);
  return number_that_does_not_fit(bundle, options.adjust);
}

TEST(NumberThatDoesNotFit, IsNoneOfTheTruePort) {
  for (const MaybePort& port : kPorts)
    for (const double noise : {0.0, 0.5, 1.0}) {
      if (!port) continue;
      for (const int images : {4, 12}) {
        const auto freed =
            after_refining(*port, *port, noise, {.distance = 0.7, .images = images, .points = 300});
        EXPECT_FALSE(freed) << text_of(*freed, 0.01);
      }
    }
}

TEST(NumberThatDoesNotFit, NamesTheIndexAndTheNormal) {
  for (const double n_water : {1.0, 1.5}) {
    const auto freed = after_refining(flat_port(3, 0.03), with_index(n_water), 0.43);
    ASSERT_TRUE(freed) << n_water;
    EXPECT_LT(freed->rms_found, freed->rms_stated);
    EXPECT_GT(freed->deviations, 6);
    EXPECT_EQ(freed->number.name, "index of water");
    EXPECT_NEAR(freed->number.now, 1.333, 0.03);
  }
  const auto freed = after_refining(flat_port(3, 0.03), flat_port(20, 0.03), 0.43);
  ASSERT_TRUE(freed);
  EXPECT_EQ(freed->number.name, "normal to the right");
  EXPECT_NEAR(freed->number.now, 3, 3);
  EXPECT_THAT(text_of(*freed, 0.0012), HasSubstr("0.12 %"));
}

// Too few observations in an image are no sign of a wrong housing.
TEST(DroppedLines, AskForTheHousingOnlyWhereErrorsAreLarge) {
  const Bundle truth =
      survey(camera_behind(flat_port(3)), {.images = 12, .points = 120, .noise = 0.3});
  Bundle few = truth;
  std::vector<std::size_t> kept(few.images.size());
  std::erase_if(few.observations, [&](const Observation& observation) {
    return observation.image < 8 && ++kept[observation.image] > 25;
  });
  RefineOptions options;
  const auto said = dropped_lines(refine(few, options), options.tracks);
  EXPECT_THAT(said, ::testing::Contains(HasSubstr("images with fewer than 30")));
  EXPECT_THAT(said, ::testing::Not(::testing::Contains(HasSubstr("housing"))));

  Bundle wrong = truth;
  for (std::size_t i = 0; i < wrong.observations.size(); i += 3)
    wrong.observations[i].pixel += Eigen::Vector2d(i % 2 == 0 ? 25 : -25, 20);
  EXPECT_THAT(dropped_lines(refine(wrong, options), options.tracks),
              ::testing::Contains(HasSubstr("check the housing")));
}

}  // namespace
}  // namespace axial::diagnosis
