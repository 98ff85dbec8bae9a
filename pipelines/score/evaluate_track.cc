// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/score/evaluate_track.h"

#include <filesystem>
#include <memory>
#include <stdexcept>

#include "bodyloom/data_tools/body/body_or_builtin.h"
#include "bodyloom/data_tools/evaluation/aist_evaluation.h"
#include "bodyloom/data_tools/evaluation/knee_flexion.h"
#include "bodyloom/data_tools/evaluation/part_label_evaluation.h"
#include "bodyloom/data_tools/evaluation/pose2sim_evaluation.h"
#include "bodyloom/data_tools/evaluation/triangulated_clip.h"
#include "bodyloom/data_tools/evaluation/truth_evaluation.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/formats/npz.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/observations/part_labels.h"
#include "bodyloom/pipelines/files.h"

namespace bodyloom {
namespace {

/// Against a file: what kind of truth it is shows in what it holds.
Evaluation EvaluateAgainstFile(const EvaluateTrackRequest& request, const Track& track) {
  const NpzArrays arrays = ReadNpz(request.truth);
  const std::shared_ptr<const BodyModel> body = BodyOrBuiltin(request.body);
  if (!HasPartLabels(arrays)) {
    return EvaluateAgainstTruth(track, TrackFromArrays(arrays, request.truth), *body);
  }
  ReadPartLabelsOptions as_they_are;
  as_they_are.mend_strays = false;
  return EvaluatePartLabels(track, PartLabelsFromNpz(arrays, request.truth, as_they_are), *body);
}

Evaluation Evaluate(const EvaluateTrackRequest& request, const PipelineCallbacks& callbacks) {
  namespace fs = std::filesystem;
  const fs::path truth = request.truth;
  const Track track = ReadTrack(request.track);
  callbacks.Update("measure", 0);
  if (request.truth.empty() && request.seen.empty()) return EvaluateAlone(track);
  if (!request.seen.empty()) {
    return EvaluateTriangulatedClip(track, ReadRigClip(request.cameras, request.seen, request.view, track),
                                    request.view);
  }
  if (!fs::is_directory(truth)) {
    return EvaluateAgainstFile(request, track);
  }
  if (fs::exists(truth / "keypoints2d")) {
    if (request.sequence.empty()) {
      throw RequestError("an AIST++ folder holds many clips: name one with --sequence");
    }
    const std::string cameras = request.cameras.empty() ? (truth / "cameras").string() : request.cameras;
    return EvaluateAist(track, request.truth, cameras, request.sequence, request.view.empty() ? "c01" : request.view,
                        BodyOrBuiltin(request.body).get());
  }
  if (fs::exists(truth / "calib_refined.json")) {
    return EvaluatePose2Sim(track, request.truth, request.view.empty() ? "cam_01" : request.view);
  }
  throw std::runtime_error(request.truth +
                           ": neither keypoints2d/ (AIST++) nor calib_refined.json (Pose2Sim) in this folder, expected "
                           "one of them, or a track file");
}

}  // namespace

Evaluation EvaluateTrack(const EvaluateTrackRequest& request, const PipelineCallbacks& callbacks) {
  if (!request.truth.empty() && !request.seen.empty()) {
    throw RequestError(
        "what is the track compared with? expected --truth, or --seen of two cameras and more, not both");
  }
  if (!request.seen.empty() && (request.cameras.empty() || request.view.empty())) {
    throw RequestError("--seen needs the calibration, --cameras, and the camera that was fitted, --view");
  }
  for (const RigDetections& one : request.seen) RequireReadable(one.detections, "detections");
  RequireReadable(request.track, "track");
  RequireReadable(request.truth, "truth");
  RequireReadable(request.body, "body model");
  RequireDistinct({request.track, request.truth, request.body}, {request.json});
  RequireWritable(request.json);
  Evaluation evaluation = Evaluate(request, callbacks);
  if (!request.json.empty()) {
    WriteFileAtomically(request.json, EvaluationJson(evaluation));
  }
  return evaluation;
}

}  // namespace bodyloom
