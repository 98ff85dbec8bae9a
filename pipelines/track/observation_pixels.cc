// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/observation_pixels.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "data_tools/observations/hand_and_face_points.h"
#include "pipelines/video/track_video.h"

namespace bodyloom {
namespace {

Matrix2x3d Inverse(const Matrix2x3d& map) {
  Matrix2x3d inverse;
  inverse.leftCols<2>() = map.leftCols<2>().inverse();
  inverse.col(2) = -inverse.leftCols<2>() * map.col(2);
  return inverse;
}

Eigen::Vector2d Apply(const Matrix2x3d& map, double x, double y) { return map * Eigen::Vector3d(x, y, 1); }

LabelImage Moved(const LabelImage& labels, const Matrix2x3d& video_from_camera, const Matrix2x3d& camera_from_video,
                 int width, int height) {
  LabelImage moved;
  if (labels.labels.empty()) return moved;
  Eigen::Array2d low(1e9, 1e9), high(-1e9, -1e9);
  for (const double x : {labels.x_begin - 0.5, labels.x_begin + labels.width - 0.5}) {
    for (const double y : {labels.y_begin - 0.5, labels.y_begin + labels.height - 0.5}) {
      const Eigen::Array2d corner = Apply(camera_from_video, x, y).array();
      low = low.min(corner);
      high = high.max(corner);
    }
  }
  const auto first = [](double v) { return std::max(0, int(std::floor(v))); };
  moved.x_begin = first(low.x());
  moved.y_begin = first(low.y());
  moved.width = std::min(width, int(std::ceil(high.x())) + 1) - moved.x_begin;
  moved.height = std::min(height, int(std::ceil(high.y())) + 1) - moved.y_begin;
  if (moved.width <= 0 || moved.height <= 0) return {};
  moved.labels.resize(size_t(moved.width) * moved.height);
  for (int y = 0; y < moved.height; ++y) {
    for (int x = 0; x < moved.width; ++x) {
      const Eigen::Vector2d at = Apply(video_from_camera, moved.x_begin + x, moved.y_begin + y);
      moved.labels[size_t(y) * moved.width + x] = labels.At(int(std::lround(at.x())), int(std::lround(at.y())));
    }
  }
  return moved;
}

}  // namespace

DenseSequence MovedToCamera(DenseSequence dense, const Matrix2x3d& video_from_camera, int camera_width,
                            int camera_height) {
  const Matrix2x3d camera_from_video = Inverse(video_from_camera);
  const double scale = std::sqrt(std::abs(camera_from_video.leftCols<2>().determinant()));
  for (std::vector<DenseKeypoint>& frame : dense.frames) {
    for (DenseKeypoint& point : frame) {
      point.pixel = Apply(camera_from_video, point.pixel.x(), point.pixel.y()).cast<float>();
      point.sigma_px = static_cast<float>(scale * point.sigma_px);
    }
  }
  dense.pixel_sigma_px *= scale;
  dense.image_width = camera_width;
  dense.image_height = camera_height;
  return dense;
}

KeypointSequence MovedKeypoints(KeypointSequence keypoints, const Matrix2x3d& map, int width, int height) {
  for (Keypoint& point : keypoints.points) {
    const Eigen::Vector2d moved = Apply(map, point.x, point.y);
    point.x = float(moved.x());
    point.y = float(moved.y());
  }
  keypoints.image_width = width;
  keypoints.image_height = height;
  return keypoints;
}

HandsAndFaceSequence MovedKeypoints(HandsAndFaceSequence hands_and_face, const Matrix2x3d& map, int width, int height) {
  const auto scale = float(std::sqrt(std::abs(map.leftCols<2>().determinant())));
  const auto move = [&map](Keypoint& point) {
    const Eigen::Vector2d moved = Apply(map, point.x, point.y);
    point.x = float(moved.x());
    point.y = float(moved.y());
  };
  ChangeHandsAndFaces(
      [&](HandsAndFace* frame) {
        for (std::optional<HandObservation>& hand : frame->hands) {
          if (!hand) continue;
          std::for_each(hand->points.begin(), hand->points.end(), move);
          for (float& sigma : hand->sigma_px) sigma *= scale;
        }
        if (!frame->face) return;
        std::for_each(frame->face->points.begin(), frame->face->points.end(), move);
        frame->face->sigma_px *= scale;
        for (float& depth : frame->face->depth_px) depth *= scale;
      },
      &hands_and_face);
  hands_and_face.image_width = width;
  hands_and_face.image_height = height;
  return hands_and_face;
}

HandsAndFaceSequence MovedToCamera(HandsAndFaceSequence hands_and_face, const Matrix2x3d& video_from_camera,
                                   int camera_width, int camera_height) {
  return MovedKeypoints(std::move(hands_and_face), Inverse(video_from_camera), camera_width, camera_height);
}

KeypointSequence MovedToCamera(KeypointSequence keypoints, const Matrix2x3d& video_from_camera, int camera_width,
                               int camera_height) {
  return MovedKeypoints(std::move(keypoints), Inverse(video_from_camera), camera_width, camera_height);
}

PartLabelSequence MovedToCamera(const PartLabelSequence& labels, const Matrix2x3d& video_from_camera, int camera_width,
                                int camera_height) {
  const Matrix2x3d camera_from_video = Inverse(video_from_camera);
  PartLabelSequence moved = labels;
  for (PackedLabels& frame : moved.frames) {
    frame = Moved(frame.Unpacked(), video_from_camera, camera_from_video, camera_width, camera_height);
  }
  moved.image_width = camera_width;
  moved.image_height = camera_height;
  return moved;
}

VideoPixels PixelsOf(const VideoInfo& video) {
  return {{video.width, video.height}, {video.stored_width, video.stored_height}};
}

bool VideoPixels::Differ(const Eigen::Vector2i& seen, const Eigen::Vector2i& camera) const {
  return square != stored && ((seen == stored && camera == square) || (seen == square && camera == stored));
}

template <typename Sequence>
bool MoveToCamera(const VideoPixels& video, const Camera& camera, Sequence* seen) {
  const Eigen::Vector2i of_seen(seen->image_width, seen->image_height), of_camera(camera.width, camera.height);
  if (!video.Differ(of_seen, of_camera)) return false;
  *seen = MovedToCamera(std::move(*seen), ScaleOfPixels(of_camera, of_seen), camera.width, camera.height);
  return true;
}
template bool MoveToCamera(const VideoPixels&, const Camera&, KeypointSequence*);
template bool MoveToCamera(const VideoPixels&, const Camera&, DenseSequence*);
template bool MoveToCamera(const VideoPixels&, const Camera&, HandsAndFaceSequence*);
template bool MoveToCamera(const VideoPixels&, const Camera&, PartLabelSequence*);

}  // namespace bodyloom
