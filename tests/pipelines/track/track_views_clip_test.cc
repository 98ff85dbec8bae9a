// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/track_views_clip.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/load_camera_path.h"
#include "data_tools/observations/load_cameras.h"
#include "data_tools/observations/rig_io.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/pose_joints.h"
#include "geometry/base/units.h"
#include "geometry/math/rotation.h"
#include "pipelines/export/export_rig.h"
#include "tests/pipelines/track/two_views.h"
#include "tests/support/test_files.h"

namespace bodyloom::track_views_clip_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kOffset_s = 0.8;

class TrackViewsClipTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new ScratchFolder;
    views_ = new TwoViews(MakeTwoViews(*shared_, 60, kOffset_s, 6));
  }
  static void TearDownTestSuite() {
    delete std::exchange(views_, nullptr);
    delete std::exchange(shared_, nullptr);
  }
  /// Both views, of which nothing is known.
  TrackViewsRequest Request() const {
    TrackViewsRequest request;
    request.view_detections = {views_->left, views_->right};
    request.out = folder_ / "track.npz";
    request.solve.num_threads = 2;
    return request;
  }
  /// A file of both cameras, as they are, with the right clock.
  std::string WriteTrueRig() const {
    std::vector<RigCamera> rig(2);
    for (RigCamera& camera : rig) camera.camera = views_->truth.camera;
    rig[0].name = "left";
    rig[1].name = "right";
    rig[1].camera_from_rig = views_->right_from_left;
    rig[1].offset_s = kOffset_s;
    WriteRig(folder_ / "true_rig.json", rig);
    return folder_ / "true_rig.json";
  }
  /// Mean distance of the joints to the truth, metres, after the root is put in place.
  static double JointError(const Track& track) {
    double sum = 0;
    int n = 0;
    for (int t = 0; t < track.num_frames(); ++t) {
      const MatrixX3d difference = (track.joints[t].rowwise() - track.joints[t].row(0)) -
                                   (views_->truth.joints[t].rowwise() - views_->truth.joints[t].row(0));
      sum += difference.topRows(22).rowwise().norm().sum();
      n += 22;
    }
    return sum / n;
  }

  static ScratchFolder* shared_;
  static TwoViews* views_;
  ScratchFolder folder_;
};
ScratchFolder* TrackViewsClipTest::shared_ = nullptr;
TwoViews* TrackViewsClipTest::views_ = nullptr;

TEST_F(TrackViewsClipTest, FindsCamerasAndClocksOfWhichNothingIsKnown) {
  TrackViewsRequest request = Request();
  request.json = folder_ / "track.json";
  const TrackReport report = TrackViewsClip(request);
  EXPECT_EQ(report.outputs, (std::vector<std::string>{folder_ / "rig.json", request.out, request.json}));
  EXPECT_LT(JointError(ReadTrack(request.out)), 0.05);

  const std::vector<RigCamera> rig = ReadRig(folder_ / "rig.json");
  ASSERT_EQ(rig.size(), 2U);
  EXPECT_EQ(rig[0].name, "left");
  EXPECT_EQ(rig[1].name, "right");
  EXPECT_TRUE(rig[0].camera_from_rig.camera_from_world_rotation.isIdentity());
  EXPECT_EQ(rig[0].camera.width, views_->width);
  // Three seconds: 1.0 to 2.0 degrees by the rig and the ground's terms, which the stated deviation covers.
  const double off = RotationAngleBetween(rig[1].camera_from_rig.camera_from_world_rotation,
                                          views_->right_from_left.camera_from_world_rotation);
  EXPECT_LT(off, 2.5 * kDegree);
  EXPECT_LT(off, 2 * std::sqrt(3.0) * rig[1].rotation_sigma_rad);
  EXPECT_NEAR(rig[1].TimeAt(1), 1 + kOffset_s, 0.02);
  EXPECT_NEAR(rig[1].middle_s, 0.5 * 89 / 30, 1e-9);
  EXPECT_NE(rig[1].rotation_sigma_rad, 0) << "estimated";
  EXPECT_NE(rig[1].offset_sigma_s, 0) << "estimated";

  ASSERT_EQ(report.views.size(), 2U);
  EXPECT_EQ(report.views[0].frames, 90);
  EXPECT_NEAR(report.views[1].frames, 84, 1);
  EXPECT_NEAR(report.views[1].fps, 30, 1e-6);
  const std::string text = ToText(report);
  EXPECT_THAT(text, HasSubstr("\nview     left   first; focal length "));
  EXPECT_THAT(text, HasSubstr("\nview     right  "));
  EXPECT_THAT(text, HasSubstr(" m from the first"));
  EXPECT_THAT(text, HasSubstr("; clock 0."));
  EXPECT_THAT(text, HasSubstr(" frames in common; median "));
  const nlohmann::json json = nlohmann::json::parse(FileBytes(request.json));
  ASSERT_EQ(json["views"].size(), 2U);
  EXPECT_EQ(json["views"][1]["name"], "right");
  EXPECT_TRUE(json["views"][1]["used"].get<bool>());
  EXPECT_NEAR(json["views"][1]["rotation_deg"].get<double>(), 60, 2);
  EXPECT_NEAR(json["views"][1]["offset_frames"].get<double>(), 24, 0.6);
}

