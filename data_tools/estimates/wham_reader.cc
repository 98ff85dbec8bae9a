// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/estimates/wham_reader.h"

#include <cmath>
#include <utility>

#include "bodyloom/data_tools/body/mean_pelvis.h"
#include "bodyloom/data_tools/estimates/estimate_arrays.h"
#include "bodyloom/data_tools/formats/printable.h"
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
  BodyEstimate estimate;
  estimate.system = "WHAM";
  estimate.body = "smpl";
  estimate.rest_pelvis = MeanPelvis(estimate.body);
  const Camera camera = CentredCamera(image_width, image_height, std::hypot(image_width, image_height));
  for (const auto& [name, value] : file.dict) {
    const std::string place = where + ": person " + PrintableText(name);
    PersonEstimate& person = estimate.people.emplace_back();
    person.name = name;
    person.poses = RequireShape(RequireNumbers(*value, "pose", place), {-1, 72}, place, "pose");
    const int64_t n = person.poses.rows();
    person.trans = RequireShape(RequireNumbers(*value, "trans", place), {n, 3}, place, "trans");
    person.betas = MeanBetas(RequireNumbers(*value, "betas", place), n, place);
    person.frames = RequireFrameNumbers(RequireNumbers(*value, "frame_ids", place), n, place, "frame_ids");
    person.cameras.assign(person.frames.size(), camera);
  }
  SortEstimate(where, &estimate);
  return estimate;
}

}  // namespace bodyloom
