// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/coco_reader.h"

#include <map>
#include <stdexcept>

#include "data_tools/observations/frame_numbers.h"

namespace bodyloom {
namespace {

int64_t FrameNumber(const JsonNode& id) {
  if (id.is_number()) return id.Integer();
  const int64_t number = FrameNumberFromName(id.Text());
  if (number < 0) id.Fail("a number or a file name with a number");
  return number;
}

/// Confidence of an annotation's visibility flag.
float ConfidenceOfFlag(double flag) { return flag >= 2 ? 1.0F : flag >= 1 ? 0.5F : 0.0F; }

int IdentityOf(const JsonNode& entry) {
  for (const char* key : {"track_id", "idx"}) {
    if (!entry.Has(key)) continue;
    const JsonNode id = entry.At(key);
    if (id.is_number() && id.Number() >= 0 && id.Number() < 1e9) return static_cast<int>(id.Number());
  }
  return -1;
}

}  // namespace

bool IsCocoJson(const JsonNode& document) {
  if (document.Has("annotations")) return true;
  return document.is_array() && document.size() > 0 && document.At(0).Has("image_id") &&
         document.At(0).Has("keypoints");
}

PeopleSequence CocoFromJson(const JsonNode& document, double fps) {
  const bool is_annotation = document.Has("annotations");
  const JsonNode entries = is_annotation ? document.At("annotations") : document;
  if (!entries.is_array()) entries.Fail("a list of detections");

  std::map<int64_t, int64_t> frame_of_image;  // image id → number in the file name
  PeopleSequence people;
  if (is_annotation && document.Has("images")) {
    const JsonNode images = document.At("images");
    for (size_t i = 0; i < images.size(); ++i) {
      const JsonNode image = images.At(i);
      const int64_t id = image.At("id").Integer();
      const int64_t number = image.Has("file_name") ? FrameNumberFromName(image.At("file_name").Text()) : -1;
      frame_of_image[id] = number >= 0 ? number : id;
      if (image.Has("width") && image.Has("height")) {
        const int64_t width = image.At("width").Integer(), height = image.At("height").Integer();
        if (width <= 0 || height <= 0 || width > 100000 || height > 100000) image.Fail("a positive image size");
        if (people.image_width > 0 && (width != people.image_width || height != people.image_height)) {
          throw std::runtime_error(image.place() + ": " + std::to_string(width) + "x" + std::to_string(height) +
                                   ", expected " + std::to_string(people.image_width) + "x" +
                                   std::to_string(people.image_height) + " as in the images before");
        }
        people.image_width = static_cast<int>(width);
        people.image_height = static_cast<int>(height);
      }
    }
  }

  std::map<int64_t, std::vector<DetectedPerson>> by_number;
  for (const auto& [id, number] : frame_of_image) by_number[number];  // images without anyone are frames too
  size_t num_points = 0;
  for (size_t i = 0; i < entries.size(); ++i) {
    const JsonNode entry = entries.At(i);
    const JsonNode values = entry.At("keypoints");
    const std::vector<double> numbers = values.Numbers();
    if (num_points == 0) num_points = numbers.size() / 3;
    if (numbers.size() != 3 * num_points || ConventionOfCount(num_points) == nullptr) {
      throw std::runtime_error(values.place() + ": " + std::to_string(numbers.size()) + " numbers, expected 3·" +
                               (i > 0 ? std::to_string(num_points) + " as in the entries before"
                                      : std::string("17 (COCO), 23 or 133 (COCO-WholeBody), 26 or 136 (Halpe)")));
    }
    int64_t number = FrameNumber(entry.At("image_id"));
    if (const auto found = frame_of_image.find(number); found != frame_of_image.end()) number = found->second;
    DetectedPerson person;
    person.identity = IdentityOf(entry);
    person.points.resize(ConventionOfCount(num_points)->names.size());
    for (size_t k = 0; k < person.points.size(); ++k) {
      const double c = numbers[3 * k + 2];
      person.points[k] = {static_cast<float>(numbers[3 * k]), static_cast<float>(numbers[3 * k + 1]),
                          is_annotation ? ConfidenceOfFlag(c) : static_cast<float>(c)};
    }
    by_number[number].push_back(std::move(person));
  }

  people.convention = num_points == 0 ? Coco17() : *ConventionOfCount(num_points);
  std::vector<int64_t> numbers;
  numbers.reserve(by_number.size());
  for (const auto& [number, unused] : by_number) numbers.push_back(number);
  FrameGrid grid = MakeFrameGrid(numbers, fps, document.place());
  people.timestamps = std::move(grid.timestamps);
  people.frames.resize(people.timestamps.size());
  size_t i = 0;
  for (auto& [number, detections] : by_number) people.frames[grid.index[i++]] = std::move(detections);
  return people;
}

}  // namespace bodyloom
