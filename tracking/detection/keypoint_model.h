// SPDX-License-Identifier: Apache-2.0
/// ONNX files of people's detectors, told apart by the shapes of what they take and give.
///
///   takes        gives                       is
///   1×3×H×W      1×(5 + 3K)×N                a pose network of YOLOv8 or YOLO11 with K landmarks (keypoint_model.h)
///   1×3×H×W      1×K×rW and 1×K×rH           RTMPose with K landmarks, r = 1 to 4 scores a pixel (keypoint_model.h)
///   1×3×H×W      1×(4 + classes)×N           YOLOv8 or YOLO11, which finds boxes alone
///
/// K is 17 (COCO), 23 or 133 (COCO-WholeBody), 26 or 136 (Halpe); of whole bodies face and hands are left out. Where
/// the file leaves the number of pictures open it is 1, where it leaves rows and columns open they are 640 × 640.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "data_tools/observations/keypoint_conventions.h"
#include "geometry/scene/observations.h"
#include "render/image/image.h"
#include "tracking/detection/inference/graph_executor.h"
#include "tracking/detection/picture_crop.h"

namespace bodyloom {

// What RTMPose says about a person's crop: decoding of its two outputs ("SimCC").
//
// For each of K landmarks the network gives one score a column and one a row of the crop, r to a pixel (r = 2 in all
// published networks): K × r·width and K × r·height numbers. A landmark lies where each is largest, at
// place = (largest column, largest row) / r   in pixels of the crop (TopDownCrop()),
// and its confidence is the smaller of the two largest scores, which is about 1 where the network is sure; where that
// is not positive there is no landmark.
// Source: MMPose, codecs/simcc_label.py and codecs/utils/post_processing.py (get_simcc_maximum).

/// K landmarks in pixels of the image, confidences limited to 1. Throws std::invalid_argument for other numbers of
/// scores.
std::vector<Keypoint> DecodeSimcc(std::span<const float> columns, std::span<const float> rows, int landmarks,
                                  int per_pixel, const PictureCrop& crop);

// What YOLOv8, YOLO11 and their pose networks say about a picture: decoding of their output.
//
// For N places ("anchors") of a letterboxed picture (LetterboxCrop()) the output holds rows × N numbers, each row
// together: x and y of a box's middle, its width and height in pixels of the letterbox; one score a class, 0 to 1;
// then, of a pose network, x, y and visibility (0 to 1) of each landmark. Pose networks know one class, a person; of
// networks with more, class 0 is the person (COCO's order), and an anchor counts when no other class is surer.
// Boxes that overlap a surer one (intersection over union above 0.7) are left out, as are scores below ¼ and all but
// the 300 surest: the defaults of the networks' own program.
// Source: Ultralytics, nn/modules/head.py and utils/ops.py (non_max_suppression).

struct YoloPerson {
  PersonBox box;                 ///< pixels of the image
  std::vector<Keypoint> points;  ///< pixels of the image; confidence is the visibility, 0 where a number is not finite
};

/// The people, surest first. Throws std::invalid_argument for other than (4 + classes + 3 · landmarks) · N numbers.
std::vector<YoloPerson> DecodeYolo(std::span<const float> output, int classes, int landmarks, const PictureCrop& crop);

enum class KeypointFamily { kYoloPose, kRtmPose, kYoloBoxes };

/// Any number of threads may use one at once.
class KeypointModel {
 public:
  /// Reads the file and tries the network out. Throws std::runtime_error in one line: what onnx_reader.h and
  /// graph_executor.h say, or the shapes that were found and those that are known.
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
  GraphExecutor network_;
  KeypointFamily family_ = KeypointFamily::kYoloPose;
  KeypointConvention convention_;
  int width_ = 0, height_ = 0, landmarks_ = 0, classes_ = 1, per_pixel_ = 0;
};

}  // namespace bodyloom
