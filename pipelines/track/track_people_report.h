// SPDX-License-Identifier: Apache-2.0
/// Report of a video in which everybody was tracked: as text for a reader, and as JSON for a program.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "data_tools/evaluation/room_physics.h"
#include "geometry/base/stopwatch.h"
#include "pipelines/detect/detect_clip.h"
#include "pipelines/track/clip_camera_path.h"
#include "pipelines/track/view_report.h"
#include "tracking/people/occlusion.h"
#include "tracking/problem/track_summary.h"
#include "tracking/room/shared_scene.h"

namespace bodyloom {

struct TrackedPerson {
  int number = 0;  ///< in LinkPeople()'s order
  FoundPerson seen;
  TrackSequenceSummary solve;
  HiddenCounts hidden;             ///< occlusions by other people
  bool fitted_again = false;       ///< with the scene shared by all fits
  RoomPhysics room;                ///< where a ground was found or given; else of no frame
  std::vector<std::string> views;  ///< of several cameras: names of those that show the person
  std::string track;               ///< file; empty if not tracked (solve.message)
};

/// Someone found who is not tracked.
struct LeftOutPerson {
  int number = 0;  ///< in LinkPeople()'s order
  FoundPerson seen;
  std::string why;  ///< "fewer than the 15 frames of 0.5 s"
};

struct TrackPeopleReport {
  std::string video;
  int width = 0, height = 0, num_frames = 0;
  double fps = 0;
  std::string network;  ///< FrameDetectorName()
  HandsAndFaceSummary hands_and_faces;
  std::optional<bool> masks_cut;  ///< of masks that were written: CutMasks()
  int num_found = 0;              ///< people in the detections, including those left out
  std::vector<TrackedPerson> people;
  std::vector<LeftOutPerson> left_out;
  SharedScene scene;
  WorldFrame world;               ///< of all tracks
  std::vector<ViewReport> views;  ///< of several videos, the first's first
  CameraPathReport camera_path;
  CameraPathSummary camera_scale;           ///< scale of the path, common to all tracks
  StageSeconds seconds, processor_seconds;  ///< StageClock'
  double total_seconds = 0;
  size_t peak_memory_bytes = 0;
  std::vector<std::string> outputs;  ///< files written
};

/// The people tracked, the scene, time by stage and files; several lines ending in a newline.
std::string ToText(const TrackPeopleReport& report);

/// The same as one JSON object; the keys are listed in docs/command.md. Numbers that are not finite become null.
std::string ToJson(const TrackPeopleReport& report);

}  // namespace bodyloom
