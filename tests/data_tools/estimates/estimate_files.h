// SPDX-License-Identifier: Apache-2.0
/// Writes results of WHAM, VIBE, PHALP, PromptHMR, GVHMR and GEM in their own formats, from people given as numbers.
#pragma once

#include <string>
#include <vector>

#include "data_tools/estimates/body_estimate.h"
#include "geometry/math/rotation.h"
#include "tests/data_tools/formats/joblib_stream.h"
#include "tests/data_tools/formats/torch_stream.h"

namespace bodyloom::estimate_files {

using namespace pickle_writer;  // NOLINT(google-build-using-namespace): opcodes read like the stream they build
using joblib_stream::JoblibStream;

template <typename Matrix>
std::vector<float> Floats(const Matrix& matrix) {
  std::vector<float> values;
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) values.push_back(static_cast<float>(matrix(r, c)));
  }
  return values;
}

inline int Count(const PersonEstimate& person) { return static_cast<int>(person.frames.size()); }

inline std::vector<int64_t> FrameIds(const PersonEstimate& person) {
  return {person.frames.begin(), person.frames.end()};
}

/// The same betas in every frame.
inline std::vector<float> BetasOfFrames(const PersonEstimate& person) {
  return Floats(RowMatrixXd(person.betas.transpose().replicate(Count(person), 1)));
}

/// defaultdict(dict): person id → arrays; `verts` is an array that readers ignore.
inline std::string WhamFile(const std::vector<PersonEstimate>& people) {
  JoblibStream stream;
  stream.Add(Global("collections", "defaultdict") + Global("builtins", "dict") + "\x85R(");
  for (const PersonEstimate& person : people) {
    const int n = Count(person);
    stream.Add(Int(std::stoi(person.name)) + "}(" + Unicode("pose")).AddFloats(Floats(person.poses), {n, 72});
    stream.Add(Unicode("trans")).AddFloats(Floats(person.trans), {n, 3});
    stream.Add(Unicode("pose_world")).AddFloats(Floats(person.poses), {n, 72});
    stream.Add(Unicode("trans_world")).AddFloats(Floats(person.trans), {n, 3});
    stream.Add(Unicode("betas")).AddFloats(BetasOfFrames(person), {n, static_cast<int>(person.betas.size())});
    stream.Add(Unicode("verts")).AddFloats(std::vector<float>(static_cast<size_t>(6 * n), 0.5F), {n, 2, 3});
    stream.Add(Unicode("frame_ids")).AddInts(FrameIds(person)).Add("u");
  }
  return stream.Add("u").Finish();
}

/// People with weak-perspective cameras.
inline std::string VibeFile(const std::vector<PersonEstimate>& people) {
  JoblibStream stream(/*aligned=*/false);
  stream.Add("}(");
  for (const PersonEstimate& person : people) {
    const int n = Count(person);
    RowMatrixXd orig_cam(n, 4);
    for (int i = 0; i < n; ++i) {
      const Camera& camera = person.cameras[static_cast<size_t>(i)];
      orig_cam.row(i) << 2 * camera.scale / camera.width, 2 * camera.scale / camera.height, camera.tx, camera.ty;
    }
    stream.Add(Int(std::stoi(person.name)) + "}(" + Unicode("pred_cam"));
    stream.AddFloats(std::vector<float>(static_cast<size_t>(3 * n), 1), {n, 3});
    stream.Add(Unicode("orig_cam")).AddFloats(Floats(orig_cam), {n, 4});
    stream.Add(Unicode("pose")).AddFloats(Floats(person.poses), {n, 72});
    stream.Add(Unicode("betas")).AddFloats(BetasOfFrames(person), {n, static_cast<int>(person.betas.size())});
    stream.Add(Unicode("joints2d") + "N" + Unicode("frame_ids")).AddInts(FrameIds(person)).Add("u");
  }
  return stream.Add("u").Finish();
}

