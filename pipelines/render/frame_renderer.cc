// SPDX-License-Identifier: Apache-2.0
#include "pipelines/render/frame_renderer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "geometry/base/check.h"
#include "geometry/scene/camera_path.h"
#include "pipelines/report_text.h"
#include "render/image/palette.h"
#include "render/view/contact_sheet.h"
#include "render/view/overlay.h"

namespace bodyloom {
namespace {

const char* const kNames[] = {"overlay", "iuv", "parts", "normal", "depth", "texture", "error"};

SurfaceAttribute AttributeOf(RenderKind kind) {
  switch (kind) {
    case RenderKind::kIuv:
      return SurfaceAttribute::kIuv;
    case RenderKind::kNormal:
      return SurfaceAttribute::kNormal;
    case RenderKind::kDepth:
      return SurfaceAttribute::kDepth;
    case RenderKind::kTexture:
      return SurfaceAttribute::kTexture;
    case RenderKind::kError:
      return SurfaceAttribute::kError;
    default:
      return SurfaceAttribute::kParts;
  }
}

void CheckBody(const BodyModel& body, RenderKind kind, const std::string& where) {
  const bool needs_parts = kind == RenderKind::kParts || kind == RenderKind::kIuv;
  if ((needs_parts && !body.has_parts()) || (kind == RenderKind::kIuv && body.data().face_iuv.rows() == 0)) {
    throw std::runtime_error(where + ": the body '" + body.name() + "' has no charts; give one that has with --body");
  }
  if (kind == RenderKind::kTexture && !body.has_uv()) {
    throw std::runtime_error(where + ": the body '" + body.name() +
                             "' has no UV coordinates; give one that has with --body");
  }
}

}  // namespace

RenderKind RenderKindFromString(const std::string& name) {
  const auto* const found = std::find(std::begin(kNames), std::end(kNames), name);
  BODYLOOM_CHECK(found != std::end(kNames), "'", name, "' is not a kind of image");
  return static_cast<RenderKind>(found - std::begin(kNames));
}

std::string ToString(RenderKind kind) { return kNames[static_cast<size_t>(kind)]; }

FrameRenderer::FrameRenderer(const BodyModel& body, const Track& track, const FrameRendererOptions& options,
                             const std::string& where)
    : body_(body), track_(track), options_(options) {
  CheckBody(body, options.kind, where);
  if (track.HasMovingCamera()) in_cameras_ = TrackInCameras(body, track);
  const Camera& camera = track.camera;
  if (camera.width <= 0 || camera.height <= 0) {
    throw std::runtime_error(where + ": image_size is " + std::to_string(camera.width) + "x" +
                             std::to_string(camera.height) + ", expected the size of the images");
  }
  const bool has_studio = options.kind == RenderKind::kOverlay;
  if (!has_studio && !options.new_view) {
    return;
  }
  const std::vector<MatrixX3d> joints = TrackJoints(body, track);
  const Eigen::Vector3d up = EstimatedUp(track);
  floor_ = FloorUnder(joints, up);
  if (options.new_view) {
    if (!floor_) {
      throw std::runtime_error(where + ": every frame is lost, there is nobody to look at from another side");
    }
    FollowViewOptions follow;
    follow.orbit = {.yaw_deg = options.view_yaw_deg, .elevation_deg = 8, .up_in_camera = up};
    follow.width = camera.width, follow.height = camera.height;
    follow.turns = options.turntable;
    view_.emplace(joints, track.motion.timestamps, follow);
  }
  if (has_studio) {
    studio_ = StudioBackdrop(camera.width, camera.height);
  }
}

PlacedBody FrameRenderer::Place(int frame, double turn_deg) const {
  if (!view_) return {TrackVertices(body_, SeenTrack(), frame), track_.CameraAt(frame), {}};
  const View view = view_->At(frame, turn_deg);
  return {view.Apply(TrackVertices(body_, track_, frame)), view.camera, view.from_camera};
}

void FrameRenderer::SetDepthRange(const std::vector<int>& frames) {
  double near_m = std::numeric_limits<double>::infinity(), far_m = 0;
  for (const int i : EvenlySpreadFrames(static_cast<int>(frames.size()), 60)) {
    const MatrixX3d vertices = Place(frames[i], 0).vertices;
    if (vertices.rows() == 0) {
      continue;
    }
    near_m = std::min(near_m, vertices.col(2).minCoeff());
    far_m = std::max(far_m, vertices.col(2).maxCoeff());
  }
  if (near_m < far_m) {
    near_m_ = std::floor(10 * near_m) / 10, far_m_ = std::ceil(10 * far_m) / 10;
  }
}

void FrameRenderer::DrawStudio(int frame, const PlacedBody& placed, Image* image) const {
  if (placed.camera.model != CameraModel::kPinhole || !floor_ || placed.vertices.rows() == 0) {
    return;
  }
  const CameraPose& view = placed.view_from_camera;
  const Floor floor = view_ ? Floor{MovedPoint(view, floor_->point), view.camera_from_world_rotation * floor_->up}
                            : FloorInCamera(*floor_, track_, frame);
  const Eigen::Vector3d centre = placed.vertices.colwise().mean().transpose();
  DrawFloorGrid(floor, centre, {}, placed.camera, image);
  DrawShadow(placed.vertices, body_.data().faces, floor, placed.camera, 0.35, image);
}

Image FrameRenderer::Draw(int frame, double turn_deg, const Image* background) {
  const PlacedBody placed = Place(frame, turn_deg);
  const bool is_overlay = options_.kind == RenderKind::kOverlay;
  Image image;
  if (background != nullptr) {
    image = *background;
  } else if (is_overlay) {
    image = studio_;
    DrawStudio(frame, placed, &image);
  } else {
    image = Image(placed.camera.width, placed.camera.height, kInkColour);
  }
  if (placed.vertices.rows() == 0) {
    return image;
  }
  if (is_overlay) {
    mesh_.Draw(placed.vertices, body_.data().faces, placed.camera,
               {.alpha = background != nullptr ? 0.72 : 1,
                .samples = placed.camera.height >= 600 ? 2 : 3,
                .num_threads = options_.num_threads},
               &image);
    return image;
  }
  AttributeImageOptions attribute;
  attribute.attribute = AttributeOf(options_.kind);
  attribute.near_m = near_m_, attribute.far_m = far_m_;
  attribute.texture = options_.texture;
  std::vector<float> errors;
  if (options_.kind == RenderKind::kError) {
    errors = VertexErrors(frame);
    attribute.vertex_errors = errors;
    attribute.error_maximum = options_.error_maximum;
  }
  attribute.num_threads = options_.num_threads;
  attributes_.Draw(body_, placed.vertices, placed.camera, attribute, &image);
  return image;
}

std::vector<float> FrameRenderer::VertexErrors(int frame) const {
  const Eigen::VectorXd errors = VertexErrorsOfFrame(SeenTrack(), *options_.truth, frame, body_, options_.error_unit);
  if (errors.size() == 0) return std::vector<float>(body_.num_vertices(), std::numeric_limits<float>::quiet_NaN());
  return {errors.begin(), errors.end()};
}

std::optional<ErrorScale> FrameRenderer::Scale() const {
  if (options_.kind != RenderKind::kError) return std::nullopt;
  if (options_.error_unit == VertexErrorUnit::kPixels) {
    return ErrorScale{options_.error_maximum, "px", "projection error, longer side 512 px"};
  }
  return ErrorScale{options_.error_maximum, "mm", "vertex error, pelvis on pelvis"};
}

std::string FrameRenderer::Caption(int frame, double turn_deg) const {
  std::string text = "frame " + std::to_string(frame) + "   " + Fixed(track_.motion.timestamps[frame], 2) + " s   " +
                     ToString(track_.frame_status[frame]);
  if (track_.frame_status[frame] == FrameStatus::kLost) {
    text += ", no body";
  }
  if (view_) {
    double yaw = std::fmod(options_.view_yaw_deg + turn_deg, 360.0);
    yaw += yaw < 0 ? 360 : 0;
    text += "   from " + Fixed(yaw, 0) + " deg";
  }
  return text;
}

std::string FrameRenderer::Legend() const {
  switch (options_.kind) {
    case RenderKind::kOverlay:
    case RenderKind::kTexture:
      return "";
    case RenderKind::kError:
      return Scale()->ToText();
    case RenderKind::kIuv:
      return "chart coordinates: red u, green v, blue the part";
    case RenderKind::kParts:
      return "parts: warm on the person's left, cool on its right";
    case RenderKind::kNormal:
      return "normals: red right, green up, blue towards the viewer";
    case RenderKind::kDepth:
      return "depth: " + Fixed(near_m_, 1) + " m warm to " + Fixed(far_m_, 1) + " m cold";
  }
  return "";
}

}  // namespace bodyloom