TEST_F(TrackViewsClipTest, KeepsWhatIsKnown) {
  TrackViewsRequest request = Request();
  request.cameras = WriteTrueRig();
  request.rig_out = folder_ / "kept.json";
  const TrackReport report = TrackViewsClip(request);
  EXPECT_LT(JointError(ReadTrack(request.out)), 0.05);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "rig.json"));
  const std::vector<RigCamera> kept = ReadRig(request.rig_out);
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_LT(
      (kept[1].camera_from_rig.camera_from_world_rotation - views_->right_from_left.camera_from_world_rotation).norm(),
      1e-9);
  EXPECT_EQ(kept[1].camera.fx, views_->focal_px);
  EXPECT_NEAR(kept[1].offset_s, kOffset_s, 1e-12);
  for (const double sigma : {kept[1].rotation_sigma_rad, kept[1].translation_sigma_m, kept[1].focal_log_sigma,
                             kept[1].offset_sigma_s, kept[1].rate_sigma}) {
    EXPECT_EQ(sigma, 0) << "given";
  }
  EXPECT_NEAR(report.views[1].frames, 84, 1);
}

bool Plans(const std::vector<PlanEntry>& plan, const std::string& what, const std::string& why) {
  return std::any_of(plan.begin(), plan.end(), [&](const PlanEntry& entry) {
    return entry.what == what && entry.why.find(why) != std::string::npos;
  });
}

TEST_F(TrackViewsClipTest, ThePlanTellsWhatIsSharedAndWhatIsEstimated) {
  TrackViewsRequest request = Request();
  request.plan = true;
  request.out = "";
  std::vector<PlanEntry> plan = TrackViewsClip(request).solve.plan;
  EXPECT_TRUE(Plans(plan, "shared by 2 views", "shape"));
  EXPECT_TRUE(Plans(plan, "view left", "90 frames, its axes and clock are the track's; focal length estimated"));
  EXPECT_TRUE(
      Plans(plan, "view right", "84 frames, estimated with the track: place and direction, focal length, clock"));
  request.cameras = WriteTrueRig();
  plan = TrackViewsClip(request).solve.plan;
  EXPECT_TRUE(Plans(plan, "view right", "its camera and clock are known"));
  request.known = KnownOfRig::kPoses;
  plan = TrackViewsClip(request).solve.plan;
  EXPECT_TRUE(Plans(plan, "view right", "estimated with the track: clock"));
  request.known = KnownOfRig::kIntrinsics;
  request.camera = "unknown-focal";
  plan = TrackViewsClip(request).solve.plan;
  EXPECT_TRUE(Plans(plan, "view right", "place and direction, focal length, clock"));
  request.same_lens = true;
  plan = TrackViewsClip(request).solve.plan;
  EXPECT_TRUE(Plans(plan, "view right", "focal length, as the first one's, clock"));
}

