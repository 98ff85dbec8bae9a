// SPDX-License-Identifier: Apache-2.0
#include "data_tools/datasets/body_truth.h"

#include "data_tools/datasets/photo_segmentation.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int kMaxParts = 24;

/// The parts that are known within the person: another's where there are any, else the body's.
std::vector<uint8_t> KnownParts(const BodySurface& body, std::span<const uint8_t> person,
                                std::span<const uint8_t> parts) {
  std::vector<uint8_t> known(body.parts.size(), 0);
  bool any = false;
  for (size_t i = 0; i < parts.size(); ++i) {
    if (person[i] == 0 || parts[i] > kMaxParts) continue;
    known[i] = parts[i];
    any = any || parts[i] != 0;
  }
  return any ? known : body.parts;
}

}  // namespace

BodyTruth BodyTruthOf(const BodySurface& body, std::span<const uint8_t> person, std::span<const uint8_t> parts) {
  const size_t area = size_t(body.width) * body.height;
  BODYLOOM_CHECK(body.parts.size() == area && body.normals.size() == 3 * area && person.size() == area &&
                     (parts.empty() || parts.size() == area),
                 "labels of the body: parts, normals and outline of ", body.parts.size(), ", ", body.normals.size(),
                 " and ", person.size(), " values, expected those of ", body.width, "x", body.height);
  BodyTruth truth;
  truth.labels.assign(area, 0);
  truth.normals = Image(body.width, body.height);
  const std::vector<uint8_t> known = KnownParts(body, person, parts);
  const std::vector<int> nearest = NearestMarked(known, body.width, body.height);
  const std::vector<int> on_body = NearestMarked(body.parts, body.width, body.height);
  for (size_t i = 0; i < area; ++i) {
    if (person[i] == 0 || nearest[i] < 0) continue;
    truth.labels[i] = static_cast<uint8_t>(LabelOfPart(known[nearest[i]]));
    if (on_body[i] < 0) continue;
    for (int c = 0; c < 3; ++c) truth.normals.bgr[3 * i + 2 - c] = NormalCode(body.normals[area * c + on_body[i]]);
  }
  return truth;
}

}  // namespace bodyloom
