// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/detection_readers.h"

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "data_tools/observations/frame_numbers.h"
#include "data_tools/observations/hand_and_face_points.h"

namespace bodyloom {
namespace {

/// The frame numbers of entries' or images' names at `key`, each a number or a file name. −1 where a file name has no
/// number.
std::vector<int64_t> FrameNumbersAt(const JsonNode& list, const char* key) {
  std::vector<int64_t> numbers(list.size(), -1);
  std::vector<std::string> names;
  std::vector<size_t> named;
  for (size_t i = 0; i < list.size(); ++i) {
    const JsonNode entry = list.At(i);
    if (!entry.Has(key)) continue;
    const JsonNode id = entry.At(key);
    if (id.is_number()) {
      numbers[i] = id.Integer();
    } else {
      names.push_back(id.Text());
      named.push_back(i);
    }
  }
  const std::vector<int64_t> from_names = FrameNumbersFromNames(names);
  for (size_t n = 0; n < named.size(); ++n) numbers[named[n]] = from_names[n];
  return numbers;
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
    const std::vector<int64_t> file_numbers = FrameNumbersAt(images, "file_name");
    for (size_t i = 0; i < images.size(); ++i) {
      const JsonNode image = images.At(i);
      const int64_t id = image.At("id").Integer();
      frame_of_image[id] = file_numbers[i] >= 0 ? file_numbers[i] : id;
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
  const std::vector<int64_t> image_numbers = FrameNumbersAt(entries, "image_id");
  size_t num_points = 0;
  for (size_t i = 0; i < entries.size(); ++i) {
    const JsonNode entry = entries.At(i);
    const JsonNode values = entry.At("keypoints");
    const std::vector<double> numbers = values.NumbersOrNan();
    if (num_points == 0) num_points = numbers.size() / 3;
    if (numbers.size() != 3 * num_points || ConventionOfCount(num_points) == nullptr) {
      throw std::runtime_error(values.place() + ": " + std::to_string(numbers.size()) + " numbers, expected 3·" +
                               (i > 0 ? std::to_string(num_points) + " as in the entries before"
                                      : std::string("17 (COCO), 23 or 133 (COCO-WholeBody), 26 or 136 (Halpe)")));
    }
    const JsonNode image_id = entry.At("image_id");
    int64_t number = image_numbers[i];
    if (number < 0 && !image_id.is_number()) image_id.Fail("a number or a file name with a number");
    if (const auto found = frame_of_image.find(number); found != frame_of_image.end()) number = found->second;
    DetectedPerson person;
    person.identity = IdentityOf(entry);
    for (size_t k = 0; k < num_points; ++k) {
      const double c = numbers[3 * k + 2];
      person.points.push_back(
          DetectedKeypoint(numbers[3 * k], numbers[3 * k + 1], is_annotation ? ConfidenceOfFlag(c) : c));
    }
    const size_t num_body = ConventionOfCount(num_points)->names.size();
    person.hands_and_face = HandsAndFaceOfWholeBody(person.points, num_body, values.place());
    if (!person.hands_and_face) {  // COCO-WholeBody's annotations have lists of their own
      const auto part = [&](const char* key) {
        std::vector<Keypoint> points = PointsAtKey(entry, key);
        for (Keypoint& p : points) p.confidence = is_annotation ? ConfidenceOfFlag(p.confidence) : p.confidence;
        return points;
      };
      person.hands_and_face =
          HandsAndFaceFrom({part("lefthand_kpts"), part("righthand_kpts"), part("face_kpts")}, entry.place());
    }
    person.points.resize(num_body);
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
