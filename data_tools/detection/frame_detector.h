// SPDX-License-Identifier: Apache-2.0
/// Frames of a clip to people with landmarks, whichever networks do it.
///
///   BlazePose (people_detector.h)      follows people from frame to frame; 33 landmarks and a mask
///   YOLO-pose (keypoint_model.h)       sees everybody in a frame at once
///   RTMPose (keypoint_model.h)         sees one person in a box; boxes are those of a YOLO, where one is given, else the
///                                      rectangle around BlazePose's landmarks (VisibleRectangle())
/// Results do not depend on the number of threads. A landmark's confidence is what the network says of its visibility.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bodyloom/data_tools/detection/people_detector.h"
#include "bodyloom/data_tools/observations/people.h"
#include "bodyloom/geometry/observations.h"
#include "bodyloom/render/image.h"

namespace bodyloom {

struct FrameDetectorOptions {
  std::string models;               ///< folder of BlazePose's networks; empty: where they are installed (model_files.h)
  PeopleDetectorOptions blazepose;  ///< max_people and num_threads count for the others too
  std::string pose_model;           ///< an ONNX file in place of BlazePose; empty: BlazePose
  std::string box_model;            ///< an ONNX file that finds people for RTMPose; empty: BlazePose does
};

struct FramePerson {
  DetectedPerson person;  ///< identity −1
  LabelImage mask;        ///< PeopleDetectorOptions::masks; empty when it was not asked for
};

class FrameDetector {
 public:
  static constexpr int kFramesAtOnce = PeopleDetector::kFramesAtOnce;

  virtual ~FrameDetector() = default;
  /// Of the people's landmarks.
  [[nodiscard]] virtual const KeypointConvention& convention() const = 0;
  /// The next frames of the clip, all of one size: a group of 1 to kFramesAtOnce. Returns the people of each.
  virtual std::vector<std::vector<FramePerson>> Detect(std::span<const Image> frames) = 0;
  [[nodiscard]] virtual PeopleDetectorSummary summary() const = 0;
};

/// Throws std::runtime_error naming a file that is missing, no such network or no use here, std::invalid_argument for
/// options that are not valid, for masks with `pose_model`, and for a `box_model` that no network needs.
std::unique_ptr<FrameDetector> MakeFrameDetector(const FrameDetectorOptions& options);

/// "heavy", or the name of the ONNX file without its folder.
std::string FrameDetectorName(const FrameDetectorOptions& options);

}  // namespace bodyloom
