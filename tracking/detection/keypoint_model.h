// SPDX-License-Identifier: Apache-2.0
/// Runs person detectors and pose networks from ONNX files. The shapes of input and outputs identify the kind:
///
///   input        outputs                     network
///   1×3×H×W      1×(5 + 3K)×N                a pose network of YOLOv8 or YOLO11 with K landmarks (DecodeYolo())
///   1×3×H×W      1×K×rW and 1×K×rH           RTMPose with K landmarks, r = 1 to 4 scores a pixel (DecodeSimcc())
///   1×3×H×W      1×(4 + classes)×N           YOLOv8 or YOLO11 that finds boxes only
///
/// K is 17 (COCO), 23 or 133 (COCO-WholeBody), 26 or 136 (Halpe); face and hands of whole bodies are dropped. A dynamic
/// batch size is taken as 1, dynamic rows and columns as 640 × 640.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "data_tools/observations/keypoint_conventions.h"
#include "geometry/scene/observations.h"
#include "render/image/image.h"
#include "tracking/detection/image_crop.h"
#include "tracking/detection/inference/graph_executor.h"

namespace bodyloom {

// Decoding of RTMPose's two outputs ("SimCC") for a person's crop.
//
// For each of K landmarks the network gives r scores for each pixel column and r for each pixel row of the crop (r = 2
// in all published networks): K × r·width and K × r·height numbers. A landmark lies at the two maxima,
//   position = (largest column, largest row) / r   in pixels of the crop (TopDownCrop()),
// and its confidence is the smaller of the two maxima, about 1 for a clear detection; where that is not positive there
// is no landmark.
// Source: MMPose, codecs/simcc_label.py and codecs/utils/post_processing.py (get_simcc_maximum).

/// Decodes K landmarks in pixels of the image, confidences limited to 1. Throws std::invalid_argument for other numbers
/// of scores.
std::vector<Keypoint> DecodeSimcc(std::span<const float> columns, std::span<const float> rows, int landmarks,
                                  int per_pixel, const ImageCrop& crop);

// Decoding of the output of YOLOv8, YOLO11 and their pose networks for an image.
//
// For N positions ("anchors") of a letterboxed image (LetterboxCrop()) the output holds rows × N numbers, row-major:
// x and y of a box's centre, its width and height in pixels of the letterbox; one score a class, 0 to 1; then, for a
// pose network, x, y and visibility (0 to 1) of each landmark. Pose networks have one class, person; in networks with
// more, class 0 is the person (COCO's order), and an anchor counts when no other class has a higher score.
// Boxes that overlap one of higher score (intersection over union above 0.7) are dropped, as are scores below ¼ and all
// but the 300 highest: the defaults of the networks' own program.
// Source: Ultralytics, nn/modules/head.py and utils/ops.py (non_max_suppression).

struct YoloPerson {
  PersonBox box;                 ///< pixels of the image
  std::vector<Keypoint> points;  ///< pixels of the image; confidence is the visibility, 0 where a number is not finite
};

/// Decodes the people, highest score first. Throws std::invalid_argument for other than (4 + classes + 3 · landmarks) ·
/// N numbers.
std::vector<YoloPerson> DecodeYolo(std::span<const float> output, int classes, int landmarks, const ImageCrop& crop);

enum class KeypointFamily { kYoloPose, kRtmPose, kYoloBoxes };

/// Any number of threads may use one at once.
class KeypointModel {
 public:
  /// Reads the file and runs the network once. Throws std::runtime_error in one line: the errors of onnx_reader.h and
  /// graph_executor.h, or the shapes that were found and those that are known.
  explicit KeypointModel(const std::string& path);

  [[nodiscard]] KeypointFamily family() const { return family_; }
  /// Convention of its landmarks; without names for boxes.
  [[nodiscard]] const KeypointConvention& convention() const { return convention_; }
  [[nodiscard]] const std::string& path() const { return path_; }

  /// Everybody in the image, highest score first. Not for RTMPose.
  [[nodiscard]] std::vector<YoloPerson> FindPeople(const Image& image) const;
  /// The landmarks of the person in a box. For RTMPose only.
  [[nodiscard]] std::vector<Keypoint> PoseIn(const Image& image, const PersonBox& box) const;

 private:
  std::string path_;
  GraphExecutor network_;
  KeypointFamily family_ = KeypointFamily::kYoloPose;
  KeypointConvention convention_;
  int width_ = 0, height_ = 0, landmarks_ = 0, classes_ = 1, per_pixel_ = 0;
};

}  // namespace bodyloom
