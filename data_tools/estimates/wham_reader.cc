// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/estimates/wham_reader.h"

#include <cmath>

#include "bodyloom/data_tools/estimates/estimate_arrays.h"
#include "bodyloom/geometry/base/refuse.h"

namespace bodyloom {

bool IsWham(const PickleValue& file) {
  if (file.dict.empty()) return false;
  const PickleValue& person = *file.dict.front().second;
  return person.Find("pose") != nullptr && person.Find("trans") != nullptr && person.Find("frame_ids") != nullptr;
}

BodyEstimate WhamFromPickle(const PickleValue& file, const std::string& where, int image_width, int image_height) {
  if (image_width <= 0 || image_height <= 0) {
    Refuse(where, "WHAM: its camera follows from the image size, which is not known; give --video or --image-size");
  }
  const Camera camera = CentredCamera(image_width, image_height, std::hypot(image_width, image_height));
  return SmplPeople(
      file, where, "WHAM", [&](const PickleValue& values, const std::string& place, PersonEstimate* person) {
        person->trans = RequireShape(RequireNumbers(values, "trans", place), {person->poses.rows(), 3}, place, "trans");
        person->cameras.assign(person->frames.size(), camera);
      });
}

}  // namespace bodyloom
