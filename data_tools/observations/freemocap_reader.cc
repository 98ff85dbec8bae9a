// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/detection_readers.h"

#include <cmath>

#include "data_tools/formats/printable.h"
#include "data_tools/observations/keypoint_conventions.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int64_t kMaxFreeMocapFrames = 1'000'000, kFreeMocapRtmPosePoints = 133;

}  // namespace

int64_t FindArrayCamera(const std::string& view, int64_t num_cameras, const std::string& where) {
  if (view.empty() && num_cameras == 1) return 0;
  for (int64_t c = 0; c < num_cameras && c < 1000; ++c) {
    if (std::to_string(c) == view) return c;
  }
  ThrowFileError(where, Concatenate(view.empty() ? "no view chosen" : "no view '" + PrintableText(view) + "'",
                                    "; the file has ", num_cameras, " cameras, 0 to ", num_cameras - 1, " (--view 0)"));
}

bool IsFreeMocap(const NdArray& array) {
  const size_t rank = array.shape.size();
  if (!array.is_number() || rank < 3 || rank > 4) return false;
  const int64_t num_points = array.shape[rank - 2], per_point = array.shape[rank - 1];
  const bool may_be_bare = rank == 3 && per_point == 3 && ConventionOfCount(static_cast<size_t>(num_points)) != nullptr;
  return num_points >= static_cast<int64_t>(MediaPipe33().names.size()) && (per_point == 2 || per_point == 3) &&
         !may_be_bare;
}

KeypointSequence FreeMocapFromArray(const NdArray& array, const std::string& where, const std::string& view,
                                    double fps) {
  const char* expected = "expected FreeMoCap's 2D landmarks, cameras x frames x points x 2";
  if (!array.is_number()) ThrowFileError(where, std::string("an array without numbers, ") + expected);
  const size_t rank = array.shape.size();
  if (rank == 3 && array.shape[2] == 3) {
    ThrowFileError(
        where, Concatenate("an array of ", array.ShapeText(), ": 3D points, which are no detections of one camera; ",
                           expected, " (raw_data/…2dData…)"));
  }
  const bool has_cameras = rank == 4 && (array.shape[3] == 2 || array.shape[3] == 3);
  if (!has_cameras && !(rank == 3 && array.shape[2] == 2)) {
    ThrowFileError(where, Concatenate("an array of ", array.ShapeText(), ", ", expected));
  }
  const size_t first = has_cameras ? 1 : 0;
  const int64_t num_cameras = has_cameras ? array.shape[0] : 1, num_frames = array.shape[first],
                num_points = array.shape[first + 1], per_point = array.shape[first + 2];
  const KeypointConvention& convention = num_points == kFreeMocapRtmPosePoints ? CocoWholeBody23() : MediaPipe33();
  if (num_points < static_cast<int64_t>(convention.names.size())) {
    ThrowFileError(where, Concatenate(num_points, " points, expected MediaPipe's 33 or more, or RTMPose's 133"));
  }
  if (num_frames < 1 || num_frames > kMaxFreeMocapFrames || num_cameras < 1) {
    ThrowFileError(where,
                   Concatenate("an array of ", array.ShapeText(), ", expected 1 to ", kMaxFreeMocapFrames, " frames"));
  }
  const int64_t camera = FindArrayCamera(view, num_cameras, where);
  const std::vector<double> values = array.ToDoubles();
  KeypointSequence sequence;
  sequence.convention = convention.name;
  sequence.names = convention.names;
  sequence.points.resize(static_cast<size_t>(num_frames) * convention.names.size());
  for (int t = 0; t < static_cast<int>(num_frames); ++t) {
    sequence.timestamps.push_back(t / fps);
    for (int k = 0; k < sequence.num_points(); ++k) {
      const double* point = values.data() + ((camera * num_frames + t) * num_points + k) * per_point;
      if (!std::isfinite(point[0]) || !std::isfinite(point[1])) continue;
      sequence.at(t, k) = {static_cast<float>(point[0]), static_cast<float>(point[1]), 1.0F};
    }
  }
  return sequence;
}

}  // namespace bodyloom
