// SPDX-License-Identifier: Apache-2.0
/// Recorded motions of any format, collected from folders, cleaned, classed, and split into training and testing.
///
/// A clip is read (load_motion.h), turned to y up, mended and cut where no person could have moved so
/// (motion_cleaning.h; every piece is a clip of its own), resampled to at most `max_fps` frames a second, and set on
/// its floor (motion_floor.h).
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
  /// Performer: as the split says, else as the source numbers it ("05" of 05_02, "d06" of gBR_…_d06_…, "HDM_bd" of
  /// HDM_bd_…), else the clip.
  std::string subject;
  std::string motion_class;  ///< one of MotionClasses()
  bool test = false;         ///< kept for testing
  bool is_named = false;     ///< the split names it
  /// 24 joints, y up, regular clock from 0. `trans` is the pelvis joint's position up to a constant of the clip, with
  /// the floor, or the lowest level on which the person rests, at y = 0.
  Motion motion;
  bool has_floor = false;       ///< a flat floor at y = 0; false for climbing and uneven ground
  double floor_shift_m = 0;     ///< height of that floor in the recording's own world: what was taken off `trans`
  double floor_flat_share = 0;  ///< of the frames in which something rests, on the floor within 8 cm
  double source_fps = 0;        ///< of the recording
  /// What cleaning did to the whole recording, with its first piece (zero with the others).
  int frames_recorded = 0, frames_mended = 0, frames_broken = 0, jumps = 0, gaps = 0, frames_dropped = 0;
};

struct MotionLibraryOptions {
  double max_fps = 60;
  std::string split_path;   ///< empty: the project's own (BuiltinMotionSplit)
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
};

/// Visits one clip after the other, folders in the given order, files sorted by name; one recording is in memory at a
/// time. A folder may be a file. Files that hold no motion are reported as left out. Throws std::runtime_error for a
/// path that is not there or a split that cannot be read, and what `visit` throws.
MotionLibrarySummary VisitMotionLibrary(const std::vector<std::string>& folders, const MotionLibraryOptions& options,
                                        const std::function<void(LibraryClip&&)>& visit);

/// All in memory: an hour is 75 MB at 60 frames a second.
std::vector<LibraryClip> LoadMotionLibrary(const std::vector<std::string>& folders,
                                           const MotionLibraryOptions& options = {},
                                           MotionLibrarySummary* summary = nullptr);

}  // namespace bodyloom
