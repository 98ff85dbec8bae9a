// SPDX-License-Identifier: Apache-2.0
/// The list of clips of a batch: a text file with one JSON object a line (JSON Lines, UTF-8). docs/batch.md has its
/// keys.
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
  ClipSettings settings;  ///< paths as they can be opened
  std::string place;      ///< "clips.jsonl: line 3", for messages
};

/// Whether an option's value is the path of a file or folder that is read.
bool IsPathSetting(const std::string& name, const std::string& value);

/// The clips in the order of the lines; never empty. `path` names the file in messages, and its folder is that of
/// relative paths. Throws std::runtime_error "path: line N: what was found, expected what".
std::vector<ManifestClip> ManifestFromText(const std::string& text, const std::string& path);

/// Every N-th of them from the i-th on, counted from 0, for a text "i/N" with i < N: which ones depends on the manifest
/// and N alone, so that a scheduler's jobs (Slurm, GNU parallel) need not know of each other. Throws RequestError.
std::vector<ManifestClip> ShardOf(const std::vector<ManifestClip>& clips, const std::string& text);

}  // namespace bodyloom
