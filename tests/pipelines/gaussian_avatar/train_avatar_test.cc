// SPDX-License-Identifier: Apache-2.0
// Training of an avatar of a synthetic person from a dataset and from a video, resuming, and rendering.
#include "pipelines/gaussian_avatar/train_avatar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "data_tools/avatar/avatar_file.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/json_reader.h"
#include "data_tools/formats/npz.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/part_labels.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_reader.h"
#include "geometry/base/check.h"
#include "pipelines/clip_span.h"
#include "pipelines/gaussian_avatar/animate_avatar.h"
#include "pipelines/gaussian_avatar/shown_avatar.h"
#include "pipelines/synthesis/synthesize_person.h"
#include "render/gaussian_avatar/avatar_image.h"
#include "render/gaussian_avatar/learning/pose_refiner.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/render/splat/same_bytes.h"

namespace bodyloom::train_avatar_test {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 10, kSize = 128;

/// A small synthetic person, its frames as images and its mask, made once.
const TemporaryFolder& Scene() {
  static const TemporaryFolder folder;
  static const bool made = [] {
    SynthesizePersonRequest request;
    request.motions = {"demo"};
    request.out = folder.File("person");
    request.motion.num_frames = kFrames;
    request.set.size_px = kSize, request.set.num_threads = 2;
    SynthesizePerson(request, {});
    const SinglePersonDataset set(folder.File("person"));
    PartLabelSequence mask;
    mask.image_width = mask.image_height = kSize;
    for (int t = 0; t < kFrames; ++t) {
      const PersonFrame frame = set.Read(t);
      LabelImage labels = {0, 0, kSize, kSize, std::vector<uint8_t>(kSize * kSize)};
      for (int i = 0; i < kSize * kSize; ++i) labels.labels[i] = frame.labels.bgr[3 * i] != 0 ? 1 : 0;
      mask.frames.emplace_back(labels);
      mask.timestamps.push_back(t / 30.0);
    }
    WriteMask(folder.File("mask.npz"), mask);
    return true;
  }();
  EXPECT_TRUE(made);
  return folder;
}

TrainAvatarRequest SmallRequest(const std::string& out) {
  TrainAvatarRequest request;
  request.clip.data = Scene().File("person");
  request.clip.threads = 2;
  request.out = out;
  request.steps = 60;
  request.skin_side = 64, request.loose = 400;
  request.train = {"0-7"}, request.validate = {"8-9"};
  request.garment = false;
  return request;
}

TEST(TrainAvatar, EndsWhereFramesHeldOutGainNothing) {
  const TemporaryFolder folder;
  TrainAvatarRequest request = SmallRequest(folder.File("run"));
  request.train = {"0-1"}, request.steps = 20000;
  const TrainAvatarSummary summary = TrainAvatar(request);
  EXPECT_LT(summary.steps, 10000);
  // The plateau is found in the smoothed losses, the best person by a single one: it may be that of the evaluation
  // that starts the cooldown.
  EXPECT_GE(summary.cooldown_step, summary.best_step);
  EXPECT_GT(summary.steps, summary.cooldown_step);
  EXPECT_EQ(summary.best_step % 250, 0);
  // The file has the person who was best, not the last.
  const AvatarTrainingState state = ReadAvatarCheckpoint(AvatarCheckpointPath(request.out)).state;
  const GaussianBody written = ReadAvatar(AvatarPath(request.out)).body;
  EXPECT_TRUE(SameBytes(written.parameters, state.ResultBody().parameters));
  EXPECT_FALSE(SameBytes(written.parameters, state.body.parameters));
  const std::string report = ReadFileBytes(folder.File("run/report.json"));
  EXPECT_NE(report.find("\"cooldown_step\": " + std::to_string(summary.cooldown_step)), std::string::npos) << report;
  EXPECT_NE(ReadFileBytes(folder.File("run/metrics.csv")).find(",held_out,"), std::string::npos);
  // Resuming a finished run does nothing.
  request.resume = true;
  EXPECT_EQ(TrainAvatar(request).steps, summary.steps);

  request.out = folder.File("all"), request.resume = false, request.all_steps = true, request.steps = 300;
  const TrainAvatarSummary all = TrainAvatar(request);
  EXPECT_EQ(all.steps, 300);
  EXPECT_EQ(all.best_step, 0);
}

TEST(TrainAvatar, LearnsADatasetsPersonAndShowsIt) {
  const TemporaryFolder folder;
  const TrainAvatarSummary summary = TrainAvatar(SmallRequest(folder.File("run")));
  EXPECT_EQ(summary.steps, 60);
  EXPECT_GT(summary.loose, 20);
  ASSERT_TRUE(summary.validation.has_value());
  EXPECT_EQ(summary.validation->frames, 2);
  EXPECT_EQ(summary.training->frames, 8);
  EXPECT_GT(summary.validation->psnr_box_db, 16);
  EXPECT_GT(summary.validation->outline_iou, 0.75);
  for (const char* name :
       {"config.json", "checkpoint.npz", "avatar.npz", "metrics.csv", "report.json", "preview.png"}) {
    EXPECT_TRUE(fs::exists(folder.File("run") + "/" + name)) << name;
  }

  AnimateAvatarRequest show;
  show.run = folder.File("run");
  show.data = Scene().File("person");
  show.threads = 1;
  show.pictures = folder.File("pictures"), show.set = folder.File("set");
  show.ply = folder.File("rest.ply"), show.posed_ply = folder.File("posed.ply"), show.posed_frame = 3;
  const AnimateAvatarSummary shown = AnimateAvatar(show);
  EXPECT_EQ(shown.frames, kFrames);
  ASSERT_TRUE(shown.scores.has_value());
  EXPECT_EQ(shown.scores->frames, kFrames);
  EXPECT_GT(shown.scores->psnr_box_db, 16);
  const cv::Mat image = cv::imread(folder.File("pictures/000003.png"), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(image.type(), CV_8UC4);
  EXPECT_EQ(image.cols, kSize);
  int inside = 0;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) inside += image.at<cv::Vec4b>(y, x)[3] > 127 ? 1 : 0;
  }
  const SinglePersonDataset set(Scene().File("person"));
  const PersonFrame frame = set.Read(3);
  int truth = 0;
  for (int i = 0; i < kSize * kSize; ++i) truth += frame.labels.bgr[3 * i] != 0 ? 1 : 0;
  EXPECT_NEAR(inside, truth, 0.25 * truth);
  // The same person in the dataset, where nobody told clothes apart.
  const SinglePersonDataset shown_set(show.set);
  ASSERT_EQ(shown_set.info().num_frames, kFrames);
  EXPECT_EQ(shown_set.track().motion.poses, set.track().motion.poses);
  const Image labels = shown_set.Read(3).labels;
  int labelled = 0;
  for (int i = 0; i < kSize * kSize; ++i) {
    const auto label = static_cast<PersonLabel>(labels.bgr[3 * i]);
    EXPECT_TRUE(label == PersonLabel::kBackground || label == PersonLabel::kSkin);
    labelled += label == PersonLabel::kSkin ? 1 : 0;
  }
  EXPECT_EQ(labelled, inside);
  const std::string rest = ReadFileBytes(show.ply), posed = ReadFileBytes(show.posed_ply);
  EXPECT_EQ(rest.substr(0, 4), "ply\n");
  EXPECT_EQ(rest.size(), posed.size());
  EXPECT_NE(rest, posed);

