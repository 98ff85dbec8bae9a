// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/track_io.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/npz.h"
#include "geometry/math/rotation.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::track_io_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kFrames = 5, kJoints = 24;
const double kNan = std::numeric_limits<double>::quiet_NaN();

Track SampleTrack(CameraModel model) {
  std::srand(1);
  Track track;
  track.motion.body = "bodyloom";
  track.motion.up = Motion::Up::kCamera;
  track.motion.poses = RowMatrixXd::Random(kFrames, 3 * kJoints);
  track.motion.trans = MatrixX3d::Random(kFrames, 3);
  track.motion.betas = Eigen::VectorXd::Random(10);
  track.motion.timestamps = {0.5, 0.55, 0.57, 0.59, 0.61};
  track.camera.model = model;
  track.camera.width = 1920;
  track.camera.height = 1080;
  track.camera.fx = 1500;
  track.camera.fy = 1510;
  track.camera.cx = 960;
  track.camera.cy = 540;
  track.camera.distortion = {0.1, -0.2, 0.001, 0.002, 0.3, 0, 0, 0.01};
  track.weak_camera.resize(model == CameraModel::kWeakPerspective ? kFrames : 0, 3);
  track.weak_camera.setConstant(2.5);
  track.frame_status = {FrameStatus::kTracked, FrameStatus::kWeak, FrameStatus::kInterpolated, FrameStatus::kLost,
                        FrameStatus::kTracked};
  track.motion.poses.row(3).setConstant(kNan);
  track.motion.trans.row(3).setConstant(kNan);
  for (int t = 0; t < kFrames; ++t) {
    track.joints.push_back(MatrixX3d::Random(kJoints, 3));
    track.coco17.push_back(MatrixX3d::Random(17, 3));
  }
  track.joint_sigma = RowMatrixXd::Random(kFrames, kJoints).cwiseAbs();
  track.joint_sigma(0, 0) = kNan;
  track.world = WorldOverGround({0.1, -0.9, -0.2}, 1.4);
  track.world->source = WorldSource::kPeople;
  track.world->vertical_sigma_deg = 1.25;
  return track;
}

/// Equal, NaN meeting NaN.
template <typename A, typename B>
bool Same(const A& a, const B& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) return false;
  return ((a.array() == b.array()) || (a.array().isNaN() && b.array().isNaN())).all();
}

std::string ErrorOf(const NpzArrays& arrays) {
  const TemporaryFolder folder;
  WriteNpz(folder.File("track.npz"), arrays);
  return FileErrorOf(folder.File("track.npz"), [&] { ReadTrack(folder.File("track.npz")); });
}

NpzArrays SampleArrays(CameraModel model) {
  const TemporaryFolder folder;
  WriteTrack(folder.File("track.npz"), SampleTrack(model));
  return ReadNpz(folder.File("track.npz"));
}

/// Only what somebody else's tracker is sure to write.
NpzArrays ForeignArrays() {
  NpzArrays arrays;
  const std::vector<double> poses(3 * 72, 0.1), trans(3 * 3, 2.0), k = {1000, 0, 320, 0, 1000, 240, 0, 0, 1};
  arrays["poses"] = NdArray::FromDoubles(poses.data(), {3, 72});
  arrays["trans"] = NdArray::FromDoubles(trans.data(), {3, 3});
  arrays["K"] = NdArray::FromDoubles(k.data(), {3, 3});
  return arrays;
}

NpzArrays With(NpzArrays arrays, const std::string& name, const std::vector<double>& values,
               std::vector<int64_t> shape) {
  arrays[name] = NdArray::FromDoubles(values.data(), std::move(shape));
  return arrays;
}

NpzArrays WithText(NpzArrays arrays, const std::string& name, const std::string& text) {
  arrays[name] = NdArray::FromString(text);
  return arrays;
}

Track Read(const NpzArrays& arrays) {
  const TemporaryFolder folder;
  WriteNpz(folder.File("track.npz"), arrays);
  return ReadTrack(folder.File("track.npz"));
}

