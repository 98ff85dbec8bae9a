// SPDX-License-Identifier: Apache-2.0
#include "data_tools/datasets/video_truth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "data_tools/estimates/estimate_arrays.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

const PickleValue& RequireDict(const PickleValue& file, const std::string& key, const std::string& where) {
  const PickleValue* value = file.Find(key);
  if (value == nullptr || value->kind != PickleValue::Kind::kDict) {
    throw std::runtime_error(where + ": " + key + ": expected a dictionary");
  }
  return *value;
}

std::string TextOf(const PickleValue* value) {
  const bool is_text =
      value != nullptr && (value->kind == PickleValue::Kind::kString || value->kind == PickleValue::Kind::kBytes);
  return is_text && IsOneLine(value->text) && value->text.size() < 1000 ? value->text : "";
}

std::string GenderOf(const PickleValue* value) {
  const std::string text = TextOf(value);
  if (text == "m" || text == "male") return "male";
  if (text == "f" || text == "female") return "female";
  return "neutral";
}

RowMatrixXd Numbers(const PickleValue& file, const std::string& key, const std::vector<int64_t>& shape,
                    const std::string& where) {
  return RequireShape(RequireNumbers(file, key, where), shape, where, key);
}

/// Entry `person` of a list of arrays.
const NdArray& OfPerson(const PickleValue& file, const std::string& key, int person, const std::string& where) {
  const PickleValue* list = file.Find(key);
  const bool has = list != nullptr &&
                   (list->kind == PickleValue::Kind::kList || list->kind == PickleValue::Kind::kTuple) &&
                   size_t(person) < list->items.size() && list->items[size_t(person)] != nullptr &&
                   list->items[size_t(person)]->kind == PickleValue::Kind::kArray;
  if (!has)
    throw std::runtime_error(Concatenate(where, ": ", key, ": expected a list with an array of person ", person));
  return list->items[size_t(person)]->array;
}

void SetMotion(const RowMatrixXd& poses, const RowMatrixXd& trans, const RowMatrixXd& betas, Track* track) {
  Motion& motion = track->motion;
  motion.body = "smpl";
  motion.up = Motion::Up::kCamera;
  motion.poses = poses;
  motion.trans = trans;
  motion.betas = Eigen::Map<const Eigen::VectorXd>(betas.data(), betas.size());
  for (Eigen::Index t = 0; t < poses.rows(); ++t) motion.timestamps.push_back(double(t) / VideoTruth().fps);
  track->frame_status.assign(size_t(poses.rows()), FrameStatus::kTracked);
  track->weak_camera.resize(0, 3);
}

void SetIntrinsics(const RowMatrixXd& k, const std::string& place, Camera* camera) {
  if (!(k(0, 0) > 0 && k(1, 1) > 0 && k(2, 2) == 1)) {
    throw std::runtime_error(place + ": expected [fx 0 cx; 0 fy cy; 0 0 1] with focal lengths above 0");
  }
  camera->model = CameraModel::kPinhole;
  camera->fx = k(0, 0), camera->fy = k(1, 1), camera->cx = k(0, 2), camera->cy = k(1, 2);
}

/// T×16 numbers, matrices row by row; rows that are no rigid motion make their frame lost.
void SetCameraPath(const RowMatrixXd& rows, Track* track) {
  constexpr double kNotRigid = 1e-3;
  for (Eigen::Index t = 0; t < rows.rows(); ++t) {
    const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(rows.row(t).data());
    CameraPose pose{matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>()};
    if (!IsRotation(pose.camera_from_world_rotation, kNotRigid)) {
      track->frame_status[size_t(t)] = FrameStatus::kLost;
      pose = CameraPose();
    }
    track->camera_from_scene.push_back(pose);
  }
}

/// Marks frames whose flag is 0 as lost.
void LoseFrames(const NdArray& flags, const std::string& where, const std::string& key, Track* track) {
  const RowMatrixXd good = RequireShape(flags, {track->num_frames()}, where, key);
  for (int t = 0; t < track->num_frames(); ++t) {
    if (good.data()[t] == 0) track->frame_status[size_t(t)] = FrameStatus::kLost;
  }
}

/// Lost frames have no pose.
void ClearLostFrames(Track* track) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (int t = 0; t < track->num_frames(); ++t) {
    if (track->frame_status[size_t(t)] != FrameStatus::kLost) continue;
    track->motion.poses.row(t).setConstant(kNaN);
    track->motion.trans.row(t).setConstant(kNaN);
  }
}

int64_t RequireFrames(const NdArray& array, const std::string& place) {
  const int64_t frames = array.shape.empty() ? 0 : array.shape[0];
  if (frames < 1 || frames > kMaxEstimateFrames) {
    throw std::runtime_error(Concatenate(place, ": ", frames, " frames, expected 1 to ", kMaxEstimateFrames));
  }
  return frames;
}

int WholeNumber(const PickleValue& file, const std::string& key, const std::string& where) {
  const PickleValue* value = file.Find(key);
  if (value == nullptr || value->kind != PickleValue::Kind::kInt || value->integer < 1 || value->integer > 100'000) {
    throw std::runtime_error(where + ": " + key + ": expected a number of pixels");
  }
  return int(value->integer);
}