  AnimateAvatarRequest turned;
  turned.run = folder.File("run/avatar.npz");
  turned.track = Scene().File("person/track.npz");
  turned.view_yaw = "0:180", turned.freeze = "2:3", turned.size = 96;
  turned.out = folder.File("turned.mp4");
  turned.threads = 1;
  const AnimateAvatarSummary other = AnimateAvatar(turned);
  EXPECT_EQ(other.frames, kFrames + 3);
  EXPECT_EQ(other.width, 96);
  EXPECT_FALSE(other.scores.has_value());
  EXPECT_EQ(VideoReader(turned.out).info().num_frames, kFrames + 3);

  turned.set = folder.File("turned_set");
  EXPECT_THROW(AnimateAvatar(turned), RequestError) << "the track beside the images would be another";
  EXPECT_FALSE(fs::exists(turned.set));
  turned.set.clear();
  turned.size = 0, turned.data = Scene().File("person");
  EXPECT_THROW(AnimateAvatar(turned), RequestError);
}

TEST(ShownAvatar, DrawsInMemoryWhatTheFilesShow) {
  const TemporaryFolder folder;
  TrainAvatarRequest train = SmallRequest(folder.File("run"));
  train.steps = 5;
  TrainAvatar(train);
  AnimateAvatarRequest files;
  files.run = train.out;
  files.track = Scene().File("person/track.npz");
  files.view_yaw = "40", files.size = 96;
  files.pictures = folder.File("files");
  AnimateAvatar(files);

  const LearnedAvatar avatar = ReadLearnedAvatar(train.out, "");
  const Track track = ReadTrack(files.track);
  ShownMotion motion;
  motion.track = track, motion.where = "dance", motion.view_yaw = "40", motion.size = 96;
  ShownAvatar shown(avatar, motion, 1, {});
  ASSERT_EQ(shown.num_frames(), kFrames);
  for (const int t : {7, 2}) {  // in any order
    const cv::Mat image = cv::imread(Concatenate(files.pictures, "/00000", t, ".png"), cv::IMREAD_UNCHANGED);
    const std::vector<uint8_t> drawn = WithAlpha(shown.Draw(t), shown.width(), shown.height());
    ASSERT_EQ(drawn.size(), image.total() * image.elemSize());
    EXPECT_TRUE(std::equal(drawn.begin(), drawn.end(), image.data)) << "frame " << t;
  }

  // A person and a motion in memory, files all the same.
  AnimateAvatarRequest memory = files;
  memory.motion = &track;
  memory.run = memory.track = "nothere";
  memory.pictures = folder.File("memory");
  AnimateLearnedAvatar(avatar, memory);
  EXPECT_EQ(ReadFileBytes(memory.pictures + "/000007.png"), ReadFileBytes(files.pictures + "/000007.png"));

  motion.view_yaw = "aside";
  EXPECT_THROW(ShownAvatar(avatar, motion, 1, {}), RequestError);
  EXPECT_THROW(ReadLearnedAvatar(folder.File("nothere"), ""), std::runtime_error);
}

