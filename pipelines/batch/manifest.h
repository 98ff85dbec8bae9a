// SPDX-License-Identifier: Apache-2.0
/// The list of clips of a batch: a text file with one JSON object a line (JSON Lines, UTF-8).
///
///   {"id": "dance_01", "detections": "dance_01.json", "image-size": "1920x1080", "fps": 60}
///   {"id": "street", "video": "street.mp4", "people": 2, "report": true}
///
/// `id` is the clip's name and that of its folder of results: 1 to 100 letters, digits, '.', '_' and '-' of ASCII, the
/// first a letter or digit; unique in the file, upper and lower case not being told apart (nor are they by all file
/// systems). `verb` is "track" or "run"; without it a line that names nothing but a video is for `run`, any other for
/// `track`. Every other key is the long name of an option of that verb without its dashes; the value is a text or a
/// number, or true or false for a switch. Not options of a clip are those of its outputs (`out`, `json`) and of the screen
/// (`quiet`, `plan`); `overlay` and `report` are switches. A relative path is taken from the manifest's folder. Empty lines
/// are passed over.
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

/// The clips in the order of the lines; never empty. `path` names the file in messages, and its folder is that of relative
/// paths. Throws std::runtime_error "path: line N: what was found, expected what".
std::vector<ManifestClip> ManifestFromText(const std::string& text, const std::string& path);

/// The same for a file of at most 256 MiB.
std::vector<ManifestClip> ReadManifest(const std::string& path);

}  // namespace bodyloom
