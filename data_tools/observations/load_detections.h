// SPDX-License-Identifier: Apache-2.0
/// Loads one person's 2D landmarks from detections in any supported format, recognised by content.
///
/// Read: a folder of OpenPose, MMPose or Ultralytics JSON files (or a folder of such folders, one per view), their
/// frames in one file, COCO results or annotations and AlphaPose, easy_ViTPose's JSON, BlazePose/MediaPipe dumps,
/// DeepLabCut's CSV, AIST++ keypoints2d pickles, FreeMoCap's 2D .npy and bare arrays (detection_readers.h),
/// VideoPose3D's .npz, the project's own .npz. JSON may be JSON Lines, begin with a byte-order mark and hold NaN or
/// null, which are missing landmarks in all formats. In folders, files that begin with a dot are passed over. If all
/// coordinates are in [0, 1], or [−1, 1] for OpenPose, they are fractions of the image, whose size must then be known.
/// Fractions become pixels by x·width − 0.5 (pixel centres at integers).
#pragma once

#include <string>
#include <vector>

#include "geometry/scene/hands_and_face.h"
#include "geometry/scene/observations.h"

namespace bodyloom {

struct LoadDetectionsOptions {
  std::string view = {};  ///< camera of a file that has several ("c01"), sub-folder of a folder that has several
  int person = 0;         ///< index among several people: 0 is the largest and longest in view (people.h)
  double fps = 0;         ///< frame rate of files without one; 0: 30, or 60 for AIST++
  int image_width = 0;    ///< when known; checked against the detections, and needed for normalised coordinates
  int image_height = 0;
  int other_width = 0, other_height = 0;  ///< another size that detections may state, and then keep; 0: none
  double min_confidence = 0;              ///< landmarks below this count as missing
  /// Order of landmarks of OpenPose, bare arrays, VideoPose3D; empty: detected by each reader.
  std::string convention = {};
};

/// A person's landmarks, and the hands and face in the same frames where the file has any: OpenPose, COCO-WholeBody and
/// Halpe, MMPose, MediaPipe and the project's own .npz.
struct PersonDetections {
  KeypointSequence body;
  HandsAndFaceSequence hands_and_face;
};

/// `warnings`, when requested, gets a line for each fault that was passed over: broken files in a folder
/// (json_folder.h), a cut end of JSON Lines. Throws std::runtime_error in one line: what was found, what was expected,
/// what to do; std::invalid_argument for options that contradict each other.
PersonDetections LoadPersonDetections(const std::string& path, const LoadDetectionsOptions& options = {},
                                      std::vector<std::string>* warnings = nullptr);

/// Its body alone.
KeypointSequence LoadDetections(const std::string& path, const LoadDetectionsOptions& options = {},
                                std::vector<std::string>* warnings = nullptr);

/// The same for the contents of a file; `where` names it in messages.
KeypointSequence DetectionsFromBytes(const std::string& bytes, const std::string& where,
                                     const LoadDetectionsOptions& options = {},
                                     std::vector<std::string>* warnings = nullptr);

/// Marks landmarks with a confidence that is lower or NaN as missing.
void DropUnsure(double min_confidence, KeypointSequence* sequence);
void DropUnsure(double min_confidence, HandsAndFaceSequence* sequence);

}  // namespace bodyloom