TEST(TrainAvatar, IsShownAsItWasLearned) {
  const TemporaryFolder folder;
  TrainAvatarRequest request = SmallRequest(folder.File("learned"));
  request.train = {"0-9"}, request.validate = {};
  const TrainAvatarSummary learned = TrainAvatar(request);
  AnimateAvatarRequest show;
  show.run = request.out;
  show.data = Scene().File("person");
  show.threads = 1;
  const AnimateAvatarSummary shown = AnimateAvatar(show);
  EXPECT_EQ(shown.scores->frames, learned.training->frames);
  EXPECT_NEAR(shown.scores->psnr_box_db, learned.training->psnr_box_db, 1e-9);
  EXPECT_NEAR(shown.scores->ssim, learned.training->ssim, 1e-9);

  // A network of the motion, which persons of earlier versions learned, is left out, and said to be.
  NpzArrays arrays = ReadNpz(AvatarPath(request.out));
  arrays["motion_network"] = NdArray::FromDouble(0);
  WriteNpz(folder.File("old.npz"), arrays);
  show.run = folder.File("old.npz");
  std::string said;
  PipelineCallbacks callbacks;
  callbacks.message = [&](const std::string& line) { said += line; };
  EXPECT_EQ(AnimateAvatar(show, callbacks).scores->psnr_box_db, shown.scores->psnr_box_db);
  EXPECT_NE(said.find("old.npz: learned a network of the motion"), std::string::npos) << said;
  arrays = ReadNpz(AvatarCheckpointPath(request.out));
  arrays["motion_network"] = NdArray::FromDouble(0);
  WriteNpz(AvatarCheckpointPath(request.out), arrays);
  request.resume = true;
  EXPECT_THROW(TrainAvatar(request), RequestError);
}

