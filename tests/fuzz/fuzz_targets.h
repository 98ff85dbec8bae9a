// SPDX-License-Identifier: Apache-2.0
/// Fuzz targets for every reader of untrusted binary files and meshes, on bytes (text: fuzz_text_targets.h). A reader
/// may only fail with std::runtime_error; accepted data must be consistent.
///
/// The same functions run under libFuzzer (tests/fuzz/fuzz_main.cc, clang) and under GoogleTest with fixed mutations
/// (tests/data_tools/fuzz/fuzz_corpus_test.cc, any compiler). Each returns true if the input was accepted.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>

#include "data_tools/body/body_compact.h"
#include "data_tools/body/body_smpl.h"
#include "data_tools/formats/npz.h"
#include "data_tools/formats/obj.h"
#include "data_tools/formats/pickle.h"
#include "data_tools/formats/weights_file.h"
#include "data_tools/motion/track_io.h"
#include "tests/fuzz/fuzz_accepts.h"

namespace bodyloom::fuzz {

/// Every key the readers look for.
inline constexpr const char* kNames[] = {"v_template",
                                         "f",
                                         "weights",
                                         "kintree_table",
                                         "J_regressor",
                                         "shapedirs",
                                         "posedirs",
                                         "hands_meanl",
                                         "hands_meanr",
                                         "vt",
                                         "ft",
                                         "part",
                                         "iu_uv",
                                         "landmark_names",
                                         "landmark_indptr",
                                         "landmark_indices",
                                         "landmark_weights",
                                         "format",
                                         "name",
                                         "joint_names",
                                         "parents",
                                         "pose_mean",
                                         "grid",
                                         "lag",
                                         "faces",
                                         "posedirs_count",
                                         "posedirs_joint",
                                         "posedirs_block",
                                         "weights_count",
                                         "weights_column",
                                         "weights_weight",
                                         "regressor_count",
                                         "regressor_column",
                                         "regressor_weight",
                                         "landmark_count",
                                         "landmark_column",
                                         "landmark_weight",
                                         "vt_iuv",
                                         "face_iuv",
                                         "face_part",
                                         "poses",
                                         "trans",
                                         "betas",
                                         "mocap_framerate",
                                         "mocap_frame_rate",
                                         "body",
                                         "timestamps",
                                         "frame_status",
                                         "joints",
                                         "coco17",
                                         "joint_sigma",
                                         "camera_model",
                                         "camera_from_scene",
                                         "K",
                                         "distortion",
                                         "image_size",
                                         "camera",
                                         "cage_v",
                                         "keypoints",
                                         "keypoint_names",
                                         "keypoint_convention",
                                         "dense_frame",
                                         "dense_face",
                                         "dense_barycentric",
                                         "dense_pixel",
                                         "dense_sigma_px",
                                         "dense_uv_sigma",
                                         "dense_pixel_sigma_px",
                                         "labels",
                                         "log_weights",
                                         "means",
                                         "covariance_upper",
                                         "arm_log_density",
                                         "leg_log_density",
                                         "input",
                                         "input_bias",
                                         "dilations",
                                         "block0.norm_scale",
                                         "block0.norm_shift",
                                         "block0.dilated",
                                         "block0.dilated_bias",
                                         "block0.mix",
                                         "block0.mix_bias",
                                         "norm_scale",
                                         "norm_shift",
                                         "output",
                                         "output_bias",
                                         "recipe",
                                         "cage_shape",
                                         "weight_count",
                                         "weight_joint",
                                         "weight",
                                         "regressor_vertex",
                                         "corrective_count",
                                         "corrective_joint",
                                         "corrective_block",
                                         "landmark_vertex",
                                         "chart_names",
                                         "chart_count",
                                         "chart_uv",
                                         "atlas_from_chart",
                                         "version",
                                         "body_size",
                                         "parameters",
                                         "is_loose",
                                         "kinds",
                                         "garment_cut",
                                         "garment_offsets",
                                         "garment_nodes",
                                         "anchor_face",
                                         "anchor_barycentric",
                                         "anchor_factor",
                                         "light",
                                         "adam_first",
                                         "adam_second",
                                         "adam_steps",
                                         "light_first",
                                         "light_second",
                                         "light_steps",
                                         "pull",
                                         "step",
                                         "seconds",
                                         "options",
                                         "smpl_params_incam.body_pose",
                                         "smpl_params_incam.global_orient",
                                         "smpl_params_incam.transl",
                                         "smpl_params_incam.betas",
                                         "K_fullimg",
                                         "enter",
                                         "enter_bias",
                                         "first",
                                         "first_bias",
                                         "down1",
                                         "down1_bias",
                                         "second",
                                         "second_bias",
                                         "down2",
                                         "down2_bias",
                                         "third",
                                         "third_bias",
                                         "down3",
                                         "down3_bias",
                                         "fourth",
                                         "fourth_bias",
                                         "up2",
                                         "up2_bias",
                                         "merge2",
                                         "merge2_bias",
                                         "up1",
                                         "up1_bias",
                                         "merge1",
                                         "merge1_bias",
                                         "up0",
                                         "up0_bias",
                                         "merge0",
                                         "merge0_bias",
                                         "leave",
                                         "leave_bias",
                                         "pixels_per_metre",
                                         "moves_outline",
                                         "label_kind",
                                         "mask_runs",
                                         "mask_count",
                                         "mask_box",
                                         "body_params_incam.body_pose",
                                         "body_params_incam.global_orient",
                                         "body_params_incam.transl"};

/// Parses named arrays without an archive, whose checksums no mutation passes: repeated (index of a known name, 3 bytes
/// of length, .npy bytes).
inline NpzArrays FramedArrays(const std::string& bytes) {
  NpzArrays arrays;
  size_t at = 0;
  while (at + 4 <= bytes.size()) {
    const auto byte = [&](size_t i) { return static_cast<size_t>(static_cast<unsigned char>(bytes[at + i])); };
    const char* name = kNames[byte(0) % std::size(kNames)];
    const size_t length = std::min(byte(1) | byte(2) << 8 | byte(3) << 16, bytes.size() - at - 4);
    Accepts([&] { arrays[name] = ReadNpyBytes(bytes.substr(at + 4, length), "fuzz.npy"); });
    at += 4 + length;
  }
  return arrays;
}

/// Inverse of FramedArrays(), for seeds; arrays of other names are left out.
inline std::string FrameArrays(const NpzArrays& arrays) {
  std::string framed;
  for (size_t i = 0; i < std::size(kNames); ++i) {
    const auto it = arrays.find(kNames[i]);
    if (it == arrays.end()) continue;
    const std::string npy = NpyBytes(it->second);
    framed += {static_cast<char>(i), static_cast<char>(npy.size()), static_cast<char>(npy.size() >> 8),
               static_cast<char>(npy.size() >> 16)};
    framed += npy;
  }
  return framed;
}

inline bool AcceptsNpz(const std::string& bytes) {
  const bool npy = Accepts([&] { ReadNpyBytes(bytes, "fuzz.npy"); });
  const bool npz = Accepts([&] {
    for (const auto& [name, array] : ReadNpzBytes(bytes, "fuzz.npz")) {
      if (array.dtype == DType::kOther) continue;
      const size_t n = array.is_text() ? array.ToStrings().size() : array.ToDoubles().size();
      if (n != static_cast<size_t>(array.num_elements())) {
        throw std::logic_error("an array of another size than its shape");
      }
    }
  });
  return npy || npz;
}

inline bool AcceptsPickle(const std::string& bytes) {
  return Accepts([&] { ReadPickle(bytes, "fuzz.pkl"); });
}

inline void CheckWeights(const WeightsFile& file) {
  for (const auto& [name, tensor] : file.tensors) {
    if (tensor.bytes.size() != static_cast<size_t>(tensor.num_elements()) * tensor.item_size) {
      throw std::logic_error("a tensor of another size than its shape");
    }
  }
}

inline bool AcceptsWeights(const std::string& bytes) {
  return Accepts([&] { CheckWeights(WeightsFromBytes(bytes, "fuzz.pth", {.widen_halves = true})); });
}

/// Constructs the model; BodyModel's exceptions are part of LoadBody's contract.
inline void CheckBody(BodyModelData data) {
  try {
    const BodyModel body(std::move(data));
    if (body.joint_template().rows() != body.num_joints()) throw std::logic_error("joints of another number");
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(std::string("fuzz: ") + error.what());
  }
}

inline bool AcceptsBody(const std::string& bytes) {
  if (Accepts([&] { LoadBodyBytes(bytes, "fuzz.pkl"); })) return true;
  const NpzArrays arrays = FramedArrays(bytes);
  return Accepts([&] {
    CheckBody(IsCompactBody(arrays) ? BodyFromCompact(arrays, "fuzz.npz", {})
                                    : BodyFromArrays(NamedArrays(arrays, "fuzz.npz"), {}));
  });
}

inline bool AcceptsTrack(const std::string& bytes) {
  if (Accepts([&] { ReadTrackBytes(bytes, "fuzz.npz", MovingCamera::kTake); })) return true;
  return Accepts([&] {
    const Track track = TrackFromArrays(FramedArrays(bytes), "fuzz.npz");
    if (static_cast<int>(track.frame_status.size()) != track.num_frames()) throw std::logic_error("frames disagree");
  });
}

inline bool AcceptsObj(const std::string& bytes) {
  return Accepts([&] {
    const ObjMesh mesh = ReadObjBytes(bytes, "fuzz.obj");
    for (const int v : mesh.corner_position) {
      if (v < 0 || v >= mesh.positions.rows()) throw std::logic_error("a corner outside the mesh");
    }
    for (const int u : mesh.corner_uv) {
      if (u < -1 || u >= mesh.uv.rows()) throw std::logic_error("a UV corner outside the mesh");
    }
  });
}

}  // namespace bodyloom::fuzz
