// SPDX-License-Identifier: Apache-2.0
#include "pipelines/detect/upright_people.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "data_tools/video/frame_image.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_reader.h"
#include "pipelines/detect/detect_clip.h"
#include "pipelines/photo_avatar/make_photo_person.h"
#include "pipelines/track/chosen_people.h"
#include "tests/support/paths.h"
#include "tests/support/real_video.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::upright_people_test {
namespace {

using ::testing::HasSubstr;

/// A person whose trunk is turned clockwise in the image.
DetectedPerson Turned(double degrees, float confidence = 0.9F) {
  DetectedPerson person;
  person.points.assign(17, Keypoint{});
  const double angle = degrees * M_PI / 180;
  const auto place = [&](int k, double right, double up) {
    person.points[size_t(k)] = {float(300 + right * std::cos(angle) + up * std::sin(angle)),
                                float(200 + right * std::sin(angle) - up * std::cos(angle)), confidence};
  };
  place(5, 20, 60), place(6, -20, 60), place(11, 15, 0), place(12, -15, 0);  // COCO's shoulders and hips
  return person;
}

PeopleSequence Clip(const std::vector<DetectedPerson>& people) {
  PeopleSequence clip;
  clip.convention = Coco17();
  clip.frames.assign(people.size(), {});
  for (size_t t = 0; t < people.size(); ++t) clip.frames[t] = {people[t]};
  return clip;
}

TEST(UprightPeople, WithinFortyFiveDegrees) {
  for (const double degrees : {0.0, 40.0, -40.0}) EXPECT_TRUE(TrunkOf(Turned(degrees), Coco17()).is_upright);
  for (const double degrees : {50.0, -50.0, 90.0, 180.0, -90.0}) {
    EXPECT_FALSE(TrunkOf(Turned(degrees), Coco17()).is_upright) << degrees;
  }
  EXPECT_NEAR(TrunkOf(Turned(0), Coco17()).confidence, 0.9, 1e-6);
  KeypointConvention other;
  other.names = {"nose"};
  EXPECT_THROW(TrunkOf(Turned(0), other), std::invalid_argument);
}

TEST(UprightPeople, AdviceWhereMostLie) {
  EXPECT_THAT(AdviceOnTurn(Clip({Turned(90), Turned(95), Turned(80), Turned(0)})), HasSubstr("--rotate auto"));
  EXPECT_EQ(AdviceOnTurn(Clip({Turned(90), Turned(95), Turned(0)})), "") << "a third of them are upright";
  EXPECT_EQ(AdviceOnTurn(Clip({Turned(0), Turned(10)})), "");
  EXPECT_EQ(AdviceOnTurn(Clip({Turned(90, 0.2F)})), "") << "hardly seen";
  EXPECT_EQ(AdviceOnTurn(Clip({})), "");
}

TEST(UprightPeople, AdviceIsSaidOfTheVideo) {
  std::vector<std::string> said;
  PipelineCallbacks callbacks;
  callbacks.message = [&](const std::string& line) { said.push_back(line); };
  SayAdviceOnTurn("a.mp4", Clip({Turned(0)}), callbacks);
  EXPECT_THAT(said, ::testing::IsEmpty());
  SayAdviceOnTurn("a.mp4", Clip({Turned(90)}), callbacks);
  EXPECT_THAT(said, ::testing::ElementsAre("a.mp4: " + AdviceOnTurn(Clip({Turned(90)}))));
}

/// A woman who squats, turned by 90 degrees. Skipped where the recording or the networks (./dev models) are missing.
class PeopleOnTheirSide : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string why = WhyNoDetection(video_); !why.empty()) GTEST_SKIP() << why;
    callbacks_.message = [this](const std::string& line) { said_ += line + "\n"; };
  }

  const std::string video_ = SharedDir() + "/data/tfjs_pose/pose_squats.mp4";
  const ScratchFolder folder_;
  PipelineCallbacks callbacks_;
  std::string said_;
};

TEST_F(PeopleOnTheirSide, InAVideoTheTurnIsAdvised) {
  DetectClipRequest request;
  request.detect.video = video_;
  request.detect.span.to_s = 0.3;
  request.detect.span.turn_deg = 90;
  request.out = folder_ / "detections.npz";
  DetectClip(request, callbacks_);
  EXPECT_THAT(said_, HasSubstr("pose_squats.mp4: most people lie on their side"));
  said_.clear();
  TrackPeopleRequest tracked;
  tracked.track.video = video_;
  tracked.track.to_s = 0.3;
  tracked.track.turn_deg = 90;
  DetectAndChoosePeople(tracked, callbacks_);
  EXPECT_THAT(said_, HasSubstr("--rotate auto"));
}

TEST_F(PeopleOnTheirSide, NotOfAPhotoWhichNoOptionTurns) {
  Image frame;
  VideoReader(video_).Read(&frame);
  WriteImage(folder_ / "photo.png", Oriented(frame, ClockwiseTurn(90)));
  StageClock clock;
  std::shared_ptr<const BodyModel> body;
  PhotoFitSettings settings;
  const FittedPhoto photo = FitPhoto(settings, folder_ / "photo.png", callbacks_, &clock, &body);
  EXPECT_EQ(photo.people, 1);
  EXPECT_THAT(said_, ::testing::Not(HasSubstr("--rotate")));
}

}  // namespace
}  // namespace bodyloom::upright_people_test
