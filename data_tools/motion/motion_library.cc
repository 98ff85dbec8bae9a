// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/motion_library.h"

#include <algorithm>
#include <filesystem>
#include <regex>
#include <stdexcept>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/load_motion.h"
#include "data_tools/motion/motion_floor.h"
#include "data_tools/motion/motion_split.h"
#include "data_tools/motion/motion_tools.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

/// A frame rate that is this near to the largest allowed is not resampled.
constexpr double kRateTolerance = 1e-3;

/// Path of a file below the folder it was found in; the file's own name when it was given itself.
std::string NameBelow(const std::string& root, const std::string& file) {
  const std::string name = fs::path(file).lexically_relative(root).generic_string();
  return name.empty() || name == "." ? fs::path(file).filename().generic_string() : name;
}

struct Origin {
  std::string source, subject;
};

/// Performer by the name: CMU numbers its trials SUBJECT_TRIAL, AIST++ has
/// genre_situation_camera_DANCER_music_choreography, HDM05 HDM_ACTOR_motion_number.
Origin OriginOf(const std::string& name) {
  static const std::regex cmu(R"((\d{1,3})_(\d{1,3}(\D.*)?|[a-z].*))"), aist(R"(g[A-Z]{2}_s\w\w_c\w+?_(d\d+)_m.*)"),
      hdm05(R"((HDM_[a-z]{2})_.*)");
  const std::string path = WithoutMotionExtension(name);
  const std::string stem = path.substr(path.rfind('/') + 1);
  const std::string file = name.ends_with(".gz") ? name.substr(0, name.size() - 3) : name;
  Origin origin{"other", stem};
  for (const auto& [extension, source] : {std::pair{".bvh", "bvh"},
                                          {".amc", "asfamc"},
                                          {".npy", "amp"},
                                          {".pkl", "aistpp"},
                                          {".npz", "amass"},
                                          {".json", "deepmimic"},
                                          {".txt", "deepmimic"}}) {
    if (file.ends_with(extension)) origin.source = source;
  }
  std::smatch match;
  if (std::regex_match(stem, match, cmu)) {
    origin.subject = match[1];
    if (origin.source == "bvh" || origin.source == "asfamc") origin.source = "cmu_" + origin.source;
  } else if (std::regex_match(stem, match, aist)) {
    origin.subject = match[1];
  } else if (std::regex_match(stem, match, hdm05)) {
    origin = {"hdm05", match[1]};
  }
  return origin;
}

double MeanRate(const Motion& motion) {
  return (motion.num_frames() - 1) / (motion.timestamps.back() - motion.timestamps.front());
}

/// At most max_fps, a regular clock, the first frame at 0.
Motion OnRegularClock(const Motion& piece, double max_fps) {
  const double rate = std::min(MeanRate(piece), max_fps);
  const bool is_regular = FrameRate(piece) > 0 && FrameRate(piece) <= max_fps * (1 + kRateTolerance);
  Motion motion = is_regular ? piece : ResampleMotion(piece, rate);
  const double start = motion.timestamps.front();
  for (double& time : motion.timestamps) time -= start;
  return motion;
}

/// The motion at its capture rate, which files may omit or state wrongly.
void SetRate(double fps, Motion* motion) {
  for (int t = 0; t < motion->num_frames(); ++t) motion->timestamps[t] = t / fps;
}

