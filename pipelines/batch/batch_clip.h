// SPDX-License-Identifier: Apache-2.0
/// A clip of a batch as a request, what its result depends on, and its results in a folder.
#pragma once

#include <string>
#include <variant>

#include "bodyloom/pipelines/batch/clip_record.h"
#include "bodyloom/pipelines/batch/manifest.h"
#include "bodyloom/pipelines/callbacks.h"
#include "bodyloom/pipelines/track/track_people_clip.h"
#include "bodyloom/pipelines/track/track_request.h"

namespace bodyloom {

struct BatchClip {
  std::string id;
  ClipSettings settings;  ///< those of the request, with which its hash is made
  /// Of `track` or of `run`. Outputs are those of TrackBatchClip(); the following two say which.
  std::variant<TrackRequest, TrackPeopleClipRequest> request;
  bool overlay = false, report = false;
};

/// "track" or "run".
std::string VerbOf(const BatchClip& clip);

/// 64 hexadecimal digits (SHA-256) that are the same when and only when these are the same: `version`, the verb, the
/// settings, the contents of every file that one of them names (of all files of a folder), and those of the pose
/// detector's networks where people are detected. Of a path its last name counts, by which some formats are told apart,
/// and not where it lies. The number of threads does not count: results do not depend on it. Throws std::runtime_error
/// naming a file that cannot be read.
std::string ClipHash(const BatchClip& clip, const std::string& version);

/// Tracks the clip, with as many threads as its request says, and writes into `folder`, which is there and empty:
/// track.npz and report.json of `track`; all that `run` writes, with its summary as report.json; on request overlay.mp4 and
/// report.html. Files that the reports name are named without their folder. Returns the record of it (done, without hash,
/// version, seconds and files). Throws as TrackClip() and TrackPeopleClip() do.
ClipRecord TrackBatchClip(const BatchClip& clip, const std::string& folder, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
