// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/track_io.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/ndarray.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

constexpr double kDefaultFrameRate = 30;
constexpr int kCocoPoints = 17;

// ---- writing ----

/// T equal n×3 matrices as one T×n×3 array.
NdArray Stack(const std::vector<MatrixX3d>& points) {
  const Eigen::Index n = points.front().rows();
  std::vector<double> values;
  values.reserve(points.size() * static_cast<size_t>(3 * n));
  for (const MatrixX3d& frame : points) values.insert(values.end(), frame.data(), frame.data() + frame.size());
  return NdArray::FromDoubles(values.data(), {static_cast<int64_t>(points.size()), n, 3});
}

void CheckPoints(const char* name, const std::vector<MatrixX3d>& points, int T, Eigen::Index n) {
  BODYLOOM_CHECK(static_cast<int>(points.size()) == T, "track: ", name, " has ", points.size(), " frames, poses ", T);
  for (const MatrixX3d& frame : points) {
    BODYLOOM_CHECK(frame.rows() == n, "track: a frame of ", name, " has ", frame.rows(), " points, expected ", n);
  }
}

void CheckTrack(const Track& track) {
  const Motion& motion = track.motion;
  const int T = motion.num_frames();
  BODYLOOM_CHECK(T > 0, "track: no frames");
  BODYLOOM_CHECK(motion.poses.cols() > 0 && motion.poses.cols() % 3 == 0, "track: poses has ", motion.poses.cols(),
                 " columns, expected 3 a joint");
  BODYLOOM_CHECK(motion.trans.rows() == T, "track: trans has ", motion.trans.rows(), " frames, poses ", T);
  BODYLOOM_CHECK(static_cast<int>(motion.timestamps.size()) == T, "track: timestamps has ", motion.timestamps.size(),
                 " frames, poses ", T);
  BODYLOOM_CHECK(static_cast<int>(track.frame_status.size()) == T, "track: frame_status has ",
                 track.frame_status.size(), " frames, poses ", T);
  BODYLOOM_CHECK(motion.betas.allFinite(), "track: betas holds NaN or infinite values");
  const bool weak = track.camera.model == CameraModel::kWeakPerspective;
  BODYLOOM_CHECK(track.camera_from_scene.empty() || (static_cast<int>(track.camera_from_scene.size()) == T && !weak),
                 "track: a path of ", track.camera_from_scene.size(), " poses of a ", ToString(track.camera.model),
                 " camera for ", T, " frames, expected as many of a pinhole camera");
  BODYLOOM_CHECK(track.weak_camera.rows() == (weak ? T : 0), "track: weak_camera has ", track.weak_camera.rows(),
                 " frames, expected ", weak ? T : 0);
}

using RowMatrix4d = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

RowMatrix4d MatrixOf(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
  RowMatrix4d matrix = RowMatrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = rotation;
  matrix.topRightCorner<3, 1>() = translation;
  return matrix;
}

/// Frames a second by the median time step; the default for a single frame.
double FrameRate(const std::vector<double>& timestamps) {
  std::vector<double> steps;
  for (size_t t = 1; t < timestamps.size(); ++t) steps.push_back(timestamps[t] - timestamps[t - 1]);
  if (steps.empty()) return kDefaultFrameRate;
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  return 1 / steps[steps.size() / 2];
}

// ---- reading ----

class TrackReader {
 public:
  TrackReader(const NpzArrays& arrays, const std::string& where) : arrays_(arrays), where_(where) {}

  Track Read() {
    ReadMotion();
    ReadTimestamps();
    ReadStatus();
    ReadCamera();
    ReadCameraPath();
    ReadPoints("joints", -1, &track_.joints);
    ReadPoints("coco17", kCocoPoints, &track_.coco17);
    const Eigen::Index J = track_.motion.poses.cols() / 3;
    track_.joint_sigma.setConstant(T_, J, std::numeric_limits<double>::quiet_NaN());
    ReadWorld();
    if (Has("joint_sigma")) track_.joint_sigma = Array("joint_sigma", {T_, -1}).ToMatrix();
    ReadPlayback();
    if (Has("root_sigma")) track_.root_sigma = Array("root_sigma", {T_}).ToMatrix();
    return std::move(track_);
  }

