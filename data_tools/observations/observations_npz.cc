// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/observations_npz.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "data_tools/formats/ndarray.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr float kBarycentricTolerance = 1e-3F;

const NdArray& RequireShape(const NpzArrays& arrays, const std::string& key, const std::vector<int64_t>& shape,
                            const std::string& where) {
  const NdArray& array = RequireArray(arrays, key, where);
  if (!array.is_number() || array.shape != shape) {
    NdArray expected;
    expected.shape = shape;
    ThrowFileError(where, key,
                   "shape " + array.ShapeText() + (array.is_number() ? "" : " of no numbers") + ", expected numbers, " +
                       expected.ShapeText());
  }
  return array;
}

/// A noise of the labels: a scalar that older files do not have.
double OptionalSigma(const NpzArrays& arrays, const std::string& key, const std::string& where) {
  if (arrays.find(key) == arrays.end()) return 0;
  const double sigma = RequireShape(arrays, key, {}, where).ToDoubles()[0];
  if (!(sigma >= 0) || !std::isfinite(sigma)) {
    ThrowFileError(where, key, std::to_string(sigma) + ", expected a standard deviation, or 0 when it is not known");
  }
  return sigma;
}

}  // namespace

std::vector<double> TimestampsFromNpz(const NpzArrays& arrays, const std::string& where) {
  const NdArray& array = RequireArray(arrays, "timestamps", where);
  if (!array.is_number() || array.shape.size() != 1) {
    ThrowFileError(where, "timestamps", "shape " + array.ShapeText() + ", expected one number a frame");
  }
  std::vector<double> timestamps = array.ToDoubles();
  if (timestamps.empty()) ThrowFileError(where, "timestamps", "no frames");
  for (size_t t = 0; t < timestamps.size(); ++t) {
    if (!std::isfinite(timestamps[t]) || (t > 0 && !(timestamps[t] > timestamps[t - 1]))) {
      ThrowFileError(where, "timestamps",
                     "entry " + std::to_string(t) + " is " + std::to_string(timestamps[t]) +
                         ", expected finite, increasing seconds");
    }
  }
  return timestamps;
}

void ImageSizeFromNpz(const NpzArrays& arrays, const std::string& where, int* width, int* height) {
  if (arrays.find("image_size") == arrays.end()) return;
  const std::vector<double> size = RequireShape(arrays, "image_size", {2}, where).ToDoubles();
  if (!(size[0] >= 0 && size[1] >= 0 && size[0] <= 100000 && size[1] <= 100000)) {
    ThrowFileError(where, "image_size",
                   std::to_string(size[0]) + " x " + std::to_string(size[1]) + ", expected pixels");
  }
  *width = static_cast<int>(size[0]);
  *height = static_cast<int>(size[1]);
}

std::vector<std::string> KeypointNamesFromNpz(const NpzArrays& arrays, const std::string& where) {
  const NdArray& names = RequireArray(arrays, "keypoint_names", where);
  if (!names.is_text() || names.shape.size() != 1) ThrowFileError(where, "keypoint_names", "expected a list of text");
  return names.ToStrings();
}

std::string ConventionNameFromNpz(const NpzArrays& arrays) {
  if (const auto found = arrays.find("keypoint_convention"); found != arrays.end() && found->second.is_text()) {
    const std::vector<std::string> text = found->second.ToStrings();
    if (!text.empty()) return text[0];
  }
  return "custom";
}

void WriteObservations(const std::string& path, const KeypointSequence* keypoints, const DenseSequence* dense) {
  BODYLOOM_CHECK(keypoints != nullptr || dense != nullptr, "WriteObservations: nothing to write");
  const std::vector<double>& timestamps = keypoints != nullptr ? keypoints->timestamps : dense->timestamps;
  int size[2] = {keypoints != nullptr ? keypoints->image_width : dense->image_width,
                 keypoints != nullptr ? keypoints->image_height : dense->image_height};
  BODYLOOM_CHECK(
      keypoints == nullptr || dense == nullptr ||
          (dense->timestamps == timestamps && dense->image_width == size[0] && dense->image_height == size[1]),
      "WriteObservations: keypoints and dense keypoints differ in timestamps or image size");
  NpzArrays arrays;
  const auto num_frames = static_cast<int64_t>(timestamps.size());
  arrays["timestamps"] = NdArray::FromDoubles(timestamps.data(), {num_frames});
  const int32_t image_size[2] = {size[0], size[1]};
  arrays["image_size"] = NdArray::FromInts32(image_size, {2});
  if (keypoints != nullptr) {
    static_assert(sizeof(Keypoint) == 3 * sizeof(float));
    BODYLOOM_CHECK(keypoints->points.size() == timestamps.size() * keypoints->names.size(),
                   "WriteObservations: ", keypoints->points.size(), " points, expected frames times names");
    arrays["keypoints"] = NdArray::FromFloats(reinterpret_cast<const float*>(keypoints->points.data()),
                                              {num_frames, static_cast<int64_t>(keypoints->names.size()), 3});
    arrays["keypoint_names"] = NdArray::FromStrings(keypoints->names);
    arrays["keypoint_convention"] = NdArray::FromString(keypoints->convention);
  }
  if (dense != nullptr) {
    BODYLOOM_CHECK(dense->frames.size() == timestamps.size(), "WriteObservations: ", dense->frames.size(),
                   " dense frames and ", timestamps.size(), " timestamps");
    std::vector<int32_t> frame, face;
    std::vector<float> barycentric, pixel, sigma;
    for (int t = 0; t < dense->num_frames(); ++t) {
      for (const DenseKeypoint& point : dense->frames[t]) {
        frame.push_back(t);
        face.push_back(point.face);
        barycentric.insert(barycentric.end(), point.barycentric.data(), point.barycentric.data() + 3);
        pixel.insert(pixel.end(), point.pixel.data(), point.pixel.data() + 2);
        sigma.push_back(point.sigma_px);
      }
    }
    const auto n = static_cast<int64_t>(frame.size());
    arrays["dense_frame"] = NdArray::FromInts32(frame.data(), {n});
    arrays["dense_face"] = NdArray::FromInts32(face.data(), {n});
    arrays["dense_barycentric"] = NdArray::FromFloats(barycentric.data(), {n, 3});
    arrays["dense_pixel"] = NdArray::FromFloats(pixel.data(), {n, 2});
    arrays["dense_sigma_px"] = NdArray::FromFloats(sigma.data(), {n});
    arrays["dense_uv_sigma"] = NdArray::FromDouble(dense->uv_sigma);
    arrays["dense_pixel_sigma_px"] = NdArray::FromDouble(dense->pixel_sigma_px);
  }
  WriteNpz(path, arrays);
}

