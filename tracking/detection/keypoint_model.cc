// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/keypoint_model.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"
#include "tracking/detection/inference/onnx_reader.h"

namespace bodyloom {
namespace {

constexpr int64_t kUsualSide = 640, kLongestSide = 4096, kMaxClasses = 2000, kMaxPerPixel = 4;

GraphExecutor ReadNetwork(const std::string& path) {
  const OperatorGraph graph = ReadOnnxGraph(path);
  const std::vector<int64_t>& stated = graph.tensors[size_t(graph.inputs[0])].shape;
  std::vector<int64_t> shape = stated;
  if (shape.size() == 4) {
    const std::vector<int64_t> usual = {1, 3, kUsualSide, kUsualSide};
    for (size_t i = 0; i < 4; ++i) shape[i] = shape[i] == -1 ? usual[i] : shape[i];
  }
  if (shape.size() != 4 || shape[0] != 1 || shape[1] != 3 || std::max(shape[2], shape[3]) > kLongestSide) {
    throw std::runtime_error(Concatenate(path, ": an input of ", GraphShapeText(stated),
                                         ", expected one image, 1x3xHxW, of at most ", kLongestSide, " a side"));
  }
  return GraphExecutor(graph, std::move(shape));
}

bool IsOneOf(const std::vector<std::vector<int64_t>>& outputs) {
  return outputs.size() == 1 && outputs[0].size() == 3 && outputs[0][0] == 1;
}

/// Number of scores per pixel if the two outputs are RTMPose's, else 0.
int64_t ScoresPerPixel(const std::vector<std::vector<int64_t>>& outputs, int64_t width, int64_t height) {
  if (outputs.size() != 2 || outputs[0].size() != 3 || outputs[1].size() != 3) return 0;
  const std::vector<int64_t>&columns = outputs[0], &rows = outputs[1];
  const int64_t r = columns[2] / width;
  const bool fits = columns[0] == 1 && rows[0] == 1 && columns[1] == rows[1] && columns[2] == r * width &&
                    rows[2] == r * height && r >= 1 && r <= kMaxPerPixel;
  return fits ? r : 0;
}

std::string Shapes(const GraphExecutor& network) {
  std::string text = "an input of " + GraphShapeText(network.input_shape()) + " and outputs of ";
  for (size_t i = 0; i < network.output_shapes().size() && i < 8; ++i) {
    text += (i == 0 ? "" : ", ") + GraphShapeText(network.output_shapes()[i]);
  }
  return text;
}

}  // namespace

KeypointModel::KeypointModel(const std::string& path) : path_(path), network_(ReadNetwork(path)) {
  height_ = int(network_.input_shape()[2]);
  width_ = int(network_.input_shape()[3]);
  const std::vector<std::vector<int64_t>>& outputs = network_.output_shapes();
  const KeypointConvention* convention = nullptr;
  if (const int64_t r = ScoresPerPixel(outputs, width_, height_); r > 0) {
    convention = ConventionOfCount(size_t(outputs[0][1]));
    family_ = KeypointFamily::kRtmPose;
    per_pixel_ = int(r);
    landmarks_ = int(outputs[0][1]);
  } else if (IsOneOf(outputs) && outputs[0][1] >= 5 && outputs[0][1] < outputs[0][2]) {
    const int64_t rows = outputs[0][1];
    convention = rows % 3 == 2 ? ConventionOfCount(size_t(rows - 5) / 3) : nullptr;
    if (convention != nullptr) {
      landmarks_ = int(rows - 5) / 3;
    } else if (rows - 4 <= kMaxClasses) {
      static const KeypointConvention none{"boxes", {}};
      convention = &none;
      family_ = KeypointFamily::kYoloBoxes;
      classes_ = int(rows - 4);
    }
  }
  if (convention == nullptr) {
    throw std::runtime_error(Concatenate(
        path, ": ", Shapes(network_),
        "; expected 1x3xHxW and 1x56xN (YOLO-pose: 5 + 3 numbers a landmark, exported without NMS), 1xKx2W and 1xKx2H "
        "(RTMPose) or 1x(4 + classes)xN (YOLO), with 17, 23, 26, 133 or 136 landmarks"));
  }
  convention_ = *convention;
}

std::vector<YoloPerson> KeypointModel::FindPeople(const Image& image) const {
  BODYLOOM_CHECK(family_ != KeypointFamily::kRtmPose, path_, ": RTMPose is shown one person at a time");
  const ImageCrop crop = LetterboxCrop(image.width, image.height, width_, height_);
  const std::vector<GraphTensor> outputs = network_.Run(LetterboxPixels(image, crop));
  std::vector<YoloPerson> people = DecodeYolo(outputs[0].floats, classes_, landmarks_, crop);
  for (YoloPerson& person : people) person.points.resize(convention_.names.size());
  return people;
}

std::vector<Keypoint> KeypointModel::PoseIn(const Image& image, const PersonBox& box) const {
  BODYLOOM_CHECK(family_ == KeypointFamily::kRtmPose, path_, ": not RTMPose");
  const ImageCrop crop = TopDownCrop(box, width_, height_);
  const std::vector<GraphTensor> outputs = network_.Run(TopDownPixels(image, crop));
  std::vector<Keypoint> points = DecodeSimcc(outputs[0].floats, outputs[1].floats, landmarks_, per_pixel_, crop);
  points.resize(convention_.names.size());
  return points;
}

namespace {

/// The first maximum of the scores; NaN is ignored.
size_t LargestAt(std::span<const float> scores) {
  size_t best = 0;
  for (size_t i = 1; i < scores.size(); ++i) {
    if (scores[i] > scores[best] || std::isnan(scores[best])) best = i;
  }
  return best;
}

}  // namespace

std::vector<Keypoint> DecodeSimcc(std::span<const float> columns, std::span<const float> rows, int landmarks,
                                  int per_pixel, const ImageCrop& crop) {
  BODYLOOM_CHECK(landmarks >= 1 && per_pixel >= 1 && crop.width >= 1 && crop.height >= 1, landmarks, " landmarks, ",
                 per_pixel, " scores a pixel");
  const size_t width = size_t(per_pixel) * size_t(crop.width), height = size_t(per_pixel) * size_t(crop.height);
  BODYLOOM_CHECK(columns.size() == width * size_t(landmarks) && rows.size() == height * size_t(landmarks),
                 columns.size(), " and ", rows.size(), " scores for ", landmarks, " landmarks in ", crop.width, "x",
                 crop.height, " pixels");
  std::vector<Keypoint> points;
  for (size_t k = 0; k < size_t(landmarks); ++k) {
    const std::span<const float> across = columns.subspan(k * width, width), down = rows.subspan(k * height, height);
    const size_t column = LargestAt(across), row = LargestAt(down);
    const float score = std::min(across[column], down[row]);
    const Eigen::Array2d pixel = crop.ImageFromCrop(Eigen::Array2d(double(column), double(row)) / per_pixel);
    const bool seen = across[column] > 0 && down[row] > 0;
    points.push_back(seen ? Keypoint{float(pixel.x()), float(pixel.y()), std::min(score, 1.0F)} : Keypoint{0, 0, 0});
  }
  return points;
}

namespace {

constexpr double kMinScore = 0.25, kSameBoxOverlap = 0.7;
constexpr size_t kMaxPeople = 300;

double Overlap(const PersonBox& a, const PersonBox& b) {
  const auto area = [](const PersonBox& box) { return (box.x1 - box.x0) * (box.y1 - box.y0); };
  const double width = std::min(a.x1, b.x1) - std::max(a.x0, b.x0);
  const double height = std::min(a.y1, b.y1) - std::max(a.y0, b.y0);
  if (!(width > 0 && height > 0)) return 0;
  return width * height / (area(a) + area(b) - width * height);
}

/// The network's output, rows × anchors.
class Numbers {
 public:
  Numbers(std::span<const float> values, size_t rows) : values_(values), anchors_(values.size() / rows) {}
  [[nodiscard]] size_t anchors() const { return anchors_; }
  [[nodiscard]] double At(size_t row, size_t anchor) const { return values_[row * anchors_ + anchor]; }