TEST(TrackIo, RoundTripIsExact) {
  const TemporaryFolder folder;
  for (const CameraModel model : {CameraModel::kPinhole, CameraModel::kWeakPerspective}) {
    const Track track = SampleTrack(model);
    WriteTrack(folder.File("a.npz"), track);
    const Track read = ReadTrack(folder.File("a.npz"));
    EXPECT_EQ(read.motion.body, "bodyloom");
    EXPECT_EQ(read.motion.up, Motion::Up::kCamera);
    EXPECT_TRUE(Same(read.motion.poses, track.motion.poses));
    EXPECT_TRUE(Same(read.motion.trans, track.motion.trans));
    EXPECT_EQ(read.motion.betas, track.motion.betas);
    EXPECT_EQ(read.motion.timestamps, track.motion.timestamps);
    EXPECT_EQ(read.frame_status, track.frame_status);
    EXPECT_EQ(read.camera.model, model);
    EXPECT_EQ(read.camera.width, 1920);
    EXPECT_EQ(read.camera.height, 1080);
    EXPECT_EQ(read.camera.K(), track.camera.K());
    EXPECT_EQ(read.camera.distortion, track.camera.distortion);
    EXPECT_TRUE(Same(read.weak_camera, track.weak_camera));
    ASSERT_EQ(read.joints.size(), track.joints.size());
    for (int t = 0; t < kFrames; ++t) {
      EXPECT_EQ(read.joints[t], track.joints[t]);
      EXPECT_EQ(read.coco17[t], track.coco17[t]);
    }
    EXPECT_TRUE(Same(read.joint_sigma, track.joint_sigma));
    WriteTrack(folder.File("b.npz"), read);
    EXPECT_EQ(ReadFileBytes(folder.File("a.npz")), ReadFileBytes(folder.File("b.npz")));
  }
}

TEST(TrackIo, FileHasAmassKeysAndShapes) {
  const NpzArrays pinhole = SampleArrays(CameraModel::kPinhole), weak = SampleArrays(CameraModel::kWeakPerspective);
  EXPECT_EQ(pinhole.at("poses").ShapeText(), "5x72");
  EXPECT_EQ(pinhole.at("trans").ShapeText(), "5x3");
  EXPECT_EQ(pinhole.at("betas").ShapeText(), "10");
  EXPECT_EQ(pinhole.at("gender").ToStrings().front(), "neutral");
  EXPECT_EQ(pinhole.at("mocap_framerate").ShapeText(), "scalar");
  EXPECT_NEAR(pinhole.at("mocap_framerate").ToDoubles().front(), 50, 1e-9) << "the median step, not the mean";
  EXPECT_EQ(pinhole.at("joints").ShapeText(), "5x24x3");
  EXPECT_EQ(pinhole.at("coco17").ShapeText(), "5x17x3");
  EXPECT_EQ(pinhole.at("joint_sigma").ShapeText(), "5x24");
  EXPECT_THAT(pinhole.at("image_size").ToInts(), ElementsAre(1920, 1080));
  EXPECT_THAT(pinhole.at("frame_status").ToInts(), ElementsAre(0, 1, 2, 3, 0));
  EXPECT_EQ(pinhole.at("frame_status").dtype, DType::kU8);
  EXPECT_THAT(pinhole.at("K").ToDoubles(), ElementsAre(1500, 0, 960, 0, 1510, 540, 0, 0, 1));
  EXPECT_EQ(pinhole.at("camera_model").ToStrings().front(), "pinhole");
  EXPECT_EQ(pinhole.count("camera"), 0U);
  EXPECT_EQ(weak.at("camera_model").ToStrings().front(), "weak");
  EXPECT_EQ(weak.at("camera").ShapeText(), "5x3");
}

