// SPDX-License-Identifier: Apache-2.0
/// Animation of a real person's photo. Skipped where the recording or the pose detector's networks (./dev models) are
/// missing, except for requests rejected before either is needed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <array>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "pipelines/photo_avatar/animate_person.h"

#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_reader.h"
#include "geometry/scene/observations.h"
#include "pipelines/photo_avatar/person_folder.h"
#include "render/view/overlay.h"
#include "tests/support/paths.h"
#include "tests/support/real_video.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/short_track.h"
#include "tests/support/toy_body.h"

namespace bodyloom::animate_person_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string ErrorOf(const AnimatePersonRequest& request) {
  try {
    AnimatePerson(request);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

class RealPersonTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const std::string video = SharedDir() + "/data/tfjs_pose/pose_squats.mp4";
    why_not_ = WhyNoDetection(video);
    if (!why_not_.empty()) return;
    folder_ = std::make_unique<ScratchFolder>();
    Image frame;
    VideoReader(video).Read(&frame);
    WriteImage(*folder_ / "photo.png", frame);
    PhotoPersonRequest request;
    request.images = {*folder_ / "photo.png"};
    request.texture_size = 256;
    person_ = std::make_unique<PhotoPerson>(MakePhotoPerson(request));
  }
  static void TearDownTestSuite() {
    person_.reset();
    folder_.reset();
  }
  void SetUp() override {
    if (!why_not_.empty()) GTEST_SKIP() << why_not_;
  }
  /// The photo's own pose as a motion.
  static std::string OwnPose() {
    std::string path = *folder_ / "own.npz";
    WriteTrack(path, person_->tracks[0]);
    return path;
  }
  static AnimatePersonRequest Request() {
    AnimatePersonRequest request;
    request.photos.images = {*folder_ / "photo.png"};
    request.photos.texture_size = 256;
    return request;
  }

  static std::string why_not_;
  static std::unique_ptr<ScratchFolder> folder_;
  static std::unique_ptr<PhotoPerson> person_;
};

std::string RealPersonTest::why_not_;
std::unique_ptr<ScratchFolder> RealPersonTest::folder_;
std::unique_ptr<PhotoPerson> RealPersonTest::person_;

TEST_F(RealPersonTest, WearsClothesOnABodyWithTheSameJoints) {
  EXPECT_EQ(person_->body->num_vertices(), person_->bare->num_vertices());
  const MatrixX3d bare = person_->bare->RestJoints(person_->betas);
  EXPECT_LT((person_->body->joint_template() - bare).rowwise().norm().maxCoeff(), 1e-6);
  EXPECT_GT(person_->report.clothes_max_m, 0.01);
  EXPECT_LT(person_->report.clothes_max_m, 0.181);
}

TEST_F(RealPersonTest, HasATextureOfWhichEveryTexelSaysWhereItIsFrom) {
  const PhotoPersonReport& report = person_->report;
  EXPECT_GT(report.seen, 0.2);
  EXPECT_LT(report.seen, 0.5);
  EXPECT_LT(report.smooth_fill, 0.1);
  EXPECT_NEAR(report.seen + report.mirrored + report.behind + report.hair + report.limb_neighbour + report.smooth_fill,
              1, 1e-9);
  ASSERT_EQ(report.photos.size(), 1U);
  EXPECT_GT(report.photos[0].rim_measured, 300);
}

TEST_F(RealPersonTest, LooksLikeThePhotoInItsOwnPose) {
  AnimatePersonRequest request = Request();
  request.track = OwnPose();
  request.pictures = *folder_ / "pictures";
  const AnimatePersonSummary summary = AnimatePerson(request);
  EXPECT_EQ(summary.frames, 1);
  const Image photo = ReadImage(*folder_ / "photo.png"), drawn = ReadImage(*folder_ / "pictures/000000.png");
  ASSERT_EQ(drawn.width, photo.width);
  double squares = 0;
  int pixels = 0;
  for (int y = 0; y < photo.height; ++y) {
    for (int x = 0; x < photo.width; ++x) {
      const uint8_t* p = drawn.pixel(x, y);
      if (p[0] + p[1] + p[2] == 0) continue;  // nobody, or black leggings
      ++pixels;
      for (int c = 0; c < 3; ++c) squares += std::pow((p[c] - photo.pixel(x, y)[c]) / 255.0, 2);
    }
  }
  EXPECT_GT(pixels, 30000);
  EXPECT_GT(-10 * std::log10(squares / (3 * pixels)), 20) << "dB, with 256 texels a side";
}

