// SPDX-License-Identifier: Apache-2.0
/// Frames of a person made from photos, several drawn at once.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bodyloom/pipelines/person/draw_person.h"

namespace bodyloom {

/// Blue, green, red, not multiplied, and alpha; zeros where nobody is.
std::vector<uint8_t> BgraOf(const DrawnPerson& person);

/// Not for use by two threads at once.
class PersonFramePainter {
 public:
  /// `person` must outlive this. `threads` frames are drawn at once. Pictures are the same for any number.
  PersonFramePainter(const PhotoPerson& person, int threads);

  [[nodiscard]] int at_once() const { return static_cast<int>(painters_.size()); }

  /// At most at_once() poses; nobody is in the picture of one without vertices. Throws std::invalid_argument for more.
  std::vector<DrawnPerson> Draw(std::span<const PersonPose> poses);

 private:
  std::vector<std::unique_ptr<PersonPainter>> painters_;
};

}  // namespace bodyloom
