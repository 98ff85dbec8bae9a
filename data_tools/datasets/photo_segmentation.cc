// SPDX-License-Identifier: Apache-2.0
#include "data_tools/datasets/photo_segmentation.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/photo.hpp>

#include "geometry/base/check.h"
#include "render/image/image_mat.h"

namespace bodyloom {
namespace {

constexpr int kGrabCutRounds = 4;
constexpr double kSureInside = 0.015, kProbable = 0.03, kPossible = 1.0 / 12;  ///< of the body's extent
constexpr double kMinShare = 0.7;  ///< of the body's pixels that the foreground must contain to be accepted
constexpr int kFillSide = 512;

cv::Mat Disc(double radius) {
  const int r = std::max(1, static_cast<int>(std::lround(radius)));
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * r + 1, 2 * r + 1});
}

/// The connected component with most pixels of the body.
cv::Mat LargestPiece(const cv::Mat& inside, const cv::Mat& body) {
  cv::Mat pieces;
  const int count = cv::connectedComponents(inside, pieces);
  std::vector<int> of_body(std::max(1, count), 0);
  for (int y = 0; y < body.rows; ++y) {
    for (int x = 0; x < body.cols; ++x) of_body[pieces.at<int>(y, x)] += body.at<uchar>(y, x) != 0;
  }
  of_body[0] = 0;
  const auto best = static_cast<int>(std::max_element(of_body.begin(), of_body.end()) - of_body.begin());
  return best == 0 ? cv::Mat::zeros(inside.size(), CV_8UC1) : cv::Mat(pieces == best);
}

cv::Mat ForegroundMask(const Image& image, const cv::Mat& body) {
  const cv::Rect box = cv::boundingRect(body);
  const double extent = std::max(box.width, box.height);
  cv::Mat inside, probable, possible, mask(body.size(), CV_8UC1, cv::Scalar(cv::GC_BGD));
  cv::erode(body, inside, Disc(kSureInside * extent));
  cv::dilate(body, probable, Disc(kProbable * extent));
  cv::dilate(body, possible, Disc(kPossible * extent));
  mask.setTo(cv::GC_PR_BGD, possible);
  mask.setTo(cv::GC_PR_FGD, probable);
  mask.setTo(cv::GC_FGD, inside);
  if (cv::countNonZero(inside) == 0 || cv::countNonZero(mask == cv::GC_BGD) == 0) return body;
  cv::setRNGSeed(1);  // its mixtures start from k-means
  cv::Mat background_model, foreground_model;
  cv::grabCut(MatOf(image), mask, {}, background_model, foreground_model, kGrabCutRounds, cv::GC_INIT_WITH_MASK);
  cv::Mat foreground = LargestPiece((mask == cv::GC_FGD) | (mask == cv::GC_PR_FGD), body);
  const double kept = cv::countNonZero(foreground & body) / std::max(1.0, double(cv::countNonZero(body)));
  return kept < kMinShare ? body : foreground;
}

}  // namespace

std::vector<uint8_t> LabelsFromBody(const Image& image, const std::vector<uint8_t>& parts) {
  const size_t area = size_t(image.width) * image.height;
  BODYLOOM_CHECK(!image.empty() && parts.size() == area, "labels from the body: an image of ", image.width, "x",
                 image.height, ", parts of ", parts.size(), " pixels");
  cv::Mat body(image.height, image.width, CV_8UC1);
  for (size_t i = 0; i < area; ++i) body.data[i] = parts[i] != 0 ? 255 : 0;
  BODYLOOM_CHECK(cv::countNonZero(body) > 0, "labels from the body: the body is not in the image");
  const cv::Mat foreground = ForegroundMask(image, body);
  const std::vector<int> nearest = NearestMarked(parts, image.width, image.height);
  std::vector<uint8_t> labels(area, 0);
  for (size_t i = 0; i < area; ++i) {
    if (foreground.data[i] != 0) labels[i] = static_cast<uint8_t>(LabelOfPart(parts[nearest[i]]));
  }
  return labels;
}

Image FilledBackground(const Image& image, const std::vector<uint8_t>& hide) {
  BODYLOOM_CHECK(!image.empty() && hide.size() == size_t(image.width) * image.height, "filled background: an image of ",
                 image.width, "x", image.height, ", a mask of ", hide.size(), " pixels");
  cv::Mat mask(image.height, image.width, CV_8UC1);
  for (size_t i = 0; i < hide.size(); ++i) mask.data[i] = hide[i] != 0 ? 255 : 0;
  const double scale = std::min(1.0, double(kFillSide) / std::max(image.width, image.height));
  const cv::Mat whole = MatOf(image);
  cv::Mat small, small_mask, filled, enlarged;
  cv::resize(whole, small, {}, scale, scale, cv::INTER_AREA);
  cv::resize(mask, small_mask, small.size(), 0, 0, cv::INTER_AREA);
  // Pixels up to half a pixel beyond the person have the person's colour mixed in.
  cv::dilate(small_mask > 0, small_mask, Disc(2));
  cv::inpaint(small, small_mask, filled, 4, cv::INPAINT_TELEA);
  cv::resize(filled, enlarged, whole.size(), 0, 0, cv::INTER_LINEAR);
  cv::resize(small_mask, mask, whole.size(), 0, 0, cv::INTER_LINEAR);
  Image result(image.width, image.height);
  cv::Mat target = MatOf(&result);
  whole.copyTo(target);
  enlarged.copyTo(target, mask > 0);
  return result;
}

std::vector<int> NearestMarked(std::span<const uint8_t> marked, int width, int height) {
  const size_t area = size_t(width) * height;
  BODYLOOM_CHECK(width > 0 && height > 0 && marked.size() == area, "nearest pixel: ", marked.size(),
                 " pixels, expected ", width, "x", height);
  std::vector<int> result(area, -1);
  if (std::all_of(marked.begin(), marked.end(), [](uint8_t value) { return value == 0; })) return result;
  // OpenCV numbers the zeros of its input and returns the nearest one for every pixel.
  cv::Mat unmarked(height, width, CV_8UC1), distance, nearest;
  for (size_t i = 0; i < area; ++i) unmarked.data[i] = marked[i] != 0 ? 0 : 255;
  cv::distanceTransform(unmarked, distance, nearest, cv::DIST_L2, cv::DIST_MASK_5, cv::DIST_LABEL_PIXEL);
  std::vector<int> pixel_of_number(area + 1, -1);
  const int* number = nearest.ptr<int>();
  for (size_t i = 0; i < area; ++i) {
    if (marked[i] != 0) pixel_of_number.at(number[i]) = static_cast<int>(i);
  }
  for (size_t i = 0; i < area; ++i) result[i] = pixel_of_number.at(number[i]);
  return result;
}

}  // namespace bodyloom