TEST(TrackIo, TracksOfOthers) {
  const Track track = Read(ForeignArrays());
  EXPECT_EQ(track.num_frames(), 3);
  EXPECT_EQ(track.motion.body, "smpl");
  EXPECT_EQ(track.camera.model, CameraModel::kPinhole);
  EXPECT_EQ(track.camera.cx, 320);
  EXPECT_EQ(track.camera.width, 0);
  EXPECT_THAT(track.motion.timestamps, ElementsAre(0, 1.0 / 30, 2.0 / 30));
  EXPECT_EQ(track.motion.betas.size(), 0);
  EXPECT_EQ(track.frame_status, std::vector<FrameStatus>(3, FrameStatus::kTracked));
  EXPECT_TRUE(track.joints.empty());
  EXPECT_TRUE(track.joint_sigma.array().isNaN().all());
  EXPECT_EQ(track.joint_sigma.rows(), 3);

  EXPECT_THAT(Read(With(ForeignArrays(), "mocap_frame_rate", {120}, {})).motion.timestamps,
              ElementsAre(0, 1.0 / 120, 2.0 / 120));
  EXPECT_THAT(Read(With(ForeignArrays(), "mocap_framerate", {60}, {1})).motion.timestamps,
              ElementsAre(0, 1.0 / 60, 2.0 / 60));
  const Track mean = Read(With(ForeignArrays(), "betas", {1, 2, 3, 4, 5, 9}, {3, 2}));
  EXPECT_EQ(mean.motion.betas, Eigen::Vector2d(3, 5));
  std::vector<double> k;
  for (int t = 0; t < 3; ++t) k.insert(k.end(), {900, 0, 320, 0, 900, 240, 0, 0, 1});
  EXPECT_EQ(Read(With(ForeignArrays(), "K", k, {3, 3, 3})).camera.fx, 900);
  EXPECT_EQ(Read(With(ForeignArrays(), "distortion", {0.1, 0.2, 0.3, 0.4, 0.5}, {5})).camera.distortion[4], 0.5);

  std::vector<double> poses(3 * 72, 0.1);
  poses[80] = kNan;
  const Track gap = Read(With(ForeignArrays(), "poses", poses, {3, 72}));
  EXPECT_EQ(gap.frame_status[0], FrameStatus::kTracked);
  EXPECT_EQ(gap.frame_status[1], FrameStatus::kLost);

  NpzArrays weak = ForeignArrays();
  weak.erase("K");
  EXPECT_EQ(Read(With(weak, "camera", std::vector<double>(9, 1.0), {3, 3})).camera.model,
            CameraModel::kWeakPerspective);
  EXPECT_EQ(Read(With(ForeignArrays(), "poses", std::vector<double>(3 * 165, 0.0), {3, 165})).motion.body, "smplx");
}

TEST(TrackIo, WorldIsKeptAndMayBeMissing) {
  const Track track = SampleTrack(CameraModel::kPinhole), read = Read(SampleArrays(CameraModel::kPinhole));
  ASSERT_TRUE(read.world);
  EXPECT_EQ(read.world->rotation, track.world->rotation);
  EXPECT_EQ(read.world->translation, track.world->translation);
  EXPECT_EQ(read.world->source, WorldSource::kPeople);
  EXPECT_EQ(read.world->vertical_sigma_deg, 1.25);
  EXPECT_TRUE(std::isnan(read.world->height_sigma_m));
  EXPECT_FALSE(Read(ForeignArrays()).world) << "files of before say nothing";

  const std::vector<double> level = {1, 0, 0, 0, 0, -1, 0, 1.5, 0, 0, -1, 0, 0, 0, 0, 1};
  const NpzArrays given = With(ForeignArrays(), "world_from_camera", level, {4, 4});
  EXPECT_EQ(Read(given).world->source, WorldSource::kGiven);
  EXPECT_EQ(Read(given).world->camera_height_m(), 1.5);
  std::vector<double> mirrored = level, scaled = level, shifted = level;
  mirrored[0] = -1;
  for (const int i : {0, 5, 10}) scaled[size_t(i)] *= 2;
  shifted[12] = 1;
  for (const std::vector<double>& wrong : {mirrored, scaled, shifted}) {
    EXPECT_THAT(ErrorOf(With(given, "world_from_camera", wrong, {4, 4})), HasSubstr("expected a rotation"));
  }
  EXPECT_THAT(ErrorOf(WithText(given, "world_source", "guessed")), HasSubstr("world_source: 'guessed'"));
  EXPECT_THAT(ErrorOf(With(given, "world_sigma", {-1, 0}, {2})), HasSubstr("world_sigma"));
}