/// People in frames of the video with a pinhole camera, with all of PHALP's entries: a ghost of person 99 in every
/// frame. Compressed, as PHALP writes it.
inline std::string PhalpFile(const std::vector<PersonEstimate>& people, int num_frames) {
  JoblibStream stream;
  stream.Add("}(");
  const auto add_matrix = [&](const Eigen::Vector3d& w, std::vector<float>* values) {
    const Eigen::Matrix3d matrix = RotationFromAxisAngle(w);
    for (const float value : Floats(matrix)) values->push_back(value);
  };
  for (int t = 0; t < num_frames; ++t) {
    std::string ids = "](", ages = "](", sizes = "](";
    std::vector<std::pair<const PersonEstimate*, Eigen::Index>> seen;
    for (const PersonEstimate& person : people) {
      for (size_t i = 0; i < person.frames.size(); ++i) {
        if (person.frames[i] != t) continue;
        seen.emplace_back(&person, static_cast<Eigen::Index>(i));
        ids += Int(std::stoi(person.name));
        ages += "K" + LittleEndian(0, 1);
        sizes += "](" + Int(person.cameras[i].height) + Int(person.cameras[i].width) + "e";
      }
    }
    stream.Add(Unicode("out/img/" + std::to_string(t + 1) + ".jpg") + "}(" + Unicode("time") + Int(t) + Unicode("tid") +
               ids + Int(99) + "e" + Unicode("tracked_time") + ages + Int(3) + "e" + Unicode("size") + sizes + "Ne" +
               Unicode("camera") + "](");
    for (const auto& [person, i] : seen) stream.AddFloats(Floats(person->trans.row(i)), {3});
    stream.Add("Ne" + Unicode("smpl") + "](");
    for (const auto& [person, i] : seen) {
      std::vector<float> root, body;
      add_matrix(person->poses.row(i).head<3>().transpose(), &root);
      for (int j = 1; j < 24; ++j) add_matrix(person->poses.row(i).segment<3>(3 * j).transpose(), &body);
      stream.Add("}(" + Unicode("global_orient")).AddFloats(root, {1, 3, 3});
      stream.Add(Unicode("body_pose")).AddFloats(body, {23, 3, 3});
      stream.Add(Unicode("betas")).AddFloats(Floats(person->betas.transpose()), {10}).Add("u");
    }
    stream.Add("Neu");
  }
  return joblib_stream::Compressed(stream.Add("u").Finish());
}

/// Tensors of a torch.save archive, added one by one.
class TensorArchive {
 public:
  std::string Tensor(const std::vector<float>& values, const std::vector<int>& shape) {
    const std::string key = std::to_string(storages_.size());
    const int count = static_cast<int>(values.size());
    storages_.push_back({key, RawOf(values), values.size()});
    std::vector<int> stride(shape.size(), 1);
    for (size_t d = shape.size() - 1; d > 0; --d) stride[d - 1] = stride[d] * shape[d];
    return torch_stream::Tensor(torch_stream::StorageId("FloatStorage", key, count, false), 0, shape, stride);
  }
  std::string K(const PersonEstimate& person) {
    std::vector<float> k;
    for (const Camera& camera : person.cameras) {
      for (const float value : Floats(camera.K())) k.push_back(value);
    }
    return Tensor(k, {Count(person), 3, 3});
  }
  [[nodiscard]] std::string Finish(const std::string& object) const { return torch_stream::Archive(object, storages_); }

 private:
  std::vector<torch_stream::RawStorage> storages_;
};

/// body_pose, betas, global_orient and transl of SMPL-X.
inline std::string SmplxParameters(const PersonEstimate& person, TensorArchive* archive) {
  const int n = Count(person);
  return Dict({{Unicode("body_pose"), archive->Tensor(Floats(RowMatrixXd(person.poses.middleCols(3, 63))), {n, 63})},
               {Unicode("betas"), archive->Tensor(BetasOfFrames(person), {n, static_cast<int>(person.betas.size())})},
               {Unicode("global_orient"), archive->Tensor(Floats(RowMatrixXd(person.poses.leftCols(3))), {n, 3})},
               {Unicode("transl"), archive->Tensor(Floats(person.trans), {n, 3})}});
}

