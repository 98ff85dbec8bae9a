// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/detection_readers.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "data_tools/formats/printable.h"
#include "data_tools/observations/keypoint_conventions.h"
#include "data_tools/observations/people.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int64_t kMaxArrayFrames = 1'000'000;
constexpr double kMinExtent_px = 20, kMaxFaceShare = 0.4;
constexpr int kFacePoints = 5;

const KeypointConvention& ConventionOfArray(int64_t num_points, const std::string& wanted, const std::string& where) {
  const KeypointConvention* by_count = ConventionOfCount(static_cast<size_t>(num_points));
  if (wanted.empty()) {
    if (by_count != nullptr) return *by_count;
    ThrowFileError(where, Concatenate(num_points,
                                      " points, expected 17 (COCO), 23 or 133 (COCO-WholeBody), 26 or 136 (Halpe), or "
                                      "the order of others (--convention)"));
  }
  std::string all;
  for (const KeypointConvention* convention : KnownConventions()) {
    all += (all.empty() ? "" : ", ") + convention->name;
    if (convention->name != wanted) continue;
    if (static_cast<int64_t>(convention->names.size()) != num_points && convention != by_count) {
      ThrowFileError(where,
                     Concatenate(num_points, " points, expected the ", convention->names.size(), " of ", wanted));
    }
    return *convention;
  }
  ThrowFileError(where, "convention '" + PrintableText(wanted) + "', expected one of " + all);
}

/// Longer side of the box of the first n points that were seen; NaN if none was.
double ExtentOf(const KeypointSequence& sequence, int t, int n) {
  double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  for (int k = 0; k < n; ++k) {
    const Keypoint& p = sequence.at(t, k);
    if (!(p.confidence > 0)) continue;
    low[0] = std::min(low[0], double{p.x}), high[0] = std::max(high[0], double{p.x});
    low[1] = std::min(low[1], double{p.y}), high[1] = std::max(high[1], double{p.y});
  }
  return low[0] <= high[0] ? std::max(high[0] - low[0], high[1] - low[1]) : NAN;
}

/// The middle one of those that are finite; NaN if none is.
double MedianOf(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return NAN;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct ThirdNumbers {
  double low = INFINITY, high = -INFINITY;
};

/// Throws unless the array can only be pixels with confidences, in COCO's order.
void RequireUnmistakable(const KeypointSequence& sequence, const ThirdNumbers& third, bool has_third,
                         const NdArray& array, const std::string& where) {
  std::vector<double> extents, face_shares;
  for (int t = 0; t < sequence.num_frames(); ++t) {
    extents.push_back(ExtentOf(sequence, t, sequence.num_points()));
    face_shares.push_back(ExtentOf(sequence, t, kFacePoints) / extents.back());
  }
  const double extent = MedianOf(extents), face_share = MedianOf(face_shares);
  if (has_third && (third.low < 0 || third.high > 1 || extent < kMinExtent_px)) {
    ThrowFileError(where, Concatenate("an array of ", array.ShapeText(), " whose third numbers lie between ", third.low,
                                      " and ", third.high, " and whose points span ", extent,
                                      ": 3D points or fractions of the image, expected x and y in pixels and a "
                                      "confidence in [0, 1]; if they are confidences give --convention coco17"));
  }
  if (sequence.num_points() == 17 && face_share > kMaxFaceShare) {
    ThrowFileError(where, Concatenate("an array of ", array.ShapeText(), " whose first five points span ", face_share,
                                      " of all, which COCO's face does not; give the order of the landmarks "
                                      "(--convention human36m17 or coco17)"));
  }
}

}  // namespace

const NdArray* KeypointArrayOf(const NpzArrays& arrays) {
  if (const auto found = arrays.find("keypoints"); found != arrays.end()) {
    const bool is_own = arrays.contains("timestamps") || arrays.contains("keypoint_names");
    return is_own ? nullptr : &found->second;
  }
  const NdArray* only = nullptr;
  for (const auto& [name, array] : arrays) {
    if (!array.is_number()) continue;
    if (only != nullptr) return nullptr;
    only = &array;
  }
  return only != nullptr && only->shape.size() >= 3 ? only : nullptr;
}

KeypointSequence KeypointsFromArray(const NdArray& array, const std::string& where, const std::string& view, double fps,
                                    const std::string& convention) {
  const size_t rank = array.shape.size();
  const bool is_landmarks =
      array.is_number() && (rank == 3 || rank == 4) && (array.shape[rank - 1] == 2 || array.shape[rank - 1] == 3);
  if (!is_landmarks) {
    ThrowFileError(where, Concatenate("an array of ", array.ShapeText(), array.is_number() ? "" : " of no numbers",
                                      ", expected landmarks, frames x points x 3 (x, y in pixels, confidence) or "
                                      "FreeMoCap's 2D, cameras x frames x points x 2"));
  }
  const int64_t per_point = array.shape[rank - 1], num_points = array.shape[rank - 2],
                num_frames = array.shape[rank - 3];
  if (num_frames < 1 || num_frames > kMaxArrayFrames) {
    ThrowFileError(where,
                   Concatenate("an array of ", array.ShapeText(), ", expected 1 to ", kMaxArrayFrames, " frames"));
  }
  const KeypointConvention& order = ConventionOfArray(num_points, convention, where);
  const int64_t chosen = rank == 4 ? FindArrayCamera(view, array.shape[0], where) : 0;
  const std::vector<double> values = array.ToDoubles();
  KeypointSequence sequence;
  sequence.convention = order.name;
  sequence.names = order.names;
  sequence.points.resize(static_cast<size_t>(num_frames) * order.names.size());
  ThirdNumbers third;
  for (int t = 0; t < static_cast<int>(num_frames); ++t) {
    sequence.timestamps.push_back(t / fps);
    for (int k = 0; k < sequence.num_points(); ++k) {
      const double* point = values.data() + ((chosen * num_frames + t) * num_points + k) * per_point;
      const double confidence = per_point == 3 ? point[2] : 1;
      if (std::isfinite(confidence)) {
        third.low = std::min(third.low, confidence), third.high = std::max(third.high, confidence);
      }
      sequence.at(t, k) = DetectedKeypoint(point[0], point[1], confidence);
    }
  }
  if (convention.empty()) {
    RequireUnmistakable(sequence, third, per_point == 3, array, where);
  } else if (third.low < 0) {
    ThrowFileError(where, Concatenate("a third number of ", third.low, ", expected confidences"));
  }
  for (Keypoint& point : sequence.points) {
    point = point.confidence > 0 ? Keypoint{point.x, point.y, std::min(1.0F, point.confidence)} : Keypoint{};
  }
  return sequence;
}

}  // namespace bodyloom