/// The clips of one file. Throws std::runtime_error when it holds none.
std::vector<LibraryClip> ClipsOf(const std::string& file, const std::string& name, const MotionSplit& split,
                                 const MotionLibraryOptions& options, std::vector<std::string>* warnings) {
  Motion motion = LoadMotion(file, {}, nullptr, warnings);
  if (motion.up == Motion::Up::kCamera) {
    throw std::runtime_error(file + ": a track in a camera's frame, expected a motion that knows which way is up");
  }
  if (motion.poses.cols() != 72) {
    throw std::runtime_error(file + ": " + std::to_string(motion.poses.cols() / 3) + " joints, expected 24");
  }
  const MotionSplitEntry* entry = split.Find(name);
  if (entry != nullptr && entry->fps > 0) SetRate(entry->fps, &motion);
  // The pelvis is at a constant offset from `trans`, which turning the world about the origin keeps constant.
  motion = ChangeUp(motion, Motion::Up::kY, Eigen::Vector3d::Zero());
  const CleanedMotion cleaned = CleanMotion(motion, options.cleaning);
  if (cleaned.pieces.empty()) {
    throw std::runtime_error(Concatenate(file, ": ", motion.num_frames(), " frames, none in a sound piece of ",
                                         options.cleaning.min_piece_s, " s (", cleaned.frames_broken, " broken, ",
                                         cleaned.jumps, " impossible steps, ", cleaned.gaps, " gaps)"));
  }
  const FloorEstimate floor = EstimateFloor(cleaned.pieces);
  const Origin origin = OriginOf(name);
  std::vector<LibraryClip> clips;
  for (const Motion& piece : cleaned.pieces) {
    LibraryClip clip;
    clip.name = clips.empty() ? name : name + "#" + std::to_string(clips.size() + 1);
    clip.source = origin.source;
    clip.subject = entry != nullptr && !entry->performer.empty() ? entry->performer : origin.subject;
    clip.motion_class = entry != nullptr ? entry->motion_class : "other";
    clip.test = entry != nullptr && entry->test;
    clip.is_named = entry != nullptr;
    clip.source_fps = MeanRate(piece);
    clip.motion = OnRegularClock(piece, options.max_fps);
    clip.motion.trans.col(1).array() -= floor.height_m;
    clip.has_floor = floor.has_floor;
    clip.floor_shift_m = floor.height_m;
    clip.floor_flat_share = floor.flat_share;
    if (clips.empty()) {
      clip.frames_recorded = motion.num_frames();
      clip.frames_mended = cleaned.frames_mended;
      clip.frames_broken = cleaned.frames_broken;
      clip.jumps = cleaned.jumps;
      clip.gaps = cleaned.gaps;
      clip.frames_dropped = cleaned.frames_dropped;
    }
    clips.push_back(std::move(clip));
  }
  return clips;
}

void Count(const LibraryClip& clip, MotionLibrarySummary* summary) {
  const double seconds = clip.motion.timestamps.back();
  ++summary->clips;
  summary->seconds += seconds;
  (clip.test ? summary->test_seconds_by_source : summary->train_seconds_by_source)[clip.source] += seconds;
  (clip.test ? summary->test_seconds_by_class : summary->train_seconds_by_class)[clip.motion_class] += seconds;
  if (!clip.is_named) summary->unnamed.push_back(clip.name);
}

}  // namespace

MotionLibrarySummary VisitMotionLibrary(const std::vector<std::string>& folders, const MotionLibraryOptions& options,
                                        const std::function<void(LibraryClip&&)>& visit) {
  BODYLOOM_CHECK(options.max_fps > 0, "max_fps ", options.max_fps, " must be positive");
  const MotionSplit own_split = options.split_path.empty() ? MotionSplit() : ReadMotionSplit(options.split_path);
  const MotionSplit& split = options.split_path.empty() ? BuiltinMotionSplit() : own_split;
  MotionLibrarySummary summary;
  for (const std::string& folder : folders) {
    if (!fs::exists(folder)) throw std::runtime_error(folder + ": not found, expected a motion or a folder of motions");
    for (const std::string& file : FilesBelow(folder)) {
      const std::string name = NameBelow(folder, file);
      std::vector<LibraryClip> clips;
      try {
        clips = ClipsOf(file, name, split, options, &summary.warnings);
      } catch (const std::runtime_error& error) {  // licences, skeletons and readmes are among the motions
        const std::string reason = error.what(), prefix = file + ": ";
        summary.left_out.emplace_back(name, reason.starts_with(prefix) ? reason.substr(prefix.size()) : reason);
        continue;
      }
      for (LibraryClip& clip : clips) {
        Count(clip, &summary);
        if (clip.test ? options.visit_test : options.visit_train) visit(std::move(clip));
      }
    }
  }
  return summary;
}

std::vector<LibraryClip> LoadMotionLibrary(const std::vector<std::string>& folders, const MotionLibraryOptions& options,
                                           MotionLibrarySummary* summary) {
  std::vector<LibraryClip> clips;
  const MotionLibrarySummary visited =
      VisitMotionLibrary(folders, options, [&](LibraryClip&& clip) { clips.push_back(std::move(clip)); });
  if (summary != nullptr) *summary = visited;
  return clips;
}

}  // namespace bodyloom