/// One person in all frames, pinhole cameras.
inline std::string GvhmrFile(const PersonEstimate& person) {
  TensorArchive archive;
  const std::string global = SmplxParameters(person, &archive), incam = SmplxParameters(person, &archive);
  return archive.Finish(Dict({{Unicode("smpl_params_global"), global},
                              {Unicode("smpl_params_incam"), incam},
                              {Unicode("K_fullimg"), archive.K(person)},
                              {Unicode("net_outputs"), Dict({{Unicode("none"), "N"}})}}));
}

/// The same of GEM-SMPL, with the other entries of its files; the motion in the world is another.
inline std::string GemFile(const PersonEstimate& person) {
  TensorArchive archive;
  PersonEstimate world = person;
  world.trans.array() += 7;
  const std::string global = SmplxParameters(world, &archive), incam = SmplxParameters(person, &archive);
  const std::string segment = Dict({{Unicode("type"), Unicode("video")}, {Unicode("start"), Int(0)}});
  return archive.Finish(
      Dict({{Unicode("body_params_global"), global},
            {Unicode("body_params_incam"), incam},
            {Unicode("net_outputs"), Dict({{Unicode("pred_body_params_incam"), SmplxParameters(world, &archive)}})},
            {Unicode("K_fullimg"), archive.K(person)},
            {Unicode("segment_info"), "](" + segment + "e"}}));
}

/// GEM-X's: `soma` L×231, axis-angle of the Hips and SOMA's 76 other joints.
inline std::string GemXFile(const PersonEstimate& person, const RowMatrixXd& soma) {
  TensorArchive archive;
  const int n = Count(person);
  const auto parameters = [&](const RowMatrixXd& pose) {
    return Dict({{Unicode("global_orient"), archive.Tensor(Floats(RowMatrixXd(pose.leftCols(3))), {n, 3})},
                 {Unicode("body_pose"), archive.Tensor(Floats(RowMatrixXd(pose.rightCols(228))), {n, 228})},
                 {Unicode("transl"), archive.Tensor(Floats(person.trans), {n, 3})},
                 {Unicode("identity_coeffs"), archive.Tensor(std::vector<float>(size_t(45 * n), 0.1F), {n, 45})},
                 {Unicode("scale_params"), archive.Tensor(std::vector<float>(size_t(68 * n), 0.2F), {n, 68})}});
  };
  const std::string global = parameters(0.5 * soma), incam = parameters(soma);
  return archive.Finish(Dict({{Unicode("body_params_global"), global},
                              {Unicode("body_params_incam"), incam},
                              {Unicode("K_fullimg"), archive.K(person)}}));
}

/// SOMA's joints in the places of SMPL's first 22.
inline const std::vector<int>& SomaJoints() {
  static const std::vector<int> joints = {0,
                                          67 /* LeftLeg */,
                                          72 /* RightLeg */,
                                          1 /* Spine1 */,
                                          68 /* LeftShin */,
                                          73 /* RightShin */,
                                          2 /* Spine2 */,
                                          69 /* LeftFoot */,
                                          74 /* RightFoot */,
                                          3 /* Chest */,
                                          70 /* LeftToeBase */,
                                          75 /* RightToeBase */,
                                          4 /* Neck1 */,
                                          11 /* LeftShoulder */,
                                          39 /* RightShoulder */,
                                          6 /* Head */,
                                          12 /* LeftArm */,
                                          40 /* RightArm */,
                                          13 /* LeftForeArm */,
                                          41 /* RightForeArm */,
                                          14 /* LeftHand */,
                                          42 /* RightHand */};
  return joints;
}

