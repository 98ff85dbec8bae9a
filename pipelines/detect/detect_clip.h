// SPDX-License-Identifier: Apache-2.0
/// Detects people in a video, from files to files: everybody's 2D landmarks, one person's mask and dense keypoints.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "geometry/base/stopwatch.h"
#include "pipelines/detect/detect_dense.h"
#include "pipelines/detect/detect_people.h"

namespace bodyloom {

struct DetectClipRequest {
  bool find_turn = false;        ///< detect.span.turn_deg is FindTurn()
  DetectPeopleRequest detect;    ///< detector.blazepose.masks follows from `mask`
  std::string out;               ///< everybody's landmarks, .npz (people_npz.h); empty: none
  std::string mask;              ///< one person's mask, .npz (part_labels.h); empty: none
  bool coarse_mask = false;      ///< the network's mask, without refinement (CutMasks())
  std::string dense;             ///< one person's dense keypoints, .npz (observations_npz.h); empty: none
  ChartDetector dense_detector;  ///< detector of dense keypoints; required for `dense`
  std::string body;              ///< body of the dense keypoints; empty: the built-in body
  int person = 0;                ///< person of mask and dense keypoints; 0: the largest and longest in view
  std::string json;              ///< ToJson(DetectClipReport); empty: none
};

/// One person found, in LinkPeople()'s order.
struct FoundPerson {
  int frames = 0;                  ///< number of frames in view
  int joined = 0;                  ///< PersonTrack::joined
  double first_s = 0, last_s = 0;  ///< seconds
  double height_px = 0;            ///< median extent of the landmarks from top to bottom
  double visible = 0;              ///< mean share of landmarks with a confidence of at least ½
};

/// Result of the landmark networks.
struct FoundLandmarks {
  int frames_with_people = 0;
  std::string network;  ///< FrameDetectorName()
  std::vector<FoundPerson> people;
  PeopleDetectorSummary detector;
  std::optional<bool> mask_cut;  ///< result of CutMasks() if a mask is written
};

/// Result of the dense detector.
struct FoundDense {
  int people = 0, frames_seen = 0;  ///< DetectedDense
  double keypoints = 0;             ///< mean over the frames in which the person was seen
};

struct DetectClipReport {
  std::string video;
  int width = 0, height = 0, frames = 0;
  std::optional<FoundLandmarks> landmarks;  ///< if landmarks were detected
  std::optional<FoundDense> dense;
  StageSeconds seconds, processor_seconds;  ///< StageClock's
  double total_seconds = 0;
  std::vector<std::string> outputs;  ///< files written
};

/// Detects and writes. Landmarks are detected unless only dense keypoints are to be written; they then define the
/// numbering of `person` (DetectDense). Throws RequestError when nothing is to be written or files coincide,
/// std::runtime_error naming a file that cannot be used or when nobody was found, Cancelled (nothing is written after
/// it).
DetectClipReport DetectClip(const DetectClipRequest& request, const PipelineCallbacks& callbacks = {});

/// FoundPerson of each of the clip's people; `tracks` is LinkPeople(people).
std::vector<FoundPerson> FoundPeople(const PeopleSequence& people, const std::vector<PersonTrack>& tracks);

/// Several lines of text ending in a newline.
std::string ToText(const DetectClipReport& report);
/// The same as one JSON object.
std::string ToJson(const DetectClipReport& report);

}  // namespace bodyloom