 private:
  [[noreturn]] void Fail(const std::string& message) const { throw std::runtime_error(where_ + ": " + message); }
  [[nodiscard]] bool Has(const std::string& name) const { return arrays_.count(name) > 0; }

  /// An array of numbers of this shape; −1: any.
  [[nodiscard]] const NdArray& Array(const std::string& name, const std::vector<int64_t>& shape) const {
    const NdArray& array = RequireArray(arrays_, name, where_);
    bool fits = array.is_number() && array.shape.size() == shape.size();
    std::string expected;
    for (size_t d = 0; d < shape.size(); ++d) {
      fits = fits && (shape[d] < 0 || array.shape[d] == shape[d]);
      expected += (d == 0 ? "" : "x") + (shape[d] < 0 ? std::string("n") : std::to_string(shape[d]));
    }
    if (!fits) {
      Fail(name + ": " + (array.is_number() ? array.ShapeText() : "not numbers") + ", expected " +
           (expected.empty() ? "a scalar" : expected));
    }
    return array;
  }
  [[nodiscard]] std::vector<double> Finite(const std::string& name, const std::vector<int64_t>& shape) const {
    std::vector<double> values = Array(name, shape).ToDoubles();
    for (const double x : values) {
      if (!std::isfinite(x)) Fail(name + ": NaN or infinite values");
    }
    return values;
  }
  [[nodiscard]] std::string Text(const std::string& name) const {
    const NdArray& array = RequireArray(arrays_, name, where_);
    if (!array.is_text() || array.num_elements() != 1) Fail(name + ": expected one text");
    std::string text = array.ToStrings().front();
    if (!IsOneLine(text) || text.size() > 1000) Fail(name + ": expected one line of text");
    return text;
  }

  void ReadMotion() {
    Motion& motion = track_.motion;
    const NdArray& poses = Array("poses", {-1, -1});
    if (poses.shape[0] < 1 || poses.shape[1] < 3 || poses.shape[1] % 3 != 0) {
      Fail("poses: " + poses.ShapeText() + ", expected frames x 3 values a joint");
    }
    T_ = static_cast<int>(std::min<int64_t>(poses.shape[0], std::numeric_limits<int>::max()));
    motion.poses = poses.ToMatrix();
    motion.trans = Array("trans", {T_, 3}).ToMatrix();
    motion.up = Motion::Up::kCamera;
    if (motion.poses.array().isInf().any()) Fail("poses: infinite values");
    if (motion.trans.array().isInf().any()) Fail("trans: infinite values");
    const int64_t columns = poses.shape[1];
    motion.body = Has("body") ? Text("body") : columns == 165 ? "smplx" : columns == 156 ? "smplh" : "smpl";
    if (Has("betas")) {
      const bool per_frame = RequireArray(arrays_, "betas", where_).shape.size() == 2;
      const std::vector<double> betas =
          Finite("betas", per_frame ? std::vector<int64_t>{T_, -1} : std::vector<int64_t>{-1});
      const Eigen::Index B = static_cast<Eigen::Index>(betas.size()) / (per_frame ? T_ : 1);
      motion.betas = Eigen::Map<const RowMatrixXd>(betas.data(), per_frame ? T_ : 1, B).colwise().mean().transpose();
    }
  }

  void ReadTimestamps() {
    std::vector<double>& timestamps = track_.motion.timestamps;
    if (Has("timestamps")) {
      timestamps = Finite("timestamps", {T_});
      for (int t = 1; t < T_; ++t) {
        if (!(timestamps[t] > timestamps[t - 1])) {
          Fail(Concatenate("timestamps: frame ", t, " is at ", timestamps[t], " s after ", timestamps[t - 1],
                           " s, expected rising times"));
        }
      }
      return;
    }
    double rate = kDefaultFrameRate;
    for (const char* name : {"mocap_frame_rate", "mocap_framerate"}) {
      if (!Has(name)) continue;
      rate = RequireArray(arrays_, name, where_).shape.empty() ? Finite(name, {}).front() : Finite(name, {1}).front();
      if (!(rate > 0)) Fail(Concatenate(name, ": ", rate, ", expected frames a second"));
    }
    for (int t = 0; t < T_; ++t) timestamps.push_back(t / rate);
  }

