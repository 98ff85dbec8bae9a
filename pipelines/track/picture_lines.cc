// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/picture_lines.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
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
std::string WhyNoLines(const SceneRequest& request, const SceneInputs& scene) {
  if (!request.use_lines) return "switched off";
  if (scene.camera_path) return "the camera moves";
  if (scene.camera_knowledge == CameraKnowledge::kWeak) return "weak perspective has no vanishing points";
  return "";
}

PictureVertical VerticalOf(const FrameSamples& samples, const std::vector<CoveredPixels>& covered,
                           const Matrix2x3d& video_from_camera, const SceneInputs& scene, int num_threads) {
  PictureVertical none;
  const StillPicture picture = MedianPicture(samples, covered, num_threads);
  if (picture.restless_share > kMaxRestlessShare) {
    none.why = Concatenate(std::lround(100 * picture.restless_share),
                           " % of what is not people moves: the camera moves, or the clip has cuts");
    return none;
  }
  std::vector<LineSegment> segments = FindLineSegments(picture);
  const Eigen::Matrix2d camera_from_video = video_from_camera.leftCols<2>().inverse();
  for (LineSegment& segment : segments) {
    for (Eigen::Vector2d* end : {&segment.a, &segment.b}) *end = camera_from_video * (*end - video_from_camera.col(2));
  }
  return FindPictureVertical(segments, CameraOfLines(scene));
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
  return VerticalOf(samples, covered, VideoFromCamera(request, clip.video, scene), scene, threads);
}

PictureVertical VerticalOfVideo(const TrackRequest& request, const KeypointSequence* keypoints,
                                const SceneInputs& scene) {
  PictureVertical none;
  none.why = request.live_lag ? "live tracking does not use it" : WhyNoLines(request, scene);
  if (!none.why.empty()) return none;
  FrameSource source(request.video,
                     {.fps = request.fps, .turn_deg = scene.playback.turn_deg, .captured_fps = request.captured_fps});
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
  std::vector<CoveredPixels> covered(samples.samples().size());
  for (size_t i = 0; keypoints != nullptr && keypoints->num_frames() > 0 && i < covered.size(); ++i) {
    const double at = times[samples.samples()[i].frame] - request.video_offset / source.fps();
    const std::vector<double>& stamps = keypoints->timestamps;
    const auto after = std::lower_bound(stamps.begin(), stamps.end(), at);
    const auto nearest = std::min<std::ptrdiff_t>(after - stamps.begin(), std::ptrdiff_t(stamps.size()) - 1);
    const size_t joints = keypoints->names.size();
    CoverJoints({keypoints->points.data() + size_t(nearest) * joints, joints}, map, samples, &covered[i]);
  }
  return VerticalOf(samples, covered, map, scene, ThreadsFor(request.solve.num_threads));
}

void UsePictureVertical(const PictureVertical& lines, CameraKnowledge knowledge, TrackSequenceInput* input) {
  input->picture_vertical = &lines;
  if (knowledge != CameraKnowledge::kUnknownFocal || !lines.has_focal) return;
  const FocalPrior prior = input->focal_prior.value_or(FocalPrior::ForImage(input->camera.width, input->camera.height));
  input->focal_prior = JoinFocalPrior(prior, lines);
}

}  // namespace bodyloom
