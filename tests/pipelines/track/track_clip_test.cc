// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/track_clip.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/npz.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/load_detections.h"
#include "data_tools/observations/observations_npz.h"
#include "data_tools/observations/people_npz.h"
#include "pipelines/export/export_track.h"
#include "pipelines/page/report_page.h"
#include "pipelines/score/evaluate_track.h"
#include "pipelines/synthesis/synthesize_clip.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_files.h"

namespace bodyloom::track_clip_test {
namespace {

SynthClipFiles SmallClip(const ScratchFolder& folder) {
  SynthesizeClipRequest request;
  request.motion = {.name = "demo", .fps = 15, .num_frames = 8};
  request.out = folder / "clip";
  request.clip.dense_per_frame = 0;
  return SynthesizeClip(request).files;
}

/// Its joints and its camera, into track.npz of the folder.
TrackRequest RequestFor(const SynthClipFiles& clip, const ScratchFolder& folder) {
  TrackRequest request;
  request.detections = clip.observations;
  request.cameras = clip.camera;
  request.out = folder / "track.npz";
  return request;
}

/// A file of that clip's joints and of a right hand whose points lie in a row from the wrist.
std::string WithHand(const SynthClipFiles& clip, const ScratchFolder& folder) {
  const KeypointSequence seen = LoadDetections(clip.observations);
  const auto wrist = std::find(seen.names.begin(), seen.names.end(), "right_wrist") - seen.names.begin();
  PeopleSequence people;
  people.convention = {seen.convention, seen.names};
  people.timestamps = seen.timestamps;
  people.image_width = seen.image_width, people.image_height = seen.image_height;
  for (int t = 0; t < seen.num_frames(); ++t) {
    DetectedPerson& person = people.frames.emplace_back().emplace_back();
    for (int k = 0; k < seen.num_points(); ++k) person.points.push_back(seen.at(t, k));
    const Keypoint at = seen.at(t, static_cast<int>(wrist));
    HandObservation hand;
    for (int k = 0; k < kHandPoints; ++k) {
      hand.points[size_t(k)] = {at.x + 2.0F * float(k % 4), at.y + float(k), 0.9F};
      hand.sigma_px[size_t(k)] = 2;
    }
    auto parts = std::make_shared<HandsAndFace>();
    parts->hands[HandsAndFace::kRight] = hand;
    person.hands_and_face = parts;
  }
  const std::string path = folder / "with_hand.npz";
  WritePeople(path, people);
  return path;
}

TEST(TrackClip, HandsOfAFileAreUsedByABodyWithFingersUnlessTheyAreSwitchedOff) {
  const ScratchFolder folder;
  TrackRequest request = RequestFor(SmallClip(folder), folder);
  request.detections = WithHand(SmallClip(folder), folder);
  const auto line = [](const TrackRequest& of, const std::string& what) {
    TrackRequest planned = of;
    planned.plan = true;
    for (const PlanEntry& entry : TrackClip(planned).solve.plan) {
      if (entry.what == what) return (entry.runs ? "run: " : "skip: ") + entry.why;
    }
    return std::string("no line");
  };
  EXPECT_EQ(line(request, "hands"), "no line") << "the built-in body has none";
  request.body = kBodyWithHands;
  EXPECT_EQ(line(request, "hands"), "run: fingers, wrists and forearms, after the body");
  const TrackReport used = TrackClip(request);
  ASSERT_EQ(used.solve.hands.size(), 2U);
  EXPECT_TRUE(used.solve.hands[1].ran);
  EXPECT_EQ(used.solve.hands[1].frames_seen, 8);
  const Track with = ReadTrack(request.out);

  request.detector.hands_and_faces = HandsAndFaceChoice::kOff;
  EXPECT_EQ(line(request, "hands"), "skip: switched off");
  EXPECT_EQ(line(request, "head by the face"), "skip: switched off");
  EXPECT_TRUE(TrackClip(request).solve.hands.empty());
  const Track without = ReadTrack(request.out);
  EXPECT_EQ(without.motion.poses.cols(), with.motion.poses.cols()) << "the body that was asked for";
  EXPECT_TRUE((without.motion.poses.rightCols(90).array() == 0).all()) << "its fingers rest";
  EXPECT_FALSE((with.motion.poses.rightCols(90).array() == 0).all());

  request.detector.hands_and_faces.reset();
  request.live_lag = 4;
  EXPECT_EQ(line(request, "hands"), "skip: not in live mode");
  request.detector.hands_and_faces = HandsAndFaceChoice::kOn;
  EXPECT_THAT([&] { TrackClip(request); },
              ::testing::ThrowsMessage<RequestError>(::testing::HasSubstr("--live follows neither hands")));
}

TEST(TrackClip, ReportsWhatItWroteAndHowFarItIs) {
  const ScratchFolder folder;
  TrackRequest request = RequestFor(SmallClip(folder), folder);
  request.json = folder / "track.json";
  PipelineCallbacks callbacks;
  std::string work;
  double fraction = 0;
  callbacks.begin = [&](const std::string& name) { work = name; };
  callbacks.progress = [&](const std::string&, double done) {
    fraction = done;
    return true;
  };
  const TrackReport report = TrackClip(request, callbacks);
  EXPECT_EQ(work, "tracking 8 frames");
  EXPECT_EQ(fraction, 1);
  EXPECT_EQ(report.num_frames, 8);
  EXPECT_EQ(report.outputs, (std::vector<std::string>{request.out, request.json}));
  EXPECT_EQ(FileBytes(request.json), ToJson(report));
  EXPECT_TRUE(std::filesystem::exists(request.out));
}

TEST(TrackClip, LostEndsAreLeftOutOfFormsThatNeedEveryFrame) {
  const ScratchFolder folder;
  const TrackRequest request = RequestFor(SmallClip(folder), folder);
  TrackClip(request);
  Track track = ReadTrack(request.out);
  const auto lose = [&](int t) {
    track.frame_status[t] = FrameStatus::kLost;
    track.motion.poses.row(t).setConstant(NAN);
    track.motion.trans.row(t).setConstant(NAN);
    track.joints[t].setConstant(NAN);
    track.coco17[t].setConstant(NAN);
  };
  for (const int t : {0, 1, 7}) lose(t);
  WriteTrack(request.out, track);
  ExportTrackRequest amass;
  amass.tracks = {request.out};
  amass.form = TrackForm::kAmass;
  amass.out = folder / "amass.npz";
  const ExportTrackReport report = ExportTrack(amass);
  EXPECT_EQ(report.lost_before, 2);
  EXPECT_EQ(report.lost_after, 1);
  EXPECT_THAT(ToText(report), testing::HasSubstr("left out 2 frames before the first and 1 after the last"));
  EXPECT_EQ(ReadNpz(amass.out).at("poses").shape[0], 5);
  amass.form = TrackForm::kBvh;
  amass.out = folder / "a.bvh";
  ExportTrack(amass);
  EXPECT_THAT(FileBytes(amass.out), testing::HasSubstr("Frames: 5"));
}

TEST(TrackClip, LostFramesBetweenAreInterpolatedInFormsThatNeedEveryFrame) {
  const ScratchFolder folder;
  const TrackRequest request = RequestFor(SmallClip(folder), folder);
  TrackClip(request);
  Track track = ReadTrack(request.out);
  for (const int t : {3, 4}) {
    track.frame_status[t] = FrameStatus::kLost;
    track.motion.poses.row(t).setConstant(NAN);
    track.motion.trans.row(t).setConstant(NAN);
    track.joints[t].setConstant(NAN);
    track.coco17[t].setConstant(NAN);
  }
  WriteTrack(request.out, track);
  ExportTrackRequest amass;
  amass.tracks = {request.out};
  amass.form = TrackForm::kAmass;
  amass.out = folder / "amass.npz";
  const ExportTrackReport report = ExportTrack(amass);
  EXPECT_EQ(report.lost_between, 2);
  EXPECT_THAT(ToText(report), testing::HasSubstr("filled   2 lost frames"));
  const RowMatrixXd trans = ReadNpz(amass.out).at("trans").ToMatrix(),
                    poses = ReadNpz(amass.out).at("poses").ToMatrix();
  ASSERT_EQ(trans.rows(), 8);
  // The root turns about the pelvis, so its place is interpolated in the camera's frame as in the file's.
  EXPECT_TRUE(poses.allFinite());
  const Eigen::RowVector3d step = trans.row(4) - trans.row(3);
  EXPECT_LT((trans.row(3) - trans.row(2) - step).norm(), 0.02 * (1 + step.norm()));
  EXPECT_LT((trans.row(5) - trans.row(4) - step).norm(), 0.02 * (1 + step.norm()));
}

TEST(TrackClip, FollowsACameraThatMovesFromTheFilesToTheFiles) {
  const ScratchFolder folder;
  SynthesizeClipRequest synth;
  synth.motion = {.name = "demo", .fps = 15, .num_frames = 20};
  synth.out = folder / "clip";
  synth.clip.dense_per_frame = 0;
  synth.clip.camera_path.motion = SynthCameraMotion::kWalking;
  const SynthClipFiles clip = SynthesizeClip(synth).files;
  TrackRequest request = RequestFor(clip, folder);
  request.camera_path = clip.camera_path;
  request.report = folder / "page.html";
  const TrackReport report = TrackClip(request);
  EXPECT_EQ(report.camera_path.poses, 20);
  EXPECT_NE(ToText(report).find("\nscale    1.0000 m a unit of the path, as given"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(ToJson(report))["camera_path"]["scale_m"], 1);
  const std::string html = FileBytes(request.report);
  EXPECT_NE(html.find("\"cameras\":[[["), std::string::npos);
  const Track track = ReadTrack(request.out, MovingCamera::kTake), truth = ReadTrack(clip.truth, MovingCamera::kTake);
  ASSERT_EQ(track.camera_from_scene.size(), 20u);
  EXPECT_LT((track.camera_from_scene[19].camera_from_world_translation -
             truth.camera_from_scene[19].camera_from_world_translation)
                .norm(),
            1e-9);
  EvaluateTrackRequest evaluate;
  evaluate.track = request.out;
  evaluate.truth = clip.truth;
  EXPECT_LT(EvaluateTrack(evaluate).Value("w_mpjpe_mm"), 300);

  // To COLMAP and back, which forgets the length.
  ExportTrackRequest colmap;
  colmap.tracks = {clip.truth};
  colmap.form = TrackForm::kColmap;
  colmap.out = folder / "sparse";
  ExportTrack(colmap);
  request.cameras = "";
  request.camera_path = colmap.out;
  request.report = "";
  const TrackReport again = TrackClip(request);
  EXPECT_TRUE(again.solve.camera_path.estimated);
  EXPECT_NEAR(again.solve.focal_px, truth.camera.fx, 1e-6) << "COLMAP's intrinsics are used";
  request.camera_scale_m = 1;
  EXPECT_FALSE(TrackClip(request).solve.camera_path.estimated);

  // A path of another clip.
  request.camera_path_first = 15;
  EXPECT_THAT([&] { TrackClip(request); },
              testing::ThrowsMessage<std::runtime_error>(testing::HasSubstr("nothing is known of the camera")));
}

TEST(TrackClip, ThePageShowsEveryFrameAndGivesTheFilesAway) {
  const ScratchFolder folder;
  TrackRequest request = RequestFor(SmallClip(folder), folder);
  request.report = folder / "page.html";
  const TrackReport report = TrackClip(request);
  EXPECT_EQ(report.outputs, (std::vector<std::string>{request.out, request.report}));
  const std::string html = FileBytes(request.report);
  const auto script = [&](const std::string& id) {
    const size_t begin = html.find('>', html.find("<script id=\"" + id + "\"")) + 1;
    return html.substr(begin, html.find("</script>", begin) - begin);
  };
  const nlohmann::json shown = nlohmann::json::parse(script("clip"));
  ASSERT_EQ(shown["seconds"].size(), 8u);
  EXPECT_NEAR(shown["seconds"][7].get<double>(), 7 / 15.0, 1e-4);
  ASSERT_EQ(report.solve.frame_px.size(), 8u);
  for (int t = 0; t < 8; ++t) {
    EXPECT_NEAR(shown["people"][0]["residual_px"][t].get<double>(), report.solve.frame_px[size_t(t)], 0.0051) << t;
  }
  EXPECT_EQ(script("glb").substr(0, 5), Base64("glTF").substr(0, 5));
  EXPECT_EQ(script("file-0").substr(0, 12), Base64("HIERARCHY").substr(0, 12));
  EXPECT_EQ(script("file-1"), Base64(FileBytes(request.out)));
}

TEST(TrackClip, ACancelledOneLeavesNothingBehind) {
  const ScratchFolder folder;
  TrackRequest request = RequestFor(SmallClip(folder), folder);
  PipelineCallbacks callbacks;
  callbacks.progress = [&](const std::string&, double done) { return done < 0.2; };
  EXPECT_THROW(TrackClip(request, callbacks), Cancelled);
  EXPECT_EQ(folder.Entries(), std::vector<std::string>{"clip"});
}

/// Returns true if the plan for these joints, declared to be of that convention, has straight knees.
bool PlansStraightKnees(TrackRequest request, const std::string& convention, const ScratchFolder& folder) {
  KeypointSequence joints = KeypointsFromNpz(ReadNpz(request.detections), request.detections);
  joints.convention = convention;
  request.detections = folder / (convention + ".npz");
  WriteObservations(request.detections, &joints, nullptr);
  request.plan = true;
  const std::vector<PlanEntry> plan = TrackClip(request).solve.plan;
  return std::any_of(plan.begin(), plan.end(),
                     [](const PlanEntry& entry) { return entry.what == "straight knees" && entry.runs; });
}

TEST(TrackClip, KneesAreKeptStraightUnlessSwitchedOff) {
  const ScratchFolder folder;
  TrackRequest request;
  const SynthClipFiles clip = SmallClip(folder);
  request.detections = clip.observations;
  request.cameras = clip.camera;
  EXPECT_TRUE(PlansStraightKnees(request, "coco17", folder));
  EXPECT_TRUE(PlansStraightKnees(request, "mediapipe33", folder));
  request.straight_knees = 0;
  EXPECT_FALSE(PlansStraightKnees(request, "coco17", folder));
  EXPECT_FALSE(PlansStraightKnees(request, "mediapipe33", folder));
  request.straight_knees = 0.5;
  EXPECT_TRUE(PlansStraightKnees(request, "coco17", folder));
}

TEST(TrackClip, StraightKneesStraightenKnees) {
  const ScratchFolder folder;
  const SynthClipFiles clip = SmallClip(folder);
  const auto flexion_deg = [&](double weight) {
    TrackRequest request;
    request.detections = clip.observations;
    request.cameras = clip.camera;
    request.out = folder / "track.npz";
    request.straight_knees = weight;
    TrackClip(request);
    EvaluateTrackRequest evaluate;  // nothing to compare with
    evaluate.track = request.out;
    evaluate.json = folder / "knees.json";
    const Evaluation alone = EvaluateTrack(evaluate);
    EXPECT_EQ(alone.protocol, "track-alone");
    EXPECT_EQ(FileBytes(evaluate.json), EvaluationJson(alone));
    return alone.Value("knee_flexion_deg");
  };
  const double without = flexion_deg(0);
  EXPECT_GT(without, 3);
  EXPECT_LT(flexion_deg(5), 0.5 * without);
}

}  // namespace
}  // namespace bodyloom::track_clip_test
