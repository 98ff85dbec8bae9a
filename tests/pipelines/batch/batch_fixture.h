// SPDX-License-Identifier: Apache-2.0
/// Small clips with true joints for tests of batches.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "data_tools/formats/atomic_file.h"
#include "pipelines/batch/batch_clip.h"
#include "pipelines/synthesis/synthesize_clip.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_files.h"

namespace bodyloom {

/// Joints and camera of six frames of the demo's walk, with noise of this seed.
inline SynthClipFiles TinyClip(const ScratchFolder& folder, int seed) {
  SynthesizeClipRequest request;
  request.motion = {.name = "demo", .fps = 15, .num_frames = 6};
  request.out = folder / ("clip" + std::to_string(seed));
  request.clip.dense_per_frame = 0;
  request.clip.seed = static_cast<uint64_t>(seed);
  return SynthesizeClip(request).files;
}

inline BatchClip BatchClipOf(const std::string& id, const SynthClipFiles& files) {
  BatchClip clip;
  clip.id = id;
  TrackRequest request;
  request.detections = files.observations;
  request.cameras = files.camera;
  request.solve.num_threads = 1;
  clip.request = request;
  clip.settings = {{"detections", files.observations}, {"cameras", files.camera}};
  return clip;
}

/// A readable clip without a person: joints without confidence.
inline BatchClip EmptyClip(const std::string& id, const ScratchFolder& folder) {
  std::string joints;
  for (int k = 0; k < 17; ++k) joints += std::string(k > 0 ? "," : "") + "0,0,0";
  BatchClip clip;
  clip.id = id;
  TrackRequest request;
  request.detections = folder / (id + ".json");
  request.image_width = 320;
  request.image_height = 240;
  WriteFileAtomically(request.detections,
                      R"([{"image_id":0,"category_id":1,"keypoints":[)" + joints + R"(],"score":0.9}])");
  clip.request = request;
  clip.settings = {{"detections", request.detections}, {"image-size", "320x240"}};
  return clip;
}

/// Bytes of every file below the folder by relative path, except files with times and memory: reports, records and the
/// table.
inline std::map<std::string, std::string> ResultBytes(const std::string& folder) {
  std::map<std::string, std::string> bytes;
  for (const std::string& file : FilesBelow(folder)) {
    if (!file.ends_with(".json") && !file.ends_with(".csv")) {
      bytes[std::filesystem::path(file).lexically_relative(folder).string()] = FileBytes(file);
    }
  }
  return bytes;
}

}  // namespace bodyloom
