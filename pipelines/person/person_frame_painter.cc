// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/person_frame_painter.h"

#include <algorithm>
#include <cmath>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/parallel.h"

namespace bodyloom {

std::vector<uint8_t> BgraOf(const DrawnPerson& person) {
  std::vector<uint8_t> bgra(4 * person.coverage.size(), 0);
  for (size_t p = 0; p < person.coverage.size(); ++p) {
    if (person.coverage[p] == 0) continue;
    for (size_t c = 0; c < 3; ++c) {
      bgra[4 * p + c] =
          static_cast<uint8_t>(std::min(255.0, std::round(255.0 * person.picture.bgr[3 * p + c] / person.coverage[p])));
    }
    bgra[4 * p + 3] = person.coverage[p];
  }
  return bgra;
}

PersonFramePainter::PersonFramePainter(const PhotoPerson& person, int threads) {
  for (int i = 0; i < std::max(1, threads); ++i) painters_.push_back(std::make_unique<PersonPainter>(person, 1));
}

std::vector<DrawnPerson> PersonFramePainter::Draw(std::span<const PersonPose> poses) {
  BODYLOOM_CHECK(poses.size() <= painters_.size(), "drawing people: ", poses.size(), " frames at once, expected up to ",
                 painters_.size());
  std::vector<DrawnPerson> drawn(poses.size());
  ParallelFor(static_cast<int>(poses.size()), at_once(), [&](int i) {
    const Camera& camera = poses[i].camera;
    drawn[i] = {Image(camera.width, camera.height),
                std::vector<uint8_t>(static_cast<size_t>(camera.width) * camera.height, 0)};
    if (poses[i].vertices_in_camera.rows() == 0) return;
    painters_[i]->Draw(poses[i].vertices_in_camera, camera, &drawn[i].picture, &drawn[i].coverage);
  });
  return drawn;
}

}  // namespace bodyloom