VideoTruth EmdbTruth(const PickleValue& file, const std::string& where) {
  VideoTruth truth;
  truth.dataset = "EMDB";
  truth.protocol = "emdb";
  truth.sequence = TextOf(file.Find("name"));
  truth.gender = GenderOf(file.Find("gender"));
  const PickleValue& smpl = RequireDict(file, "smpl", where);
  const PickleValue& camera = RequireDict(file, "camera", where);
  const int64_t T = RequireFrames(RequireNumbers(smpl, "poses_root", where), where + ": poses_root");
  RowMatrixXd poses(T, 72);
  poses << Numbers(smpl, "poses_root", {T, 3}, where), Numbers(smpl, "poses_body", {T, 69}, where);
  SetMotion(poses, Numbers(smpl, "trans", {T, 3}, where), Numbers(smpl, "betas", {-1}, where), &truth.track);
  SetIntrinsics(Numbers(camera, "intrinsics", {3, 3}, where), where + ": intrinsics", &truth.track.camera);
  truth.track.camera.width = WholeNumber(camera, "width", where);
  truth.track.camera.height = WholeNumber(camera, "height", where);
  SetCameraPath(Numbers(camera, "extrinsics", {T, 4, 4}, where), &truth.track);
  LoseFrames(RequireNumbers(file, "good_frames_mask", where), where, "good_frames_mask", &truth.track);
  return truth;
}

VideoTruth ThreeDpwTruth(const PickleValue& file, int person, const std::string& where) {
  VideoTruth truth;
  truth.dataset = "3DPW";
  truth.protocol = "3dpw";
  truth.sequence = TextOf(file.Find("sequence"));
  const PickleValue* genders = file.Find("genders");
  const bool has_gender = genders != nullptr && size_t(person) < genders->items.size();
  truth.gender = GenderOf(has_gender ? genders->items[size_t(person)].get() : nullptr);
  truth.num_people = int(file.Find("poses")->items.size());
  const NdArray& poses = OfPerson(file, "poses", person, where);
  const int64_t T = RequireFrames(poses, where + ": poses");
  const RowMatrixXd betas = RequireShape(OfPerson(file, "betas", person, where), {-1}, where, "betas");
  constexpr Eigen::Index kShapeComponents = 10;  // files hold up to 300, of which the public bodies have ten
  SetMotion(RequireShape(poses, {T, 72}, where, "poses"),
            RequireShape(OfPerson(file, "trans", person, where), {T, 3}, where, "trans"), betas, &truth.track);
  Eigen::VectorXd& shape = truth.track.motion.betas;
  shape.conservativeResize(std::min(shape.size(), kShapeComponents));
  Camera& camera = truth.track.camera;
  SetIntrinsics(Numbers(file, "cam_intrinsics", {3, 3}, where), where + ": cam_intrinsics", &camera);
  camera.width = int(std::lround(2 * camera.cx)), camera.height = int(std::lround(2 * camera.cy));
  if (camera.width < 1 || camera.height < 1 || camera.width > 100'000 || camera.height > 100'000) {
    throw std::runtime_error(where + ": cam_intrinsics: a principal point outside any image");
  }
  SetCameraPath(Numbers(file, "cam_poses", {T, 4, 4}, where), &truth.track);
  LoseFrames(OfPerson(file, "campose_valid", person, where), where, "campose_valid", &truth.track);
  return truth;
}

bool IsEmdb(const PickleValue& file) {
  const PickleValue* smpl = file.Find("smpl");
  return smpl != nullptr && smpl->Find("poses_root") != nullptr && file.Find("camera") != nullptr;
}

bool IsThreeDpw(const PickleValue& file) {
  const PickleValue* poses = file.Find("poses");
  return poses != nullptr && (poses->kind == PickleValue::Kind::kList || poses->kind == PickleValue::Kind::kTuple) &&
         file.Find("cam_poses") != nullptr;
}

}  // namespace

VideoTruth VideoTruthFromPickle(const PickleValue& file, int person, const std::string& where) {
  BODYLOOM_CHECK(person >= 0, "person ", person, " must not be negative");
  if (!IsEmdb(file) && !IsThreeDpw(file)) {
    throw std::runtime_error(where + ": expected EMDB's *_data.pkl or a sequence file of 3DPW");
  }
  const int people = IsEmdb(file) ? 1 : int(file.Find("poses")->items.size());
  if (person >= people) {
    throw std::runtime_error(Concatenate(where, ": ", people, " people, expected one with number ", person));
  }
  VideoTruth truth = IsEmdb(file) ? EmdbTruth(file, where) : ThreeDpwTruth(file, person, where);
  ClearLostFrames(&truth.track);
  return truth;
}

void SetLostFrames(int T, Eigen::Index columns, const NamedCamera& camera, VideoTruth* truth) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  Track& track = truth->track;
  track.motion.up = Motion::Up::kCamera;
  track.motion.poses.setConstant(T, columns, kNaN);
  track.motion.trans.setConstant(T, 3, kNaN);
  track.frame_status.assign(size_t(T), FrameStatus::kLost);
  track.weak_camera.resize(0, 3);
  track.camera = camera.camera;
  track.camera_from_scene.assign(size_t(T), camera.pose);
  for (int t = 0; t < T; ++t) track.motion.timestamps.push_back(t / truth->fps);
}

std::vector<int> FramesNearTimes(int num_frames, double fps, const std::vector<double>& times_s,
                                 const std::string& where) {
  std::vector<int> frames;
  for (const double time : times_s) {
    const double frame = time * fps;
    if (!(std::abs(frame) < 1e9) || std::lround(frame) < 0 || std::lround(frame) >= num_frames) {
      throw std::runtime_error(
          Concatenate(where, ": ", num_frames, " frames at ", fps, " a second, the track has one at ", time, " s"));
    }
    frames.push_back(int(std::lround(frame)));
  }
  return frames;
}

}  // namespace bodyloom
