// SPDX-License-Identifier: Apache-2.0
#include "pipelines/score/evaluate_track.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "data_tools/body/body_io.h"
#include "data_tools/datasets/video_truth.h"
#include "data_tools/evaluation/aist_evaluation.h"
#include "data_tools/evaluation/human36m_evaluation.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/evaluation/part_label_evaluation.h"
#include "data_tools/evaluation/rig_track_evaluation.h"
#include "data_tools/evaluation/room_physics.h"
#include "data_tools/evaluation/self_penetration.h"
#include "data_tools/evaluation/triangulated_clip.h"
#include "data_tools/evaluation/truth_evaluation.h"
#include "data_tools/evaluation/world_drift.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/json_reader.h"
#include "data_tools/formats/npz.h"
#include "data_tools/formats/object_npy.h"
#include "data_tools/formats/pickle.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/frame_numbers.h"
#include "data_tools/observations/load_cameras.h"
#include "data_tools/observations/load_detections.h"
#include "data_tools/observations/part_labels.h"
#include "data_tools/observations/rig_io.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/scene/camera_path.h"
#include "geometry/scene/track_edits.h"
#include "pipelines/body_of_track.h"
#include "pipelines/files.h"
#include "pipelines/track/observation_pixels.h"
#include "pipelines/video/track_video.h"

