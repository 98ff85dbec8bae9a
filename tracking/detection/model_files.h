// SPDX-License-Identifier: Apache-2.0
/// Locates the detector's networks: BlazePose, hands' and faces' landmarks of MediaPipe, .tflite files of the npm
/// package @mediapipe/holistic (cmake/models.txt: version, checksums, licence). They are not part of this project;
/// `./dev models` fetches them.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

/// Person detector: input 1×224×224×3 in [−1, 1]. The package calls it assets; the whole file is the .tflite.
inline constexpr const char* kPoseDetectorFile = "pose_solution_packed_assets.data";
/// Landmark networks of three sizes: input 1×256×256×3 in [0, 1].
inline constexpr const char* kPoseLandmarkLiteFile = "pose_landmark_lite.tflite";
inline constexpr const char* kPoseLandmarkFullFile = "pose_landmark_full.tflite";
inline constexpr const char* kPoseLandmarkHeavyFile = "pose_landmark_heavy.tflite";
/// Narrows a hand's region: input 1×256×256×3 in [0, 1].
inline constexpr const char* kHandRegionFile = "hand_recrop.tflite";
/// 21 landmarks of a hand: input 1×224×224×3 in [0, 1].
inline constexpr const char* kHandLandmarkFile = "hand_landmark_full.tflite";
/// 468 landmarks of a face: input 1×192×192×3 in [0, 1].
inline constexpr const char* kFaceLandmarkFile = "face_landmark.tflite";

/// The folders that are searched, in this order. `folder` is the user's choice and `variable` the value of the
/// environment's BODYLOOM_MODELS: the first of the two that is not empty is the only folder. Otherwise, for the program
/// at the path `program`: ../share/bodyloom/models from its folder (installed), and ../../models when its folder lies
/// in that of a build (build/PRESET/apps → build/models). Last comes models/ beside the shared library `module` that
/// this code is part of, a Python module in a wheel; there is none where it is empty.
std::vector<std::string> ModelFolders(const std::string& folder, const std::string& variable,
                                      const std::string& program, const std::string& module = "");

/// Path of a model's file in the first of ModelFolders() that has it, for this process and its environment. Throws
/// std::runtime_error in one line with the file, the folders searched, and a remedy.
std::string FindModelFile(const std::string& file, const std::string& folder = "");

}  // namespace bodyloom
