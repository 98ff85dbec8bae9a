// SPDX-License-Identifier: Apache-2.0
#include "render/overlay.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/check.h"
#include "geometry/posed_body.h"
#include "render/draw_keypoints.h"
#include "render/shaded_mesh.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

std::optional<BodyPose> PoseOf(const BodyModel& body, const Track& track, int frame) {
  const Motion& motion = track.motion;
  if (!motion.poses.row(frame).allFinite() || !motion.trans.row(frame).allFinite()) return std::nullopt;
  return PoseFromAxisAngle(body, motion.poses.row(frame).transpose(), motion.trans.row(frame).transpose());
}

/// Joints of all frames of a track that are known, for framing.
void AppendJoints(const BodyModel& body, const Track& track, std::vector<MatrixX3d>* joints) {
  const MatrixX3d rest = body.RestJoints(track.motion.betas);
  for (int t = 0; t < track.num_frames(); ++t) {
    if (const auto pose = PoseOf(body, track, t)) joints->push_back(PoseSkeleton(body, rest, *pose).joints);
  }
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
  if (!(up_in_camera.norm() > 0)) return no("overlay: up_in_camera must not be zero");
  return true;
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
  BODYLOOM_CHECK(!options.part_colours || body.has_parts(), "overlay: the body '", body.name(),
                 "' has no parts to colour");
  if (options.part_colours) {
    for (const uint8_t part : body.data().face_part) face_colours_.push_back(PartColour(part));
  }
  if (!options.side_view) return;
  std::vector<MatrixX3d> joints;
  AppendJoints(body, track, &joints);
  if (reference != nullptr) AppendJoints(body, *reference, &joints);
  BODYLOOM_CHECK(!joints.empty(), "overlay: no frame of the track is known, there is nothing to see from the side");
  const int side_width = 2 * static_cast<int>(std::lround(0.5 * track.camera.height * options.side_aspect));
  side_ = OrbitView(joints, side_width, track.camera.height,
                    {.yaw_deg = options.side_yaw_deg,
                     .elevation_deg = options.side_elevation_deg,
                     .up_in_camera = options.up_in_camera});
  // The floor lies under the lowest joint, which is an ankle or a foot, about 4 cm below it.
  const Vector3d up = options.up_in_camera.normalized();
  double lowest = std::numeric_limits<double>::infinity();
  Vector3d sum = Vector3d::Zero();
  for (const MatrixX3d& frame : joints) {
    lowest = std::min(lowest, (frame * up).minCoeff());
    sum += frame.row(0).transpose();
  }
  const Vector3d middle = sum / static_cast<double>(joints.size());
  const Eigen::Matrix3d& R = side_->from_camera.camera_from_world_rotation;
  side_floor_.up = R * up;
  side_floor_.point =
      R * (middle + (lowest - 0.04 - middle.dot(up)) * up) + side_->from_camera.camera_from_world_translation;
  side_backdrop_ = StudioBackdrop(side_->camera.width, side_->camera.height);
  DrawFloorGrid(side_floor_, side_floor_.point, {}, side_->camera, &side_backdrop_);
}

