// SPDX-License-Identifier: Apache-2.0
/// The terms of one frame, and its camera where that moves. Borrowed pointers outlive the cost.
#pragma once

#include "bodyloom/geometry/camera.h"
#include "bodyloom/tracking/problem/frame_term.h"

namespace bodyloom {

struct FrameData {
  /// Of a camera that moves: a frame's state is in the scene, and its terms speak of this camera's frame
  /// (moving_camera.h). Null: the camera stands still.
  const CameraPose* camera_from_scene = nullptr;
  TermList terms;

  /// As of TermList.
  template <typename Term>
  Term& Get() {
    return terms.Get<Term>();
  }
  template <typename Term>
  [[nodiscard]] const Term& Get() const {
    return terms.Get<Term>();
  }
};

}  // namespace bodyloom
