// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/motion_sheet.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "data_tools/motion/smpl_rest.h"
#include "geometry/base/check.h"
#include "geometry/body/body_model.h"
#include "geometry/math/rotation.h"
#include "render/image/image_mat.h"
#include "render/image/palette.h"
#include "render/view/contact_sheet.h"

namespace bodyloom {
namespace {

constexpr double kRoom_m = 2.2;    ///< height that a row shows
constexpr double kBelow_m = 0.12;  ///< of it, below y = 0
constexpr int kLabelHeight_px = 18, kHeadJoint = 15, kSubpixelBits = 4;
constexpr Colour kMiddle{120, 126, 140}, kFloor{196, 200, 208};

cv::Scalar ScalarOf(Colour colour) { return {double(colour.blue), double(colour.green), double(colour.red)}; }

Colour ColourOf(int joint) {
  const std::string& name = SmplJointNames()[joint];
  return name.starts_with("l_") ? kLeftColour : name.starts_with("r_") ? kRightColour : kMiddle;
}

/// Metres in a row of the strip → pixels with kSubpixelBits fractional bits.
struct RowScale {
  double px_per_m = 1, floor_y_px = 0;
  [[nodiscard]] cv::Point At(double x_px, double right_m, double up_m) const {
    const double unit = 1 << kSubpixelBits;
    return {static_cast<int>(std::lround(unit * (x_px + px_per_m * right_m))),
            static_cast<int>(std::lround(unit * (floor_y_px - px_per_m * up_m)))};
  }
};

/// Seen along −view in the horizontal plane; `right` is the picture's right. Far bones first.
void DrawFigure(const MatrixX3d& joints, const Eigen::Vector3d& right, const Eigen::Vector3d& view, double x_px,
                const RowScale& scale, cv::Mat* mat) {
  std::array<int, 23> bones{};
  for (int j = 1; j < 24; ++j) bones[j - 1] = j;
  const auto depth = [&](int j) { return (joints.row(j) + joints.row(SmplParents()[j])).dot(view.transpose()); };
  std::sort(bones.begin(), bones.end(), [&](int a, int b) { return depth(a) < depth(b); });
  const auto at = [&](int j) {
    const Eigen::RowVector3d from_pelvis = joints.row(j) - joints.row(0);
    return scale.At(x_px, from_pelvis.dot(right.transpose()), joints(j, 1));
  };
  for (const int j : bones) {
    cv::line(*mat, at(SmplParents()[j]), at(j), ScalarOf(ColourOf(j)), 2, cv::LINE_AA, kSubpixelBits);
  }
  const int radius = static_cast<int>(std::lround(0.09 * scale.px_per_m * (1 << kSubpixelBits)));
  cv::circle(*mat, at(kHeadJoint), radius, ScalarOf(kMiddle), cv::FILLED, cv::LINE_AA, kSubpixelBits);
}

/// The body's left in the horizontal plane; the first axis when the pelvis lies on its side.
Eigen::Vector3d LeftOf(const Motion& motion, int t) {
  Eigen::Vector3d left = RotationFromAxisAngle(motion.poses.block<1, 3>(t, 0).transpose()).col(0);
  left.y() = 0;
  return left.norm() > 1e-3 ? Eigen::Vector3d(left.normalized()) : Eigen::Vector3d::UnitX();
}

}  // namespace

Image DrawMotionStrip(const Motion& motion, bool has_floor, const std::string& label,
                      const MotionSheetOptions& options) {
  BODYLOOM_CHECK(motion.poses.cols() == 72 && motion.num_frames() > 0 && motion.up == Motion::Up::kY,
                 "DrawMotionStrip: ", motion.poses.cols() / 3, " joints, expected 24 in a world with y up");
  BODYLOOM_CHECK(options.instants > 0 && options.figure_width_px > 0, options.instants, " instants of ",
                 options.figure_width_px, " pixels, expected positive numbers");
  const std::vector<int> frames = EvenlySpreadFrames(motion.num_frames(), options.instants);
  std::vector<MatrixX3d> joints;
  double highest = kRoom_m - kBelow_m, lowest = 0;
  for (const int t : frames) {
    joints.push_back(PoseSmplJoints(motion.poses.row(t).transpose(), motion.trans.row(t).transpose()));
    highest = std::max(highest, joints.back().col(1).maxCoeff() + 0.1);
    lowest = std::min(lowest, joints.back().col(1).minCoeff());
  }
  const int row_px = options.figure_width_px * 5 / 4;
  Image strip(options.figure_width_px * options.instants, kLabelHeight_px + 2 * row_px, kPaperColour);
  cv::Mat mat = MatOf(&strip);
  RowScale scale;
  scale.px_per_m = row_px / (highest - lowest + kBelow_m);
  for (const bool is_side : {false, true}) {
    const int bottom = kLabelHeight_px + (is_side ? 2 : 1) * row_px;
    scale.floor_y_px = bottom - (kBelow_m - lowest) * scale.px_per_m;
    if (has_floor) {
      const int y = static_cast<int>(std::lround(scale.floor_y_px));
      cv::line(mat, {0, y}, {strip.width - 1, y}, ScalarOf(kFloor));
    }
    for (size_t i = 0; i < frames.size(); ++i) {
      const Eigen::Vector3d left = LeftOf(motion, frames[i]), front = left.cross(Eigen::Vector3d::UnitY());
      const double x_px = (static_cast<double>(i) + 0.5) * options.figure_width_px;
      // From the front the person's left is on the right; from the left side the front is on the left.
      if (is_side) {
        DrawFigure(joints[i], -front, left, x_px, scale, &mat);
      } else {
        DrawFigure(joints[i], left, front, x_px, scale, &mat);
      }
    }
  }
  cv::rectangle(mat, {0, 0, strip.width, kLabelHeight_px}, ScalarOf({226, 229, 235}), cv::FILLED);
  std::string ascii = label;
  std::replace_if(
      ascii.begin(), ascii.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  cv::putText(mat, ascii, {4, kLabelHeight_px - 5}, cv::FONT_HERSHEY_SIMPLEX, 0.42, ScalarOf(kInkColour), 1,
              cv::LINE_AA);
  return strip;
}

Image MotionSheet(const std::vector<Image>& strips, const MotionSheetOptions& options) {
  BODYLOOM_CHECK(!strips.empty() && options.columns > 0, strips.size(), " strips in ", options.columns, " columns");
  constexpr int kGap_px = 8;
  const int width = strips[0].width + kGap_px, height = strips[0].height + kGap_px;
  const int columns = std::min(options.columns, static_cast<int>(strips.size()));
  const int rows = (static_cast<int>(strips.size()) + columns - 1) / columns;
  Image sheet(columns * width + kGap_px, rows * height + kGap_px, kInkColour);
  for (size_t i = 0; i < strips.size(); ++i) {
    const int column = static_cast<int>(i) / rows, row = static_cast<int>(i) % rows;
    Paste(strips[i], kGap_px + column * width, kGap_px + row * height, &sheet);
  }
  return sheet;
}

}  // namespace bodyloom
