// SPDX-License-Identifier: Apache-2.0
#include "render/view/overlay.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/camera_path.h"
#include "render/view/overlay_landmarks.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

std::optional<BodyPose> PoseOf(const BodyModel& body, const Track& track, int frame) {
  const Motion& motion = track.motion;
  if (!track.HasResult(frame)) return std::nullopt;
  return PoseFromAxisAngle(body, motion.poses.row(frame).transpose(), motion.trans.row(frame).transpose());
}

}  // namespace

bool OverlayOptions::IsValid(std::string* why) const {
  const auto no = [&](const std::string& text) {
    if (why != nullptr) *why = text;
    return false;
  };
  if (!(alpha >= 0 && alpha <= 1)) return no("overlay: alpha must be in [0, 1]");
  if (!(side_aspect > 0.1 && side_aspect < 10)) return no("overlay: side_aspect must be in (0.1, 10)");
  if (!(std::abs(side_elevation_deg) < 90)) return no("overlay: side_elevation_deg must be in (-90, 90)");
  if (!std::isfinite(side_yaw_deg)) return no("overlay: side_yaw_deg must be finite");
  if (num_threads < 1) return no("overlay: num_threads must be at least 1");
  if (!(up_in_camera.norm() > 0)) return no("overlay: up_in_camera must not be zero");
  return true;
}

FollowViewOptions OverlayOptions::SideView(int height) const {
  FollowViewOptions view;
  view.orbit = {.yaw_deg = side_yaw_deg, .elevation_deg = side_elevation_deg, .up_in_camera = up_in_camera};
  view.width = 2 * static_cast<int>(std::lround(0.5 * height * side_aspect));
  view.height = height;
  view.follows = side_follows;
  return view;
}

double OverlayCaptionHeight(int image_height) { return std::max(9.0, image_height / 48.0); }

int OverlaySamples(int image_height) { return image_height >= 600 ? 2 : 3; }

std::optional<BodyPose> PoseInCamera(const BodyModel& body, const Track& track, int frame) {
  std::optional<BodyPose> pose = PoseOf(body, track, frame);
  if (!pose || !track.HasMovingCamera()) return pose;
  const Vector3d pelvis = body.RestJoints(track.motion.betas).row(0).transpose();
  return MovedPose(track.camera_from_scene[size_t(frame)], pelvis, *std::move(pose));
}

Floor FloorInCamera(const Floor& floor, const Track& track, int frame) {
  if (!track.HasMovingCamera()) return floor;
  const CameraPose& camera = track.camera_from_scene[size_t(frame)];
  return {MovedPoint(camera, floor.point), camera.camera_from_world_rotation * floor.up};
}

MatrixX3d TrackVertices(const BodyModel& body, const Track& track, int frame) {
  BODYLOOM_CHECK(frame >= 0 && frame < track.num_frames(), "frame ", frame, " is outside the track's ",
                 track.num_frames(), " frames");
  const auto pose = PoseOf(body, track, frame);
  return pose ? PoseVertices(body, track.motion.betas, *pose) : MatrixX3d(0, 3);
}

OverlayRenderer::OverlayRenderer(const BodyModel& body, const Track& track, const OverlayOptions& options,
                                 const Track* reference)
    : body_(body), track_(track), reference_(reference), options_(options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), why);
  BODYLOOM_CHECK(track.camera.width > 0 && track.camera.height > 0, "overlay: the track's camera has no image size");
  BODYLOOM_CHECK(track.num_frames() > 0, "overlay: the track has no frames");
  BODYLOOM_CHECK(options.colours == BodyColours::kPlain || body.has_parts(), "overlay: the body '", body.name(),
                 "' has no parts to colour");
  if (options.colours != BodyColours::kPlain) {
    for (const uint8_t part : body.data().face_part) {
      face_colours_.push_back(options.colours == BodyColours::kParts ? PartColour(part) : ClothesColour(part));
    }
  }
  backdrop_ = StudioBackdrop(track.camera.width, track.camera.height);
  const std::vector<MatrixX3d> joints = TrackJoints(body, track);
  const std::vector<MatrixX3d> leaders = reference != nullptr ? TrackJoints(body, *reference) : joints;
  floor_ = FloorOfWorld(track);
  if (floor_) {
    options_.up_in_camera = floor_->up;
  } else {
    floor_ = FloorUnder(leaders, options.up_in_camera);
  }
  if (!options.side_view) return;
  BODYLOOM_CHECK(leaders.size() == joints.size(), "overlay: the track has ", joints.size(), " frames, its reference ",
                 leaders.size());
  BODYLOOM_CHECK(floor_, "overlay: no frame of the track is known, there is nothing to see from the side");
  side_.emplace(std::vector<SidePanelPerson>{{leaders, joints, track.level_m}}, track.motion.timestamps,
                options_.SideView(track.camera.height), *floor_);
}

