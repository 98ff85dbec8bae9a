// SPDX-License-Identifier: Apache-2.0
#include "data_tools/estimates/load_estimate.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "data_tools/body/body_landmarks.h"
#include "data_tools/estimates/estimate_arrays.h"
#include "data_tools/estimates/estimate_readers.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/inflate.h"
#include "data_tools/formats/json_reader.h"
#include "data_tools/formats/npz.h"
#include "data_tools/formats/pickle.h"
#include "data_tools/formats/printable.h"
#include "data_tools/formats/torch_weights.h"
#include "data_tools/formats/zip.h"
#include "data_tools/motion/amass.h"
#include "data_tools/motion/track_io.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr const char* kExpectedEstimate =
    "expected a track .npz, wham_output.pkl, vibe_output.pkl, PHALP's or 4D-Humans' results .pkl, PromptHMR's "
    "results.pkl, GVHMR's hmr4d_results.pt, GEM's smpl_params.pt or hpe_results.pt, SAM 3D Body's .npz or .json, or "
    "SAM3DBody-cpp's .csv";

bool IsTorchArchive(std::string_view bytes) {
  return LooksLikeZip(bytes) && bytes.find("/data.pkl") != std::string_view::npos;
}

bool LooksLikePickle(std::string_view bytes) {
  return LooksLikeZlib(bytes) || LooksLikeGzip(bytes) ||
         (bytes.size() > 2 && bytes[0] == '\x80' && bytes[1] >= 2 && bytes[1] <= 5);
}

bool LooksLikeJson(std::string_view bytes) {
  const size_t first = WithoutByteOrderMark(bytes).find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && std::string_view("{[").find(WithoutByteOrderMark(bytes)[first]) < 2;
}

}  // namespace

BodyEstimate EstimateFromBytes(const std::string& bytes, const std::string& where, const LoadEstimateOptions& options) {
  const int width = options.image_width, height = options.image_height;
  BODYLOOM_CHECK(width >= 0 && height >= 0, "image size ", width, "x", height, " must not be negative");
  if (bytes.empty()) ThrowFileError(where, std::string("the file is empty; ") + kExpectedEstimate);
  if (IsTorchArchive(bytes)) {
    const WeightsFile file = TorchWeightsFromBytes(bytes, where);
    if (IsGvhmr(file)) return GvhmrFromTensors(file, where);
    if (IsGem(file)) return GemFromTensors(file, where);
    ThrowFileError(where, std::string("a file of torch.save without 'smpl_params_incam' or 'body_params_incam'; ") +
                              kExpectedEstimate);
  }
  if (LooksLikeZip(bytes)) {
    const NpzArrays arrays = ReadNpzBytes(bytes, where);
    if (IsSam3dBody(arrays)) return Sam3dBodyFromNpz(arrays, where, width, height);
    if (!IsAmass(arrays))
      ThrowFileError(where, std::string("an .npz without 'poses' and 'trans'; ") + kExpectedEstimate);
    if (arrays.count("K") == 0 && arrays.count("camera") == 0) {
      ThrowFileError(where, std::string("poses in a world frame, expected the camera's; ") + kExpectedEstimate);
    }
    return EstimateFromTrack(TrackFromArrays(arrays, where), where);
  }
  if (IsSam3dBodyCsv(bytes)) return Sam3dBodyFromCsv(bytes, where);
  if (LooksLikeJson(bytes)) {
    const nlohmann::json json = ParseJson(bytes, where);
    const JsonNode document(json, where);
    if (IsSam3dBody(document)) return Sam3dBodyFromJson(document, width, height);
    ThrowFileError(where, std::string("JSON without 'pred_keypoints_3d' and 'pred_cam_t'; ") + kExpectedEstimate);
  }
  if (!LooksLikePickle(bytes)) ThrowFileError(where, std::string("unknown kind of file; ") + kExpectedEstimate);
  const PicklePtr file = ReadPickle(bytes, where);
  if (IsVibe(*file)) return VibeFromPickle(*file, where, width, height);
  if (IsWham(*file)) return WhamFromPickle(*file, where, width, height);
  if (IsPromptHmr(*file)) return PromptHmrFromPickle(*file, where, width, height);
  if (IsPhalp(*file)) return PhalpFromPickle(*file, where, width, height);
  ThrowFileError(where, std::string(file->kind == PickleValue::Kind::kDict && file->dict.empty()
                                        ? "a pickle of an empty dictionary: nobody was found; "
                                        : "a pickle that holds no known poses; ") +
                            kExpectedEstimate);
}

BodyEstimate LoadEstimate(const std::string& path, const LoadEstimateOptions& options) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    return ReadSam3dBodyFolder(path, options.image_width, options.image_height);
  return EstimateFromBytes(ReadFileBytes(path), path, options);
}

BodyEstimate EstimateFromTrack(const Track& track, const std::string& where) {
  constexpr Eigen::Index kSmpl = 72, kBody = 66;
  const Motion& motion = track.motion;
  const Eigen::Index columns = motion.poses.cols();
  if (columns != kSmpl && columns != 156 && columns != 162 && columns != 165) {
    ThrowFileError(where, "poses",
                   Concatenate(columns, " columns, expected 72 (SMPL), 156 (SMPL-H), 162 or 165 (SMPL-X)"));
  }
  BodyEstimate estimate;
  estimate.system = "track";
  estimate.body = motion.body;
  estimate.rest_pelvis = MeanPelvis(motion.body == "smplx" ? "smplx" : "smpl");
  estimate.num_frames = motion.num_frames();
  PersonEstimate& person = estimate.people.emplace_back();
  person.name = "0";
  person.betas = motion.betas;
  for (int t = 0; t < motion.num_frames(); ++t) {
    if (track.HasResult(t)) person.frames.push_back(t);
  }
  const auto n = static_cast<Eigen::Index>(person.frames.size());
  person.poses.setZero(n, kSmpl);
  person.trans.resize(n, 3);
  const Eigen::Index kept = columns == kSmpl ? kSmpl : kBody;
  for (Eigen::Index i = 0; i < n; ++i) {
    const int t = person.frames[static_cast<size_t>(i)];
    person.poses.row(i).head(kept) = motion.poses.row(t).head(kept);
    person.trans.row(i) = motion.trans.row(t);
    person.cameras.push_back(track.CameraAt(t));
    const bool has_joints = t < static_cast<int>(track.joints.size()) && track.joints[t].rows() > 0;
    if (i == 0 && has_joints && track.joints[t].row(0).allFinite()) {
      estimate.rest_pelvis = (track.joints[t].row(0) - motion.trans.row(t)).transpose();
    }
  }
  SortEstimate(where, &estimate);
  return estimate;
}

}  // namespace bodyloom