  void ReadStatus() {
    std::vector<int64_t> status(T_, 0);
    const bool given = Has("frame_status");
    if (given) status = WholeNumbers(Array("frame_status", {T_}), "frame_status", where_);
    for (int t = 0; t < T_; ++t) {
      if (status[t] < 0 || status[t] > 3) {
        Fail(Concatenate("frame_status: frame ", t, " is ", status[t], ", expected 0 to 3"));
      }
      const bool known = track_.motion.HasPose(t);
      auto frame = static_cast<FrameStatus>(status[t]);
      if (!known && frame != FrameStatus::kLost) {
        if (given) Fail(Concatenate("frame ", t, " is ", ToString(frame), ", but its pose holds NaN"));
        frame = FrameStatus::kLost;
      }
      track_.frame_status.push_back(frame);
    }
  }

  void ReadCamera() {
    Camera& camera = track_.camera;
    if (Has("camera_model")) {
      try {
        camera.model = CameraModelFromString(Text("camera_model"));
      } catch (const std::invalid_argument& error) {
        Fail(std::string("camera_model: ") + error.what());
      }
    } else {
      camera.model = Has("camera") && !Has("K") ? CameraModel::kWeakPerspective : CameraModel::kPinhole;
    }
    if (Has("image_size")) {
      const std::vector<double> size = Finite("image_size", {2});
      for (const double x : size) {
        if (x < 0 || x > 1e6 || x != std::floor(x)) Fail(Concatenate("image_size: ", x, ", expected pixels"));
      }
      camera.width = static_cast<int>(size[0]);
      camera.height = static_cast<int>(size[1]);
    }
    const bool weak = camera.model == CameraModel::kWeakPerspective;
    if (!weak || Has("K")) ReadIntrinsics(weak);
    if (Has("distortion")) ReadDistortion();
    track_.weak_camera.resize(0, 3);
    if (weak) {
      track_.weak_camera = Array("camera", {T_, 3}).ToMatrix();
      for (int t = 0; t < T_; ++t) {
        const bool valid = track_.weak_camera.row(t).allFinite() && track_.weak_camera(t, 0) > 0;
        if (!valid && track_.frame_status[t] != FrameStatus::kLost) {
          Fail(Concatenate("camera: frame ", t, " is (", track_.weak_camera.row(t),
                           "), expected a scale above 0 and two offsets"));
        }
      }
    }
  }

  void ReadIntrinsics(bool weak) {
    if (!Has("K")) Fail("no camera: expected K (3x3), or camera (frames x 3)");
    const bool per_frame = RequireArray(arrays_, "K", where_).shape.size() == 3;
    const std::vector<double> k = Finite("K", per_frame ? std::vector<int64_t>{T_, 3, 3} : std::vector<int64_t>{3, 3});
    for (size_t i = 9; i < k.size(); ++i) {
      if (std::abs(k[i] - k[i % 9]) > 1e-6 * (1 + std::abs(k[i % 9]))) {
        Fail(Concatenate("K: frame ", i / 9, " differs from frame 0, expected one camera for all frames"));
      }
    }
    const bool form = k[3] == 0 && k[6] == 0 && k[7] == 0 && k[8] == 1 && std::abs(k[1]) <= 1e-9 * std::abs(k[0]);
    if (!form || (!weak && (k[0] <= 0 || k[4] <= 0))) {
      Fail("K: expected [fx 0 cx; 0 fy cy; 0 0 1] with focal lengths above 0");
    }
    Camera& camera = track_.camera;
    camera.fx = k[0];
    camera.fy = k[4];
    camera.cx = k[2];
    camera.cy = k[5];
  }

  void ReadDistortion() {
    std::vector<double> distortion = Finite("distortion", {-1});
    while (distortion.size() > 8 && distortion.back() == 0) distortion.pop_back();
    if (distortion.size() != 0 && distortion.size() != 4 && distortion.size() != 5 && distortion.size() != 8) {
      Fail(Concatenate("distortion: ", distortion.size(), " values, expected 4, 5 or 8 in OpenCV's order"));
    }
    std::copy(distortion.begin(), distortion.end(), track_.camera.distortion.begin());
  }