TEST_F(RealPersonTest, KeptAndTakenUpAgainIsTheSame) {
  AnimatePersonRequest request = Request();
  request.track = OwnPose();
  request.keep = *folder_ / "kept";
  request.pictures = *folder_ / "first";
  AnimatePerson(request);
  for (const std::string& file : PhotoPersonFiles(*folder_ / "kept", 1)) EXPECT_TRUE(fs::exists(file)) << file;
  AnimatePersonRequest again;
  again.person = *folder_ / "kept";
  again.track = OwnPose();
  again.pictures = *folder_ / "second";
  again.moved_track = *folder_ / "moved.npz";
  again.threads = 1;
  AnimatePerson(again);
  // The kept body is rounded by less than 1e-5 m: a pixel of its contour may change.
  const Image first = ReadImage(*folder_ / "first/000000.png"), second = ReadImage(*folder_ / "second/000000.png");
  int differ = 0;
  for (size_t i = 0; i < first.bgr.size(); ++i) differ += std::abs(first.bgr[i] - second.bgr[i]) > 8 ? 1 : 0;
  EXPECT_LT(differ, first.width * first.height / 200);
  // The moved track on the kept body is where the bare one was.
  const Track moved = ReadTrack(*folder_ / "moved.npz");
  EXPECT_EQ(moved.motion.betas.cwiseAbs().maxCoeff(), 0);
  EXPECT_LT((moved.motion.trans - person_->tracks[0].motion.trans).cwiseAbs().maxCoeff(), 1e-6);
}

TEST_F(RealPersonTest, HasTheLightOfThePhoto) {
  const ShLighting& light = person_->light.coefficients;
  EXPECT_NE(light, GreyLight(EvenLight()));
  EXPECT_EQ(light.row(0), light.row(2)) << "one for all colours";
  const PhotoPerson kept = ReadPhotoPerson(*folder_ / "kept", "");
  EXPECT_LT((kept.light.coefficients - light).cwiseAbs().maxCoeff(), 1e-6);
}

TEST_F(RealPersonTest, SeveralPhotosShowMore) {
  PhotoPersonRequest request;
  request.texture_size = 128;
  request.images = {*folder_ / "photo.png"};
  const double one = MakePhotoPerson(request).report.seen;
  Image mirrored = ReadImage(*folder_ / "photo.png");
  for (int y = 0; y < mirrored.height; ++y) {
    for (int x = 0; x < mirrored.width / 2; ++x) {
      for (int c = 0; c < 3; ++c) std::swap(mirrored.pixel(x, y)[c], mirrored.pixel(mirrored.width - 1 - x, y)[c]);
    }
  }
  WriteImage(*folder_ / "mirrored.png", mirrored);
  request.images.push_back(*folder_ / "mirrored.png");
  EXPECT_GT(MakePhotoPerson(request).report.seen, one + 0.05);
}

TEST_F(RealPersonTest, APhotoOfNobodySaysSo) {
  WriteImage(*folder_ / "nobody.png", Image(320, 240, Colour{120, 130, 140}));
  PhotoPersonRequest request;
  request.images = {*folder_ / "nobody.png"};
  try {
    MakePhotoPerson(request);
    FAIL();
  } catch (const NoPersonFound& error) {
    EXPECT_THAT(error.what(), HasSubstr("nobody.png: nobody was found"));
  }
}

TEST(AnimatePersonRequests, ContradictionsAreRefused) {
  const ScratchFolder folder;
  AnimatePersonRequest request;
  EXPECT_THAT(ErrorOf(request), HasSubstr("--image"));
  request.person = folder / "kept";
  EXPECT_THAT(ErrorOf(request), HasSubstr("--track"));
  request.photos.images = {folder / "me.jpg"};
  EXPECT_THAT(ErrorOf(request), HasSubstr("one of them"));
  request.person = "";
  request.keep = folder / "kept";
  EXPECT_THAT(ErrorOf(request), HasSubstr("me.jpg"));
  request.photos.images.clear();
  request.keep = "";
  request.person = folder / "none";
  request.track = folder / "none.npz";
  EXPECT_THAT(ErrorOf(request), HasSubstr("expected --out"));
  request.out = folder / "out.mp4";
  EXPECT_THAT(ErrorOf(request), HasSubstr("none.npz"));
}

TEST(PersonFolder, WhatIsMissingOrBrokenIsNamed) {
  const ScratchFolder folder;
  const auto error = [&] {
    try {
      ReadPhotoPerson(folder / "me", "");
    } catch (const std::runtime_error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(error(), HasSubstr("body.npz"));
  PhotoPerson person;
  person.bare = std::shared_ptr<const BodyModel>(&BuiltinBody(), [](const BodyModel*) {});
  person.body = std::make_shared<const BodyModel>(ToyBody());
  person.texture = Image(16, 16);
  person.tracks.push_back(ShortTrack(1));
  fs::create_directory(folder / "me");
  WritePhotoPerson(folder / "me", person);
  EXPECT_THAT(error(), HasSubstr("body.npz: has 804 vertices"));
  person.body = person.bare;
  WritePhotoPerson(folder / "me", person);
  EXPECT_EQ(error(), "");
  WriteFileAtomically(folder / "me/person.json", R"({"light": [1, 2]})");
  EXPECT_THAT(error(), HasSubstr("person.json: light"));
  WriteFileAtomically(folder / "me/person.json", "{}");  // of before the light was taken away
  EXPECT_EQ(error(), "");
  EXPECT_EQ(ReadPhotoPerson(folder / "me", "").light.coefficients, GreyLight(EvenLight()));
  WriteFileAtomically(folder / "me/texture.png", "garbage");
  EXPECT_THAT(error(), HasSubstr("texture.png"));
}

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

// A saved grey person under other light.

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

}  // namespace bodyloom::animate_person_test