bool HasKeypoints(const NpzArrays& arrays) { return arrays.find("keypoints") != arrays.end(); }
bool HasDense(const NpzArrays& arrays) { return arrays.find("dense_frame") != arrays.end(); }

KeypointSequence KeypointsFromNpz(const NpzArrays& arrays, const std::string& where) {
  KeypointSequence sequence;
  sequence.timestamps = TimestampsFromNpz(arrays, where);
  ImageSizeFromNpz(arrays, where, &sequence.image_width, &sequence.image_height);
  sequence.names = KeypointNamesFromNpz(arrays, where);
  sequence.convention = ConventionNameFromNpz(arrays);
  const auto num_frames = static_cast<int64_t>(sequence.timestamps.size());
  const auto num_points = static_cast<int64_t>(sequence.names.size());
  const std::vector<float> values = RequireShape(arrays, "keypoints", {num_frames, num_points, 3}, where).ToFloats();
  sequence.points.resize(static_cast<size_t>(num_frames * num_points));
  for (size_t i = 0; i < sequence.points.size(); ++i) {
    const float x = values[3 * i], y = values[3 * i + 1], c = values[3 * i + 2];
    if (std::isfinite(x) && std::isfinite(y) && c > 0) sequence.points[i] = {x, y, std::min(c, 1.0F)};
  }
  return sequence;
}

DenseSequence DenseFromNpz(const NpzArrays& arrays, const std::string& where) {
  DenseSequence dense;
  dense.timestamps = TimestampsFromNpz(arrays, where);
  dense.frames.resize(dense.timestamps.size());
  ImageSizeFromNpz(arrays, where, &dense.image_width, &dense.image_height);
  dense.uv_sigma = OptionalSigma(arrays, "dense_uv_sigma", where);
  dense.pixel_sigma_px = OptionalSigma(arrays, "dense_pixel_sigma_px", where);
  const int64_t n = RequireArray(arrays, "dense_frame", where).num_elements();
  const std::vector<int64_t> frame =
      WholeNumbers(RequireShape(arrays, "dense_frame", {n}, where), "dense_frame", where);
  const std::vector<int64_t> face = WholeNumbers(RequireShape(arrays, "dense_face", {n}, where), "dense_face", where);
  const std::vector<float> barycentric = RequireShape(arrays, "dense_barycentric", {n, 3}, where).ToFloats();
  const std::vector<float> pixel = RequireShape(arrays, "dense_pixel", {n, 2}, where).ToFloats();
  const std::vector<float> sigma = RequireShape(arrays, "dense_sigma_px", {n}, where).ToFloats();
  for (int64_t i = 0; i < n; ++i) {
    const std::string entry = "entry " + std::to_string(i);
    if (frame[i] < 0 || frame[i] >= dense.num_frames()) {
      ThrowFileError(
          where, "dense_frame",
          entry + " is " + std::to_string(frame[i]) + ", expected 0 to " + std::to_string(dense.num_frames() - 1));
    }
    if (face[i] < 0 || face[i] > 100'000'000) {
      ThrowFileError(where, "dense_face", entry + " is " + std::to_string(face[i]) + ", expected a face index");
    }
    DenseKeypoint point;
    point.face = static_cast<int>(face[i]);
    point.barycentric = {barycentric[3 * i], barycentric[3 * i + 1], barycentric[3 * i + 2]};
    if (!(std::abs(point.barycentric.sum() - 1) < kBarycentricTolerance) ||
        !(point.barycentric.minCoeff() > -kBarycentricTolerance)) {
      ThrowFileError(where, "dense_barycentric", entry + ": weights must not be negative and sum to 1");
    }
    point.pixel = {pixel[2 * i], pixel[2 * i + 1]};
    if (!point.pixel.allFinite()) ThrowFileError(where, "dense_pixel", entry + " is not finite");
    point.sigma_px = sigma[i];
    if (!(point.sigma_px > 0) || !std::isfinite(point.sigma_px)) {
      ThrowFileError(where, "dense_sigma_px",
                     entry + " is " + std::to_string(point.sigma_px) + ", expected a positive number");
    }
    dense.frames[frame[i]].push_back(point);
  }
  return dense;
}

DenseSequence ReadDenseObservations(const std::string& path) { return DenseFromNpz(ReadNpz(path), path); }

}  // namespace bodyloom