/// A path that stays where it is, of the second view alone.
TEST_F(TrackViewsClipTest, AViewHasAPathOfItsOwn) {
  TrackViewsRequest request = Request();
  std::vector<double> times;
  for (int i = 0; i < 20; ++i) times.push_back(0.5 * i);
  std::filesystem::create_directories(folder_ / "paths");
  WriteCameraPath(folder_ / "paths/right.json", {times, std::vector<CameraPose>(times.size())});
  TrackViewsClip(request);
  const Track still = ReadTrack(request.out);
  request.camera_path = folder_ / "paths/{view}.json";
  TrackViewsClip(request);
  const Track moving = ReadTrack(request.out);
  double largest = 0;
  for (int t = 0; t < still.num_frames(); ++t) {
    largest = std::max(largest, (still.joints[t] - moving.joints[t]).cwiseAbs().maxCoeff());
  }
  EXPECT_LE(largest, 0.02) << "it differs by the weights of the vertical alone";
  request.plan = true;
  request.out = "";
  EXPECT_TRUE(Plans(TrackViewsClip(request).solve.plan, "view right", "moves along its path"));
}

TEST_F(TrackViewsClipTest, AnotherMotionIsAnError) {
  TrackViewsRequest request = Request();
  // Somebody who sits on the floor with raised arms.
  Motion motion = DemoMotion(BuiltinBody(), 60, 30);
  for (int t = 0; t < motion.num_frames(); ++t) {
    for (int side = 0; side < 2; ++side) {
      motion.poses(t, 3 * (kLeftHip + side)) = -1.5;
      motion.poses(t, 3 * (kLeftKnee + side)) = 0.2;
      motion.poses(t, 3 * (kLeftShoulder + side) + 2) = side == 0 ? 1.3 : -1.3;
    }
  }
  SynthClipOptions synth;
  synth.dense_per_frame = 0;
  const SynthClip other = MakeSynthClip(BuiltinBody(), motion, synth);
  request.view_detections[1] = folder_ / "other.npz";
  WriteObservations(request.view_detections[1], &other.keypoints, nullptr);
  request.json = folder_ / "track.json";
  EXPECT_THAT([&] { TrackViewsClip(request); },
              ThrowsMessage<NoPersonFound>(HasSubstr("no other view shows the motion of the first: ")));
  EXPECT_FALSE(std::filesystem::exists(request.out));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "rig.json"));
  EXPECT_EQ(nlohmann::json::parse(FileBytes(request.json))["status"], "failure");
}

TEST_F(TrackViewsClipTest, DoubtsAViewOfAnUnlikelyLens) {
  SynthesizeClipRequest synth;
  synth.motion = {.name = "demo", .fps = 30, .num_frames = 90};
  synth.out = folder_ / "far";
  synth.clip.dense_per_frame = 0;
  synth.clip.camera.yaw_deg = 60;
  synth.clip.camera.focal_px = 4000;
  TrackViewsRequest request = Request();
  request.view_detections[1] = SynthesizeClip(synth).files.observations;
  request.json = folder_ / "track.json";
  std::vector<std::string> messages;
  PipelineCallbacks callbacks;
  callbacks.message = [&](const std::string& line) { messages.push_back(line); };
  TrackViewsClip(request, callbacks);
  EXPECT_THAT(messages, ::testing::Contains(HasSubstr("view observations may show another motion")));
  const nlohmann::json views = nlohmann::json::parse(FileBytes(request.json))["views"];
  EXPECT_THAT(views[1]["doubt"].get<std::string>(), HasSubstr("px is unlikely in images of 960x720"));
  EXPECT_FALSE(views[0].contains("doubt"));
  messages.clear();
  TrackViewsClip(Request(), callbacks);
  EXPECT_TRUE(messages.empty()) << messages[0];
}

TEST_F(TrackViewsClipTest, ACancelledOneLeavesNothingBehind) {
  PipelineCallbacks callbacks;
  double last = 0;
  callbacks.progress = [&](const std::string&, double done) {
    EXPECT_GE(done, last) << "forwards over the fits of all views";
    last = done;
    return done < 0.7;
  };
  EXPECT_THROW(TrackViewsClip(Request(), callbacks), Cancelled);
  EXPECT_EQ(folder_.Entries(), std::vector<std::string>{});
}

