// SPDX-License-Identifier: Apache-2.0
/// Poses in the world, markers and cameras, each read back by an independent reader.
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <map>
#include <sstream>
#include <stdexcept>

#include "data_tools/export/camera_writers.h"
#include "data_tools/export/markers.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/amass.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/observations/colmap_reader.h"
#include "data_tools/observations/load_camera_path.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "tests/data_tools/export/exported_scene.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::export_files_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::vector<std::string> Split(const std::string& text, char at) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == at) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

TEST(ExportScene, PosesInTheWorldArePosesSeenFromIt) {
  const Track track = TrackWithAGap();
  const ExportScene scene = SceneOf(track);
  const ExportPerson& person = scene.people[0];
  ASSERT_EQ(person.poses.size(), 10U);
  EXPECT_EQ(scene.start_s, 0.5);
  EXPECT_NEAR(scene.fps, 6, 1e-9);
  const MatrixX3d own = PoseVertices(BuiltinBody(), person.betas, person.poses[3]);
  EXPECT_LT((own - VerticesInWorld(track, 5)).cwiseAbs().maxCoeff(), 1e-9);
  const Motion motion = MotionInWorld(TiltedWorld(), person.rest_joints.row(0).transpose(), track.motion);
  EXPECT_EQ(motion.up, Motion::Up::kY);
  EXPECT_FALSE(motion.HasPose(3));
  const MatrixX3d by_motion =
      PoseVertices(BuiltinBody(), motion.betas,
                   PoseFromAxisAngle(BuiltinBody(), motion.poses.row(5).transpose(), motion.trans.row(5).transpose()));
  EXPECT_LT((by_motion - own).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(ExportScene, TheRootTurnsAboutThePelvisWhereverItRests) {
  BodyPose pose;
  pose.rotations = {RotationFromAxisAngle({0.3, -0.5, 0.2})};
  pose.trans = {0.4, 0.1, 3};
  const Vector3d pelvis(0.1, -0.35, 0.02), vertex(0.2, 0.6, 0.1);  // the built-in body's own is at the origin
  const auto place = [&](const BodyPose& p) { return Vector3d(p.rotations[0] * (vertex - pelvis) + pelvis + p.trans); };
  EXPECT_TRUE(
      place(PoseInWorld(TiltedWorld(), pelvis, pose)).isApprox(TiltedWorld().PointFromCamera(place(pose)), 1e-12));
}

TEST(ExportScene, RefusesNobody) {
  Track track = TrackWithAGap();
  track.motion.poses.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(SceneOf(track), std::invalid_argument);
  EXPECT_THROW(MakeExportScene({}, {}, WorldFrame()), std::invalid_argument);
}

/// Compares marker positions with the body's landmarks.
void ExpectMarkers(const MarkerTrajectories& markers, const ExportScene& scene) {
  ASSERT_EQ(markers.positions.size(), 12U);
  EXPECT_TRUE(markers.positions[3].array().isNaN().all());
  const MatrixX3d truth = PoseLandmarks(BuiltinBody(), scene.people[0].betas, scene.people[0].poses[3],
                                        {"left_heel", "right_wrist", "left_hip", "right_hip"});
  EXPECT_EQ(markers.positions[5].row(12), truth.row(0));
  EXPECT_EQ(markers.positions[5].row(18), truth.row(1));
  EXPECT_TRUE(markers.positions[5].row(0).isApprox(0.5 * (truth.row(2) + truth.row(3))));
  EXPECT_GT(markers.positions[5](14, 1), markers.positions[5](15, 1)) << "the top of the head above the nose";
}

TEST(TrcWriter, ReadsBack) {
  const ExportScene scene = SceneOf(TrackWithAGap());
  const MarkerTrajectories markers = HalpeMarkers(scene, scene.people[0]);
  ExpectMarkers(markers, scene);
  const std::vector<std::string> lines = Split(TrcText("walk.trc", markers), '\n');
  ASSERT_EQ(lines.size(), 5U + 12 + 1);
  EXPECT_EQ(lines[0], "PathFileType\t4\t(X/Y/Z)\twalk.trc");
  EXPECT_EQ(lines[2], "6\t6\t12\t22\tm\t6\t0\t12");
  const std::vector<std::string> names = Split(lines[3], '\t');
  EXPECT_EQ(names[0], "Frame#");
  for (size_t m = 0; m < 22; ++m) EXPECT_EQ(names[2 + 3 * m], HalpeMarkerNames()[m]);
  EXPECT_EQ(Split(lines[4], '\t')[67], "Z22");
  for (size_t t = 0; t < 12; ++t) {
    const std::vector<std::string> row = Split(lines[5 + t], '\t');
    ASSERT_EQ(row.size(), 2U + 66);
    EXPECT_NEAR(std::stod(row[1]), t / 6.0, 1e-6);
    for (size_t i = 0; i < 66; ++i) {
      if (t == 3 || t == 4) {
        EXPECT_EQ(row[2 + i], "");
      } else {
        EXPECT_NEAR(std::stod(row[2 + i]), markers.positions[t](Eigen::Index(i / 3), Eigen::Index(i % 3)), 1e-7);
      }
    }
  }
  MarkerTrajectories broken = markers;
  broken.seconds.pop_back();
  EXPECT_THROW(TrcText("a", broken), std::invalid_argument);
}

template <typename T>
T At(const std::string& bytes, size_t offset) {
  T value{};
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// Parameters of a C3D file: "GROUP:NAME" → offset of the data.
std::map<std::string, size_t> C3dParameters(const std::string& bytes) {
  std::map<int, std::string> groups;
  std::map<std::string, size_t> parameters;
  for (size_t at = 512 + 4; bytes[at] != 0;) {
    const size_t length = size_t(std::abs(int(bytes[at])));
    // A signed byte: below zero in the group's own record.
    const int byte = uint8_t(bytes[at + 1]), group = byte < 128 ? byte : byte - 256;
    const std::string name = bytes.substr(at + 2, length);
    const size_t offset = at + 2 + length;
    if (group < 0) {
      groups[-group] = name;
    } else {
      parameters[groups.at(group) + ":" + name] = offset + 4 + uint8_t(bytes[offset + 3]);
    }
    at = offset + size_t(At<int16_t>(bytes, offset));
  }
  return parameters;
}

TEST(C3dWriter, ReadsBack) {
  const ExportScene scene = SceneOf(TrackWithAGap());
  const MarkerTrajectories markers = HalpeMarkers(scene, scene.people[0]);
  const std::string bytes = C3dBytes(markers);
  EXPECT_EQ(bytes.size() % 512, 0U);
  EXPECT_EQ(bytes.substr(0, 2), "\x02\x50");
  EXPECT_EQ(At<uint16_t>(bytes, 2), 22);
  EXPECT_EQ(At<uint16_t>(bytes, 6), 1);
  EXPECT_EQ(At<uint16_t>(bytes, 8), 12);
  EXPECT_EQ(At<float>(bytes, 12), -1);
  EXPECT_NEAR(At<float>(bytes, 20), 6, 1e-5);
  EXPECT_EQ(uint8_t(bytes[512 + 3]), 84);
  const size_t data = 512 * size_t(At<uint16_t>(bytes, 16) - 1);
  EXPECT_EQ(data, 512 * (1 + size_t(uint8_t(bytes[512 + 2]))));
  const std::map<std::string, size_t> parameters = C3dParameters(bytes);
  EXPECT_EQ(At<int16_t>(bytes, parameters.at("POINT:USED")), 22);
  EXPECT_EQ(bytes.substr(parameters.at("POINT:UNITS"), 2), "mm");
  EXPECT_EQ(bytes.substr(parameters.at("POINT:LABELS") + 9, 9), "RHip     ");
  EXPECT_EQ(At<int16_t>(bytes, parameters.at("POINT:FRAMES")), 12);
  EXPECT_EQ(512 * size_t(At<int16_t>(bytes, parameters.at("POINT:DATA_START")) - 1), data);
  EXPECT_EQ(parameters.count("FORCE_PLATFORM:USED"), 1U);
  for (size_t t = 0; t < 12; ++t) {
    for (size_t m = 0; m < 22; ++m) {
      const size_t at = data + 16 * (22 * t + m);
      const bool lost = t == 3 || t == 4;
      EXPECT_EQ(At<uint32_t>(bytes, at + 12), lost ? 0xBF800000U : 0U);
      for (size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(At<float>(bytes, at + 4 * k),
                    lost ? 0 : 1000 * markers.positions[t](Eigen::Index(m), Eigen::Index(k)), 1e-3);
      }
    }
  }
}

/// The picture's point of p by a pose and a pinhole.
Eigen::Vector2d Pixel(const Matrix3d& rotation, const Vector3d& translation, double fx, double fy, double cx, double cy,
                      const Vector3d& p) {
  const Vector3d q = rotation * p + translation;
  return {fx * q.x() / q.z() + cx, fy * q.y() / q.z() + cy};
}

TEST(ColmapWriter, SeesTheBodyWhereTheClipDid) {
  const Track track = TrackWithAGap();
  const ExportScene scene = SceneOf(track);
  const TemporaryFolder folder;
  WriteColmap(folder.File(""), scene);
  std::istringstream camera(Split(ReadFileBytes(folder.File("cameras.txt")), '\n')[1]);
  std::string id, model;
  double w = 0, h = 0, fx = 0, fy = 0, cx = 0, cy = 0;
  camera >> id >> model >> w >> h >> fx >> fy >> cx >> cy;
  EXPECT_EQ(model, "PINHOLE");
  const std::vector<std::string> lines = Split(ReadFileBytes(folder.File("images.txt")), '\n');
  ASSERT_EQ(lines.size(), 1U + 2 * 10 + 1);
  EXPECT_THAT(lines[7], ::testing::EndsWith("1 frame_000005.png"));
  EXPECT_EQ(lines[2], "");
  std::istringstream image(lines[1]);
  double qw = 0, qx = 0, qy = 0, qz = 0;
  Vector3d t;
  image >> id >> qw >> qx >> qy >> qz >> t[0] >> t[1] >> t[2];
  std::istringstream point(Split(ReadFileBytes(folder.File("points3D.txt")), '\n')[101]);
  Vector3d p;
  point >> id >> p[0] >> p[1] >> p[2];
  const BodyPose pose =
      PoseFromAxisAngle(BuiltinBody(), track.motion.poses.row(0).transpose(), track.motion.trans.row(0).transpose());
  Eigen::Vector2d px;
  track.camera.Project(PoseVertices(BuiltinBody(), track.motion.betas, pose).row(100).transpose(), &px);
  const Eigen::Vector2d seen = Pixel(Eigen::Quaterniond(qw, qx, qy, qz).toRotationMatrix(), t, fx, fy, cx, cy, p);
  EXPECT_LT((seen - px - Eigen::Vector2d(0.5, 0.5)).norm(), 1e-3);

  Camera lens = track.camera;
  lens.distortion = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8};
  EXPECT_THAT(ColmapCamerasText(lens), ::testing::HasSubstr("FULL_OPENCV"));
  EXPECT_THAT(Split(Split(ColmapCamerasText(lens), '\n')[1], ' ').size(), 4U + 12);
  lens.model = CameraModel::kWeakPerspective;
  EXPECT_THROW(ColmapCamerasText(lens), std::invalid_argument);
}

/// Pixel of vertex v of frame t in a moving camera, in OpenCV's pixel coordinates.
Eigen::Vector2d SeenPixel(const Track& track, int t, int v) {
  const BodyPose pose =
      PoseFromAxisAngle(BuiltinBody(), track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose());
  const Vector3d x = PoseVertices(BuiltinBody(), track.motion.betas, pose).row(v).transpose();
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  EXPECT_TRUE(track.camera.Project(MovedPoint(track.camera_from_scene[size_t(t)], x), &px));
  return px;
}

TEST(ColmapWriter, ACameraThatMovesComesBackFromOurReader) {
  const Track track = ShortTrack(6, SynthCameraMotion::kWalking);
  const ExportScene scene = SceneOf(track);
  const TemporaryFolder folder;
  WriteColmap(folder.File(""), scene);
  const ColmapModel model = ReadColmapModel(folder.File(""));
  ASSERT_EQ(model.images.size(), size_t(track.num_frames()));
  for (const int t : {0, 5, 11}) {
    const MatrixX3d in_world = PoseVertices(BuiltinBody(), track.motion.betas, scene.people[0].poses[size_t(t)]);
    Eigen::Vector2d px;
    const Camera& camera = model.cameras.at(1).camera;
    ASSERT_TRUE(camera.Project(MovedPoint(model.images[size_t(t)].pose, in_world.row(700).transpose()), &px));
    EXPECT_LT((px - SeenPixel(track, t, 700)).norm(), 1e-6);
  }
  // The whole way back: a path from the files that the tracker would take, up to the scene's place in the world.
  const CameraPath path =
      CameraPathOnClock(LoadCameraPath(folder.File("")), track.motion.timestamps, {.first = 0}, "colmap");
  const SampledCameraPath sampled = SampleCameraPath(path, track.motion.timestamps);
  const CameraPose first = Inverse(track.camera_from_scene[0]);
  for (size_t t = 0; t < track.camera_from_scene.size(); ++t) {
    const CameraPose expected = Compose(track.camera_from_scene[t], first);
    EXPECT_LT(
        (sampled.camera_from_scene[t].camera_from_world_translation - expected.camera_from_world_translation).norm(),
        1e-9);
  }
}

TEST(ExportScene, TracksOfAMovingAndOfAStillCameraAreNotOneScene) {
  const Track still = ShortTrack(), moving = ShortTrack(6, SynthCameraMotion::kHandHeld);
  const std::array<const BodyModel*, 2> bodies = {&BuiltinBody(), &BuiltinBody()};
  const std::array<const Track*, 2> tracks = {&still, &moving};
  EXPECT_THROW(MakeExportScene(bodies, tracks, TiltedWorld()), std::invalid_argument);
}

/// Numbers in brackets after "key = ".
std::vector<double> TomlNumbers(const std::string& text, const std::string& key) {
  const size_t begin = text.find("\n" + key + " = ") + key.size() + 4, end = text.find('\n', begin);
  std::string line = text.substr(begin, end - begin);
  for (char& c : line) {
    if (c == '[' || c == ']' || c == ',') c = ' ';
  }
  std::istringstream stream(line);
  std::vector<double> numbers;
  for (double x = 0; stream >> x;) numbers.push_back(x);
  return numbers;
}

TEST(Pose2SimCalibration, IsTheCameraInAWorldWithZUp) {
  const Track track = TrackWithAGap();
  const std::string text = Pose2SimCalibrationText("cam_01", track.camera, TiltedWorld());
  EXPECT_THAT(text, ::testing::StartsWith("[cam_01]\nname = \"cam_01\"\nsize = [ 320.0, 240.0]\n"));
  EXPECT_EQ(TomlNumbers(text, "distortions").size(), 4U);
  const std::vector<double> r = TomlNumbers(text, "rotation"), t = TomlNumbers(text, "translation");
  const std::vector<double> K = TomlNumbers(text, "matrix");
  ASSERT_EQ(K.size(), 9U);
  EXPECT_EQ(K[2], track.camera.cx);
  const Matrix3d R = RotationFromAxisAngle({r[0], r[1], r[2]});
  const Vector3d place = -R.transpose() * Vector3d(t[0], t[1], t[2]);
  EXPECT_NEAR(place.z(), 1.3, 1e-9) << "the camera's height is z";
  EXPECT_TRUE((R.transpose() * Vector3d(0.1, -1, -0.25).normalized()).isApprox(Vector3d::UnitZ(), 1e-9));
  // Its TRC files turn (x, y, z) to (y, z, x): then the world is ours.
  const Vector3d p(0.4, -0.3, 4), theirs = R.transpose() * (p - Vector3d(t[0], t[1], t[2]));
  EXPECT_TRUE(Vector3d(theirs.y(), theirs.z(), theirs.x()).isApprox(TiltedWorld().PointFromCamera(p), 1e-9));
  EXPECT_THROW(Pose2SimCalibrationText("cam 01", track.camera, TiltedWorld()), std::invalid_argument);
}

TEST(Amass, SmplxFormHasWhatRetargetersRead) {
  const Track track = ShortTrack();
  const ExportScene scene = SceneOf(track);
  const Vector3d pelvis = scene.people[0].rest_joints.row(0).transpose();
  const Motion motion = MotionInWorld(TiltedWorld(), pelvis, track.motion);
  const TemporaryFolder folder;
  WriteAmassSmplx(folder.File("a.npz"), motion, pelvis);
  const NpzArrays arrays = ReadNpz(folder.File("a.npz"));
  EXPECT_EQ(arrays.at("betas").shape, std::vector<int64_t>{16});
  EXPECT_EQ(arrays.at("poses").shape, (std::vector<int64_t>{12, 165}));
  EXPECT_EQ(arrays.at("pose_body").shape, (std::vector<int64_t>{12, 63}));
  EXPECT_EQ(arrays.at("pose_hand").shape, (std::vector<int64_t>{12, 90}));
  EXPECT_EQ(arrays.at("mocap_frame_rate").shape, std::vector<int64_t>{});
  EXPECT_NEAR(arrays.at("mocap_frame_rate").ToDoubles()[0], 6, 1e-9);
  EXPECT_EQ(arrays.at("gender").ToStrings()[0], "neutral");
  const RowMatrixXd root = arrays.at("root_orient").ToMatrix(), trans = arrays.at("trans").ToMatrix();
  // z up: the person's own upward axis, and the pelvis above the ground.
  const BodyPose& pose = scene.people[0].poses[4];
  const Vector3d up = RotationFromAxisAngle(root.row(4).transpose()) * Vector3d::UnitY();
  const Vector3d own_up = pose.rotations[0] * Vector3d::UnitY();
  EXPECT_TRUE(up.isApprox(Vector3d(own_up.x(), -own_up.z(), own_up.y()), 1e-9));
  const Vector3d place = pelvis + pose.trans;
  // On SMPL-X's mean shape the pelvis rests at (0.0031, −0.3514, 0.0120), whatever is up in the world.
  EXPECT_NEAR(trans(4, 0) + 0.0031, place.x(), 1e-9);
  EXPECT_NEAR(trans(4, 1) - 0.3514, -place.z(), 1e-9);
  EXPECT_NEAR(trans(4, 2) + 0.0120, place.y(), 1e-9);
  EXPECT_EQ(AmassFromNpz(arrays, "a").num_frames(), 12);
}

}  // namespace
}  // namespace bodyloom::export_files_test
