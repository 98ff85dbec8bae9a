// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/estimates/load_estimate.h"

#include <filesystem>

#include "bodyloom/data_tools/estimates/gvhmr_reader.h"
#include "bodyloom/data_tools/estimates/phalp_reader.h"
#include "bodyloom/data_tools/estimates/sam3d_body_reader.h"
#include "bodyloom/data_tools/estimates/track_estimate.h"
#include "bodyloom/data_tools/estimates/vibe_reader.h"
#include "bodyloom/data_tools/estimates/wham_reader.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/formats/inflate.h"
#include "bodyloom/data_tools/formats/npz.h"
#include "bodyloom/data_tools/formats/pickle.h"
#include "bodyloom/data_tools/formats/torch_weights.h"
#include "bodyloom/data_tools/formats/zip.h"
#include "bodyloom/data_tools/motion/amass.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/refuse.h"

namespace bodyloom {
namespace {

constexpr const char* kExpectedEstimate =
    "expected a track .npz, wham_output.pkl, vibe_output.pkl, PHALP's or 4D-Humans' results .pkl, GVHMR's "
    "hmr4d_results.pt, or SAM 3D Body's .npz";

bool IsTorchArchive(std::string_view bytes) {
  return LooksLikeZip(bytes) && bytes.find("/data.pkl") != std::string_view::npos;
}

bool LooksLikePickle(std::string_view bytes) {
  return LooksLikeZlib(bytes) || LooksLikeGzip(bytes) ||
         (bytes.size() > 2 && bytes[0] == '\x80' && bytes[1] >= 2 && bytes[1] <= 5);
}

}  // namespace

BodyEstimate EstimateFromBytes(const std::string& bytes, const std::string& where, const LoadEstimateOptions& options) {
  const int width = options.image_width, height = options.image_height;
  BODYLOOM_CHECK(width >= 0 && height >= 0, "image size ", width, "x", height, " must not be negative");
  if (bytes.empty()) Refuse(where, std::string("the file is empty; ") + kExpectedEstimate);
  if (IsTorchArchive(bytes)) {
    const WeightsFile file = TorchWeightsFromBytes(bytes, where);
    if (IsGvhmr(file)) return GvhmrFromTensors(file, where);
    Refuse(where, std::string("a file of torch.save without 'smpl_params_incam'; ") + kExpectedEstimate);
  }
  if (LooksLikeZip(bytes)) {
    const NpzArrays arrays = ReadNpzBytes(bytes, where);
    if (IsSam3dBody(arrays)) return Sam3dBodyFromNpz(arrays, where);
    if (!IsAmass(arrays)) Refuse(where, std::string("an .npz without 'poses' and 'trans'; ") + kExpectedEstimate);
    if (arrays.count("K") == 0 && arrays.count("camera") == 0) {
      Refuse(where, std::string("poses in a world frame, expected the camera's; ") + kExpectedEstimate);
    }
    return EstimateFromTrack(TrackFromArrays(arrays, where), where);
  }
  if (!LooksLikePickle(bytes)) Refuse(where, std::string("unknown kind of file; ") + kExpectedEstimate);
  const PicklePtr file = ReadPickle(bytes, where);
  if (IsVibe(*file)) return VibeFromPickle(*file, where, width, height);
  if (IsWham(*file)) return WhamFromPickle(*file, where, width, height);
  if (IsPhalp(*file)) return PhalpFromPickle(*file, where, width, height);
  Refuse(where, std::string(file->kind == PickleValue::Kind::kDict && file->dict.empty()
                                ? "a pickle of an empty dictionary: nobody was found; "
                                : "a pickle that holds no known poses; ") +
                    kExpectedEstimate);
}

BodyEstimate LoadEstimate(const std::string& path, const LoadEstimateOptions& options) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return ReadSam3dBodyFolder(path);
  return EstimateFromBytes(ReadFileBytes(path), path, options);
}

}  // namespace bodyloom