/// SMPL's pose on SOMA's joints, others at rest: L×231.
inline RowMatrixXd SomaPose(const PersonEstimate& person) {
  RowMatrixXd soma = RowMatrixXd::Zero(person.poses.rows(), 231);
  for (size_t j = 0; j < SomaJoints().size(); ++j) {
    soma.middleCols(3 * SomaJoints()[j], 3) = person.poses.middleCols(3 * Eigen::Index(j), 3);
  }
  return soma;
}

/// PromptHMR's results of frames loaded at this size, with other entries of them. `as_matrices`: without `pose`.
inline std::string PromptHmrFile(const std::vector<PersonEstimate>& people, int width, int height, float focal_px,
                                 bool as_matrices = false) {
  JoblibStream stream;
  stream.Add("}(" + Unicode("camera") + "}(" + Unicode("pred_cam_R"));
  stream.AddFloats(std::vector<float>(9, 0.5F), {1, 3, 3});
  stream.Add(Unicode("img_focal")).AddFloats({focal_px}, {});
  stream.Add(Unicode("img_center")).AddFloats({0.5F * float(width), 0.5F * float(height)}, {2});
  stream.Add("u" + Unicode("has_slam") + "\x88" + Unicode("masks") + "N" + Unicode("people") + "}(");
  for (const PersonEstimate& person : people) {
    const int n = Count(person);
    RowMatrixXd pose = RowMatrixXd::Zero(n, 165);
    pose.leftCols(66) = person.poses.leftCols(66);
    std::vector<float> matrices;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < 55; ++j) {
        const Eigen::Matrix3d matrix = RotationFromAxisAngle(pose.row(i).segment<3>(3 * j).transpose());
        for (const float value : Floats(matrix)) matrices.push_back(value);
      }
    }
    stream.Add(Int(std::stoi(person.name)) + "}(" + Unicode("track_id") + Int(1) + Unicode("frames"));
    stream.AddInts(FrameIds(person)).Add(Unicode("smplx_cam") + "}(" + Unicode("rotmat"));
    stream.AddFloats(matrices, {n, 55, 3, 3});
    if (!as_matrices) stream.Add(Unicode("pose")).AddFloats(Floats(RowMatrixXd(pose.leftCols(75))), {n, 75});
    stream.Add(Unicode("shape")).AddFloats(BetasOfFrames(person), {n, static_cast<int>(person.betas.size())});
    stream.Add(Unicode("trans")).AddFloats(Floats(person.trans), {n, 3}).Add("u");
    stream.Add(Unicode("smplx_world") + "}(" + Unicode("trans"));
    stream.AddFloats(std::vector<float>(size_t(3 * n), 9.0F), {n, 3}).Add("uu");
  }
  return stream.Add("uu").Finish();
}

/// A person in these frames, with different poses of every joint, about `depth_m` from the camera.
inline PersonEstimate MakePerson(const std::string& name, const std::vector<int>& frames, const Camera& camera,
                                 const Eigen::Vector3d& place) {
  PersonEstimate person;
  person.name = name;
  person.frames = frames;
  const auto n = static_cast<Eigen::Index>(frames.size());
  person.poses.resize(n, 72);
  person.trans.resize(n, 3);
  person.betas = Eigen::VectorXd::LinSpaced(10, -0.5, 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (int c = 0; c < 72; ++c) person.poses(i, c) = 0.3 * std::sin(1.3 * c + static_cast<double>(i));
    person.poses.row(i).head<3>() << 3.0, 0.1, 0.05 * static_cast<double>(i);  // upright in a camera whose y is down
    person.trans.row(i) = (place + 0.01 * static_cast<double>(i) * Eigen::Vector3d(1, 0.5, 2)).transpose();
    person.cameras.push_back(camera);
    if (camera.model != CameraModel::kWeakPerspective) continue;
    person.trans.row(i).setZero();
    person.cameras.back().tx = camera.tx + 0.01 * static_cast<double>(i);
  }
  return person;
}

}  // namespace bodyloom::estimate_files