  /// 16 numbers in row-major order.
  [[nodiscard]] CameraPose RigidMotion(const double* numbers, const std::string& name) const {
    const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers);
    CameraPose pose{matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>()};
    if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1) || !IsRotation(pose.camera_from_world_rotation, 1e-6)) {
      Fail(name + ": expected a rotation and a translation [R t; 0 0 0 1]");
    }
    return pose;
  }

  void ReadCameraPath() {
    if (!Has("camera_from_scene")) return;
    if (track_.camera.model != CameraModel::kPinhole) {
      Fail("camera_from_scene: of a weak-perspective camera, which has no place in a scene");
    }
    const std::vector<double> m = Finite("camera_from_scene", {T_, 4, 4});
    for (int t = 0; t < T_; ++t) {
      track_.camera_from_scene.push_back(
          RigidMotion(m.data() + size_t{16} * t, Concatenate("camera_from_scene: frame ", t)));
    }
  }

  void ReadWorld() {
    if (!Has("world_from_camera")) return;
    const CameraPose pose = RigidMotion(Finite("world_from_camera", {4, 4}).data(), "world_from_camera");
    WorldFrame& world = track_.world.emplace();
    world.rotation = pose.camera_from_world_rotation;
    world.translation = pose.camera_from_world_translation;
    if (Has("world_source")) {
      try {
        world.source = WorldSourceFromString(Text("world_source"));
      } catch (const std::invalid_argument& error) {
        Fail(std::string("world_source: ") + error.what());
      }
    } else {
      world.source = WorldSource::kGiven;
    }
    if (Has("world_level")) {
      const std::vector<double> level = Finite("world_level", {T_});
      track_.level_m = Eigen::Map<const Eigen::VectorXd>(level.data(), T_);
    }
    if (!Has("world_sigma")) return;
    const std::vector<double> sigma = Array("world_sigma", {2}).ToDoubles();
    if (sigma[0] < 0 || sigma[1] < 0 || std::isinf(sigma[0]) || std::isinf(sigma[1])) {
      Fail("world_sigma: expected standard deviations, degrees and metres");
    }
    world.vertical_sigma_deg = sigma[0];
    world.height_sigma_m = sigma[1];
  }

  void ReadPlayback() {
    VideoPlayback& playback = track_.playback;
    if (Has("video_turn_deg")) {
      const double turn = Finite("video_turn_deg", {}).front();
      if (turn != 0 && turn != 90 && turn != 180 && turn != 270) {
        Fail(Concatenate("video_turn_deg: ", turn, ", expected 0, 90, 180 or 270"));
      }
      playback.turn_deg = static_cast<int>(turn);
    }
    if (Has("video_slowdown")) playback.slowdown = Finite("video_slowdown", {}).front();
    if (playback.slowdown <= 0) Fail(Concatenate("video_slowdown: ", playback.slowdown, ", expected above 0"));
  }

  void ReadPoints(const std::string& name, int64_t n, std::vector<MatrixX3d>* points) const {
    if (!Has(name)) return;
    const NdArray& array = Array(name, {T_, n, 3});
    const std::vector<double> values = array.ToDoubles();
    const Eigen::Index rows = array.shape[1];
    for (int t = 0; t < T_; ++t)
      points->emplace_back(Eigen::Map<const MatrixX3d>(values.data() + t * 3 * rows, rows, 3));
  }

  const NpzArrays& arrays_;
  const std::string& where_;
  Track track_;
  int T_ = 0;
};

}  // namespace