 private:
  std::span<const float> values_;
  size_t anchors_;
};

bool IsPerson(const Numbers& numbers, size_t anchor, int classes) {
  const double score = numbers.At(4, anchor);
  if (!(score >= kMinScore)) return false;  // not a number compares false
  for (int c = 1; c < classes; ++c) {
    if (numbers.At(4 + size_t(c), anchor) > score) return false;
  }
  return true;
}

PersonBox BoxOf(const Numbers& numbers, size_t anchor, const ImageCrop& crop) {
  const Eigen::Array2d middle(numbers.At(0, anchor), numbers.At(1, anchor));
  const Eigen::Array2d half = Eigen::Array2d(numbers.At(2, anchor), numbers.At(3, anchor)) / 2;
  const Eigen::Array2d low = crop.ImageFromCrop(middle - half), high = crop.ImageFromCrop(middle + half);
  return {low.x(), low.y(), high.x(), high.y(), std::min(numbers.At(4, anchor), 1.0)};
}

bool IsUsable(const PersonBox& box) {
  return std::isfinite(box.x0) && std::isfinite(box.y0) && std::isfinite(box.x1) && std::isfinite(box.y1) &&
         box.x1 > box.x0 && box.y1 > box.y0;
}

Keypoint PointOf(const Numbers& numbers, size_t row, size_t anchor, const ImageCrop& crop) {
  const Eigen::Array2d place = crop.ImageFromCrop({numbers.At(row, anchor), numbers.At(row + 1, anchor)});
  const double visibility = numbers.At(row + 2, anchor);
  const Keypoint point = {float(place.x()), float(place.y()), float(std::clamp(visibility, 0.0, 1.0))};
  const bool finite = std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(visibility);
  return finite ? point : Keypoint{0, 0, 0};
}

}  // namespace

std::vector<YoloPerson> DecodeYolo(std::span<const float> output, int classes, int landmarks, const ImageCrop& crop) {
  BODYLOOM_CHECK(classes >= 1 && landmarks >= 0, classes, " classes and ", landmarks, " landmarks");
  const size_t rows = 4 + size_t(classes) + 3 * size_t(landmarks);
  BODYLOOM_CHECK(output.size() % rows == 0, output.size(), " numbers, expected ", rows, " for each anchor");
  const Numbers numbers(output, rows);
  std::vector<std::pair<PersonBox, size_t>> candidates;
  for (size_t anchor = 0; anchor < numbers.anchors(); ++anchor) {
    if (!IsPerson(numbers, anchor, classes)) continue;
    const PersonBox box = BoxOf(numbers, anchor, crop);
    if (IsUsable(box)) candidates.emplace_back(box, anchor);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.first.score > b.first.score; });
  std::vector<YoloPerson> people;
  for (const auto& [box, anchor] : candidates) {
    if (people.size() == kMaxPeople) break;
    const auto is_same = [&b = box](const YoloPerson& other) { return Overlap(b, other.box) > kSameBoxOverlap; };
    if (std::any_of(people.begin(), people.end(), is_same)) continue;
    YoloPerson& person = people.emplace_back();
    person.box = box;
    for (int k = 0; k < landmarks; ++k) {
      person.points.push_back(PointOf(numbers, 4 + size_t(classes) + 3 * size_t(k), anchor, crop));
    }
  }
  return people;
}

}  // namespace bodyloom
