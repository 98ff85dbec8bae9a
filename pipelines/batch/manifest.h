// SPDX-License-Identifier: Apache-2.0
/// The list of clips of a batch: a text file with one JSON object per line (JSON Lines, UTF-8). Its keys are listed in
/// docs/batch.md.
///
///   {"id": "dance_01", "detections": "dance_01.json", "image-size": "1920x1080", "fps": 60}
///   {"id": "street", "video": "street.mp4", "people": 2, "report": true}
#pragma once

#include <map>
#include <string>
#include <vector>

namespace bodyloom {

/// Options by their long names without dashes; switches are "true" or "false".
using ClipSettings = std::map<std::string, std::string>;

struct ManifestClip {
  std::string id;
  std::string verb;       ///< "track" or "run"
  ClipSettings settings;  ///< paths resolved against the manifest's folder
  std::string place;      ///< "clips.jsonl: line 3", for messages
};

/// Returns true if the option's value is the path of a file or folder that is read.
bool IsPathSetting(const std::string& name, const std::string& value);

/// Parses the clips in the order of the lines; never empty. `path` names the file in messages; relative paths are
/// resolved against its folder. Throws std::runtime_error "path: line N: what was found, expected what".
std::vector<ManifestClip> ManifestFromText(const std::string& text, const std::string& path);

/// Every N-th clip starting with the i-th (from 0) for the text "i/N" with i < N. The selection depends on the manifest
/// and N alone, so a scheduler's jobs (Slurm, GNU parallel) need no coordination. Throws RequestError.
std::vector<ManifestClip> ShardOf(const std::vector<ManifestClip>& clips, const std::string& text);

}  // namespace bodyloom
