// SPDX-License-Identifier: Apache-2.0
/// The panel beside an overlay in which the same scene is seen from its side, where errors in depth show.
#pragma once

#include <vector>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/render/floor.h"
#include "bodyloom/render/follow_view.h"
#include "bodyloom/render/image.h"
#include "bodyloom/render/view_camera.h"

namespace bodyloom {

class SidePanel {
 public:
  /// As FollowView, whose view it shows.
  SidePanel(const std::vector<MatrixX3d>& joints, const std::vector<double>& timestamps,
            const FollowViewOptions& options, const std::vector<MatrixX3d>& others = {});

  /// What is drawn into at one moment: the image with the floor's grid, and whence it is seen.
  struct Picture {
    View view;
    Floor floor;  ///< in the view's camera
    Image image;
  };
  /// Frame t of the joints; `floor` in the frame of the joints.
  [[nodiscard]] Picture At(int t, const Floor& floor) const;

  [[nodiscard]] int width() const { return backdrop_.width; }

 private:
  FollowView follow_;
  Image backdrop_;
};

/// A picture with another one of the same height to its right.
Image Beside(const Image& left, const Image& right);

}  // namespace bodyloom
