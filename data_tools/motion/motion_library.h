// SPDX-License-Identifier: Apache-2.0
/// Collects recorded motions of any format from folders, cleans and classifies them, and splits them into training and
/// test clips.
///
/// A clip is read (load_motion.h), converted to y up, repaired and cut at impossible movements (motion_cleaning.h;
/// every piece is a separate clip), resampled to at most `max_fps` frames a second, and set on its floor
/// (motion_floor.h).
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "data_tools/motion/motion_cleaning.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct LibraryClip {
  std::string name;    ///< path below the given folder, '/' separators; pieces after the first: "…#2"
  std::string source;  ///< format: bvh asfamc amp deepmimic aistpp amass; CMU's with their numbering: cmu_bvh, …; hdm05
  /// Performer: as in the split, else by the source's numbering ("05" of 05_02, "d06" of gBR_…_d06_…, "HDM_bd" of
  /// HDM_bd_…), else the clip.
  std::string subject;
  std::string motion_class;  ///< one of MotionClasses()
  bool test = false;         ///< kept for testing
  bool is_named = false;     ///< true if the split names it
  /// 24 joints, y up, regular clock from 0. `trans` is the pelvis joint's position up to a constant of the clip, with
  /// the floor, or the lowest level on which the person rests, at y = 0.
  Motion motion;
  bool has_floor = false;       ///< a flat floor at y = 0; false for climbing and uneven ground
  double floor_shift_m = 0;     ///< height of that floor in the recording's own world, subtracted from `trans`
  double floor_flat_share = 0;  ///< share of the support frames that are within 8 cm of the floor
  double source_fps = 0;        ///< of the recording
  /// Cleaning statistics of the whole recording, in its first piece (zero in the others).
  int frames_recorded = 0, frames_mended = 0, frames_broken = 0, jumps = 0, gaps = 0, frames_dropped = 0;
};

struct MotionLibraryOptions {
  double max_fps = 60;
  std::string split_path;   ///< empty: the built-in one (BuiltinMotionSplit)
  bool visit_train = true;  ///< false: clips for training are counted, not visited
  bool visit_test = true;   ///< false: the same for those kept for testing
  MotionCleaningOptions cleaning;
};

struct MotionLibrarySummary {
  int clips = 0;
  double seconds = 0;
  std::map<std::string, double> train_seconds_by_source, test_seconds_by_source;
  std::map<std::string, double> train_seconds_by_class, test_seconds_by_class;
  std::vector<std::string> unnamed;  ///< clips the split does not name: training, class "other"
  std::vector<std::pair<std::string, std::string>> left_out;  ///< file below its folder, one line of reason
  std::vector<std::string> warnings;                          ///< faults that LoadMotion() passed over
};

/// Visits the clips in turn, folders in the given order, files sorted by name; one recording is in memory at a time. A
/// folder may also be a file. Files without a motion are reported as left out. Throws std::runtime_error for a missing
/// path or a split that cannot be read, and the exceptions of `visit`.
MotionLibrarySummary VisitMotionLibrary(const std::vector<std::string>& folders, const MotionLibraryOptions& options,
                                        const std::function<void(LibraryClip&&)>& visit);

/// Loads all clips into memory: an hour is 75 MB at 60 frames a second.
std::vector<LibraryClip> LoadMotionLibrary(const std::vector<std::string>& folders,
                                           const MotionLibraryOptions& options = {},
                                           MotionLibrarySummary* summary = nullptr);

}  // namespace bodyloom
