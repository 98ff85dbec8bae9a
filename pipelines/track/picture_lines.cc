// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/picture_lines.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <exception>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/scene/camera_path.h"
#include "pipelines/video/track_video.h"
#include "tracking/detection/line_segments.h"

namespace bodyloom {
namespace {

constexpr int kMaxFramesRead = 1800;

/// The rectangle of points that are seen, widened.
void CoverJoints(std::span<const Keypoint> points, const Matrix2x3d& video_from_camera, const FrameSamples& samples,
                 CoveredPixels* covered) {
  const CoveredRegion region = CoveredByPoints(points, video_from_camera);
  if (region.x1 >= region.x0) CoverBox(region.x0, region.y0, region.x1, region.y1, samples.small(), covered);
}

Camera CameraOfLines(const SceneInputs& scene) {
  const Camera& camera = scene.camera.camera;
  if (scene.camera_knowledge == CameraKnowledge::kKnown) return camera;
  const FocalPrior prior = scene.ForTracker().focal_prior.value_or(FocalPrior::ForImage(camera.width, camera.height));
  return MakePinhole(camera.width, camera.height, std::exp(prior.log_mean));
}

/// The reason why no lines are looked for; "": they are.
std::string WhyNoLines(const TrackSettings& request, const SceneInputs& scene) {
  if (!request.use_lines) return "switched off";
  if (scene.camera_knowledge == CameraKnowledge::kWeak) return "weak perspective has no vanishing points";
  return "";
}

/// Segments of a picture in the camera's pixels.
std::vector<LineSegment> SegmentsOf(const StillPicture& picture, const Matrix2x3d& video_from_camera) {
  std::vector<LineSegment> segments = FindLineSegments(picture);
  const Eigen::Matrix2d camera_from_video = video_from_camera.leftCols<2>().inverse();
  for (LineSegment& segment : segments) {
    for (Eigen::Vector2d* end : {&segment.a, &segment.b}) *end = camera_from_video * (*end - video_from_camera.col(2));
  }
  return segments;
}

/// The frames that were kept of a clip.
struct KeptFrames {
  const FrameSamples& samples;
  std::vector<double> seconds;           ///< of each of them
  std::span<const double> clip_seconds;  ///< of the clip's frames
  std::vector<CoveredPixels> covered;    ///< people in each of them
  Matrix2x3d video_from_camera;
};

PictureVertical VerticalOfStill(const KeptFrames& kept, const SceneInputs& scene, int num_threads) {
  const StillPicture picture = MedianPicture(kept.samples, kept.covered, num_threads);
  if (picture.restless_share > kMaxRestlessShare) {
    PictureVertical none;
    none.why = Concatenate(std::lround(100 * picture.restless_share),
                           " % of what is not people moves: the camera moves, or the clip has cuts");
    return none;
  }
  return FindPictureVertical(SegmentsOf(picture, kept.video_from_camera), CameraOfLines(scene));
}

/// Samples of a clip, by their numbers, and the cameras that made them.
struct CamerasOfSamples {
  std::vector<size_t> samples;
  std::vector<CameraPose> camera_from_scene;
};

CamerasOfSamples CamerasOnPath(const SceneRequest& request, const KeptFrames& kept, const SceneInputs& scene) {
  const CameraPath path = CameraPathOnClock(*scene.camera_path, kept.clip_seconds,
                                            {request.camera_path_first, request.camera_path_fps}, "its path");
  CamerasOfSamples on_path;
  std::vector<double> times;
  for (size_t i = 0; i < kept.seconds.size(); ++i) {
    if (kept.seconds[i] < path.timestamps.front() || kept.seconds[i] > path.timestamps.back()) continue;
    on_path.samples.push_back(i);
    times.push_back(kept.seconds[i]);
  }
  on_path.camera_from_scene = SampleCameraPath(path, times).camera_from_scene;
  return on_path;
}

/// Directions of a camera that turns, a quarter of the picture apart, each with the median of the samples as they look
/// from there: people and noise vanish in it as for a camera that stands still.
std::vector<TurnedPicture> MediansOfTurned(const KeptFrames& kept, const CamerasOfSamples& cameras,
                                           const Camera& camera, int num_threads) {
  Eigen::Matrix3d K;  // of the video
  K << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1;
  K.topRows<2>() = kept.video_from_camera * K;
  const double apart = std::atan(0.25 * std::min(camera.width, camera.height) / camera.fx);
  std::vector<Eigen::Matrix3d> directions;
  std::vector<TurnedPicture> pictures;
  for (const CameraPose& pose : cameras.camera_from_scene) {
    const Eigen::Matrix3d& R = pose.camera_from_world_rotation;
    const auto is_near = [&](const Eigen::Matrix3d& other) { return other.row(2).dot(R.row(2)) > std::cos(apart); };
    if (std::any_of(directions.begin(), directions.end(), is_near)) continue;
    directions.push_back(R);
    // A sample that is not on the path, or looks the other way, is hidden.
    std::vector<Eigen::Matrix3d> moved_from_sample(kept.seconds.size(), Eigen::Matrix3d::Identity());
    std::vector<CoveredPixels> covered(kept.seconds.size(), CoveredPixels(kept.samples.small().num_pixels(), 1));
    for (size_t k = 0; k < cameras.samples.size(); ++k) {
      const Eigen::Matrix3d& of_sample = cameras.camera_from_scene[k].camera_from_world_rotation;
      if (R.row(2).dot(of_sample.row(2)) <= 0) continue;
      moved_from_sample[cameras.samples[k]] = K * R * of_sample.transpose() * K.inverse();
      covered[cameras.samples[k]] = kept.covered[cameras.samples[k]];
    }
    const StillPicture picture = MedianPicture(kept.samples, covered, moved_from_sample, num_threads);
    if (picture.restless_share > kMaxRestlessShare) continue;
    pictures.push_back({SegmentsOf(picture, kept.video_from_camera), R});
  }
  return pictures;
}

/// A dozen of the samples themselves.
std::vector<TurnedPicture> SamplesOfMoving(const KeptFrames& kept, const CamerasOfSamples& cameras, int num_threads) {
  const size_t count = cameras.samples.size(), most = FrameSamples::kFewestSamples, step = (count + most - 1) / most;
  std::vector<TurnedPicture> pictures(step == 0 ? 0 : (count + step - 1) / step);
  ParallelFor(static_cast<int>(pictures.size()), num_threads, [&](int i) {
    const size_t k = step * static_cast<size_t>(i), sample = cameras.samples[k];
    const SmallPicture& size = kept.samples.small();
    StillPicture picture{size.width, size.height, size.scale, kept.samples.samples()[sample].grey,
                         kept.covered[sample]};
    picture.people.resize(picture.grey.size(), 0);  // it is empty where nobody is seen
    pictures[i] = {SegmentsOf(picture, kept.video_from_camera),
                   cameras.camera_from_scene[k].camera_from_world_rotation};
  });
  return pictures;
}

PictureVertical VerticalOfTurned(const SceneRequest& request, const KeptFrames& kept, const SceneInputs& scene,
                                 int num_threads) {
  CamerasOfSamples cameras;
  try {
    cameras = CamerasOnPath(request, kept, scene);
  } catch (const std::exception& error) {  // the path is not of this clip: of no use here, and refused elsewhere
    PictureVertical none;
    none.why = error.what();
    return none;
  }
  const Camera camera = CameraOfLines(scene);
  const bool goes = std::any_of(cameras.camera_from_scene.begin(), cameras.camera_from_scene.end(),
                                [](const CameraPose& pose) { return !pose.camera_from_world_translation.isZero(); });
  return FindSharedVertical(
      goes ? SamplesOfMoving(kept, cameras, num_threads) : MediansOfTurned(kept, cameras, camera, num_threads), camera);
}

PictureVertical VerticalOf(const SceneRequest& request, const KeptFrames& kept, const SceneInputs& scene,
                           int num_threads) {
  return scene.camera_path ? VerticalOfTurned(request, kept, scene, num_threads)
                           : VerticalOfStill(kept, scene, num_threads);
}

Matrix2x3d VideoFromCamera(const SceneRequest& request, const VideoInfo& video, const SceneInputs& scene) {
  return VideoFromCameraPixels(scene.camera.video_px_from_camera_px, scene.camera.camera, video, request.video);
}

}  // namespace

PictureVertical VerticalOfClip(const TrackSettings& request, const DetectedClip& clip, const SceneInputs& scene) {
  PictureVertical none;
  const FrameSamples& samples = clip.samples;
  none.why = WhyNoLines(request, scene);
  if (none.why.empty() && samples.samples().empty()) none.why = "no frames were kept";
  if (!none.why.empty()) return none;
  std::vector<CoveredPixels> covered(samples.samples().size());
  const int threads = ThreadsFor(request.solve.num_threads);
  ParallelFor(static_cast<int>(covered.size()), threads, [&](int i) {
    const auto frame = static_cast<size_t>(samples.samples()[i].frame);
    const std::vector<DetectedPerson>& people = clip.people.frames[frame];
    for (size_t person = 0; person < people.size(); ++person) {
      const bool has_mask = !clip.masks.empty() && !clip.masks[frame][person].empty();
      if (has_mask) {
        CoverMask(clip.masks[frame][person].Unpacked(), samples.small(), &covered[i]);
      } else {
        CoverJoints(people[person].points, NamedCamera().video_px_from_camera_px, samples, &covered[i]);
      }
    }
  });
  std::vector<double> seconds;
  for (const GreySample& sample : samples.samples()) seconds.push_back(clip.people.timestamps[sample.frame]);
  const KeptFrames kept{samples, std::move(seconds), clip.people.timestamps, std::move(covered),
                        VideoFromCamera(request, clip.video, scene)};
  return VerticalOf(request, kept, scene, threads);
}

PictureVertical VerticalOfVideo(const TrackRequest& request, const KeypointSequence* keypoints,
                                const SceneInputs& scene) {
  PictureVertical none;
  none.why = request.live_lag ? "live tracking does not use it" : WhyNoLines(request, scene);
  if (none.why.empty() && scene.camera_path && !scene.camera_path->frames.empty() && request.from_s > 0) {
    none.why = "the camera's path counts frames from --from on, the lines those of the whole video";
  }
  if (!none.why.empty()) return none;
  FrameSpan span{.fps = request.fps, .turn_deg = scene.playback.turn_deg, .captured_fps = request.captured_fps};
  if (scene.camera_path) span.from_s = request.from_s;  // the path is of these frames
  FrameSource source(request.video, span);
  FrameSamples samples;
  std::vector<double> times;
  Image frame;
  double time_s = 0;
  while (static_cast<int>(times.size()) < kMaxFramesRead && source.Read(&frame, &time_s)) {
    samples.Add(frame);
    times.push_back(time_s);
  }
  Matrix2x3d map;
  try {
    map = VideoFromCamera(request, source.info(), scene);
  } catch (const std::runtime_error& error) {  // another crop: of no use here, and no fault of the track
    none.why = error.what();
    return none;
  }
  for (double& time : times) time -= request.video_offset / source.fps();
  std::vector<CoveredPixels> covered(samples.samples().size());
  std::vector<double> seconds;
  for (const GreySample& sample : samples.samples()) seconds.push_back(times[sample.frame]);
  for (size_t i = 0; keypoints != nullptr && keypoints->num_frames() > 0 && i < covered.size(); ++i) {
    const std::vector<double>& stamps = keypoints->timestamps;
    const auto after = std::lower_bound(stamps.begin(), stamps.end(), seconds[i]);
    const auto nearest = std::min<std::ptrdiff_t>(after - stamps.begin(), std::ptrdiff_t(stamps.size()) - 1);
    const size_t joints = keypoints->names.size();
    CoverJoints({keypoints->points.data() + size_t(nearest) * joints, joints}, map, samples, &covered[i]);
  }
  const std::vector<double>& clip_seconds = keypoints != nullptr ? keypoints->timestamps : times;
  const KeptFrames kept{samples, std::move(seconds), clip_seconds, std::move(covered), map};
  return VerticalOf(request, kept, scene, ThreadsFor(request.solve.num_threads));
}

void UsePictureVertical(const PictureVertical& lines, CameraKnowledge knowledge, TrackSequenceInput* input) {
  input->picture_vertical = &lines;
  if (knowledge != CameraKnowledge::kUnknownFocal || !lines.has_focal) return;
  const FocalPrior prior = input->focal_prior.value_or(FocalPrior::ForImage(input->camera.width, input->camera.height));
  input->focal_prior = JoinFocalPrior(prior, lines);
}

}  // namespace bodyloom
