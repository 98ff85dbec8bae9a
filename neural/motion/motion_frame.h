// SPDX-License-Identifier: Apache-2.0
/// Input frame of the motion-dependent renderer, a window around the person and the motion maps of its body, and its
/// results.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace bodyloom {

/// Images are planar (channel, row, column). Unknown fields are empty.
struct MotionFrame {
  int width = 0, height = 0;  ///< of the window
  /// Position of the window of frame t − 1 in this one: pixel (x, y) of that window is pixel (x + before_x, y +
  /// before_y) of this one.
  int before_x = 0, before_y = 0;

  // One of the two, according to the configuration's descriptor.
  std::vector<float> motion;  ///< channels × U × U: normals and velocities in UV
  std::vector<float> dense;   ///< channels × height × width: dense UV and keypoints of the last frames
  std::vector<float> uv;      ///< 2 × height × width, the body's atlas coordinates in [0, 1]
  std::vector<float> body;    ///< height × width: 1 where a pixel shows the body

  // Truth.
  std::vector<float> image;     ///< 3 × height × width in [0, 1], RGB, 0 on the background
  std::vector<uint8_t> labels;  ///< height × width; 0: background
  std::vector<float> normals;   ///< 3 × height × width unit normals in the camera frame, 0 on the background
};

/// Fills frame t of a clip, with truth if requested. Called from one thread other than the caller's.
using MotionFrameSource = std::function<void(int t, bool with_truth, MotionFrame* frame)>;

// Result of the motion-dependent renderer.

/// Planar, window size.
struct MotionImage {
  int width = 0, height = 0;
  std::vector<float> image;     ///< 3, RGB in [0, 1], 0 on the background
  std::vector<float> alpha;     ///< 1, probability of the foreground (1 throughout without the shape decoder)
  std::vector<float> normals;   ///< 3, camera frame, shortened by alpha; empty without normals
  std::vector<uint8_t> labels;  ///< most likely class; empty without the shape decoder
};

// Reach of clothes and hair beyond the body, which limits the region to be rendered.

/// The minimum r, in pixels, for which squares of side 2r + 1 around the body's pixels cover all but the share
/// `left_out` of the frames' foreground (labels other than 0); 0 when the frames have no labels or no foreground.
/// Frames without a body are ignored.
int ClothesReach(std::span<const MotionFrame> frames, double left_out = 0.001);

// Scores of a trained motion-dependent renderer against images of the person it was trained on.

/// Means over the frames of roll-outs, one per gap-free range, that start without a past. "Foreground" is the true one:
/// labels other than the background.
struct MotionScores {
  double image_l1 = 0;            ///< mean |Â − A| over the foreground and channels
  double psnr_db = 0;             ///< over the foreground, range 1
  double label_iou = 0;           ///< mean over the classes other than the background that occur; NaN without labels
  double foreground_iou = 0;      ///< NaN without labels
  std::vector<double> class_iou;  ///< by class; NaN where it does not occur; empty without labels
  double normal_deg = 0;          ///< mean angle over the foreground; NaN without normals
  double flicker = 0;  ///< mean over the foreground of |(Â_t − Â_{t−1}) − (A_t − A_{t−1})|: temporal error
  // Of whole windows on black; NaN if not measured (window too small, or not requested). Consecutive windows are
  // aligned, as for flicker.
  double ssim = 0, lpips = 0, tlpips = 0;
  bool lpips_random_features = true;  ///< LPIPS and tLPIPS are not comparable with published figures
  int frames = 0;
};

/// Scores of one frame.
struct MotionFrameScores {
  double image_l1 = std::numeric_limits<double>::quiet_NaN(), ssim = image_l1, lpips = image_l1;
  double tlpips = image_l1;  ///< NaN for a clip's first frame
};

}  // namespace bodyloom