TEST_F(TrackViewsClipTest, CamerasAreFoundByNameOrByOrder) {
  TrackViewsRequest request = Request();
  const std::vector<NamedCamera> cameras = LoadCameras(WriteTrueRig());
  std::vector<NamedCamera> file = {cameras[1], cameras[0]};
  const auto write = [&] { WriteCameras(folder_ / "cameras.json", file); };
  request.cameras = folder_ / "cameras.json";
  write();
  EXPECT_EQ(LoadViewInputs(request)[0].name, "left") << "by the files' names";
  EXPECT_TRUE(LoadViewInputs(request)[0].camera_from_rig->camera_from_world_translation.isZero());
  file[0].name = "a";
  file[1].name = "b";
  write();
  const std::vector<ViewInputs> ordered = LoadViewInputs(request);
  EXPECT_EQ(ordered[0].name, "a");
  EXPECT_FALSE(ordered[1].clock.HasClock()) << "no rig's file";
  request.views = {"b", "a"};
  EXPECT_EQ(LoadViewInputs(request)[0].name, "b");
  request.views = {"b", "c"};
  EXPECT_THAT([&] { LoadViewInputs(request); }, ThrowsMessage<std::runtime_error>(HasSubstr("no camera 'c'")));
  request.views.clear();
  file.push_back(file[1]);
  file[2].name = "d";
  write();
  EXPECT_THAT([&] { LoadViewInputs(request); },
              ThrowsMessage<std::runtime_error>(HasSubstr("2 cameras in the order of the views")));
  request.image_width = 64;
  request.image_height = 48;
  file.pop_back();
  write();
  EXPECT_THAT([&] { LoadViewInputs(request); },
              ThrowsMessage<std::runtime_error>(HasSubstr("--image-size says 64x48")));
}

TEST_F(TrackViewsClipTest, ClocksOfARigAreRelativeToTheFirstView) {
  std::vector<RigCamera> rig = ReadRig(WriteTrueRig());
  rig[0].offset_s = -1.5;
  rig[0].rate = 1e-3;
  rig[1].rate = 2e-3;
  rig[1].middle_s = 3;
  WriteRig(folder_ / "rig.json", rig);
  TrackViewsRequest request = Request();
  request.cameras = folder_ / "rig.json";
  const std::vector<ViewInputs> views = LoadViewInputs(request);
  ASSERT_TRUE(views[1].clock.HasClock());
  for (const double first_s : {0.5, 2.0}) {
    const double common_s = rig[0].FirstTimeAt(first_s);
    EXPECT_NEAR(rig[0].TimeAt(common_s), first_s, 1e-12);
    EXPECT_NEAR(views[1].clock.TimeAt(first_s), rig[1].TimeAt(common_s), 1e-12);
  }
  EXPECT_NEAR(views[1].clock.TimeAt(views[1].inputs.timestamps()[0]), 6 / 30.0 + kOffset_s, 1e-9);
  request.known = KnownOfRig::kPoses;
  EXPECT_NEAR(LoadViewInputs(request)[1].inputs.timestamps()[0], 6 / 30.0 + kOffset_s, 1e-9);
}

TEST_F(TrackViewsClipTest, SomePosesAreAnError) {
  WriteFileAtomically(folder_ / "cameras.json",
                      R"([{"name":"left","width":960,"height":720,"fx":1000,"rotation":[0,0,0],"translation":[0,0,0]},)"
                      R"({"name":"right","width":960,"height":720,"fx":1000}])");
  TrackViewsRequest request = Request();
  request.cameras = folder_ / "cameras.json";
  EXPECT_THAT([&] { LoadViewInputs(request); },
              ThrowsMessage<std::runtime_error>(HasSubstr("1 of the 2 views' cameras have a pose")));
  request.known = KnownOfRig::kIntrinsics;
  EXPECT_FALSE(LoadViewInputs(request)[0].camera_from_rig.has_value());
}

