// SPDX-License-Identifier: Apache-2.0
/// Poses in the world, markers, cameras and USD text, each read back by a reader of the test's own.
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <map>
#include <sstream>
#include <stdexcept>

#include "bodyloom/data_tools/export/c3d_writer.h"
#include "bodyloom/data_tools/export/colmap_writer.h"
#include "bodyloom/data_tools/export/pose2sim_calibration.h"
#include "bodyloom/data_tools/export/trc_writer.h"
#include "bodyloom/data_tools/export/usda_writer.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/motion/amass.h"
#include "bodyloom/data_tools/motion/bvh_writer.h"
#include "bodyloom/data_tools/motion/motion_tools.h"
#include "bodyloom/data_tools/observations/colmap_reader.h"
#include "bodyloom/data_tools/observations/load_camera_path.h"
#include "bodyloom/geometry/camera_path.h"
#include "bodyloom/geometry/rotation.h"
#include "tests/data_tools/export/exported_scene.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom {
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

/// Where markers are, read off the body's landmarks.
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

/// Where a camera that moves saw vertex v of frame t, in OpenCV's pixels.
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

/// The numbers of a list whose brackets may be nested.
std::vector<double> UsdList(std::string list) {
  for (char& c : list) {
    if (c == '(' || c == ')' || c == ',') c = ' ';
  }
  std::istringstream stream(list);
  std::vector<double> numbers;
  for (double x = 0; stream >> x;) numbers.push_back(x);
  return numbers;
}

/// Numbers of "key = [...]" or of one time sample of it.
std::vector<double> UsdNumbers(const std::string& text, const std::string& key, int sample = -1) {
  size_t at = text.find(key);
  EXPECT_NE(at, std::string::npos) << key;
  if (sample >= 0) {
    at = text.find('{', at);
    for (int i = 0; i <= sample; ++i) at = text.find(": [", at + 1);
  }
  const size_t begin = text.find('[', text.find(sample >= 0 ? ": " : "= ", at)), end = text.find(']', begin);
  return UsdList(text.substr(begin + 1, end - begin - 1));
}

/// The matrix of one time sample: "11: ( (…), (…), (…), (…) )".
std::vector<double> UsdMatrixSample(const std::string& text, const std::string& key, int sample) {
  size_t at = text.find(key);
  EXPECT_NE(at, std::string::npos) << key;
  at = text.find('{', at);
  for (int i = 0; i <= sample; ++i) at = text.find(": (", at + 1);
  return UsdList(text.substr(at + 2, text.find('\n', at) - at - 2));
}

TEST(UsdaWriter, ACameraThatMovesHasASampleOfEveryFrame) {
  const Track track = ShortTrack(6, SynthCameraMotion::kHandHeld);
  const ExportScene scene = SceneOf(track);
  const std::string text = UsdaText(scene, 0);
  const std::vector<double> m = UsdMatrixSample(text, "matrix4d xformOp:transform.timeSamples", 11);
  ASSERT_EQ(m.size(), 16U) << "of frame 11";
  EXPECT_EQ(UsdaText(SceneOf(ShortTrack()), 0).find("xformOp:transform.timeSamples"), std::string::npos);
  const Vector3d place(m[12], m[13], m[14]);
  EXPECT_LT((place - CentreOf(scene.camera_keys[11].camera_from_world)).norm(), 1e-5);
  // Rows of the transposed matrix are the camera's axes in the world: −z is where it looks.
  const Vector3d ahead = scene.camera_keys[11].camera_from_world.camera_from_world_rotation.row(2).transpose();
  EXPECT_LT((Vector3d(m[8], m[9], m[10]) + ahead).norm(), 1e-5);
}

TEST(UsdaWriter, PosesTheBodyWhereItIs) {
  const Track track = TrackWithAGap();
  const std::string text = UsdaText(SceneOf(track), 8);
  EXPECT_THAT(text, ::testing::StartsWith("#usda 1.0\n"));
  EXPECT_THAT(text, ::testing::HasSubstr("metersPerUnit = 1\n"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '{'), std::count(text.begin(), text.end(), '}'));
  EXPECT_THAT(text, ::testing::HasSubstr("2.5: \"invisible\""));
  std::vector<double> points = UsdNumbers(text, "point3f[] points");
  const std::vector<double> weights = UsdNumbers(text, "blendShapeWeights.timeSamples", 3);
  for (size_t k = 0; k < weights.size(); ++k) {
    const std::string shape = text.substr(text.find("def BlendShape \"corrective_" + std::to_string(k)));
    const std::vector<double> offsets = UsdNumbers(shape, "offsets");
    for (size_t i = 0; i < points.size(); ++i) points[i] += weights[k] * offsets[i];
  }
  const std::vector<double> q = UsdNumbers(text, "rotations.timeSamples", 3);
  const std::vector<double> translations = UsdNumbers(text, "translations.timeSamples", 3);
  const std::vector<double> bind = UsdNumbers(text, "bindTransforms"), rest = UsdNumbers(text, "restTransforms");
  const std::vector<double> joints = UsdNumbers(text, "jointIndices"), skin = UsdNumbers(text, "jointWeights");
  std::vector<Eigen::Affine3d> skinning, posed;
  for (size_t j = 0; j < 24; ++j) {
    Eigen::Affine3d local = Eigen::Affine3d::Identity();
    local.translation() = Vector3d(translations[3 * j], translations[3 * j + 1], translations[3 * j + 2]);
    local.linear() = Eigen::Quaterniond(q[4 * j], q[4 * j + 1], q[4 * j + 2], q[4 * j + 3]).toRotationMatrix();
    const int parent = SmplParents()[j];
    posed.push_back(parent < 0 ? local : posed[size_t(parent)] * local);
    EXPECT_EQ(bind[16 * j], 1);
    const Vector3d place(bind[16 * j + 12], bind[16 * j + 13], bind[16 * j + 14]);
    skinning.push_back(posed.back() * Eigen::Translation3d(-place));
    if (j > 0) {
      EXPECT_NEAR(rest[16 * j + 12], translations[3 * j], 1e-6);
    }
  }
  const MatrixX3d truth = VerticesInWorld(track, 5);
  double farthest = 0;
  for (size_t v = 0; v < size_t(truth.rows()); ++v) {
    const Vector3d p(points[3 * v], points[3 * v + 1], points[3 * v + 2]);
    Vector3d at = Vector3d::Zero();
    for (size_t k = 0; k < 4; ++k) at += skin[4 * v + k] * (skinning[size_t(joints[4 * v + k])] * p);
    farthest = std::max(farthest, (at - truth.row(Eigen::Index(v)).transpose()).norm());
  }
  EXPECT_LT(farthest, 1e-3);
}

