// SPDX-License-Identifier: Apache-2.0
/// Where the pose detector's networks lie: BlazePose of MediaPipe, four .tflite files of the npm package
/// @mediapipe/pose (cmake/models.txt: version, checksums, licence). They are no part of this project; `./dev models`
/// fetches them.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

/// Finds people: 1×224×224×3 in [−1, 1]. The package calls it assets; the whole file is the .tflite.
inline constexpr const char* kPoseDetectorFile = "pose_solution_packed_assets.data";
/// Find a person's landmarks: 1×256×256×3 in [0, 1].
inline constexpr const char* kPoseLandmarkLiteFile = "pose_landmark_lite.tflite";
inline constexpr const char* kPoseLandmarkFullFile = "pose_landmark_full.tflite";
inline constexpr const char* kPoseLandmarkHeavyFile = "pose_landmark_heavy.tflite";

/// The folders in which a program looks, in this order. `folder` is the user's own choice and `variable` the value of
/// the environment's BODYLOOM_MODELS: where one is given (not empty), the first of them alone counts. Otherwise, for
/// the program at the path `program`: ../share/bodyloom/models from its folder (installed), and ../../models when its
/// folder lies in that of a build (build/PRESET/apps → build/models).
std::vector<std::string> ModelFolders(const std::string& folder, const std::string& variable,
                                      const std::string& program);

/// Path of a model's file in the first of ModelFolders() that has it, for this process and its environment. Throws
/// std::runtime_error in one line with the file, where it was looked for, and what to do.
std::string FindModelFile(const std::string& file, const std::string& folder = "");

}  // namespace bodyloom
