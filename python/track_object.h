// SPDX-License-Identifier: Apache-2.0
/// Track object of the Python module, and conversion of arguments to bodies and tracks.
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/rig.h"
#include "geometry/scene/track.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom::python {

/// An immutable track with its origin.
struct TrackObject {
  TrackObject(Track track, std::string name, std::shared_ptr<const BodyModel> body = nullptr);

  Track track;
  std::string name;                             ///< its file or a description, for messages
  std::shared_ptr<const BodyModel> body;        ///< that it was fitted with; null: unknown, for a track from a file
  std::optional<TrackSequenceSummary> summary;  ///< of the solve; none for a track from a file
  std::vector<double> joints, coco17;           ///< T×J×3 and T×17×3 in one piece; empty when the track has none
};

using Path = std::filesystem::path;
using BodyArgument = std::variant<std::shared_ptr<BodyModel>, Path>;
using TrackArgument = std::variant<std::shared_ptr<TrackObject>, Path>;
using RigArgument = std::variant<std::vector<RigCamera>, Path>;

/// The argument's body, else the built-in one.
std::shared_ptr<const BodyModel> BodyFrom(const std::optional<BodyArgument>& argument);
/// The argument's body, else the track's own, else the built-in one.
std::shared_ptr<const BodyModel> BodyOf(const TrackObject& track, const std::optional<BodyArgument>& argument);
/// The argument's track, read when it is a path.
std::shared_ptr<TrackObject> TrackFrom(const TrackArgument& argument);

/// "" when there is none.
std::string TextOf(const std::optional<Path>& path);

}  // namespace bodyloom::python
