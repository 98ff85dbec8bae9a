// SPDX-License-Identifier: Apache-2.0
/// The panel beside an overlay that shows people from their side, where errors in depth, lean and height are visible:
/// one cell a person, each with a camera that follows that person alone, so somebody far away makes nobody small.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "render/image/image.h"
#include "render/view/floor.h"
#include "render/view/follow_view.h"
#include "render/view/shaded_mesh.h"
#include "render/view/view_camera.h"

namespace bodyloom {

/// Somebody to show; T frames each, no rows where nothing is known, the frame of the floor.
struct SidePanelPerson {
  std::vector<MatrixX3d> joints;       ///< J×3; the camera follows the first one
  std::vector<MatrixX3d> others = {};  ///< kept in view too (the true joints); or empty
  Eigen::VectorXd level_m = {};        ///< of what supports the person over the floor, metres; empty: the floor
};

class SidePanel {
 public:
  static constexpr int kMostPeople = 3;

  /// The first kMostPeople of `people`, or fewer: as many as have cells in which an adult's height is at least a
  /// quarter of the panel's. Cells are of the same size, above each other or side by side, whichever shows the
  /// smallest person larger. `options`: arguments of FollowView, with the size of the whole panel. Throws
  /// std::invalid_argument for no people, and as FollowView.
  SidePanel(const std::vector<SidePanelPerson>& people, const std::vector<double>& timestamps,
            const FollowViewOptions& options, const Floor& floor);

  [[nodiscard]] int width() const { return width_; }
  /// People shown: the first ones of those given.
  [[nodiscard]] int num_cells() const { return static_cast<int>(cells_.size()); }

  /// A cell's picture at one moment, its view and the floor in the view's camera.
  struct Picture {
    View view;
    Floor floor;
    Image image;
  };
  /// The grid of the floor, at the level that supports the person, and nobody, at frame t of the joints.
  [[nodiscard]] Picture At(int cell, int t) const;

  /// Places the cells' pictures, one for each, in the panel.
  [[nodiscard]] Image Joined(const std::vector<Picture>& pictures) const;

 private:
  struct Cell {
    int x = 0, y = 0;
    FollowView follow;
    Image backdrop;
    Eigen::VectorXd level_m;
  };
  static std::vector<Cell> Arranged(const std::vector<SidePanelPerson>& people, const std::vector<double>& timestamps,
                                    const FollowViewOptions& options, bool stacked);
  /// Pixels a metre of the smallest person.
  static double SmallestScale(const std::vector<Cell>& cells);

  int width_, height_;
  Floor floor_;
  std::vector<Cell> cells_;
};

/// A body to draw into a cell.
struct BodyInPanel {
  MatrixX3d vertices;  ///< in the camera frame of the panel's people; no rows: nobody
  const MatrixX3i* faces = nullptr;
  MeshStyle style;
  bool marks = true;  ///< draw its contact with the floor
};

/// Draws the body's shadow straight below it, the body, and where it touches the floor or how far it is from it
/// (DrawFloorContact()), numbers with letters of this height, pixels.
void DrawInPanel(const BodyInPanel& body, double caption_height, MeshDrawer* drawer, SidePanel::Picture* picture);

/// Concatenates two pictures of the same height horizontally.
Image Beside(const Image& left, const Image& right);

// Marks on a floor that show at a glance whether a body stands on it, hovers or is below it.

/// Surface up to this far above or below the floor touches it, metres: what a sole gives way and a fit is uncertain.
inline constexpr double kTouchesFloorM = 0.02;

struct FloorContact {
  double lowest_m = 0;                               ///< height of the lowest vertex over the floor, < 0: below it
  Eigen::Vector3d lowest = Eigen::Vector3d::Zero();  ///< that vertex
  std::vector<Eigen::Vector3d> touching;             ///< on the floor, below the parts that touch it, at most 12
};

/// Finds where a body (vertices in the camera frame, at least one) touches a floor: its lowest vertex, then the lowest
/// one that is 12 cm from it along the floor, and so on, those of them within kTouchesFloorM of the floor. A standing
/// foot has two: ball and heel.
FloorContact ContactWithFloor(const MatrixX3d& vertices, const Floor& floor);

/// Draws a green disc, 4 cm in radius, where the body touches the floor. Where its lowest point does not, a line from
/// there straight to the floor with bars at its ends, and its height in cm ("12 cm", letters cap_px high): dark above
/// the floor, red below.
void DrawFloorContact(const FloorContact& contact, const Floor& floor, const Camera& camera, double cap_px,
                      Image* image);

}  // namespace bodyloom