TEST(TrackIo, LevelsAreKeptAndAreOverAWorld) {
  EXPECT_EQ(SampleArrays(CameraModel::kPinhole).count("world_level"), 0U) << "the ground alone";
  EXPECT_EQ(Read(SampleArrays(CameraModel::kPinhole)).LevelAt(3), 0);
  const TemporaryFolder folder;
  Track track = SampleTrack(CameraModel::kPinhole);
  track.level_m = (Eigen::VectorXd(kFrames) << 0, 0, 0.45, 0.45, 0).finished();
  WriteTrack(folder.File("t.npz"), track);
  const Track read = ReadTrack(folder.File("t.npz"));
  ASSERT_EQ(read.level_m.size(), kFrames);
  EXPECT_EQ(read.level_m, track.level_m);
  EXPECT_EQ(read.LevelAt(3), 0.45);
  const NpzArrays arrays = SampleArrays(CameraModel::kPinhole);
  EXPECT_THAT(ErrorOf(With(arrays, "world_level", {0, 0.45}, {2})), HasSubstr("world_level"));
  EXPECT_THAT(ErrorOf(With(arrays, "world_level", std::vector<double>(kFrames, kNan), {kFrames})),
              HasSubstr("world_level"));
  track.level_m.conservativeResize(kFrames - 1);
  EXPECT_THROW(WriteTrack(folder.File("short.npz"), track), std::invalid_argument);
  track.level_m = Eigen::VectorXd::Constant(kFrames, 0.45);
  track.world.reset();
  EXPECT_THROW(WriteTrack(folder.File("no_world.npz"), track), std::invalid_argument);
}

TEST(TrackIo, PlaybackOfTheVideoIsKept) {
  EXPECT_EQ(Read(SampleArrays(CameraModel::kPinhole)).playback, VideoPlayback());
  const TemporaryFolder folder;
  Track track = SampleTrack(CameraModel::kPinhole);
  track.playback = {270, 8};
  WriteTrack(folder.File("t.npz"), track);
  EXPECT_EQ(ReadTrack(folder.File("t.npz")).playback, track.playback);
  EXPECT_THAT(ErrorOf(With(ForeignArrays(), "video_turn_deg", {45}, {})), HasSubstr("video_turn_deg: 45"));
  EXPECT_THAT(ErrorOf(With(ForeignArrays(), "video_slowdown", {0}, {})), HasSubstr("video_slowdown: 0"));
  EXPECT_THAT(ErrorOf(With(ForeignArrays(), "video_slowdown", {kNan}, {})), HasSubstr("video_slowdown: NaN"));
}

