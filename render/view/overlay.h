// SPDX-License-Identifier: Apache-2.0
/// Draws overlays to judge a track: the projected body over the video (or a plain backdrop), detected and projected
/// landmarks, a caption, and optionally a side view, where errors in depth, lean and height over the floor are visible.
/// With a moving camera the overlay uses each frame's camera, the side view the scene frame.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"
#include "render/image/image.h"
#include "render/view/caption.h"
#include "render/view/floor.h"
#include "render/view/follow_view.h"
#include "render/view/shaded_mesh.h"
#include "render/view/side_panel.h"

namespace bodyloom {

/// Colouring of the estimated body.
enum class BodyColours {
  kPlain,    ///< one colour
  kParts,    ///< by chart; needs a body with parts
  kClothes,  ///< shirt, trousers, shoes, skin; needs a body with parts
};

struct OverlayOptions {
  bool body = true;
  double alpha = 0.72;  ///< opacity of the body over the video
  BodyColours colours = BodyColours::kPlain;
  bool skeleton = false;     ///< bones between the projected landmarks
  bool floor = true;         ///< without video: a floor with the body's shadow (pinhole only)
  bool side_view = false;    ///< a second panel to the right, as high as the image
  bool side_follows = true;  ///< the side camera follows the person; false: it sees the whole clip's space
  double side_yaw_deg = 90;  ///< 90: from the person's left when it faces the camera
  double side_elevation_deg = 8;
  double side_aspect = 0.75;  ///< width of the panel / its height
  /// For the floor and the side view of a tilted camera, where no ground is known (FloorOfWorld()).
  Eigen::Vector3d up_in_camera = -Eigen::Vector3d::UnitY();
  double min_confidence = 0.1;  ///< detections below are not drawn
  int num_threads = 1;          ///< the picture is the same for any number
  /// False with the reason when a field is out of range.
  bool IsValid(std::string* why) const;
  /// The view of the side panel beside a picture of this height.
  [[nodiscard]] FollowViewOptions SideView(int height) const;
};

/// Height of the letters of an overlay's captions, pixels.
double OverlayCaptionHeight(int image_height);
/// Samples per pixel along x and y for bodies in an overlay; fewer for large pictures.
int OverlaySamples(int image_height);

/// Content of one picture besides the body. Pointers are borrowed and may be null.
struct OverlayFrame {
  const Image* background = nullptr;           ///< of the camera's size; null: a plain backdrop
  const KeypointSequence* detected = nullptr;  ///< drawn as discs, the track's own landmarks as rings
  std::vector<CaptionLine> caption = {};       ///< top left
};

/// Not for use by two threads at once; copies are.
class OverlayRenderer {
 public:
  /// Borrows everything. `reference` (may be null): the true track, drawn beside the estimate in the side view. Throws
  /// std::invalid_argument when the track has no image size or no frame, or options are out of range.
  OverlayRenderer(const BodyModel& body, const Track& track, const OverlayOptions& options = {},
                  const Track* reference = nullptr);

  /// Size of the pictures, side panel included.
  [[nodiscard]] int width() const { return track_.camera.width + (side_ ? side_->width() : 0); }
  [[nodiscard]] int height() const { return track_.camera.height; }

  /// Renders a frame; lost frames show no body. Throws std::invalid_argument when `frame` is not in the track or the
  /// background has another size than the camera.
  [[nodiscard]] Image Render(int frame, const OverlayFrame& what) const;

 private:
  [[nodiscard]] Image Backdrop(int frame, const MatrixX3d& vertices, const Camera& camera) const;
  [[nodiscard]] MeshStyle Style(double alpha) const;
  [[nodiscard]] Image Side(int frame) const;

  const BodyModel& body_;
  const Track& track_;
  const Track* reference_;
  OverlayOptions options_;
  std::vector<Colour> face_colours_;
  std::optional<SidePanel> side_;
  Image backdrop_;
  std::optional<Floor> floor_;  ///< the track's frame
  mutable MeshDrawer drawer_;   ///< reuses its memory
};

/// The pose of frame t in its camera frame; empty when the frame is lost.
std::optional<BodyPose> PoseInCamera(const BodyModel& body, const Track& track, int frame);

/// Transforms a floor from the track's frame to the camera of frame t.
Floor FloorInCamera(const Floor& floor, const Track& track, int frame);

/// The body of frame t of a track, V×3 in the track's frame (camera frame, or scene frame of a moving camera); empty
/// when the frame is lost.
MatrixX3d TrackVertices(const BodyModel& body, const Track& track, int frame);

}  // namespace bodyloom
