// SPDX-License-Identifier: Apache-2.0
/// Draws overlays of several people: their bodies over the video as one scene with correct occlusion, each in its own
/// colour, and optionally a side view (render/view/side_panel.h) of up to three people, the largest in the image.
#pragma once

#include <optional>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/hands_and_face.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"
#include "render/image/image.h"
#include "render/view/floor.h"
#include "render/view/overlay.h"
#include "render/view/shaded_mesh.h"

namespace bodyloom {

/// One person of the overlay. Pointers are borrowed.
struct PersonInOverlay {
  const BodyModel* body = nullptr;
  const Track* track = nullptr;
  const KeypointSequence* detected = nullptr;            ///< may be null; the frames of the track
  const HandsAndFaceSequence* hands_and_face = nullptr;  ///< the same
  int number = 0;                                        ///< in the caption; determines the colour (PersonColour)
};

/// Not for use by two threads at once; copies are.
class PeopleOverlay {
 public:
  /// Tracks of one camera (pinhole) and one clip: frames of two people are the same moment when their timestamps are
  /// equal. The options `colours`, `skeleton` and `body` are not used. Throws std::invalid_argument for no people,
  /// image sizes that differ or are not known, a camera that is not a pinhole, and options out of range. `ground`: the
  /// floor, camera frame; by default just below the lowest joint of all.
  explicit PeopleOverlay(std::vector<PersonInOverlay> people, const OverlayOptions& options = {},
                         const std::optional<Floor>& ground = std::nullopt);

  /// Times at which anybody is tracked, seconds, increasing.
  [[nodiscard]] const std::vector<double>& timestamps() const { return timestamps_; }
  /// Size of the pictures, side panel included.
  [[nodiscard]] int width() const { return camera().width + (side_ ? side_->width() : 0); }
  [[nodiscard]] int height() const { return camera().height; }

  /// Renders one moment; `background` has the camera's size or is null: a plain backdrop. People absent or lost at that
  /// moment are not drawn. Throws std::invalid_argument when the moment is not an index of timestamps() or the
  /// background has another size.
  [[nodiscard]] Image Render(int moment, const Image* background) const;

 private:
  /// All bodies at one moment, and as one mesh.
  struct Scene {
    std::vector<MatrixX3d> bodies;  ///< by person; no rows: absent or lost
    MatrixX3d vertices;
    MatrixX3i faces;
    std::vector<Colour> colours;  ///< of faces
  };

  /// A frame of a track whose camera moves.
  struct Seen {
    const Track* track = nullptr;
    int frame = 0;
  };

  [[nodiscard]] const Camera& camera() const { return people_[0].track->camera; }
  /// Track and frame that give a moving camera's pose at a moment; empty for a static camera.
  [[nodiscard]] std::optional<Seen> SeenFrom(int moment) const;
  [[nodiscard]] Scene SceneAt(int moment) const;
  [[nodiscard]] MeshStyle Style() const;
  [[nodiscard]] Image Side(int moment, const Scene& scene) const;
  void DrawCaptions(int moment, Image* image) const;

  std::vector<PersonInOverlay> people_;
  OverlayOptions options_;
  std::vector<double> timestamps_;
  std::vector<std::vector<int>> frames_;  ///< [person][moment]: frame of the person's track, −1: absent
  std::optional<SidePanel> side_;
  std::vector<size_t> in_panel_;  ///< people by cell of the panel
  std::optional<Floor> floor_;    ///< camera frame
  Image backdrop_;
  mutable MeshDrawer drawer_;  ///< reuses its memory
};

}  // namespace bodyloom
