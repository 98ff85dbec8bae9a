// SPDX-License-Identifier: Apache-2.0
/// Frames of a clip to people with landmarks, whichever networks do it.
///
///   BlazePose (people_detector.h)      follows people from frame to frame; 33 landmarks and a mask
///   YOLO-pose (keypoint_model.h)       sees everybody in a frame at once
///   RTMPose (keypoint_model.h)         sees one person in a box; boxes are those of a YOLO, where one is given, else
///   the
///                                      rectangle around BlazePose's landmarks (VisibleRectangle())
/// Results do not depend on the number of threads. A landmark's confidence is what the network says of its visibility.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "data_tools/observations/people.h"
#include "geometry/scene/observations.h"
#include "render/image/image.h"
#include "tracking/detection/people_detector.h"
#include "tracking/detection/pose_landmarks.h"

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

// How far a landmark of BlazePose may be trusted, as the confidence in [0, 1] that the tracker turns into a standard
// deviation.

/// The landmark's visibility, within [0, 1]; 0 when a coordinate is not finite.
double LandmarkConfidence(const PoseLandmark& landmark);

// Where a person is in a picture, by the person's landmarks.

struct ImageRectangle {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< pixels; empty when x1 < x0
};

/// The rectangle of the landmarks with a confidence of at least ½, or of all that are seen when none has: those below
/// are where the detector would put them if they were seen, which may be far from the person. Empty when none is seen.
ImageRectangle VisibleRectangle(const DetectedPerson& person);

}  // namespace bodyloom