TEST(TrainAvatar, FindsTheSkirtAndLetsItSwing) {
  const TemporaryFolder folder;
  TrainAvatarRequest request = SmallRequest(folder.File("bare"));
  const TrainAvatarSummary bare = TrainAvatar(request);
  EXPECT_EQ(bare.cloth, 0);
  request.out = folder.File("whole"), request.garment = true;
  const TrainAvatarSummary summary = TrainAvatar(request);
  EXPECT_GT(summary.cloth, 1000);
  EXPECT_GT(summary.garment_length_m, 0.25);
  EXPECT_GT(summary.validation->outline_iou, bare.validation->outline_iou);
  const AvatarFile avatar = ReadAvatar(AvatarPath(request.out));
  ASSERT_TRUE(avatar.garment.has_value());
  EXPECT_EQ(avatar.num_bones(), avatar.num_joints + avatar.garment->num_nodes());

  // Gone on with it is not looked for again, and comes out the same.
  request.out = folder.File("parts"), request.clip.threads = 1;
  PipelineCallbacks callbacks;
  int calls = 0;
  callbacks.progress = [&](const std::string& stage, double) { return stage.rfind("loss", 0) != 0 || ++calls < 9; };
  EXPECT_TRUE(TrainAvatar(request, callbacks).stopped);
  request.resume = true;
  bool looked = false;
  callbacks.progress = [&](const std::string& stage, double) {
    looked = looked || stage == "looking for a garment";
    return true;
  };
  TrainAvatar(request, callbacks);
  EXPECT_FALSE(looked);
  const auto fit = [&](const std::string& run) {
    return ReadJsonFile(folder.File(run + "/report.json")).at("garment");
  };
  EXPECT_GT(fit("whole").at("found_in"), 0);
  EXPECT_EQ(fit("parts"), fit("whole"));
  const AvatarFile parts = ReadAvatar(AvatarPath(request.out));
  ASSERT_EQ(avatar.body.size(), parts.body.size());
  for (int c = 0; c < GaussianBody::kNumParameters; ++c) {
    for (int i = 0; i < avatar.body.size(); ++i) {
      ASSERT_EQ(avatar.body.parameters(i, c), parts.body.parameters(i, c)) << c;
    }
  }
  request.garment = false;
  EXPECT_THROW(TrainAvatar(request), RequestError) << "begun with a garment";

  // The garment's pixels are those of the truth's skirt, as a dataset says them.
  AnimateAvatarRequest compare;
  compare.run = folder.File("whole"), compare.data = Scene().File("person"), compare.set = folder.File("set");
  compare.threads = 2;
  const AnimateAvatarSummary compared = AnimateAvatar(compare);
  const SinglePersonDataset truth(compare.data), result(compare.set);
  size_t both = 0, either = 0;
  for (int t = 0; t < kFrames; ++t) {
    const Image a = truth.Read(t).labels, b = result.Read(t).labels;
    for (int i = 0; i < kSize * kSize; ++i) {
      const bool in_a = a.bgr[3 * i] == uint8_t(PersonLabel::kBottom),
                 in_b = b.bgr[3 * i] == uint8_t(PersonLabel::kBottom);
      both += in_a && in_b ? 1 : 0, either += in_a || in_b ? 1 : 0;
    }
  }
  EXPECT_NEAR(static_cast<double>(both) / static_cast<double>(either), *compared.scores->garment_iou, 0.02);

  // Time that stands still is the same picture, cloth included.
  AnimateAvatarRequest show;
  show.run = folder.File("whole"), show.track = Scene().File("person/track.npz");
  show.freeze = "4:3", show.pictures = folder.File("pictures"), show.report = folder.File("page.html");
  show.ply = folder.File("rest.ply");
  show.threads = 1;
  EXPECT_EQ(AnimateAvatar(show).frames, kFrames + 3);
  const std::string fourth = ReadFileBytes(folder.File("pictures/000004.png"));
  EXPECT_EQ(fourth, ReadFileBytes(folder.File("pictures/000007.png")));
  EXPECT_NE(fourth, ReadFileBytes(folder.File("pictures/000008.png")));

  // A garment that is not the stored one is refused.
  AvatarFile other = avatar;
  other.garment->cut.length_m += 0.05;
  WriteAvatar(folder.File("other.npz"), other);
  show.run = folder.File("other.npz");
  EXPECT_THROW(AnimateAvatar(show), std::runtime_error);
}