TEST(TrackIo, ThePathOfACameraThatMovesIsKeptForThoseWhoTakeIt) {
  const TemporaryFolder folder;
  Track track = SampleTrack(CameraModel::kPinhole);
  for (int t = 0; t < kFrames; ++t) {
    track.camera_from_scene.push_back({RotationFromAxisAngle({0.1 * t, 0.2, -0.3}), {1.0 * t, 2, 3}});
  }
  WriteTrack(folder.File("t.npz"), track);
  const Track read = ReadTrack(folder.File("t.npz"), MovingCamera::kTake);
  ASSERT_EQ(read.camera_from_scene.size(), size_t{kFrames});
  for (size_t t = 0; t < kFrames; ++t) {
    EXPECT_EQ(read.camera_from_scene[t].camera_from_world_rotation,
              track.camera_from_scene[t].camera_from_world_rotation);
    EXPECT_EQ(read.camera_from_scene[t].camera_from_world_translation,
              track.camera_from_scene[t].camera_from_world_translation);
  }
  EXPECT_THAT(FileErrorOf("t.npz", [&] { ReadTrack(folder.File("t.npz")); }), HasSubstr("whose camera moves"));
  EXPECT_FALSE(ReadNpz(folder.File("t.npz")).at("camera_from_scene").shape.empty());

  track.camera_from_scene.pop_back();
  EXPECT_THROW(WriteTrack(folder.File("t.npz"), track), std::invalid_argument);
  std::vector<double> path;
  for (int t = 0; t < 3; ++t) path.insert(path.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  EXPECT_THAT(ErrorOf(With(ForeignArrays(), "camera_from_scene", {1, 2}, {2})), HasSubstr("expected 3x4x4"));
  path[16] = -1;
  EXPECT_THAT(ErrorOf(With(ForeignArrays(), "camera_from_scene", path, {3, 4, 4})), HasSubstr("frame 1: expected a"));
}

TEST(TrackIo, BrokenMembersAreNamed) {
  const NpzArrays good = ForeignArrays();
  const auto without = [&](const std::string& name) {
    NpzArrays less = good;
    less.erase(name);
    return less;
  };
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_THAT(ErrorOf(without("poses")), HasSubstr("no array 'poses'"));
  EXPECT_THAT(ErrorOf(without("trans")), HasSubstr("no array 'trans'"));
  EXPECT_THAT(ErrorOf(without("K")), HasSubstr("no camera"));
  EXPECT_THAT(ErrorOf(With(good, "poses", std::vector<double>(3 * 71, 0.0), {3, 71})), HasSubstr("poses: 3x71"));
  EXPECT_THAT(ErrorOf(With(good, "poses", {}, {0, 72})), HasSubstr("poses: 0x72"));
  EXPECT_THAT(ErrorOf(With(good, "poses", std::vector<double>(72, 0.0), {72})), HasSubstr("expected nxn"));
  EXPECT_THAT(ErrorOf(With(good, "poses", std::vector<double>(216, inf), {3, 72})), HasSubstr("poses: infinite"));
  EXPECT_THAT(ErrorOf(With(good, "trans", {1, 2, 3}, {1, 3})), HasSubstr("trans: 1x3, expected 3x3"));
  EXPECT_THAT(ErrorOf(With(good, "betas", {kNan}, {1})), HasSubstr("betas: NaN"));
  EXPECT_THAT(ErrorOf(With(good, "timestamps", {0, 1, 1}, {3})), HasSubstr("timestamps: frame 2"));
  EXPECT_THAT(ErrorOf(With(good, "timestamps", {0, 1}, {2})), HasSubstr("timestamps: 2, expected 3"));
  EXPECT_THAT(ErrorOf(With(good, "mocap_framerate", {0}, {})), HasSubstr("mocap_framerate: 0"));
  EXPECT_THAT(ErrorOf(With(good, "mocap_framerate", {kNan}, {})), HasSubstr("mocap_framerate: NaN"));
  EXPECT_THAT(ErrorOf(With(good, "K", {1, 0, 0, 0, 0, 0, 0, 0, 1}, {3, 3})), HasSubstr("K: expected"));
  EXPECT_THAT(ErrorOf(With(good, "K", {1, 0, 0, 0, 1, 0, 0, 0, 2}, {3, 3})), HasSubstr("K: expected"));
  EXPECT_THAT(ErrorOf(With(good, "K", {1, 0.5, 0, 0, 1, 0, 0, 0, 1}, {3, 3})), HasSubstr("K: expected"));
  EXPECT_THAT(ErrorOf(With(good, "K", std::vector<double>(9, kNan), {3, 3})), HasSubstr("K: NaN"));
  std::vector<double> k;
  for (int t = 0; t < 3; ++t) k.insert(k.end(), {900.0 + t, 0, 320, 0, 900, 240, 0, 0, 1});
  EXPECT_THAT(ErrorOf(With(good, "K", k, {3, 3, 3})), HasSubstr("K: frame 1 differs"));
  EXPECT_THAT(ErrorOf(With(good, "distortion", {1, 2, 3}, {3})), HasSubstr("distortion: 3 values"));
  EXPECT_THAT(ErrorOf(With(good, "image_size", {640.5, 480}, {2})), HasSubstr("image_size: 640.5"));
  EXPECT_THAT(ErrorOf(With(good, "image_size", {-1, 480}, {2})), HasSubstr("image_size: -1"));
  EXPECT_THAT(ErrorOf(With(good, "frame_status", {0, 4, 0}, {3})), HasSubstr("frame 1 is 4"));
  EXPECT_THAT(ErrorOf(With(good, "frame_status", {0, 0.5, 0}, {3})), HasSubstr("frame_status: element 1"));
  EXPECT_THAT(ErrorOf(With(good, "joints", {1, 2, 3}, {1, 1, 3})), HasSubstr("joints: 1x1x3, expected 3xnx3"));
  EXPECT_THAT(ErrorOf(With(good, "coco17", std::vector<double>(9, 0.0), {3, 1, 3})), HasSubstr("expected 3x17x3"));
  EXPECT_THAT(ErrorOf(WithText(good, "camera_model", "fisheye")), HasSubstr("camera_model"));
  EXPECT_THAT(ErrorOf(WithText(good, "poses", "none")), HasSubstr("poses: not numbers"));
  EXPECT_THAT(ErrorOf(WithText(good, "camera_model", "weak")), HasSubstr("no array 'camera'"));
  const NpzArrays weak = WithText(good, "camera_model", "weak");
  EXPECT_THAT(ErrorOf(With(weak, "camera", std::vector<double>(9, 0.0), {3, 3})), HasSubstr("camera: frame 0"));
  std::vector<double> poses(3 * 72, 0.1);
  poses[80] = kNan;
  EXPECT_THAT(ErrorOf(With(With(good, "poses", poses, {3, 72}), "frame_status", {0, 0, 0}, {3})),
              HasSubstr("frame 1 is tracked, but its pose holds NaN"));
}

TEST(TrackIo, TruncatedFilesAreRefused) {
  const TemporaryFolder folder;
  WriteTrack(folder.File("a.npz"), SampleTrack(CameraModel::kPinhole));
  const std::string whole = ReadFileBytes(folder.File("a.npz"));
  for (size_t n = 0; n<whole.size(); n += n + 400> whole.size() ? 1 : 13) {
    FileErrorOf("cut.npz", [&] { ReadTrackBytes(whole.substr(0, n), "cut.npz"); });
  }
}

TEST(TrackIo, ContradictingTracksAreNotWritten) {
  const TemporaryFolder folder;
  const auto refuse = [&](const auto& change) {
    Track track = SampleTrack(CameraModel::kPinhole);
    change(&track);
    EXPECT_THROW(WriteTrack(folder.File("a.npz"), track), std::invalid_argument);
  };
  refuse([](Track* t) { *t = Track(); });
  refuse([](Track* t) { t->motion.poses.conservativeResize(kFrames, 71); });
  refuse([](Track* t) { t->motion.trans.conservativeResize(kFrames - 1, 3); });
  refuse([](Track* t) { t->motion.timestamps.pop_back(); });
  refuse([](Track* t) { t->motion.betas[0] = kNan; });
  refuse([](Track* t) { t->frame_status.pop_back(); });
  refuse([](Track* t) { t->joints.pop_back(); });
  refuse([](Track* t) { t->joints[1].conservativeResize(3, 3); });
  refuse([](Track* t) { t->coco17[2].conservativeResize(3, 3); });
  refuse([](Track* t) { t->joint_sigma.conservativeResize(kFrames, 3); });
  refuse([](Track* t) { t->camera.model = CameraModel::kWeakPerspective; });
  FileErrorOf("absent/a.npz", [&] { WriteTrack(folder.File("absent/a.npz"), SampleTrack(CameraModel::kPinhole)); });
}

TEST(TrackIo, BodiesWithoutLandmarksHaveNoCocoMember) {
  const TemporaryFolder folder;
  Track track = SampleTrack(CameraModel::kPinhole);
  for (MatrixX3d& points : track.coco17) points.resize(0, 3);
  WriteTrack(folder.File("a.npz"), track);
  EXPECT_EQ(ReadNpz(folder.File("a.npz")).count("coco17"), 0U);
  EXPECT_TRUE(ReadTrack(folder.File("a.npz")).coco17.empty());
}

}  // namespace
}  // namespace bodyloom::track_io_test
