// SPDX-License-Identifier: Apache-2.0
#include "python/track_object.h"

#include <cmath>
#include <limits>
#include <utility>

#include "data_tools/body/builtin_body.h"
#include "data_tools/motion/track_io.h"
#include "pipelines/body_of_track.h"

namespace bodyloom::python {
namespace {

/// T×n×3; frames that have no points are NaN.
std::vector<double> InOnePiece(const std::vector<MatrixX3d>& frames) {
  Eigen::Index points = 0;
  for (const MatrixX3d& frame : frames) points = std::max(points, frame.rows());
  std::vector<double> values(size_t(3 * points) * frames.size(), std::numeric_limits<double>::quiet_NaN());
  for (size_t t = 0; t < frames.size(); ++t) {
    std::copy_n(frames[t].data(), frames[t].size(), values.begin() + std::ptrdiff_t(t) * 3 * points);
  }
  return values;
}

}  // namespace

TrackObject::TrackObject(Track track, std::string name, std::shared_ptr<const BodyModel> body)
    : track(std::move(track)), name(std::move(name)), body(std::move(body)) {
  joints = InOnePiece(this->track.joints);
  coco17 = InOnePiece(this->track.coco17);
}

std::shared_ptr<const BodyModel> BodyFrom(const std::optional<BodyArgument>& argument) {
  if (!argument) return BodyOrBuiltin("");
  if (const auto* body = std::get_if<std::shared_ptr<BodyModel>>(&*argument)) return *body;
  const pybind11::gil_scoped_release unlocked;
  return BodyOrBuiltin(std::get<Path>(*argument).string());
}

std::shared_ptr<const BodyModel> BodyOf(const TrackObject& track, const std::optional<BodyArgument>& argument) {
  if (argument) return BodyFrom(argument);
  return track.body != nullptr ? track.body : BodyOfTrack("", track.track);
}

std::shared_ptr<TrackObject> TrackFrom(const TrackArgument& argument) {
  if (const auto* track = std::get_if<std::shared_ptr<TrackObject>>(&argument)) return *track;
  const std::string path = std::get<Path>(argument).string();
  const pybind11::gil_scoped_release unlocked;
  return std::make_shared<TrackObject>(ReadTrack(path), path);
}

std::string TextOf(const std::optional<Path>& path) { return path ? path->string() : ""; }

}  // namespace bodyloom::python
