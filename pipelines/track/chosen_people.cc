// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/chosen_people.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "data_tools/body/builtin_body.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/body/hand_skeleton.h"
#include "geometry/scene/observations.h"
#include "pipelines/detect/upright_people.h"
#include "pipelines/files.h"
#include "pipelines/track/clip_camera_path.h"
#include "pipelines/track/picture_lines.h"
#include "pipelines/video/track_video.h"
#include "tracking/hands/fit_hands.h"

namespace bodyloom {
namespace {

/// Whoever is seen in fewer frames is seen too briefly.
double FewestFrames(const TrackPeopleRequest& request, const PeopleSequence& people) {
  return std::min(request.min_seconds * VideoFrameRate(people.timestamps), 0.5 * double(people.timestamps.size()));
}

/// The reason for which a person of `frames` frames was not chosen.
std::string WhyLeftOut(const TrackPeopleRequest& request, const PeopleSequence& people, int frames) {
  if (request.person) return Concatenate("--person ", *request.person, " asks for another one");
  if (const double fewest = FewestFrames(request, people); frames < fewest) {
    const int whole = int(std::ceil(fewest));
    return fewest < 0.5 * double(people.timestamps.size())
               ? Concatenate("fewer than the ", whole, " frames of ", request.min_seconds, " s")
               : Concatenate("fewer than half of the clip's ", people.timestamps.size(), " frames");
  }
  return Concatenate("--people ", request.max_people, " takes those who are larger and longer in view");
}

/// Numbers of those to be tracked, in LinkPeople()'s order.
std::vector<int> ChoosePeople(const TrackPeopleRequest& request, const DetectedClip& clip,
                              const std::vector<PersonTrack>& everybody) {
  const std::string& video = request.track.video;
  if (request.person) {
    PersonOf(clip.people, *request.person, video);  // throws when there is no such person
    return {*request.person};
  }
  const double fewest = FewestFrames(request, clip.people);
  std::vector<int> chosen;
  for (size_t i = 0; i < everybody.size(); ++i) {
    if (request.max_people > 0 && int(chosen.size()) == request.max_people) break;
    if (double(everybody[i].detections.size()) >= fewest) chosen.push_back(int(i));
  }
  if (chosen.empty()) {
    throw NoPersonFound(everybody.empty()
                            ? Concatenate(video, ": nobody was found in ", clip.people.timestamps.size(), " frames")
                            : Concatenate(video, ": nobody was seen for ", request.min_seconds,
                                          " s; --person 0 takes whoever was seen most"));
  }
  return chosen;
}

/// Tracks them and frees their masks; progress is that of all fits.
TrackPeopleResult Solve(const TrackPeopleRequest& request, const SceneInputs& scene, const PictureVertical& lines,
                        const std::vector<const BodyModel*>& bodies,
                        const std::vector<std::vector<CameraPose>>& cameras, const PipelineCallbacks& callbacks,
                        std::vector<DetectedObservations>* observations) {
  std::vector<DetectedObservations>& seen = *observations;
  std::vector<TrackSequenceInput> inputs;
  const auto gets_fingers = [&](size_t i) { return bodies[i] != scene.body.get(); };
  for (const DetectedObservations& person : seen) {
    TrackSequenceInput& input = inputs.emplace_back(scene.ForTracker());
    input.keypoints = &person.keypoints;
    input.part_labels = person.mask ? &*person.mask : nullptr;
    const bool uses_hands = !person.hands_and_face.empty() && !gets_fingers(inputs.size() - 1);
    input.hands_and_face = uses_hands ? &person.hands_and_face : nullptr;
    UsePictureVertical(lines, scene.camera_knowledge, &input);
    if (cameras.empty()) continue;
    input.camera_from_scene = &cameras[inputs.size() - 1];
    input.camera_scale_m = CameraScaleOf(request.track, *scene.camera_path);
  }
  TrackSequenceOptions options = request.track.solve;
  options.camera_knowledge = scene.camera_knowledge;
  options.straight_knees_weight = StraightKneesWeight(request.track, seen.front().keypoints.convention);
  bool cancelled = false;
  options.progress = [&](const TrackProgress& at) {
    cancelled = !callbacks.ReportProgress(at.stage, at.fraction);
    return !cancelled;
  };
  TrackPeopleResult result = TrackPeople(std::move(inputs), options);
  if (cancelled) throw Cancelled();
  for (DetectedObservations& person : seen) person.mask.reset();
  ReturnFreedMemory();
  for (size_t i = 0; i < seen.size(); ++i) {
    TrackSequenceResult& person = result.people[i];
    person.track.playback = scene.playback;
    if (!gets_fingers(i) || !person.summary.IsUsable()) continue;
    GiveFingers(*bodies[i], &person.track);
    TrackSequenceInput input;
    input.body = bodies[i];
    input.keypoints = &seen[i].keypoints;
    input.hands_and_face = &seen[i].hands_and_face;
    FitHandsAndHead(input, ThreadsFor(options.num_threads), &person);
  }
  return result;
}

}  // namespace

void CheckTrackPeopleRequest(const TrackPeopleRequest& request) {
  if (request.track.video.empty()) throw RequestError("the video is required");
  if (request.person && request.max_people > 0) {
    throw RequestError("--person and --people both choose who is tracked, expected one of them");
  }
  if (request.track.stature_m > 0 && !request.person && request.max_people != 1) {
    throw RequestError("--stature is one person's: say whose with --person, or give --people 1");
  }
  if (request.track.camera == "weak") {
    throw RequestError("weak perspective puts nobody into a common space: use track for one person at a time");
  }
}

ChosenPeople DetectAndChoosePeople(const TrackPeopleRequest& request, const PipelineCallbacks& callbacks) {
  ChosenPeople people;
  people.clip = DetectForTracking(request.track, callbacks, request.max_people);
  SayAdviceOnTurn(request.track.video, people.clip.people, callbacks);
  people.everybody = LinkPeople(people.clip.people);
  people.chosen = ChoosePeople(request, people.clip, people.everybody);
  return people;
}

bool GivesFingers(const TrackPeopleRequest& request, const GivenInMemory& given) {
  return request.track.body.empty() && given.body == nullptr;
}

HandsAndFaceChoice HandsFor(const TrackPeopleRequest& request, const GivenInMemory& given, const BodyModel& body) {
  const bool uses_hands = HasFingers(body) || GivesFingers(request, given);
  return request.track.detector.hands_and_faces.value_or(uses_hands ? HandsAndFaceChoice::kAuto
                                                                    : HandsAndFaceChoice::kOff);
}

TrackPeopleReport ReportOf(const TrackPeopleRequest& request, const ChosenPeople& people) {
  const PeopleSequence& detected = people.clip.people;
  TrackPeopleReport report;
  report.video = request.track.video;
  report.width = detected.image_width;
  report.height = detected.image_height;
  report.num_frames = int(detected.frames.size());
  report.fps = VideoFrameRate(detected.timestamps);
  report.network = FrameDetectorName(request.track.detector);
  report.hands_and_faces = people.clip.detector.hands_and_faces;
  const std::vector<FoundPerson> found = FoundPeople(detected, people.everybody);
  report.num_found = int(found.size());
  for (const int number : people.chosen) {
    TrackedPerson& person = report.people.emplace_back();
    person.number = number;
    person.seen = found[size_t(number)];
  }
  for (int number = 0; number < report.num_found; ++number) {
    if (std::find(people.chosen.begin(), people.chosen.end(), number) != people.chosen.end()) continue;
    const FoundPerson& seen = found[size_t(number)];
    report.left_out.push_back({number, seen, WhyLeftOut(request, detected, seen.frames)});
  }
  return report;
}

TrackedScene TrackDetectedPeople(const TrackPeopleRequest& request, const SceneInputs& scene, ChosenPeople* chosen,
                                 bool gives_fingers, const PipelineCallbacks& callbacks, TrackPeopleReport* report) {
  TrackedScene tracked;
  const ChosenPeople& people = *chosen;
  for (const int number : people.chosen) {
    const PersonTrack& person = people.everybody[size_t(number)];
    tracked.seen.push_back(ObservationsOf(people.clip, person, SpanOf(person), request.track, scene));
    const bool with_fingers = gives_fingers && ShowsHand(tracked.seen.back().hands_and_face);
    tracked.bodies.push_back(with_fingers ? &BuiltinBodyWithHands() : scene.body.get());
  }
  const size_t count = tracked.seen.size();
  std::vector<std::vector<CameraPose>> cameras;  // of each person's frames
  for (size_t i = 0; scene.camera_path && i < count; ++i) {
    cameras.push_back(CamerasAt(request.track, *scene.camera_path, people.clip.people.timestamps,
                                tracked.seen[i].keypoints.timestamps, &report->camera_path));
  }
  callbacks.Begin(Concatenate("tracking ", count, count == 1 ? " person" : " people"));
  const PictureVertical lines = VerticalOfClip(request.track, people.clip, scene);
  chosen->clip.masks.clear();  // half of a long clip's observations
  chosen->clip.people.frames.clear();
  chosen->clip.samples = {};
  chosen->clip.background = {};
  ReturnFreedMemory();
  tracked.result = Solve(request, scene, lines, tracked.bodies, cameras, callbacks, &tracked.seen);
  report->scene = tracked.result.summary.scene;
  for (size_t i = 0; i < count; ++i) {
    TrackedPerson& person = report->people[i];
    person.solve = tracked.result.people[i].summary;
    person.hidden = tracked.result.summary.hidden[i];
    person.fitted_again = tracked.result.summary.fitted_again[i] != 0;
    if (!person.solve.IsUsable()) continue;
    const Track& track = tracked.result.people[i].track;
    report->world = track.world.value_or(WorldFrame());
    person.room = RoomPhysicsOnGround(track, *tracked.bodies[i], ThreadsFor(request.track.solve.num_threads));
    if (tracked.any) continue;
    tracked.any = true;
    report->camera_scale = person.solve.camera_path;
    const std::string warning = MovingCameraWarning(report->camera_path, person.solve.camera_path, person.solve.ground);
    if (!warning.empty()) callbacks.Message(warning);
  }
  return tracked;
}

void RequireAnyTrack(const TrackPeopleRequest& request, const TrackedScene& tracked) {
  if (tracked.any) return;
  throw NoPersonFound(request.track.video +
                      ": nobody could be tracked: " + tracked.result.people.front().summary.message);
}

}  // namespace bodyloom
