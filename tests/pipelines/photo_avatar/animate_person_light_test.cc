// SPDX-License-Identifier: Apache-2.0
/// A saved grey person under other light.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <string>

#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/video/image_file.h"
#include "pipelines/photo_avatar/animate_person.h"
#include "pipelines/photo_avatar/person_folder.h"
#include "render/view/overlay.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/short_track.h"

namespace bodyloom::animate_person_light_test {
namespace {

using ::testing::HasSubstr;

class PersonInOtherLight : public ::testing::Test {
 protected:
  void SetUp() override {
    PhotoPerson person;
    person.bare = person.clothed = person.body = BodyOrBuiltin("");
    person.betas = Eigen::VectorXd::Zero(2);
    person.texture = Image(16, 16, Colour{120, 120, 120});
    Track track = ShortTrack(1);
    track.motion.betas = person.betas;
    person.tracks = {track};
    std::filesystem::create_directory(folder_ / "me");
    WritePhotoPerson(folder_ / "me", person);
    WriteTrack(folder_ / "track.npz", track);
  }
  AnimatePersonRequest Request(const std::string& light) {
    AnimatePersonRequest request;
    request.person = folder_ / "me";
    request.track = folder_ / "track.npz";
    request.pictures = folder_ / "pictures";
    if (!light.empty()) {
      request.relight = folder_ / "light.json";
      WriteFileAtomically(request.relight, light);
    }
    return request;
  }
  /// Mean blue, green, red of the person's left and right half in the picture.
  std::array<std::array<double, 3>, 2> Halves(const std::string& light) {
    AnimatePerson(Request(light));
    const Image image = ReadImage(folder_ / "pictures/000000.png");
    int first = image.width, last = 0;
    const auto is_person = [&](int x, int y) { return image.pixel(x, y)[0] + image.pixel(x, y)[2] > 0; };
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        if (is_person(x, y)) first = std::min(first, x), last = std::max(last, x);
      }
    }
    std::array<std::array<double, 3>, 2> sums{};
    std::array<int, 2> pixels{};
    for (int y = 0; y < image.height; ++y) {
      for (int x = first; x <= last; ++x) {
        if (!is_person(x, y)) continue;
        const size_t half = 2 * x < first + last ? 0 : 1;
        ++pixels[half];
        for (size_t c = 0; c < 3; ++c) sums[half][c] += image.pixel(x, y)[c];
      }
    }
    for (size_t half = 0; half < 2; ++half) {
      for (double& sum : sums[half]) sum /= pixels[half];
    }
    return sums;
  }
  ScratchFolder folder_;
};

TEST_F(PersonInOtherLight, EvenLightLeavesColoursAsTheyAre) {
  for (const std::string light : {"", R"({"ambient": 1})"}) {
    const auto halves = Halves(light);
    for (const auto& half : halves) {
      for (const double value : half) EXPECT_NEAR(value, 120, 1) << light;
    }
  }
}

TEST_F(PersonInOtherLight, LightFromTheLeftFallsOnTheLeft) {
  const auto halves =
      Halves(R"({"directional": [{"from": [-1, 0, 0.2], "intensity": 1, "colour": [1, 0.5, 0.25]}], "ambient": 0.2})");
  EXPECT_GT(halves[0][2], 1.15 * halves[1][2]);
  EXPECT_GT(halves[0][2], halves[0][1]) << "red light";
  EXPECT_GT(halves[0][1], halves[0][0]);
}

TEST_F(PersonInOtherLight, WhatCannotBeGivenIsRefused) {
  const auto error = [&](const std::string& light) {
    try {
      AnimatePerson(Request(light));
    } catch (const std::exception& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(error(R"({"ambient": 1, "estimate": false})"), HasSubstr("light.json: has \"estimate\": false"));
  EXPECT_THAT(error(R"({"ambient": 1, "encoding": "linear"})"), HasSubstr("photos are sRGB"));
  EXPECT_THAT(error("[]"), HasSubstr("light.json"));
  AnimatePersonRequest request = Request("");
  request.relight = folder_ / "none.json";
  EXPECT_THAT(
      [&] {
        try {
          AnimatePerson(request);
        } catch (const std::exception& e) {
          return std::string(e.what());
        }
        return std::string();
      }(),
      HasSubstr("none.json"));
}

}  // namespace
}  // namespace bodyloom::animate_person_light_test
