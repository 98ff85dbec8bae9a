// SPDX-License-Identifier: Apache-2.0
/// Detects people with landmarks in the frames of a clip, by one of several networks.
///
///   BlazePose (people_detector.h)      follows people from frame to frame; 33 landmarks and a mask
///                                      one region a hand and a face (hands_and_face_detector.h)
///   YOLO-pose (keypoint_model.h)       finds everybody in a frame in one pass
///   RTMPose (keypoint_model.h)         finds the landmarks of one person in a box, which comes from a YOLO network if
///                                      one is given, else from BlazePose's landmarks (VisibleRectangle())
/// Results do not depend on the number of threads. A landmark's confidence is the visibility that the network gives it.
#pragma once

#include <memory>
#include <optional>
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
  /// Hands and faces of the people whom BlazePose finds; not looked for with `pose_model`. None: the job decides,
  /// MakeFrameDetector() looks for none.
  std::optional<HandsAndFaceChoice> hands_and_faces;
  std::string box_model;  ///< an ONNX file that finds people for RTMPose; empty: BlazePose does
};

struct FramePerson {
  DetectedPerson person;  ///< identity −1
  LabelImage mask;        ///< PeopleDetectorOptions::masks; empty when it was not asked for
};

/// Parts of people to look for in a frame, of those that the options name.
struct FrameParts {
  bool mask = true, hands_and_faces = true;
};

class FrameDetector {
 public:
  static constexpr int kFramesAtOnce = PeopleDetector::kFramesAtOnce;

  virtual ~FrameDetector() = default;
  /// Of the people's landmarks.
  [[nodiscard]] virtual const KeypointConvention& convention() const = 0;
  /// The next frames of the clip, all of one size: a group of 1 to kFramesAtOnce. Returns the people of each.
  /// parts: of each frame; empty: all parts.
  virtual std::vector<std::vector<FramePerson>> Detect(std::span<const Image> frames,
                                                       std::span<const FrameParts> parts = {}) = 0;
  [[nodiscard]] virtual PeopleDetectorSummary summary() const = 0;
};

/// Throws std::runtime_error naming a file that is missing, no such network or no use here, std::invalid_argument for
/// options that are not valid, for masks or hands (kOn) with `pose_model`, and for a `box_model` that no network needs.
std::unique_ptr<FrameDetector> MakeFrameDetector(const FrameDetectorOptions& options);

/// "heavy", or the name of the ONNX file without its folder.
std::string FrameDetectorName(const FrameDetectorOptions& options);

/// Confidence of a BlazePose landmark, from which the tracker derives a standard deviation: the visibility, limited to
/// [0, 1]; 0 when a coordinate is not finite.
double LandmarkConfidence(const PoseLandmark& landmark);

// Extent of a person in an image, from the person's landmarks.

struct ImageRectangle {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< pixels; empty when x1 < x0
};

/// The rectangle of the landmarks with a confidence of at least ½, or of all detected ones when none has. Landmarks of
/// lower confidence are guesses, which may be far from the person. Empty when no landmark is detected.
ImageRectangle VisibleRectangle(const DetectedPerson& person);

}  // namespace bodyloom