TEST(TrainAvatar, AVideoWithAMaskIsTheSame) {
  const TemporaryFolder folder;
  TrainAvatarRequest request = SmallRequest(folder.File("set"));
  request.steps = 6;
  TrainAvatar(request);
  request.clip.data = Scene().File("person/images");
  request.clip.track = Scene().File("person/track.npz");
  request.clip.mask = Scene().File("mask.npz");
  request.out = folder.File("video");
  TrainAvatar(request);
  const AvatarFile a = ReadAvatar(AvatarPath(folder.File("set"))), b = ReadAvatar(AvatarPath(folder.File("video")));
  ASSERT_EQ(a.body.size(), b.body.size());
  for (int c = 0; c < GaussianBody::kNumParameters; ++c) {
    for (int i = 0; i < a.body.size(); ++i) ASSERT_EQ(a.body.parameters(i, c), b.body.parameters(i, c));
  }
  request.out = folder.File("other");
  request.clip.mask.clear();
  EXPECT_THROW(TrainAvatar(request), RequestError);
}

TEST(TrainAvatar, GoesOnAsIfNeverLeft) {
  const TemporaryFolder folder;
  TrainAvatarRequest request = SmallRequest(folder.File("whole"));
  request.steps = 20;
  TrainAvatar(request);
  request.out = folder.File("parts");
  request.clip.threads = 1;
  PipelineCallbacks callbacks;
  int calls = 0;
  callbacks.progress = [&](const std::string& stage, double) { return stage.rfind("loss", 0) != 0 || ++calls < 7; };
  const TrainAvatarSummary stopped = TrainAvatar(request, callbacks);
  EXPECT_TRUE(stopped.stopped);
  EXPECT_EQ(stopped.steps, 7);
  EXPECT_FALSE(stopped.validation.has_value());
  EXPECT_THROW(TrainAvatar(request), RequestError) << "there is a run";
  request.resume = true;
  const TrainAvatarSummary end = TrainAvatar(request);
  EXPECT_EQ(end.steps, 20);
  const AvatarFile a = ReadAvatar(AvatarPath(folder.File("whole"))), b = ReadAvatar(AvatarPath(folder.File("parts")));
  ASSERT_EQ(a.body.size(), b.body.size());
  for (int c = 0; c < GaussianBody::kNumParameters; ++c) {
    for (int i = 0; i < a.body.size(); ++i) ASSERT_EQ(a.body.parameters(i, c), b.body.parameters(i, c)) << c;
  }
  EXPECT_EQ(a.body.light, b.body.light);
  request.seed = 2;
  EXPECT_THROW(TrainAvatar(request), RequestError) << "another seed is another run";
  request.out = folder.File("nothing");
  EXPECT_THROW(TrainAvatar(request), RequestError);
}

