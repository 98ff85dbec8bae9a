// SPDX-License-Identifier: Apache-2.0
#include "pipelines/score/evaluate_track.h"

#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "data_tools/body/body_io.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/video_truth.h"
#include "data_tools/evaluation/aist_evaluation.h"
#include "data_tools/evaluation/evaluation.h"
#include "data_tools/evaluation/part_label_evaluation.h"
#include "data_tools/evaluation/rig_track_evaluation.h"
#include "data_tools/evaluation/room_physics.h"
#include "data_tools/evaluation/self_penetration.h"
#include "data_tools/evaluation/triangulated_clip.h"
#include "data_tools/evaluation/truth_evaluation.h"
#include "data_tools/evaluation/world_drift.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/npz.h"
#include "data_tools/formats/pickle.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/part_labels.h"
#include "data_tools/observations/rig_io.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/scene/camera_path.h"
#include "geometry/scene/track_edits.h"
#include "pipelines/files.h"

namespace bodyloom {
namespace {

/// Against another track, each frame as its camera saw it, and where the scenes drift apart. Frames that the truth has
/// lost are left out.
Evaluation EvaluateAgainstTrack(const Track& given_track, const Track& given_truth, const BodyModel& body,
                                const BodyModel* true_body = nullptr) {
  std::vector<int> known;
  for (int t = 0; t < given_truth.num_frames(); ++t) {
    if (given_truth.HasResult(t)) known.push_back(t);
  }
  BODYLOOM_CHECK(!known.empty(), "the truth has lost every frame, there is nothing to compare with");
  const bool selects =
      int(known.size()) < given_truth.num_frames() && given_track.num_frames() == given_truth.num_frames();
  const Track track = selects ? SelectFrames(given_track, known) : given_track;
  const Track truth = selects ? SelectFrames(given_truth, known) : given_truth;
  VertexErrorOptions options;
  options.true_body = true_body;
  Evaluation evaluation = EvaluateAgainstTruth(
      TrackInCameras(body, track), TrackInCameras(true_body != nullptr ? *true_body : body, truth), body, options);
  if (track.HasMovingCamera() || truth.HasMovingCamera()) {
    AddWorldDrift(MeasureWorldDrift(track, truth, body, true_body), &evaluation);
  }
  return evaluation;
}

bool HasRig(const EvaluateTrackRequest& request, const EvaluationInMemory& given) {
  return !request.rig.empty() || given.rig != nullptr;
}

/// Against a track of several cameras. The true motion goes to `true_motion`.
Evaluation EvaluateAgainstRigTrack(const EvaluateTrackRequest& request, const Track& track, const BodyModel& body,
                                   const EvaluationInMemory& given, std::optional<Motion>* true_motion) {
  std::optional<Track> read;
  if (given.truth == nullptr) read = ReadTrack(request.truth, MovingCamera::kTake);
  const Track& truth = read ? *read : *given.truth;
  RequireTrackFitsBody(track, body, request.track);
  RequireTrackFitsBody(truth, body, read ? request.truth : "truth");
  RigTrackOptions options;
  options.equal_clocks = request.equal_clocks;
  options.vertices.num_threads = ThreadsFor(0);
  *true_motion = truth.motion;
  const std::vector<RigCamera> rig = given.rig != nullptr ? *given.rig : ReadRig(request.rig);
  try {
    return EvaluateAgainstRig(track, truth, rig, request.view, body, options);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(request.track + ": " + error.what());
  }
}

/// Against a sequence of a data set of videos.
Evaluation EvaluateAgainstVideoTruth(const EvaluateTrackRequest& request, const Track& track, const BodyModel& body,
                                     const PipelineCallbacks& callbacks) {
  const PicklePtr file = ReadPickleFile(request.truth);
  const VideoTruth truth = VideoTruthFromPickle(*file, request.true_person, request.truth);
  std::optional<BodyModel> true_body;
  if (!request.true_body.empty()) true_body = LoadBody(request.true_body);
  RequireTrackFitsBody(truth.track, true_body ? *true_body : body, request.truth);
  if (!true_body && truth.gender != "neutral") {
    callbacks.Message(Concatenate(request.truth, ": of SMPL's ", truth.gender,
                                  " body; without it as --true-body shapes and joints are those of '", body.name(),
                                  "'"));
  }
  const Track at_times = FramesNearTimes(truth.track, track.motion.timestamps, request.truth);
  Evaluation evaluation = EvaluateAgainstTrack(track, at_times, body, true_body ? &*true_body : nullptr);
  evaluation.protocol = truth.dataset == "EMDB" ? "emdb" : "3dpw";
  evaluation.subject = {{"sequence", truth.sequence}, {"gender", truth.gender}};
  return evaluation;
}

/// Against a file: what kind of truth it is shows in what it holds. A true motion goes to `true_motion`.
Evaluation EvaluateAgainstFile(const EvaluateTrackRequest& request, const Track& track, const BodyModel& body,
                               const PipelineCallbacks& callbacks, std::optional<Motion>* true_motion) {
  if (request.truth.ends_with(".pkl")) return EvaluateAgainstVideoTruth(request, track, body, callbacks);
  const NpzArrays arrays = ReadNpz(request.truth);
  if (!HasPartLabels(arrays)) {
    Track truth = TrackFromArrays(arrays, request.truth, MovingCamera::kTake);
    Evaluation evaluation = EvaluateAgainstTrack(track, truth, body);
    *true_motion = std::move(truth.motion);
    return evaluation;
  }
  ReadPartLabelsOptions as_they_are;
  as_they_are.mend_strays = false;
  return EvaluatePartLabels(TrackInCameras(body, track), PartLabelsFromNpz(arrays, request.truth, as_they_are), body);
}

Evaluation EvaluateAgainstFiles(const EvaluateTrackRequest& request, const Track& in_scene, const BodyModel& body,
                                const PipelineCallbacks& callbacks, std::optional<Motion>* true_motion) {
  namespace fs = std::filesystem;
  const fs::path truth = request.truth;
  if (request.truth.empty() && request.seen.empty()) return EvaluateAlone(in_scene);
  const Track track = TrackInCameras(body, in_scene);  // what the other protocols compare
  if (!request.seen.empty()) {
    return EvaluateTriangulatedClip(track, ReadRigClip(request.cameras, request.seen, request.view, track, callbacks),
                                    request.view);
  }
  if (!fs::is_directory(truth)) {
    return EvaluateAgainstFile(request, in_scene, body, callbacks, true_motion);
  }
  if (fs::exists(truth / "keypoints2d")) {
    if (request.sequence.empty()) {
      throw RequestError("an AIST++ folder holds many clips: name one with --sequence");
    }
    const std::string cameras = request.cameras.empty() ? (truth / "cameras").string() : request.cameras;
    return EvaluateAist(track, request.truth, cameras, request.sequence, request.view.empty() ? "c01" : request.view,
                        &body);
  }
  if (fs::exists(truth / "calib_refined.json")) {
    return EvaluatePose2Sim(track, request.truth, request.view.empty() ? "cam_01" : request.view);
  }
  throw std::runtime_error(request.truth +
                           ": neither keypoints2d/ (AIST++) nor calib_refined.json (Pose2Sim) in this folder, expected "
                           "one of them, or a track file");
}

/// Measures the surface of the tracked body: in the world that the track states, and its self-penetration beside that
/// of the true one.
void AddSurfaceMeasures(const Track& track, const std::optional<Motion>& true_motion, const BodyModel& body,
                        const PipelineCallbacks& callbacks, Evaluation* evaluation) {
  if (track.motion.poses.cols() > 3 * body.num_joints() || track.motion.betas.size() > body.num_betas()) {
    callbacks.Message("self-penetration is left out: the track is not of the body '" + body.name() +
                      "'; give the track's own with --body");
    return;
  }
  if (track.world) AddRoomPhysics(MeasureRoomPhysics(track, body, ThreadsFor(0)), evaluation);
  SelfPenetrationOptions options;
  options.num_threads = ThreadsFor(0);
  const auto add = [&](const Motion& motion, const char* prefix) {
    std::vector<int> frames(motion.num_frames());
    std::iota(frames.begin(), frames.end(), 0);
    AddSelfPenetration(MeasureSelfPenetration(motion, frames, body, options), prefix, evaluation);
  };
  add(track.motion, "");
  if (true_motion) add(*true_motion, "gt_");
}

/// Checks what goes with a rig.
void CheckEvaluationRig(const EvaluateTrackRequest& request, const EvaluationInMemory& given) {
  if (!HasRig(request, given)) {
    if (request.equal_clocks) throw RequestError("--equal-clocks is of the cameras of --rig, which is not given");
    return;
  }
  if (given.truth == nullptr && (request.truth.empty() || std::filesystem::is_directory(request.truth))) {
    throw RequestError("--rig has the cameras of a true track: give the track of all of them, --truth FILE.npz");
  }
  if (!request.cameras.empty() || !request.sequence.empty()) {
    throw RequestError("--rig has the cameras: leave out --cameras and --sequence");
  }
}

/// Checks the request and its files, except the track and the body.
void CheckEvaluation(const EvaluateTrackRequest& request, const EvaluationInMemory& given) {
  if ((!request.truth.empty() || given.truth != nullptr || HasRig(request, given)) && !request.seen.empty()) {
    throw RequestError(
        "what is the track compared with? expected --truth, or --seen of two cameras and more, not both");
  }
  if (!request.seen.empty() && (request.cameras.empty() || request.view.empty())) {
    throw RequestError("--seen needs the calibration, --cameras, and the camera that was fitted, --view");
  }
  CheckEvaluationRig(request, given);
  for (const RigDetections& one : request.seen) RequireReadable(one.detections, "detections");
  if ((!request.true_body.empty() || request.true_person != 0) && !request.truth.ends_with(".pkl")) {
    throw RequestError("--true-body and --true-person are of a sequence of EMDB or 3DPW: give --truth FILE.pkl");
  }
  RequireReadable(request.truth, "truth");
  RequireReadable(request.true_body, "true body");
  RequireReadable(request.rig, "rig");
  RequireDistinct({request.truth, request.rig}, {request.json});
  RequireWritable(request.json);
}

/// Of a request that CheckEvaluation() has passed.
Evaluation EvaluateChecked(const EvaluateTrackRequest& request, const BodyModel& body, const Track& track,
                           const EvaluationInMemory& given, const PipelineCallbacks& callbacks) {
  callbacks.Update("measure", 0);
  std::optional<Motion> true_motion;
  if (given.truth != nullptr) true_motion = given.truth->motion;
  Evaluation evaluation = HasRig(request, given) ? EvaluateAgainstRigTrack(request, track, body, given, &true_motion)
                          : given.truth != nullptr
                              ? EvaluateAgainstTrack(track, *given.truth, body)
                              : EvaluateAgainstFiles(request, track, body, callbacks, &true_motion);
  AddSurfaceMeasures(track, true_motion, body, callbacks, &evaluation);
  if (!request.json.empty()) {
    WriteFileAtomically(request.json, EvaluationJson(evaluation));
  }
  return evaluation;
}

}  // namespace

Evaluation EvaluateTrack(const EvaluateTrackRequest& request, const PipelineCallbacks& callbacks) {
  RequireReadable(request.track, "track");
  RequireReadableBody(request.body);
  CheckEvaluation(request, {});
  RequireDistinct({request.track, request.body}, {request.json});
  return EvaluateChecked(request, *BodyOrBuiltin(request.body), ReadTrack(request.track, MovingCamera::kTake), {},
                         callbacks);
}

Evaluation EvaluateTrack(const EvaluateTrackRequest& request, const BodyModel& body, const Track& track,
                         const EvaluationInMemory& given, const PipelineCallbacks& callbacks) {
  CheckEvaluation(request, given);
  return EvaluateChecked(request, body, track, given, callbacks);
}

}  // namespace bodyloom