/// The world positions of a BVH file's joints at a frame, by name: a reader of the test's own.
std::map<std::string, Vector3d> BvhPositions(const std::string& text, int frame, bool at_rest = false) {
  std::istringstream stream(text);
  std::string word, name;
  struct Joint {
    std::string name;
    int parent;
    Vector3d offset;
  };
  std::vector<Joint> joints;
  std::vector<int> open;
  bool end_site = false;
  while (stream >> word && word != "MOTION") {
    if (word == "ROOT" || word == "JOINT") {
      stream >> name;
      joints.push_back({name, open.empty() ? -1 : open.back(), Vector3d::Zero()});
      end_site = false;
    } else if (word == "End") {
      end_site = true;
    } else if (word == "{") {
      open.push_back(end_site ? -2 : int(joints.size()) - 1);
    } else if (word == "}") {
      open.pop_back();
    } else if (word == "OFFSET") {
      Vector3d offset;
      stream >> offset[0] >> offset[1] >> offset[2];
      if (!end_site) joints.back().offset = offset;
    }
  }
  std::string line;
  while (std::getline(stream, line) && line.find("Frame Time") == std::string::npos) {
  }
  for (int t = 0; t <= frame; ++t) std::getline(stream, line);
  std::istringstream numbers(line);
  Vector3d root;
  numbers >> root[0] >> root[1] >> root[2];
  std::map<std::string, Vector3d> positions;
  std::vector<Eigen::Affine3d> world;
  for (const Joint& joint : joints) {
    Vector3d zxy;
    numbers >> zxy[0] >> zxy[1] >> zxy[2];
    if (at_rest) zxy.setZero();
    const double deg = M_PI / 180;
    Eigen::Affine3d local = Eigen::Translation3d(joint.parent < 0 ? root : joint.offset) *
                            Eigen::AngleAxisd(zxy[0] * deg, Vector3d::UnitZ()) *
                            Eigen::AngleAxisd(zxy[1] * deg, Vector3d::UnitX()) *
                            Eigen::AngleAxisd(zxy[2] * deg, Vector3d::UnitY());
    world.push_back(joint.parent < 0 ? local : world[size_t(joint.parent)] * local);
    positions[joint.name] = world.back().translation() / 100;
  }
  return positions;
}

TEST(BvhRig, JointsAreWhereTheyAreUnderEveryRigsNames) {
  const Track track = ShortTrack();
  const ExportScene scene = SceneOf(track);
  const ExportPerson& person = scene.people[0];
  const Motion motion = MotionInWorld(TiltedWorld(), person.rest_joints.row(0).transpose(), track.motion);
  const MatrixX3d truth = PoseSkeleton(BuiltinBody(), person.rest_joints, person.poses[7]).joints;
  const std::map<BvhRig, std::vector<std::string>> wrist_ankle = {{BvhRig::kSmpl, {"l_wrist", "r_ankle", "head"}},
                                                                  {BvhRig::kMixamo, {"LeftHand", "RightFoot", "Head"}},
                                                                  {BvhRig::kUnreal, {"hand_l", "foot_r", "head"}}};
  for (const auto& [rig, names] : wrist_ankle) {
    const std::string text = BvhText(motion, BuiltinBody(), rig);
    const std::map<std::string, Vector3d> at = BvhPositions(text, 7);
    EXPECT_EQ(at.size(), rig == BvhRig::kSmpl ? 24U : 22U);
    EXPECT_LT((at.at(names[0]) - truth.row(20).transpose()).norm(), 1e-6);
    EXPECT_LT((at.at(names[1]) - truth.row(8).transpose()).norm(), 1e-6);
    EXPECT_LT((at.at(names[2]) - truth.row(15).transpose()).norm(), 1e-6);
    const std::map<std::string, Vector3d> rest = BvhPositions(text, 7, true);
    const std::string shoulder = rig == BvhRig::kMixamo   ? "LeftArm"
                                 : rig == BvhRig::kUnreal ? "upperarm_l"
                                                          : "l_shoulder";
    const Vector3d arm = rest.at(names[0]) - rest.at(shoulder);
    EXPECT_NEAR(std::atan2(-arm.y(), arm.x()) * 180 / M_PI, rig == BvhRig::kUnreal ? 45 : 0, 3)
        << "below the horizontal";
  }
  EXPECT_THROW(BvhRigFromString("rigify"), std::invalid_argument);
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
}  // namespace bodyloom
