// SPDX-License-Identifier: Apache-2.0
/// Loads 2D detections of any form: recognises the format by content and returns one person's landmarks.
///
/// Read: a folder of OpenPose or MMPose JSON files (or a folder of such folders, one a view), OpenPose and MMPose
/// frames in one file, COCO results or annotations and AlphaPose, BlazePose/MediaPipe dumps, AIST++ keypoints2d
/// pickles, FreeMoCap's 2D .npy, the project's own .npz.
/// Coordinates in [0, 1] (all of them) are taken as fractions of the image, whose size must then be known; OpenPose's
/// [−1, 1] likewise. Fractions become pixels by x·width − 0.5 (pixel centres at integers).
#pragma once

#include <string>

#include "geometry/scene/observations.h"

namespace bodyloom {

struct LoadDetectionsOptions {
  std::string view;     ///< camera of a file that has several ("c01"), sub-folder of a folder that has several
  int person = 0;       ///< which one when several were seen: 0 is the largest and longest in view (people.h)
  double fps = 0;       ///< frame rate of files that do not say; 0: 30, or 60 for AIST++
  int image_width = 0;  ///< when known; checked against the detections, and needed for normalised coordinates
  int image_height = 0;
  double min_confidence = 0;  ///< landmarks below this count as missing
  std::string convention;     ///< OpenPose model when it should not be detected (openpose_reader.h)
};

/// Throws std::runtime_error in one line: what was found, what was expected, what to do; std::invalid_argument for
/// options that contradict each other.
KeypointSequence LoadDetections(const std::string& path, const LoadDetectionsOptions& options = {});

/// The same for the contents of a file; `where` names it in messages.
KeypointSequence DetectionsFromBytes(const std::string& bytes, const std::string& where,
                                     const LoadDetectionsOptions& options = {});

/// Landmarks with less confidence, or one that is not a number, become missing.
void DropUnsure(double min_confidence, KeypointSequence* sequence);

}  // namespace bodyloom
