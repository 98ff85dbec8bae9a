// SPDX-License-Identifier: Apache-2.0
/// Pickles in the form of EMDB's and 3DPW's, made of tracks with a moving camera.
#pragma once

#include <string>
#include <vector>

#include "geometry/scene/track.h"
#include "tests/data_tools/formats/pickle_writer.h"

namespace bodyloom {

inline std::string PickledMatrix(const RowMatrixXd& matrix, const std::vector<int>& shape) {
  return pickle_writer::Doubles2({matrix.data(), matrix.data() + matrix.size()}, shape);
}

inline std::string PickledFlags(const std::vector<uint8_t>& flags) {
  return pickle_writer::Array2("b1", '|', {int(flags.size())}, false, pickle_writer::RawOf(flags));
}

/// 4×4 matrices, world to camera.
inline std::string PickledPath(const Track& track) {
  std::vector<double> values;
  for (const CameraPose& pose : track.camera_from_scene) {
    Eigen::Matrix<double, 4, 4, Eigen::RowMajor> matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = pose.camera_from_world_rotation;
    matrix.topRightCorner<3, 1>() = pose.camera_from_world_translation;
    values.insert(values.end(), matrix.data(), matrix.data() + 16);
  }
  return pickle_writer::Doubles2(values, {track.num_frames(), 4, 4});
}

inline std::string PickledIntrinsics(const Camera& camera) { return PickledMatrix(RowMatrixXd(camera.K()), {3, 3}); }

inline std::string EmdbPickle(const Track& track, const std::vector<uint8_t>& good, const std::string& gender) {
  using namespace pickle_writer;  // NOLINT(google-build-using-namespace)
  const int T = track.num_frames(), B = int(track.motion.betas.size());
  const std::string smpl = Dict({{Str2("poses_root"), PickledMatrix(track.motion.poses.leftCols(3), {T, 3})},
                                 {Str2("poses_body"), PickledMatrix(track.motion.poses.rightCols(69), {T, 69})},
                                 {Str2("trans"), PickledMatrix(track.motion.trans, {T, 3})},
                                 {Str2("betas"), PickledMatrix(track.motion.betas, {B})}});
  const std::string camera = Dict({{Str2("intrinsics"), PickledIntrinsics(track.camera)},
                                   {Str2("extrinsics"), PickledPath(track)},
                                   {Str2("width"), Int(track.camera.width)},
                                   {Str2("height"), Int(track.camera.height)}});
  return Pickle(2, Dict({{Str2("gender"), Str2(gender)},
                         {Str2("name"), Str2("P0_00_walk")},
                         {Str2("n_frames"), Int(T)},
                         {Str2("good_frames_mask"), PickledFlags(good)},
                         {Str2("camera"), camera},
                         {Str2("smpl"), smpl}}));
}

/// All people have the first one's camera.
inline std::string ThreeDpwPickle(const std::vector<Track>& people, const std::vector<std::vector<uint8_t>>& valid) {
  using namespace pickle_writer;  // NOLINT(google-build-using-namespace)
  const auto list = [&](const auto& item) {
    std::string text = "](";
    for (size_t i = 0; i < people.size(); ++i) text += item(i);
    return text + "e";
  };
  const int T = people[0].num_frames();
  return Pickle(2, Dict({{Str2("sequence"), Str2("downtown_walking_00")},
                         {Str2("poses"), list([&](size_t i) {
                            return PickledMatrix(people[i].motion.poses, {T, 72});
                          })},
                         {Str2("trans"), list([&](size_t i) {
                            return PickledMatrix(people[i].motion.trans, {T, 3});
                          })},
                         {Str2("betas"), list([&](size_t i) {
                            return PickledMatrix(people[i].motion.betas, {int(people[i].motion.betas.size())});
                          })},
                         {Str2("genders"), list([&](size_t i) { return Str2(i == 0 ? "m" : "f"); })},
                         {Str2("campose_valid"), list([&](size_t i) { return PickledFlags(valid[i]); })},
                         {Str2("cam_intrinsics"), PickledIntrinsics(people[0].camera)},
                         {Str2("cam_poses"), PickledPath(people[0])}}));
}

}  // namespace bodyloom