MeshStyle OverlayRenderer::Style(double alpha) const {
  return {.face_colours = face_colours_,
          .alpha = alpha,
          .samples = OverlaySamples(track_.camera.height),
          .num_threads = options_.num_threads};
}

Image OverlayRenderer::Side(int frame) const {
  SidePanel::Picture panel = side_->At(0, frame);
  const double caption_height = OverlayCaptionHeight(track_.camera.height);
  if (reference_ != nullptr) {
    DrawInPanel({.vertices = TrackVertices(body_, *reference_, frame),
                 .faces = &body_.data().faces,
                 .style = {.colour = kReferenceColour,
                           .samples = OverlaySamples(track_.camera.height),
                           .num_threads = options_.num_threads},
                 .marks = false},
                caption_height, &drawer_, &panel);
  }
  const double alpha = reference_ != nullptr ? options_.alpha : 1;
  DrawInPanel({.vertices = TrackVertices(body_, track_, frame), .faces = &body_.data().faces, .style = Style(alpha)},
              caption_height, &drawer_, &panel);
  return std::move(panel.image);
}

Image OverlayRenderer::Backdrop(int frame, const MatrixX3d& vertices, const Camera& camera) const {
  Image image = backdrop_;
  if (!options_.floor || !floor_ || camera.model != CameraModel::kPinhole) return image;
  if (vertices.rows() == 0) return image;
  const Vector3d centre = vertices.colwise().mean().transpose();
  const Floor floor = FloorInCamera(RaisedFloor(*floor_, track_.LevelAt(frame)), track_, frame);
  DrawFloorGrid(floor, centre, {}, camera, &image);
  if (options_.body) DrawShadow(vertices, body_.data().faces, floor, camera, 0.35, &image);
  return image;
}

Image OverlayRenderer::Render(int frame, const OverlayFrame& what) const {
  BODYLOOM_CHECK(frame >= 0 && frame < track_.num_frames(), "frame ", frame, " is outside the track's ",
                 track_.num_frames(), " frames");
  const Camera camera = track_.CameraAt(frame);
  const auto pose = PoseInCamera(body_, track_, frame);
  const MatrixX3d vertices = pose ? PoseVertices(body_, track_.motion.betas, *pose) : MatrixX3d(0, 3);
  Image view;
  if (what.background != nullptr) {
    BODYLOOM_CHECK(what.background->width == camera.width && what.background->height == camera.height,
                   "overlay: the video is ", what.background->width, "x", what.background->height, ", the camera ",
                   camera.width, "x", camera.height);
    view = *what.background;
  } else {
    view = Backdrop(frame, vertices, camera);
  }
  if (pose && options_.body) {
    const double alpha = what.background != nullptr ? options_.alpha : 1;
    drawer_.Draw(vertices, body_.data().faces, camera, Style(alpha), &view);
  }
  if (pose && (options_.skeleton || what.detected != nullptr)) {
    DrawOverlayLandmarks({.body = &body_, .betas = track_.motion.betas, .pose = *pose, .camera = camera}, what.detected,
                         frame, {.skeleton = options_.skeleton, .min_confidence = options_.min_confidence}, &view);
  }
  const double caption_height = OverlayCaptionHeight(view.height);
  DrawCaption(what.caption, Corner::kTopLeft, caption_height, &view);
  if (what.detected != nullptr) {
    DrawCaption(LandmarkLegend(options_.skeleton), Corner::kBottomLeft, caption_height, &view);
  }
  if (!side_) return view;

  Image panel = Side(frame);
  std::vector<CaptionLine> legend = {{"seen from the side"}};
  if (reference_ != nullptr) {
    legend = {{"estimate", CaptionLine::Mark::kDisc, kBodyColour},
              {"truth", CaptionLine::Mark::kDisc, kReferenceColour}};
  }
  DrawCaption(legend, Corner::kBottomRight, caption_height, &panel);
  return Beside(view, panel);
}

}  // namespace bodyloom