void OverlayRenderer::DrawLandmarks(int frame, const KeypointSequence* detected, const BodyPose& pose,
                                    Image* image) const {
  DrawnKeypoints seen, projected;
  projected.names = detected != nullptr ? detected->names : CocoNames();
  std::erase_if(projected.names, [&](const std::string& name) { return body_.FindLandmark(name) < 0; });
  const MatrixX3d points = PoseLandmarks(body_, track_.motion.betas, pose, projected.names);
  const Camera camera = track_.CameraAt(frame);
  projected.pixels.resize(points.rows(), 2);
  for (int k = 0; k < points.rows(); ++k) {
    Eigen::Vector2d pixel;
    if (!camera.Project(points.row(k).transpose(), &pixel)) pixel.setConstant(std::nan(""));
    projected.pixels.row(k) = pixel.transpose();
  }
  const double size = std::max(2.0, image->height / 220.0);
  if (options_.skeleton) {
    DrawKeypoints(projected, {.size_px = size}, image);
  }
  if (detected == nullptr) return;
  BODYLOOM_CHECK(frame < detected->num_frames(), "overlay: frame ", frame, " is outside the ", detected->num_frames(),
                 " frames of detections");
  seen.names = projected.names;
  seen.min_confidence = options_.min_confidence;
  seen.pixels.resize(points.rows(), 2);
  for (size_t k = 0; k < seen.names.size(); ++k) {
    const auto it = std::find(detected->names.begin(), detected->names.end(), seen.names[k]);
    const Keypoint& p = detected->at(frame, static_cast<int>(it - detected->names.begin()));
    seen.pixels.row(k) << p.x, p.y;
    seen.confidence.push_back(p.confidence);
  }
  if (!options_.skeleton) DrawKeypoints(projected, {.size_px = 1.25 * size, .bones = false, .hollow = true}, image);
  DrawResiduals(seen, projected, 0.5 * size, image);
  DrawKeypoints(seen, {.size_px = 0.8 * size, .bones = false}, image);
}

void OverlayRenderer::DrawSide(int frame, Image* panel) const {
  const MatrixX3i& faces = body_.data().faces;
  const auto draw = [&](const MatrixX3d& vertices_in_camera, const MeshStyle& style) {
    if (vertices_in_camera.rows() == 0) return;
    const MatrixX3d vertices = side_->Apply(vertices_in_camera);
    DrawShadow(vertices, faces, side_floor_, side_->camera, 0.3, panel);
    DrawMesh(vertices, faces, side_->camera, style, panel);
  };
  if (reference_ != nullptr && frame < reference_->num_frames()) {
    draw(TrackVertices(body_, *reference_, frame), {.colour = kReferenceColour});
  }
  const double alpha = reference_ != nullptr ? options_.alpha : 1;
  draw(TrackVertices(body_, track_, frame), {.face_colours = face_colours_, .alpha = alpha});
}

Image OverlayRenderer::Render(int frame, const OverlayFrame& what) const {
  BODYLOOM_CHECK(frame >= 0 && frame < track_.num_frames(), "frame ", frame, " is outside the track's ",
                 track_.num_frames(), " frames");
  const Camera camera = track_.CameraAt(frame);
  Image view;
  if (what.background != nullptr) {
    BODYLOOM_CHECK(what.background->width == camera.width && what.background->height == camera.height,
                   "overlay: the video is ", what.background->width, "x", what.background->height, ", the camera ",
                   camera.width, "x", camera.height);
    view = *what.background;
  } else {
    view = StudioBackdrop(camera.width, camera.height);
  }
  const auto pose = PoseOf(body_, track_, frame);
  if (pose && options_.body) {
    const double alpha = what.background != nullptr ? options_.alpha : 1;
    DrawMesh(PoseVertices(body_, track_.motion.betas, *pose), body_.data().faces, camera,
             {.face_colours = face_colours_, .alpha = alpha}, &view);
  }
  if (pose && (options_.skeleton || what.detected != nullptr)) DrawLandmarks(frame, what.detected, *pose, &view);
  DrawCaption(what.caption, Corner::kTopLeft, 0, &view);
  if (!side_) return view;

  Image panel = side_backdrop_;
  DrawSide(frame, &panel);
  std::vector<CaptionLine> legend = {{"seen from the side", false, {}}};
  if (reference_ != nullptr) legend = {{"estimate", true, kBodyColour}, {"truth", true, kReferenceColour}};
  DrawCaption(legend, Corner::kBottomRight, 0, &panel);
  Image both(width(), height());
  Paste(view, 0, 0, &both);
  Paste(panel, view.width, 0, &both);
  return both;
}

}  // namespace bodyloom
