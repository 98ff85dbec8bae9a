// SPDX-License-Identifier: Apache-2.0
/// ONNX files of people's detectors, told apart by the shapes of what they take and give.
///
///   takes        gives                       is
///   1×3×H×W      1×(5 + 3K)×N                a pose network of YOLOv8 or YOLO11 with K landmarks (yolo_people.h)
///   1×3×H×W      1×K×rW and 1×K×rH           RTMPose with K landmarks, r = 1 to 4 scores a pixel (simcc_landmarks.h)
///   1×3×H×W      1×(4 + classes)×N           YOLOv8 or YOLO11, which finds boxes alone
///
/// K is 17 (COCO), 23 or 133 (COCO-WholeBody), 26 or 136 (Halpe); of whole bodies face and hands are left out. Where the
/// file leaves the number of pictures open it is 1, where it leaves rows and columns open they are 640 × 640.
#pragma once

#include <string>
#include <vector>

#include "bodyloom/data_tools/detection/onnx_network.h"
#include "bodyloom/data_tools/detection/simcc_landmarks.h"
#include "bodyloom/data_tools/detection/yolo_people.h"
#include "bodyloom/data_tools/observations/keypoint_conventions.h"
#include "bodyloom/render/image.h"

namespace bodyloom {

enum class KeypointFamily { kYoloPose, kRtmPose, kYoloBoxes };

/// Any number of threads may use one at once.
class KeypointModel {
 public:
  /// Reads the file and tries the network out. Throws std::runtime_error in one line: what onnx_model.h and
  /// onnx_network.h say, or the shapes that were found and those that are known.
  explicit KeypointModel(const std::string& path);

  [[nodiscard]] KeypointFamily family() const { return family_; }
  /// Of its landmarks; without names for boxes.
  [[nodiscard]] const KeypointConvention& convention() const { return convention_; }
  [[nodiscard]] const std::string& path() const { return path_; }

  /// Everybody in the picture, surest first, by a network that finds people: not RTMPose.
  [[nodiscard]] std::vector<YoloPerson> FindPeople(const Image& image) const;
  /// The landmarks of the person in a box, by RTMPose.
  [[nodiscard]] std::vector<Keypoint> PoseIn(const Image& image, const PersonBox& box) const;

 private:
  std::string path_;
  OnnxNetwork network_;
  KeypointFamily family_ = KeypointFamily::kYoloPose;
  KeypointConvention convention_;
  int width_ = 0, height_ = 0, landmarks_ = 0, classes_ = 1, per_pixel_ = 0;
};

}  // namespace bodyloom
