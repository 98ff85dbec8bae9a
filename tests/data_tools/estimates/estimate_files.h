// SPDX-License-Identifier: Apache-2.0
/// Writes results of WHAM, VIBE, PHALP and GVHMR in their own formats, from people given as numbers.
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

/// One person in all frames, pinhole cameras.
inline std::string GvhmrFile(const PersonEstimate& person) {
  const int n = Count(person);
  std::vector<torch_stream::RawStorage> storages;
  const auto tensor = [&](const std::vector<float>& values, const std::vector<int>& shape) {
    const std::string key = std::to_string(storages.size());
    const int count = static_cast<int>(values.size());
    storages.push_back({key, RawOf(values), values.size()});
    std::vector<int> stride(shape.size(), 1);
    for (size_t d = shape.size() - 1; d > 0; --d) stride[d - 1] = stride[d] * shape[d];
    return torch_stream::Tensor(torch_stream::StorageId("FloatStorage", key, count, false), 0, shape, stride);
  };
  std::vector<float> k;
  for (const Camera& camera : person.cameras) {
    for (const float value : Floats(camera.K())) k.push_back(value);
  }
  const auto parameters = [&] {
    return Dict({{Unicode("body_pose"), tensor(Floats(RowMatrixXd(person.poses.middleCols(3, 63))), {n, 63})},
                 {Unicode("betas"), tensor(BetasOfFrames(person), {n, static_cast<int>(person.betas.size())})},
                 {Unicode("global_orient"), tensor(Floats(RowMatrixXd(person.poses.leftCols(3))), {n, 3})},
                 {Unicode("transl"), tensor(Floats(person.trans), {n, 3})}});
  };
  const std::string object = Dict({{Unicode("smpl_params_global"), parameters()},
                                   {Unicode("smpl_params_incam"), parameters()},
                                   {Unicode("K_fullimg"), tensor(k, {n, 3, 3})},
                                   {Unicode("net_outputs"), Dict({{Unicode("none"), "N"}})}});
  return torch_stream::Archive(object, storages);
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