void WriteTrack(const std::string& path, const Track& track) {
  CheckTrack(track);
  const Motion& motion = track.motion;
  const int T = motion.num_frames();
  const Eigen::Index J = motion.poses.cols() / 3;
  NpzArrays arrays;
  arrays["poses"] = NdArray::FromDoubles(motion.poses.data(), {T, 3 * J});
  arrays["trans"] = NdArray::FromDoubles(motion.trans.data(), {T, 3});
  arrays["betas"] = NdArray::FromDoubles(motion.betas.data(), {motion.betas.size()});
  arrays["gender"] = NdArray::FromString("neutral");
  arrays["mocap_framerate"] = NdArray::FromDouble(FrameRate(motion.timestamps));
  arrays["body"] = NdArray::FromString(motion.body);
  arrays["timestamps"] = NdArray::FromDoubles(motion.timestamps.data(), {T});
  std::vector<uint8_t> status;
  for (const FrameStatus s : track.frame_status) status.push_back(static_cast<uint8_t>(s));
  arrays["frame_status"] = NdArray::FromUInt8(status.data(), {T});

  const Camera& camera = track.camera;
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> K = camera.K();
  const int32_t size[] = {camera.width, camera.height};
  arrays["camera_model"] = NdArray::FromString(ToString(camera.model));
  arrays["K"] = NdArray::FromDoubles(K.data(), {3, 3});
  arrays["distortion"] = NdArray::FromDoubles(camera.distortion.data(), {8});
  arrays["image_size"] = NdArray::FromInts32(size, {2});
  if (camera.model == CameraModel::kWeakPerspective) {
    arrays["camera"] = NdArray::FromDoubles(track.weak_camera.data(), {T, 3});
  }
  if (track.HasMovingCamera()) {
    std::vector<double> path;
    for (const CameraPose& pose : track.camera_from_scene) {
      const RowMatrix4d matrix = MatrixOf(pose.camera_from_world_rotation, pose.camera_from_world_translation);
      path.insert(path.end(), matrix.data(), matrix.data() + 16);
    }
    arrays["camera_from_scene"] = NdArray::FromDoubles(path.data(), {T, 4, 4});
  }
  if (track.world) {
    const RowMatrix4d matrix = MatrixOf(track.world->rotation, track.world->translation);
    const double sigma[] = {track.world->vertical_sigma_deg, track.world->height_sigma_m};
    arrays["world_from_camera"] = NdArray::FromDoubles(matrix.data(), {4, 4});
    arrays["world_source"] = NdArray::FromString(ToString(track.world->source));
    arrays["world_sigma"] = NdArray::FromDoubles(sigma, {2});
  }
  if (track.level_m.size() > 0) {
    BODYLOOM_CHECK(track.world && track.level_m.size() == T && track.level_m.allFinite(), "track: level_m has ",
                   track.level_m.size(), " frames, expected ", T, " finite heights over the ground of a world");
    arrays["world_level"] = NdArray::FromDoubles(track.level_m.data(), {T});
  }
  const VideoPlayback &playback = track.playback, as_stored;
  if (playback.turn_deg != as_stored.turn_deg) arrays["video_turn_deg"] = NdArray::FromDouble(playback.turn_deg);
  if (playback.slowdown != as_stored.slowdown) arrays["video_slowdown"] = NdArray::FromDouble(playback.slowdown);
  if (!track.joints.empty()) {
    CheckPoints("joints", track.joints, T, J);
    arrays["joints"] = Stack(track.joints);
  }
  if (!track.coco17.empty() && track.coco17.front().rows() > 0) {
    CheckPoints("coco17", track.coco17, T, kCocoPoints);
    arrays["coco17"] = Stack(track.coco17);
  }
  if (track.joint_sigma.size() > 0) {
    BODYLOOM_CHECK(track.joint_sigma.rows() == T && track.joint_sigma.cols() == J, "track: joint_sigma is ",
                   track.joint_sigma.rows(), "x", track.joint_sigma.cols(), ", expected ", T, "x", J);
    arrays["joint_sigma"] = NdArray::FromDoubles(track.joint_sigma.data(), {T, J});
  }
  if (track.root_sigma.size() > 0) {
    BODYLOOM_CHECK(track.root_sigma.size() == T, "track: root_sigma has ", track.root_sigma.size(),
                   " frames, expected ", T);
    arrays["root_sigma"] = NdArray::FromDoubles(track.root_sigma.data(), {T});
  }
  WriteNpz(path, arrays);
}

Track TrackFromArrays(const NpzArrays& arrays, const std::string& where, MovingCamera moving) {
  Track track = TrackReader(arrays, where).Read();
  if (moving == MovingCamera::kRefuse && track.HasMovingCamera()) {
    throw std::runtime_error(where + ": a track whose camera moves, expected one of a camera that stands still");
  }
  return track;
}

Track ReadTrackBytes(const std::string& bytes, const std::string& where, MovingCamera moving) {
  return TrackFromArrays(ReadNpzBytes(bytes, where), where, moving);
}

Track ReadTrack(const std::string& path, MovingCamera moving) {
  return ReadTrackBytes(ReadFileBytes(path), path, moving);
}

}  // namespace bodyloom
