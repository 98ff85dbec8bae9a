// SPDX-License-Identifier: Apache-2.0
/// Overlay of several people: their bodies over the video as one scene, nearer ones in front pixel by pixel, each in a
/// colour of their own; and on request the scene from its side, where errors in depth show.
#pragma once

#include <optional>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"
#include "render/image/image.h"
#include "render/view/floor.h"
#include "render/view/overlay.h"
#include "render/view/shaded_mesh.h"

namespace bodyloom {

/// One of them. Pointers are borrowed.
struct PersonInOverlay {
  const BodyModel* body = nullptr;
  const Track* track = nullptr;
  const KeypointSequence* detected = nullptr;  ///< may be null; the frames of the track
  int number = 0;                              ///< in the caption; chooses the colour (PersonColour)
};

/// Not for use by two threads at once; copies are.
class PeopleOverlay {
 public:
  /// Tracks of one camera (pinhole) and one clip: frames of two people are the same moment when their timestamps are
  /// equal. Of the options `colours`, `skeleton` and `body` are not used. Throws std::invalid_argument when there is
  /// nobody, when the image sizes differ or are not known, when a camera is not a pinhole, and when options are out of
  /// range. `ground`: where the floor is, camera frame; without it just under the lowest joint of all.
  explicit PeopleOverlay(std::vector<PersonInOverlay> people, const OverlayOptions& options = {},
                         const std::optional<Floor>& ground = std::nullopt);

  /// The moments at which anybody was followed, seconds, increasing.
  [[nodiscard]] const std::vector<double>& timestamps() const { return timestamps_; }
  /// Size of the pictures, side panel included.
  [[nodiscard]] int width() const { return camera().width + (side_ ? side_->width() : 0); }
  [[nodiscard]] int height() const { return camera().height; }

  /// The picture of one moment; `background` has the camera's size or is null: a plain backdrop. Whoever is not there
  /// at that moment, or lost, is not drawn. Throws std::invalid_argument when the moment is none of timestamps() or the
  /// background has another size.
  [[nodiscard]] Image Render(int moment, const Image* background) const;

 private:
  /// Everybody's bodies at one moment as one mesh.
  struct Scene {
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
  /// From where a moment was seen by a camera that moves; nothing: it stands still.
  [[nodiscard]] std::optional<Seen> SeenFrom(int moment) const;
  [[nodiscard]] Scene SceneAt(int moment) const;
  [[nodiscard]] MeshStyle Style(const Scene& scene, double alpha) const;
  [[nodiscard]] Image Side(int moment, const Scene& scene) const;
  void DrawCaptions(int moment, Image* image) const;

  std::vector<PersonInOverlay> people_;
  OverlayOptions options_;
  std::vector<double> timestamps_;
  std::vector<std::vector<int>> frames_;  ///< [person][moment]: frame of the person's track, −1: not there
  std::optional<SidePanel> side_;
  std::optional<Floor> floor_;  ///< camera frame
  Image backdrop_;
  mutable MeshDrawer drawer_;  ///< memory used again
};

}  // namespace bodyloom