namespace bodyloom {
namespace {

RigView ReadView(const RigDetections& seen, const std::vector<NamedCamera>& cameras, const std::string& calibration,
                 const PipelineCallbacks& callbacks) {
  const NamedCamera& named = FindCamera(cameras, seen.view, calibration);
  LoadDetectionsOptions options;
  options.person = seen.person;
  std::vector<std::string> warnings;
  KeypointSequence detections = LoadDetections(seen.detections, options, &warnings);
  for (const std::string& warning : warnings) callbacks.Message(warning);
  const Camera& camera = named.camera;
  if (detections.image_width > 0) {
    const Matrix2x3d map = VideoFromCameraPixels(named.video_px_from_camera_px, camera, detections.image_width,
                                                 detections.image_height, seen.detections);
    detections = MovedToCamera(std::move(detections), map, camera.width, camera.height);
  }
  return {named.name, camera, named.pose, AsCoco17(detections, seen.detections)};
}

/// The frame that is nearest to a time; −1 when none is within half a frame.
int FrameAt(const std::vector<double>& timestamps, double time_s) {
  const auto nearer = [&](double a, double b) { return std::abs(a - time_s) < std::abs(b - time_s); };
  const auto nearest = std::min_element(timestamps.begin(), timestamps.end(), nearer);
  if (nearest == timestamps.end() || std::abs(*nearest - time_s) > 0.5 / VideoFrameRate(timestamps)) return -1;
  return int(nearest - timestamps.begin());
}

/// Both tracks without the frames that the truth has lost.
std::pair<Track, Track> KnownFrames(const Track& given_track, const Track& given_truth) {
  std::vector<int> known;
  for (int t = 0; t < given_truth.num_frames(); ++t) {
    if (given_truth.HasResult(t)) known.push_back(t);
  }
  BODYLOOM_CHECK(!known.empty(), "the truth has lost every frame, there is nothing to compare with");
  const bool selects =
      int(known.size()) < given_truth.num_frames() && given_track.num_frames() == given_truth.num_frames();
  if (!selects) return {given_track, given_truth};
  return {SelectFrames(given_track, known), SelectFrames(given_truth, known)};
}

/// Against another track, each frame as its camera saw it, and where the scenes drift apart. Frames that the truth has
/// lost are left out.
Evaluation EvaluateAgainstTrack(const Track& given_track, const Track& given_truth, const BodyModel& body,
                                const BodyModel* true_body = nullptr) {
  const auto [track, truth] = KnownFrames(given_track, given_truth);
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

/// The camera of a data set whose cameras stand still.
NamedCamera StandingCamera(const EvaluateTrackRequest& request) {
  constexpr std::string_view kCamera = "_camera.json";
  const std::string& truth = request.truth;
  std::string cameras = request.cameras;
  for (const std::string_view ending : {"_joint_3d.json", "_smpl_param.json"}) {
    if (!cameras.empty() || !truth.ends_with(ending)) continue;
    const std::string beside = truth.substr(0, truth.size() - ending.size()) + std::string(kCamera);
    if (std::filesystem::exists(beside)) cameras = beside;
  }
  if (cameras.empty()) {
    throw RequestError(truth + ": a truth in the world of its cameras: give them, --cameras, and --view");
  }
  RequireReadable(cameras, "cameras");
  if (std::filesystem::is_directory(truth)) return ReadRichCamera(cameras, request.view);
  NamedCamera camera = FindCamera(LoadCameras(cameras), request.view, cameras);
  if (!camera.has_pose) throw std::runtime_error(cameras + ": cameras without a pose, expected those of the data set");
  return camera;
}

RowMatrixXd RegressorOf(const EvaluateTrackRequest& request, const BodyModel& body) {
  return request.joint_regressor.empty() ? RowMatrixXd() : ReadJointRegressor(request.joint_regressor, body);
}

/// Against a motion of a data set of videos.
Evaluation EvaluateAgainstVideoTruth(const EvaluateTrackRequest& request, const VideoTruth& truth, const Track& track,
                                     const BodyModel& body, const PipelineCallbacks& callbacks) {
  std::optional<BodyModel> given_body;
  if (!request.true_body.empty()) given_body = LoadBody(request.true_body);
  const BodyModel& true_body = given_body ? *given_body : body;
  RequireTrackFitsBody(truth.track, true_body, request.truth);
  if (!given_body && truth.gender != "neutral") {
    const std::string whose = truth.gender.empty() ? "subject " + truth.subject + "'s" : truth.gender;
    callbacks.Message(Concatenate(request.truth, ": of ", truth.track.motion.body == "smplx" ? "SMPL-X" : "SMPL", "'s ",
                                  whose, " body; without it as --true-body shapes and joints are those of '",
                                  body.name(), "'"));
  }
  const Track at_times = SelectFrames(
      truth.track, FramesNearTimes(truth.track.num_frames(), truth.fps, track.motion.timestamps, request.truth));
  Evaluation evaluation = EvaluateAgainstTrack(track, at_times, body, given_body ? &true_body : nullptr);
  evaluation.protocol = truth.protocol;
  for (const auto& [name, value] :
       {std::pair("sequence", truth.sequence), std::pair("gender", truth.gender), std::pair("person", truth.subject)}) {
    if (!value.empty()) evaluation.subject.emplace_back(name, value);
  }
  if (!request.joint_regressor.empty()) {
    ReadJointRegressor(request.joint_regressor, true_body);
    const auto [known_track, known_truth] = KnownFrames(track, at_times);
    const Track seen = TrackInCameras(body, known_track);
    AddRegressedJoints(seen, NearestFramesWithResult(HasResults(seen, seen.num_frames())),
                       TrackInCameras(true_body, known_truth), body, true_body, RegressorOf(request, body),
                       &evaluation);
  }
  return evaluation;
}

/// Against joints of Human3.6M.
Evaluation EvaluateAgainstHuman36m(const EvaluateTrackRequest& request, const Human36mClip& clip, const Track& track,
                                   const BodyModel& body) {
  const NamedCamera camera = StandingCamera(request);
  const std::vector<int> frames =
      FramesNearTimes(int(clip.joints.size()), kHuman36mFps, track.motion.timestamps, request.truth);
  Evaluation evaluation =
      EvaluateHuman36m(TrackInCameras(body, track), clip.joints, frames, camera.pose, body, RegressorOf(request, body));
  evaluation.subject = {{"sequence", clip.sequence}, {"view", camera.name}};
  return evaluation;
}

Evaluation EvaluateAgainstJson(const EvaluateTrackRequest& request, const Track& track, const BodyModel& body,
                               const PipelineCallbacks& callbacks) {
  constexpr JsonLimits kSubject = {.max_bytes = size_t{1} << 30};
  const nlohmann::json json = ReadJsonFile(request.truth, kSubject);
  const JsonNode document(json, request.truth);
  if (!HasHuman36mSmpl(document)) {
    return EvaluateAgainstHuman36m(request, Human36mFromJson(document, request.sequence), track, body);
  }
  return EvaluateAgainstVideoTruth(request, Human36mSmplFromJson(document, request.sequence, StandingCamera(request)),
                                   track, body, callbacks);
}

/// Against a file: what kind of truth it is shows in what it holds. A true motion goes to `true_motion`.
Evaluation EvaluateAgainstFile(const EvaluateTrackRequest& request, const Track& track, const BodyModel& body,
                               const PipelineCallbacks& callbacks, std::optional<Motion>* true_motion) {
  if (request.truth.ends_with(".pkl")) {
    const PicklePtr file = ReadPickleFile(request.truth);
    return EvaluateAgainstVideoTruth(request, VideoTruthFromPickle(*file, request.true_person, request.truth), track,
                                     body, callbacks);
  }
  if (request.truth.ends_with(".json")) return EvaluateAgainstJson(request, track, body, callbacks);
  const NpzArrays arrays = ReadNpz(request.truth);
  if (IsHuman36mPositions(arrays)) {
    const PicklePtr positions = ReadObjectOfNpz(ReadFileBytes(request.truth), "positions_3d", request.truth);
    return EvaluateAgainstHuman36m(request, Human36mFromPositions(*positions, request.sequence, request.truth), track,
                                   body);
  }
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
  if (IsRichSequence(request.truth)) {
    return EvaluateAgainstVideoTruth(
        request, ReadRichTruth(request.truth, request.true_person, StandingCamera(request)), in_scene, body, callbacks);
  }
  throw std::runtime_error(request.truth +
                           ": neither keypoints2d/ (AIST++), calib_refined.json (Pose2Sim) nor folders of frames "
                           "(RICH) in this folder, expected one of them, or a track file");
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

/// Checks what goes with motions of data sets only.
void CheckDataSetOptions(const EvaluateTrackRequest& request) {
  const bool is_json = request.truth.ends_with(".json");
  const bool is_pickle_or_folder = request.truth.ends_with(".pkl") || std::filesystem::is_directory(request.truth);
  if ((!request.true_body.empty() && !is_pickle_or_folder && !is_json) ||
      (request.true_person != 0 && !is_pickle_or_folder)) {
    throw RequestError(
        "--true-body and --true-person are of a sequence of EMDB, 3DPW or RICH: give --truth FILE.pkl or its folder");
  }
  if (!request.joint_regressor.empty() && !is_json && !is_pickle_or_folder && !request.truth.ends_with(".npz")) {
    throw RequestError("--joint-regressor is of motions of data sets: give --truth");
  }
  RequireReadable(request.joint_regressor, "joint regressor");
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
  CheckDataSetOptions(request);
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

RigDetections RigDetectionsFromText(const std::string& text) {
  const size_t equals = text.find('=');
  const std::string head = text.substr(0, equals);
  const size_t colon = head.find(':');
  RigDetections seen;
  seen.view = head.substr(0, colon);
  const std::string person = colon == std::string::npos ? "0" : head.substr(colon + 1);
  const bool is_number = !person.empty() && person.size() < 6 &&
                         std::all_of(person.begin(), person.end(), [](unsigned char c) { return std::isdigit(c); });
  if (equals == std::string::npos || equals + 1 == text.size() || seen.view.empty() || !is_number) {
    throw RequestError("'" + text + "', expected VIEW=FILE or VIEW:PERSON=FILE as in cam_02:1=detections.npz");
  }
  seen.person = std::stoi(person);
  seen.detections = text.substr(equals + 1);
  return seen;
}

MultiViewClip ReadRigClip(const std::string& cameras, const std::vector<RigDetections>& seen, const std::string& view,
                          const Track& track, const PipelineCallbacks& callbacks) {
  if (seen.size() < 2) throw RequestError("one camera has nothing to triangulate with, expected detections of two");
  const std::vector<NamedCamera> calibrated = LoadCameras(cameras);
  const std::string fitted = FindCamera(calibrated, view, cameras).name;
  MultiViewClip clip;
  clip.name = std::filesystem::path(seen[0].detections).stem().string();
  int own = -1;
  for (const RigDetections& one : seen) {
    clip.views.push_back(ReadView(one, calibrated, cameras, callbacks));
    if (clip.views.back().name != fitted) continue;
    own = int(clip.views.size()) - 1;
    clip.views.back().name = view;  // as the caller spells it
  }
  if (own < 0) {
    throw RequestError("no detections of the camera " + fitted + ", to which the track was fitted, among those given");
  }
  const std::vector<double>& times = clip.views[size_t(own)].detections.timestamps;
  clip.fps = VideoFrameRate(times);
  const int first = track.motion.timestamps.empty() ? -1 : FrameAt(times, track.motion.timestamps[0]);
  if (first < 0) {
    throw std::runtime_error(seen[size_t(own)].detections + ": no frame at the time at which the track begins");
  }
  for (size_t v = 0; v < clip.views.size(); ++v) {
    KeypointSequence& detections = clip.views[v].detections;
    if (detections.num_frames() <= first) {
      throw std::runtime_error(
          Concatenate(seen[v].detections, ": ", detections.num_frames(), " frames, the track begins at frame ", first));
    }
    const int last = detections.num_frames() - 1;
    detections = CutFrames(std::move(detections), first, last);
  }
  clip.coco17_in_world = TriangulateViews(clip.views);
  return clip;
}

Evaluation EvaluateTrack(const EvaluateTrackRequest& request, const PipelineCallbacks& callbacks) {
  RequireReadable(request.track, "track");
  RequireReadableBody(request.body);
  CheckEvaluation(request, {});
  RequireDistinct({request.track, request.body}, {request.json});
  const Track track = ReadTrack(request.track, MovingCamera::kTake);
  return EvaluateChecked(request, *BodyOfTrack(request.body, track), track, {}, callbacks);
}

Evaluation EvaluateTrack(const EvaluateTrackRequest& request, const BodyModel& body, const Track& track,
                         const EvaluationInMemory& given, const PipelineCallbacks& callbacks) {
  CheckEvaluation(request, given);
  return EvaluateChecked(request, body, track, given, callbacks);
}

}  // namespace bodyloom