/// The scene's track with every frame's body somewhat beside the truth. As in every track of one camera nobody knows
/// how far away it is.
std::string TrackBeside(const TemporaryFolder& folder) {
  Track track = ReadTrack(Scene().File("person/track.npz"));
  for (int t = 0; t < track.num_frames(); ++t) track.motion.trans.row(t) += Eigen::RowVector3d(0.02, -0.015, 0);
  track.world = WorldFrame{};
  track.joint_sigma.setConstant(track.num_frames(), static_cast<int>(track.joints[0].rows()), 0.03);
  track.root_sigma.setConstant(track.num_frames(), 0.28);
  WriteTrack(folder.File("beside.npz"), track);
  return folder.File("beside.npz");
}

TEST(TrainAvatar, RefinesTheTrack) {
  const TemporaryFolder folder;
  TrainAvatarRequest request = SmallRequest(folder.File("run"));
  // The person is learned where the truth is; then all frames are beside it.
  request.steps = 100;
  TrainAvatar(request);
  request.clip.track = TrackBeside(folder);
  request.resume = true, request.refined_track = folder.File("refined.npz");
  const TrainAvatarSummary summary = TrainAvatar(request);
  ASSERT_TRUE(summary.validation_refined.has_value());
  EXPECT_GT(summary.validation_refined->psnr_box_db, summary.validation->psnr_box_db + 0.5);
  EXPECT_EQ(summary.written.back(), request.refined_track);
  EXPECT_TRUE(fs::exists(folder.File("run/preview_refined.png")));
  const Track truth = ReadTrack(Scene().File("person/track.npz")), before = ReadTrack(request.clip.track);
  const Track after = ReadTrack(request.refined_track);
  ASSERT_EQ(after.num_frames(), kFrames);
  double was = 0, is = 0;
  for (int t = 0; t < kFrames; ++t) {
    was += (before.motion.trans.row(t) - truth.motion.trans.row(t)).head<2>().norm();
    is += (after.joints[t] - truth.joints[t]).leftCols<2>().rowwise().norm().mean();
    EXPECT_NE(after.motion.poses.row(t), before.motion.poses.row(t));
    EXPECT_TRUE(after.joints[t].row(0).isApprox((after.motion.trans.row(t) - before.motion.trans.row(t)) +
                                                    truth.joints[t].row(0) +
                                                    (before.motion.trans.row(t) - truth.motion.trans.row(t)),
                                                1e-9))
        << "joints are those of the refined pose";
  }
  EXPECT_LT(is, 0.6 * was);
  EXPECT_EQ(after.motion.betas, before.motion.betas);
  EXPECT_EQ(after.motion.timestamps, before.motion.timestamps);
  EXPECT_EQ(after.camera.K(), before.camera.K());
  EXPECT_EQ(after.frame_status, before.frame_status);
  EXPECT_TRUE(after.world.has_value());
  request.refined_track = request.clip.track;
  EXPECT_THROW(TrainAvatar(request), RequestError) << "an input";
}