TEST(TrackViewsRequest, ContradictionsAreNamed) {
  TrackViewsRequest good;
  good.view_detections = {"a.json", "b.json"};
  good.out = "track.npz";
  EXPECT_NO_THROW(CheckTrackViewsRequest(good));
  EXPECT_TRUE(HasSeveralViews(good));
  const auto expect = [&](const auto& change, const std::string& message) {
    TrackViewsRequest request = good;
    change(&request);
    EXPECT_THAT([&] { CheckTrackViewsRequest(request); }, ThrowsMessage<RequestError>(HasSubstr(message)));
  };
  using Request = TrackViewsRequest;
  expect([](Request* r) { r->views = {"c01", "c01"}; }, "--view lists c01 twice");
  expect([](Request* r) { r->views = {"c01", "c02", "c03"}; }, "2 files of --detections and 3 names in --view");
  expect([](Request* r) { r->views = {"c01", ""}; }, "an empty name");
  expect([](Request* r) { r->view_detections = {"a.json", "a.json"}; }, "a.json is given twice");
  expect([](Request* r) { r->view_detections.clear(); }, "give --detections");
  expect([](Request* r) { r->camera_path = "sparse"; }, "several views need a path each");
  expect([](Request* r) { r->camera = "weak"; }, "leave out --camera weak");
  expect([](Request* r) { r->dense = "iuv"; }, "leave out --dense");
  expect([](Request* r) { r->part_labels = "labels.npz"; }, "leave out --part-labels");
  expect([](Request* r) { r->init = "wham.pkl"; }, "leave out --init");
  expect([](Request* r) { r->live_lag = 4; }, "leave out --live");
  expect([](Request* r) { r->known = KnownOfRig::kPoses; }, "give --cameras");
  expect([](Request* r) { r->out.clear(); }, "--out is required");
  TrackViewsRequest one = good;
  one.view_detections = {"a.json"};
  one.views = {"c01"};
  EXPECT_FALSE(HasSeveralViews(one));
  EXPECT_EQ(RequestOfOneView(one).detections, "a.json");
  EXPECT_EQ(RequestOfOneView(one).view, "c01");
  one.rig_out = "rig.json";
  EXPECT_THAT([&] { RequestOfOneView(one); }, ThrowsMessage<RequestError>(HasSubstr("--rig-out is of several views")));
  one.rig_out.clear();
  one.same_lens = true;
  EXPECT_THAT([&] { RequestOfOneView(one); },
              ThrowsMessage<RequestError>(HasSubstr("--same-lens is of several views")));
}

TEST_F(TrackViewsClipTest, ItsRigIsExported) {
  ExportRigRequest request;
  request.cameras = WriteTrueRig();
  for (const std::string& form : RigFormNames()) {
    request.form = RigFormFromString(form);
    request.out = folder_ / form;
    const ExportRigReport report = ExportRig(request);
    EXPECT_THAT(report.cameras, ::testing::ElementsAre("left", "right"));
    EXPECT_THAT(ToText(report), HasSubstr("wrote " + request.out));
    EXPECT_TRUE(std::filesystem::exists(request.form == RigForm::kColmap ? request.out + "/images.txt" : request.out));
  }
  WriteFileAtomically(folder_ / "one.json", R"({"name":"a","width":640,"height":480,"fx":600})");
  request.cameras = folder_ / "one.json";
  EXPECT_THAT([&] { ExportRig(request); }, ThrowsMessage<std::runtime_error>(HasSubstr("camera a has no pose")));
  WriteFileAtomically(folder_ / "names.json",
                      R"({"name":"a b","width":640,"height":480,"fx":600,"rotation":[0,0,0],"translation":[0,0,0]})");
  request.cameras = folder_ / "names.json";
  request.form = RigForm::kToml;
  request.out = folder_ / "names.toml";
  EXPECT_THAT([&] { ExportRig(request); }, ThrowsMessage<std::runtime_error>(HasSubstr("names.json: ")));
  request.cameras = "";
  EXPECT_THROW(ExportRig(request), RequestError);
}

}  // namespace
}  // namespace bodyloom::track_views_clip_test
