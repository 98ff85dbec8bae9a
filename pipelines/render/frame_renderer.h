// SPDX-License-Identifier: Apache-2.0
/// Renders one frame of a track for RenderTrack, from the track's camera or from a camera that turns about the person.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data_tools/evaluation/vertex_errors.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"
#include "render/image/image.h"
#include "render/view/attribute_image.h"
#include "render/view/error_colours.h"
#include "render/view/floor.h"
#include "render/view/follow_view.h"
#include "render/view/shaded_mesh.h"

namespace bodyloom {

/// Content of a rendered image.
enum class RenderKind { kOverlay, kIuv, kParts, kNormal, kDepth, kTexture, kError };
/// "overlay", "iuv", …; throws std::invalid_argument for other names.
RenderKind RenderKindFromString(const std::string& name);
std::string ToString(RenderKind kind);

struct FrameRendererOptions {
  RenderKind kind = RenderKind::kOverlay;
  bool new_view = false;    ///< from a camera that follows the person
  double view_yaw_deg = 0;  ///< 90: from the person's left when it faces the camera
  bool turntable = false;   ///< the new view's camera will be turned
  TexelAttribute texture = {};
  const Track* truth = nullptr;  ///< kError: true track, compared frame by frame in its cameras
  VertexErrorUnit error_unit = VertexErrorUnit::kMillimetres;
  double error_maximum = 1;  ///< in that unit: the last colour
  int num_threads = 1;
};

/// A body in the frame of the camera that renders it.
struct PlacedBody {
  MatrixX3d vertices;  ///< camera frame of the view; no rows: the frame is lost
  Camera camera;
  CameraPose view_from_camera;  ///< for a new view, from the track's frame; otherwise identity
};

/// Not for use by two threads at once. Borrows body, track, texture and truth.
class FrameRenderer {
 public:
  /// Throws std::runtime_error, beginning with `where`, when the body lacks data for this kind, the camera has no image
  /// size, or a new view is requested of a track without a known frame.
  FrameRenderer(const BodyModel& body, const Track& track, const FrameRendererOptions& options,
                const std::string& where);

  [[nodiscard]] PlacedBody Place(int frame, double turn_deg) const;
  /// Sets the colour range of depth maps, metres, from the nearest and farthest vertex of these frames (sampled).
  void SetDepthRange(const std::vector<int>& frames);

  /// Draws a frame. `background` has the camera's size; null: a studio (kOverlay) or a plain colour.
  [[nodiscard]] Image Draw(int frame, double turn_deg, const Image* background);
  /// Error of every vertex in a frame; NaN where the frame is lost on either side.
  [[nodiscard]] std::vector<float> VertexErrors(int frame) const;
  /// Scale of the error colours; empty for other kinds.
  [[nodiscard]] std::optional<ErrorScale> Scale() const;
  /// "frame 12   0.40 s   tracked", and for a turned camera by how much.
  [[nodiscard]] std::string Caption(int frame, double turn_deg) const;
  /// Legend of the colours; empty for kinds that need none.
  [[nodiscard]] std::string Legend() const;

 private:
  void DrawStudio(int frame, const PlacedBody& placed, Image* image) const;
  [[nodiscard]] const Track& SeenTrack() const { return track_.HasMovingCamera() ? in_cameras_ : track_; }

  const BodyModel& body_;
  const Track& track_;
  Track in_cameras_;  ///< of a camera that moves: the track as each frame's camera saw it
  FrameRendererOptions options_;
  std::optional<FollowView> view_;
  std::optional<Floor> floor_;  ///< the track's frame: the camera's, or the scene of one that moves
  Image studio_;
  double near_m_ = 1, far_m_ = 5;
  MeshDrawer mesh_;
  AttributePainter attributes_;
};

}  // namespace bodyloom
