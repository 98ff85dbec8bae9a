// SPDX-License-Identifier: Apache-2.0
/// Fuzz targets for inputs of jobs other than weights, images and observations: a run's config.json, the requested
/// light, a batch's manifest and the records of its clips.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "pipelines/animate/relight_frames.h"
#include "pipelines/batch/batch_clip.h"
#include "pipelines/batch/manifest.h"
#include "pipelines/runs/motion_run.h"
#include "pipelines/runs/run_config.h"
#include "tests/fuzz/fuzz_file_targets.h"

namespace bodyloom::fuzz {

/// The run of any of the three renderers.
inline bool AcceptsRunConfig(const std::string& bytes) {
  Folder().Write("run/config.json", bytes);
  const std::string folder = Folder().path() + "/run";
  std::string why;
  const bool motion = Accepts([&] {
    const MotionRun run = ReadMotionRun(folder);
    if (!run.config.IsValid(&why)) throw std::logic_error(why);
    if (!std::isfinite(run.fps) || !std::isfinite(run.pixels_per_metre)) throw std::logic_error("not finite");
  });
  const bool photo = Accepts([&] {
    if (!ReadPhotoRun(folder).config.IsValid(&why)) throw std::logic_error(why);
  });
  const bool guided = Accepts([&] {
    if (!ReadGuidedRun(folder).config.IsValid(&why)) throw std::logic_error(why);
  });
  return motion || photo || guided;
}

inline bool AcceptsRelight(const std::string& bytes) {
  const std::string path = Folder().Write("light.json", bytes);
  return Accepts([&] {
    if (!ReadRelight(path).light.allFinite()) throw std::logic_error("light that is not finite");
  });
}

inline bool AcceptsManifest(const std::string& bytes) {
  return Accepts([&] {
    const std::vector<ManifestClip> clips = ManifestFromText(bytes, "fuzz.jsonl");
    if (clips.empty()) throw std::logic_error("no clips");
    for (const ManifestClip& clip : clips) {
      if (clip.id.empty() || clip.id[0] == '.' || clip.id.find('/') != std::string::npos || !IsOneLine(clip.id)) {
        throw std::logic_error("an id that is no name of a folder: " + clip.id);
      }
      if (clip.verb != "track" && clip.verb != "run") throw std::logic_error("another verb");
      for (const auto& [name, value] : clip.settings) {
        if (value.empty() || !IsOneLine(value)) throw std::logic_error("a setting in several lines");
      }
    }
  });
}

inline bool AcceptsClipRecord(const std::string& bytes) {
  return Accepts([&] {
    const ClipRecord record = ClipRecordFromText(bytes, "fuzz.json");
    if (ToLine(ClipRecordFromText(ToLine(record), "fuzz.json")) != ToLine(record)) {
      throw std::logic_error("a record that is another one when it is written and read");
    }
  });
}

}  // namespace bodyloom::fuzz
