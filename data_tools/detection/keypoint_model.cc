// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/detection/keypoint_model.h"

#include <stdexcept>
#include <utility>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int64_t kUsualSide = 640, kLongestSide = 4096, kMostClasses = 2000, kMostPerPixel = 4;

OnnxNetwork ReadNetwork(const std::string& path) {
  OnnxModel model = ReadOnnxModel(path);
  std::vector<int64_t> shape = model.input_shape;
  if (shape.size() == 4) {
    const std::vector<int64_t> usual = {1, 3, kUsualSide, kUsualSide};
    for (size_t i = 0; i < 4; ++i) shape[i] = shape[i] == -1 ? usual[i] : shape[i];
  }
  if (shape.size() != 4 || shape[0] != 1 || shape[1] != 3 || std::max(shape[2], shape[3]) > kLongestSide) {
    throw std::runtime_error(Concatenate(path, ": an input of ", OnnxShapeText(model.input_shape),
                                         ", expected one picture, 1x3xHxW, of at most ", kLongestSide, " a side"));
  }
  return {std::move(model), std::move(shape)};
}

bool IsOneOf(const std::vector<std::vector<int64_t>>& outputs) {
  return outputs.size() == 1 && outputs[0].size() == 3 && outputs[0][0] == 1;
}

/// Scores a pixel when the two outputs are RTMPose's, else 0.
int64_t ScoresPerPixel(const std::vector<std::vector<int64_t>>& outputs, int64_t width, int64_t height) {
  if (outputs.size() != 2 || outputs[0].size() != 3 || outputs[1].size() != 3) return 0;
  const std::vector<int64_t>&columns = outputs[0], &rows = outputs[1];
  const int64_t r = columns[2] / width;
  const bool fits = columns[0] == 1 && rows[0] == 1 && columns[1] == rows[1] && columns[2] == r * width &&
                    rows[2] == r * height && r >= 1 && r <= kMostPerPixel;
  return fits ? r : 0;
}

std::string Shapes(const OnnxNetwork& network) {
  std::string text = "an input of " + OnnxShapeText(network.input_shape()) + " and outputs of ";
  for (size_t i = 0; i < network.output_shapes().size() && i < 8; ++i) {
    text += (i == 0 ? "" : ", ") + OnnxShapeText(network.output_shapes()[i]);
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
    } else if (rows - 4 <= kMostClasses) {
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
  const PictureCrop crop = LetterboxCrop(image.width, image.height, width_, height_);
  const std::vector<OnnxTensor> outputs = network_.Run(LetterboxPixels(image, crop));
  std::vector<YoloPerson> people = DecodeYolo(*outputs[0].floats, classes_, landmarks_, crop);
  for (YoloPerson& person : people) person.points.resize(convention_.names.size());
  return people;
}

std::vector<Keypoint> KeypointModel::PoseIn(const Image& image, const PersonBox& box) const {
  BODYLOOM_CHECK(family_ == KeypointFamily::kRtmPose, path_, ": not RTMPose");
  const PictureCrop crop = TopDownCrop(box, width_, height_);
  const std::vector<OnnxTensor> outputs = network_.Run(TopDownPixels(image, crop));
  std::vector<Keypoint> points = DecodeSimcc(*outputs[0].floats, *outputs[1].floats, landmarks_, per_pixel_, crop);
  points.resize(convention_.names.size());
  return points;
}

}  // namespace bodyloom
