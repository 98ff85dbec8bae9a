// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/track_inputs.h"

#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "data_tools/formats/npz.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/frame_numbers.h"
#include "data_tools/observations/load_detections.h"
#include "data_tools/observations/observations_npz.h"
#include "data_tools/observations/part_labels.h"
#include "geometry/base/check.h"
#include "geometry/scene/track_edits.h"
#include "pipelines/detect/upright_people.h"
#include "pipelines/files.h"
#include "pipelines/track/detected_people.h"
#include "pipelines/track/found_camera_motion.h"
#include "pipelines/track/observation_pixels.h"
#include "pipelines/track/picture_lines.h"
#include "tracking/detection/iuv_to_dense.h"
#include "tracking/initialise/swap_repair.h"
#include "tracking/lifter/given_landmarks.h"
#include "tracking/lifter/lift_keypoints.h"

namespace bodyloom {
namespace {

/// Frame rate of observations that give none; 0 when the request and the video give none either.
double FrameRate(const TrackRequest& request, const TrackInputs& inputs) {
  return request.fps > 0 ? request.fps : inputs.video_fps();
}

InitialPoses ReadInitialiser(const TrackRequest& request, const TrackInputs& inputs) {
  InitialPosesRequest poses;
  poses.path = request.init;
  poses.body = inputs.body.get();
  poses.keypoints = inputs.keypoints ? &*inputs.keypoints : nullptr;
  poses.num_frames = inputs.num_frames();
  poses.person = request.person;
  const Camera& camera = inputs.camera.camera;
  poses.camera = inputs.camera_knowledge == CameraKnowledge::kKnown
                     ? camera
                     : MakePinhole(camera.width, camera.height, StartFocalPx(camera.width, camera.height));
  return ReadInitialPoses(poses);
}

/// Landmarks of another system take the lifter's place, which fills the frames that they lack and says where up is.
std::vector<LiftedFrame> LiftedWith(const TrackRequest& request, const TrackInputs& inputs) {
  if (!inputs.keypoints || !inputs.lifter) {
    throw std::runtime_error(
        request.init + ": gives 3D landmarks, which take the lifter's place; give 2D joints and leave --lifter on");
  }
  if (request.live_lag) {
    throw std::runtime_error(request.init + ": gives 3D landmarks, which --live does not use");
  }
  std::vector<LiftedFrame> frames =
      LiftKeypoints(*inputs.keypoints, inputs.initialiser->camera, inputs.camera_knowledge == CameraKnowledge::kKnown,
                    FindCuts(*inputs.keypoints), *inputs.lifter, {});
  TakeGivenLandmarks(inputs.initialiser->landmarks, {}, &frames);
  return frames;
}

/// Observations of this project's own form may hold either kind or both.
struct Holds {
  bool keypoints = true, dense = false;
};

Holds WhatItHolds(const std::string& path) {
  if (!path.ends_with(".npz")) {
    return {};
  }
  const NpzArrays arrays = ReadNpz(path);
  return {HasKeypoints(arrays) || !HasDense(arrays), HasDense(arrays)};
}

/// Observations of an anamorphic video may be in its stored pixels, as most detectors see them, or in square ones.
template <typename Sequence>
void UseCameraPixels(const std::string& path, const PipelineCallbacks& callbacks, const TrackInputs& inputs,
                     Sequence* seen) {
  const int width = seen->image_width, height = seen->image_height;
  const Camera& camera = inputs.camera.camera;
  if (!MoveToCamera(PixelsOf(inputs.video), camera, seen)) return;
  callbacks.Message(Concatenate(path, ": made in pixels that are not square, ", width, "x", height, "; moved to ",
                                camera.width, "x", camera.height));
}

/// The one image size of a clip: the camera's, which the observations may bring but not contradict.
void AgreeOnImageSize(const std::string& path, int width, int height, Camera* camera) {
  if (width == 0) {
    return;
  }
  if (camera->width == 0) {
    camera->width = width;
    camera->height = height;
  }
  if (camera->width != width || camera->height != height) {
    throw std::runtime_error(Concatenate(path, ": made for images of ", width, "x", height, ", the camera is for ",
                                         camera->width, "x", camera->height));
  }
}

/// Live tracking does not use the camera's motion.
bool LooksForMotion(const TrackRequest& request) { return !request.live_lag && WhyNoCameraMotion(request).empty(); }

/// Hands and faces are used where they were asked for, and by bodies with fingers unless they are switched off.
HandsAndFaceChoice HandsOf(const TrackRequest& request, const TrackInputs& inputs) {
  if (request.live_lag) return HandsAndFaceChoice::kOff;
  return request.detector.hands_and_faces.value_or(HasFingers(*inputs.body) ? HandsAndFaceChoice::kAuto
                                                                            : HandsAndFaceChoice::kOff);
}

bool UsesHands(const TrackRequest& request, const TrackInputs& inputs) {
  return HandsOf(request, inputs) != HandsAndFaceChoice::kOff;
}

void UseDense(const std::string& path, const TrackRequest& request, const PipelineCallbacks& callbacks,
              TrackInputs* inputs) {
  LoadDenseOptions options;
  const double fps = FrameRate(request, *inputs);
  if (fps > 0) {
    options.fps = fps;
  }
  options.person = request.person;
  options.uv_sigma = request.dense_uv_sigma;
  inputs->dense = LoadDense(path, *inputs->body, options);
  UseCameraPixels(path, callbacks, *inputs, &*inputs->dense);
  AgreeOnImageSize(path, inputs->dense->image_width, inputs->dense->image_height, &inputs->camera.camera);
}

/// 2D joints, and the dense keypoints that lie in the same file.
void UseDetections(const TrackRequest& request, const PipelineCallbacks& callbacks, TrackInputs* inputs) {
  Camera& camera = inputs->camera.camera;
  const Holds holds = WhatItHolds(request.detections);
  if (holds.keypoints) {
    LoadDetectionsOptions options;
    options.view = request.view;
    options.person = request.person;
    options.fps = FrameRate(request, *inputs);
    options.image_width = camera.width;
    options.image_height = camera.height;
    const VideoPixels video = PixelsOf(inputs->video);
    const Eigen::Vector2i of_camera(camera.width, camera.height);
    if (video.Differ(video.stored, of_camera) || video.Differ(video.square, of_camera)) {
      options.image_width = video.stored.x(), options.image_height = video.stored.y();
      options.other_width = video.square.x(), options.other_height = video.square.y();
    }
    options.min_confidence = request.min_confidence;
    options.convention = request.convention;
    std::vector<std::string> warnings;
    PersonDetections person = LoadPersonDetections(request.detections, options, &warnings);
    inputs->keypoints = std::move(person.body);
    if (UsesHands(request, *inputs)) inputs->hands_and_face = std::move(person.hands_and_face);
    for (const std::string& warning : warnings) callbacks.Message(warning);
    UseCameraPixels(request.detections, callbacks, *inputs, &*inputs->keypoints);
    MoveToCamera(PixelsOf(inputs->video), camera, &inputs->hands_and_face);
    AgreeOnImageSize(request.detections, inputs->keypoints->image_width, inputs->keypoints->image_height, &camera);
  }
  if (holds.dense && request.dense.empty()) UseDense(request.detections, request, callbacks, inputs);
}

void UseGivenKeypoints(const TrackRequest& request, const KeypointSequence& keypoints,
                       const HandsAndFaceSequence* hands_and_face, TrackInputs* inputs) {
  Camera& camera = inputs->camera.camera;
  inputs->keypoints = keypoints;
  if (hands_and_face != nullptr && UsesHands(request, *inputs)) inputs->hands_and_face = *hands_and_face;
  DropUnsure(request.min_confidence, &inputs->hands_and_face);
  DropUnsure(request.min_confidence, &*inputs->keypoints);
  AgreeOnImageSize(request.detections, keypoints.image_width, keypoints.image_height, &camera);
}

Track ReadReference(const TrackRequest& request, const TrackInputs& inputs) {
  Track reference = ReadTrack(request.reference, MovingCamera::kTake);
  if (reference.num_frames() == inputs.num_frames()) return reference;
  throw std::runtime_error(Concatenate(request.reference, ": ", reference.num_frames(), " frames, expected the ",
                                       inputs.num_frames(), " of the detections"));
}

/// Keeps the frames of the request's span, which is on the video's clock.
void CutToSpan(const TrackRequest& request, TrackInputs* inputs) {
  if (request.from_s <= 0 && request.to_s < 0) return;
  constexpr double kSameTime = 1e-6;
  const std::vector<double> times = inputs->timestamps();
  const double slowdown = inputs->playback.slowdown;
  int first = 0, last = inputs->num_frames() - 1;
  while (first <= last && times[size_t(first)] * slowdown < request.from_s - kSameTime) ++first;
  while (request.to_s >= 0 && last >= first && times[size_t(last)] * slowdown > request.to_s + kSameTime) --last;
  if (first > last) {
    throw RequestError(Concatenate("the clip from second ", request.from_s, " to ", request.to_s,
                                   " holds none of the detections' frames, which are from second ",
                                   times.front() * slowdown, " to ", times.back() * slowdown));
  }
  const auto cut = [&](auto* observations) {
    if (*observations) *observations = CutFrames(std::move(**observations), first, last);
  };
  cut(&inputs->keypoints), cut(&inputs->dense), cut(&inputs->part_labels);
  if (!inputs->hands_and_face.frames.empty()) {
    inputs->hands_and_face = CutFrames(std::move(inputs->hands_and_face), first, last);
  }
  const int count = last - first + 1;
  if (inputs->initialiser) {
    InitialPoses& initial = *inputs->initialiser;
    initial.motion = TakeFrames(initial.motion, first, count);
    if (!initial.landmarks.empty()) {
      initial.landmarks = {initial.landmarks.begin() + first, initial.landmarks.begin() + last + 1};
    }
  }
  if (inputs->reference) {
    std::vector<int> frames(static_cast<size_t>(count));
    std::iota(frames.begin(), frames.end(), first);
    inputs->reference = SelectFrames(*inputs->reference, frames);
  }
}

/// Cameras of the frames on the path. A path found in the video may lack frames that the detections have.
void UsePath(const TrackRequest& request, const PipelineCallbacks& callbacks, TrackInputs* inputs) {
  const std::vector<double>& times = inputs->timestamps();
  CameraPathReport& report = inputs->camera_path_report;
  try {
    inputs->camera_from_scene = CamerasAt(request, *inputs->camera_path, times, times, &report);
    inputs->camera_scale_m = CameraScaleOf(request, *inputs->camera_path);
  } catch (const std::runtime_error& error) {
    if (!report.found) throw;
    callbacks.Message(request.video + ": the camera's path does not fit the detections" + error.what());
    report.found = false;
  }
}

/// Detects people in the video: the chosen one's landmarks, and the mask.
void UseDetectedPeople(const TrackRequest& request, const PipelineCallbacks& callbacks, TrackInputs* inputs) {
  TrackSettings detection = request;
  detection.find_camera_motion = LooksForMotion(request);
  detection.detector.hands_and_faces = HandsOf(request, *inputs);
  const DetectedClip clip = DetectForTracking(detection, callbacks);
  const std::string& no_hands = clip.detector.hands_and_faces.why_not;
  if (!no_hands.empty()) callbacks.Message("hands and faces are not looked for: " + no_hands);
  SayAdviceOnTurn(request.video, clip.people, callbacks);
  const PersonTrack person = PersonOf(clip.people, request.person, request.video);
  DetectedObservations seen = ObservationsOf(clip, person, WholeClip(clip), request, *inputs);
  inputs->keypoints = std::move(seen.keypoints);
  inputs->hands_and_face = std::move(seen.hands_and_face);
  inputs->part_labels = std::move(seen.mask);
  UseFocal(request, &inputs->camera.camera);  // the lines need it
  if (LooksForMotion(request)) {
    UseCameraMotion(request, clip.background, callbacks, inputs, &inputs->camera_path_report);
  }
  inputs->picture_vertical = VerticalOfClip(request, clip, *inputs);
}

}  // namespace

std::vector<std::string> RequireTrackInputs(const TrackRequest& request) {
  std::vector<std::string> inputs = RequireFiles(request, request.detector);
  const std::vector<std::pair<std::string, std::string>> named_inputs = {{request.detections, "detections"},
                                                                         {request.dense, "dense keypoints"},
                                                                         {request.part_labels, "part labels"},
                                                                         {request.init, "initialiser"},
                                                                         {request.reference, "reference track"}};
  for (const auto& [path, what] : named_inputs) {
    RequireReadable(path, what);
    inputs.push_back(path);
  }
  return inputs;
}

TrackSequenceInput TrackInputs::ForTracker() const {
  TrackSequenceInput input = SceneInputs::ForTracker();
  input.keypoints = keypoints ? &*keypoints : nullptr;
  input.dense = dense ? &*dense : nullptr;
  input.part_labels = part_labels ? &*part_labels : nullptr;
  input.hands_and_face = hands_and_face.empty() ? nullptr : &hands_and_face;
  if (initialiser && initialiser->landmarks.empty()) input.initialiser = &initialiser->motion;
  if (!lifted.empty()) input.lifted = &lifted;
  if (!camera_from_scene.empty()) input.camera_from_scene = &camera_from_scene;
  input.camera_scale_m = camera_scale_m;
  if (picture_vertical) UsePictureVertical(*picture_vertical, camera_knowledge, &input);
  return input;
}

TrackInputs LoadTrackInputs(const TrackRequest& given_request, const PipelineCallbacks& callbacks,
                            const GivenInMemory& given) {
  const TrackRequest request = WithTurn(given_request, callbacks);
  TrackInputs inputs;
  static_cast<SceneInputs&>(inputs) =
      LoadSceneInputs(request, given, request.detections, !ReadsJointsOffLabels(request));
  Camera& camera = inputs.camera.camera;
  if (given.keypoints != nullptr) {
    UseGivenKeypoints(request, *given.keypoints, given.hands_and_face, &inputs);
  } else if (!request.detections.empty()) {
    UseDetections(request, callbacks, &inputs);
  }
  if (!request.dense.empty()) {
    UseDense(request.dense, request, callbacks, &inputs);
  }
  if (!request.part_labels.empty()) {
    ReadPartLabelsOptions options;
    const double fps = FrameRate(request, inputs);
    if (fps > 0) {
      options.fps = fps;
    }
    inputs.part_labels = ReadPartLabels(request.part_labels, options);
    UseCameraPixels(request.part_labels, callbacks, inputs, &*inputs.part_labels);
    AgreeOnImageSize(request.part_labels, inputs.part_labels->image_width, inputs.part_labels->image_height, &camera);
    inputs.joints_from_labels = ReadsJointsOffLabels(request);
    if (inputs.joints_from_labels) inputs.keypoints = KeypointsFromPartLabels(*inputs.part_labels);
  }
  if (DetectsPeople(request)) UseDetectedPeople(request, callbacks, &inputs);
  if (camera.width == 0) {
    throw std::runtime_error(Concatenate(request.detections.empty() ? request.dense : request.detections,
                                         ": does not say how large the images are; give --video, --cameras or "
                                         "--image-size"));
  }
  UseFocal(request, &camera);
  if (!request.video.empty() && !DetectsPeople(request)) {
    if (LooksForMotion(request)) {
      UseCameraMotion(request, BackgroundOfVideo(request, inputs.keypoints ? &*inputs.keypoints : nullptr, inputs),
                      callbacks, &inputs, &inputs.camera_path_report);
    }
    inputs.picture_vertical = VerticalOfVideo(request, inputs.keypoints ? &*inputs.keypoints : nullptr, inputs);
  }
  if (!request.init.empty()) inputs.initialiser = ReadInitialiser(request, inputs);
  if (!request.reference.empty()) inputs.reference = ReadReference(request, inputs);
  if (!DetectsPeople(request)) CutToSpan(request, &inputs);
  if (inputs.camera_path) {
    UsePath(request, callbacks, &inputs);
  }
  if (inputs.initialiser && !inputs.initialiser->landmarks.empty()) inputs.lifted = LiftedWith(request, inputs);
  return inputs;
}

}  // namespace bodyloom
