// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/detection_readers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "data_tools/formats/printable.h"
#include "data_tools/observations/keypoint_conventions.h"
#include "geometry/base/units.h"
#include "geometry/scene/observations.h"

namespace bodyloom {
namespace {

constexpr double kMicrosecond = 1e-6;
constexpr int64_t kMaxViews = 99;  ///< names have two digits

std::string ViewName(int64_t index) {
  char name[16];
  std::snprintf(name, sizeof(name), "c%02d", static_cast<int>(index) + 1);
  return name;
}

int64_t FindView(const std::string& view, int64_t num_views, const std::string& where) {
  if (view.empty() && num_views == 1) return 0;
  std::vector<std::string> present;
  for (int64_t v = 0; v < std::min(num_views, kMaxViews); ++v) {
    if (ViewName(v) == view) return v;
    present.push_back(ViewName(v));
  }
  throw std::runtime_error(where + ": " + (view.empty() ? "no view chosen" : "no view '" + view + "'") +
                           "; the file has " + PrintableList(present));
}

std::vector<double> Timestamps(const PickleValue& file, int64_t num_frames, double fps, const std::string& where) {
  std::vector<double> timestamps(num_frames);
  if (file.Find("timestamps") == nullptr) {
    for (int64_t t = 0; t < num_frames; ++t) timestamps[t] = static_cast<double>(t) / fps;
    return timestamps;
  }
  const std::vector<double> microseconds = RequireNumbers(file, "timestamps", where).ToDoubles();
  if (static_cast<int64_t>(microseconds.size()) != num_frames) {
    throw std::runtime_error(where + ": timestamps: " + std::to_string(microseconds.size()) + " values, expected " +
                             std::to_string(num_frames) + ", one a frame");
  }
  for (int64_t t = 0; t < num_frames; ++t) {
    timestamps[t] = microseconds[t] * kMicrosecond;
    if (!std::isfinite(timestamps[t]) || (t > 0 && !(timestamps[t] > timestamps[t - 1]))) {
      throw std::runtime_error(where + ": timestamps[" + std::to_string(t) + "]: " + std::to_string(microseconds[t]) +
                               ", expected finite, increasing microseconds");
    }
  }
  return timestamps;
}

}  // namespace

bool IsAistKeypoints2d(const PickleValue& file) { return file.Find("keypoints2d") != nullptr; }

KeypointSequence AistKeypoints2dFromPickle(const PickleValue& file, const std::string& where, const std::string& view,
                                           double fps) {
  const NdArray& array = RequireNumbers(file, "keypoints2d", where);
  if (array.shape.size() != 4 || (array.shape[2] != 17 && array.shape[2] != 25) || array.shape[3] != 3 ||
      array.shape[1] == 0) {
    throw std::runtime_error(where + ": keypoints2d: shape " + array.ShapeText() +
                             ", expected views x frames x 17 (COCO) or 25 (BODY_25) x 3");
  }
  const int64_t num_frames = array.shape[1], num_points = array.shape[2];
  const int64_t v = FindView(view, array.shape[0], where);
  const KeypointConvention& convention = num_points == 17 ? Coco17() : Body25();
  KeypointSequence sequence;
  sequence.convention = convention.name;
  sequence.names = convention.names;
  sequence.timestamps = Timestamps(file, num_frames, fps, where);
  sequence.points.resize(static_cast<size_t>(num_frames * num_points));
  const std::vector<float> values = array.ToFloats();
  const float* view_values = values.data() + v * num_frames * num_points * 3;
  bool any = false;
  for (size_t i = 0; i < sequence.points.size(); ++i) {
    const float x = view_values[3 * i], y = view_values[3 * i + 1], score = view_values[3 * i + 2];
    if (!std::isfinite(x) || !std::isfinite(y) || !(score > 0)) continue;  // NaN: the frame has no detection
    sequence.points[i] = {x, y, std::min(score, 1.0F)};
    any = true;
  }
  if (!any) throw NoPersonFound(where + ": nobody was detected in view " + ViewName(v));
  return sequence;
}

std::vector<MatrixX3d> ReadAistKeypoints3d(const std::string& path, bool optimised) {
  const PicklePtr file = ReadPickleFile(path);
  const std::string key = optimised ? "keypoints3d_optim" : "keypoints3d";
  const NdArray& array = RequireNumbers(*file, key, path);
  if (array.shape.size() != 3 || array.shape[1] != 17 || array.shape[2] != 3) {
    throw std::runtime_error(path + ": " + key + ": shape " + array.ShapeText() + ", expected frames x 17 x 3");
  }
  const std::vector<double> values = array.ToDoubles();
  std::vector<MatrixX3d> frames(array.shape[0]);
  for (size_t t = 0; t < frames.size(); ++t) {
    frames[t] = Eigen::Map<const MatrixX3d>(values.data() + t * 51, 17, 3) * kCentimetre;
  }
  return frames;
}

}  // namespace bodyloom