TEST(TrainAvatar, RefiningGoesOnAsIfNeverLeft) {
  const TemporaryFolder folder;
  TrainAvatarRequest request = SmallRequest(folder.File("whole"));
  request.clip.track = TrackBeside(folder);
  request.steps = 20, request.refine = true;
  request.refine_rounds = 2, request.refined_track = folder.File("whole.npz");
  TrainAvatar(request);
  request.out = folder.File("parts"), request.refined_track = folder.File("parts.npz");
  request.clip.threads = 1;
  PipelineCallbacks callbacks;
  int calls = 0, stop_at = 9;
  callbacks.progress = [&](const std::string& stage, double) {
    return (stage.rfind("loss", 0) != 0 && stage != "refining the track") || ++calls < stop_at;
  };
  EXPECT_TRUE(TrainAvatar(request, callbacks).stopped);
  EXPECT_FALSE(fs::exists(request.refined_track));
  request.resume = true;
  calls = 0, stop_at = 15;  // eleven steps are left of learning
  const TrainAvatarSummary stopped = TrainAvatar(request, callbacks);
  EXPECT_EQ(stopped.steps, 20);
  EXPECT_TRUE(stopped.stopped);
  EXPECT_FALSE(fs::exists(request.refined_track));
  TrainAvatar(request);
  const AvatarCheckpoint a = ReadAvatarCheckpoint(AvatarCheckpointPath(folder.File("whole")));
  const AvatarCheckpoint b = ReadAvatarCheckpoint(AvatarCheckpointPath(folder.File("parts")));
  ASSERT_EQ(a.state.poses.values.rows(), kFrames);
  int moved = 0;
  for (int t = 0; t < kFrames; ++t) {
    moved += a.state.poses.IsZero(t) ? 0 : 1;
    for (int c = 0; c < a.state.poses.values.columns(); ++c) {
      ASSERT_EQ(a.state.poses.values(t, c), b.state.poses.values(t, c)) << t;
    }
  }
  EXPECT_EQ(moved, 8) << "the frames learned from, not those held out";
  EXPECT_EQ(ReadFileBytes(folder.File("whole.npz")), ReadFileBytes(folder.File("parts.npz")));
  request.refine = false;
  EXPECT_THROW(TrainAvatar(request), RequestError) << "begun with --refine";
}

TEST(RefinedTrack, WithoutCorrectionsIsTheTrackByteForByte) {
  const TemporaryFolder folder;
  const std::shared_ptr<const BodyModel> body = BodyOrBuiltin("");
  const Track track = ReadTrack(TrackBeside(folder));
  const PoseRefiner refiner(*body, track.motion.betas, TrackedPoses(*body, track), {});
  PoseCorrections corrections;
  corrections.Reset(kFrames, body->num_joints());
  WriteTrack(folder.File("track.npz"), track);
  WriteTrack(folder.File("same.npz"), RefinedTrack(*body, track, refiner, corrections));
  EXPECT_EQ(ReadFileBytes(folder.File("track.npz")), ReadFileBytes(folder.File("same.npz")));
  corrections.values(2, 7) = 0.1F;
  const Track other = RefinedTrack(*body, track, refiner, corrections);
  for (int t = 0; t < kFrames; ++t) {
    for (int j = 0; j < body->num_joints(); ++j) {
      const bool same = other.motion.poses.row(t).segment<3>(3 * j) == track.motion.poses.row(t).segment<3>(3 * j);
      EXPECT_EQ(same, t != 2 || j != 2) << t << " " << j;
    }
  }
}

TEST(FrameSpans, AreWhatIsAskedFor) {
  const TrainingSplit usual = ReadTrainingSplit({}, {}, 10);
  EXPECT_EQ(usual.train.size(), 8U);
  EXPECT_EQ(usual.validation, (std::vector<int>{8, 9}));
  const TrainingSplit rest = ReadTrainingSplit({}, {"2-3", "5-5"}, 7);
  EXPECT_EQ(rest.train, (std::vector<int>{0, 1, 4, 6}));
  EXPECT_EQ(rest.validation, (std::vector<int>{2, 3, 5}));
  const TrainingSplit none = ReadTrainingSplit({"1-2"}, {}, 7);
  EXPECT_EQ(none.train, (std::vector<int>{1, 2}));
  EXPECT_TRUE(none.validation.empty());
  for (const char* bad : {"5", "3-2", "0-10", "-1-3", "1-2x", ""}) {
    EXPECT_THROW(ReadTrainingSplit({bad}, {}, 10), RequestError) << bad;
  }
  EXPECT_THROW(ReadTrainingSplit({"0-4"}, {"4-5"}, 10), RequestError);
}

}  // namespace
}  // namespace bodyloom::train_avatar_test
