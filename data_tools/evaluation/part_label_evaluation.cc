// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/part_label_evaluation.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "data_tools/evaluation/evaluation.h"
#include "geometry/base/check.h"
#include "geometry/body/posed_body.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {
namespace {

constexpr int kCharts = 25;

/// The two charts of one limb bone or of the torso under one number: the lower of the two.
constexpr std::array<uint8_t, kCharts> kJoined = {0,  1,  1,  3,  4,  5,  6,  7,  8,  7,  8,  11, 12,
                                                  11, 12, 15, 16, 15, 16, 19, 20, 19, 20, 23, 23};

double Mean(const std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double LowestDecile(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 10);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Pixels of one frame: how often label a met rendered chart b.
using Confusion = std::array<std::array<int64_t, kCharts>, kCharts>;

struct Overlap {
  int64_t label = 0, rendered = 0, both = 0;
  [[nodiscard]] double IoU() const {
    const int64_t either = label + rendered - both;
    return either > 0 ? static_cast<double>(both) / static_cast<double>(either) : 0;
  }
};

/// Overlap of every group of charts.
std::array<Overlap, kCharts> Overlaps(const Confusion& confusion, const std::array<uint8_t, kCharts>& group) {
  std::array<Overlap, kCharts> result{};
  for (int a = 0; a < kCharts; ++a) {
    for (int b = 0; b < kCharts; ++b) {
      result[group[a]].label += confusion[a][b];
      result[group[b]].rendered += confusion[a][b];
      if (group[a] == group[b]) result[group[a]].both += confusion[a][b];
    }
  }
  return result;
}

Confusion Compare(const PartLabelSequence& labels, int t, const VisibilityBuffer& buffer, const BodyModel& body) {
  const LabelImage image = labels.PartsOf(t);
  PixelBox box = buffer.box();
  if (box.empty()) box = {image.x_begin, image.y_begin, image.x_begin, image.y_begin};
  box.x_begin = std::min(box.x_begin, image.x_begin);
  box.y_begin = std::min(box.y_begin, image.y_begin);
  box.x_end = std::max(box.x_end, image.x_begin + image.width);
  box.y_end = std::max(box.y_end, image.y_begin + image.height);
  Confusion confusion{};
  for (int y = box.y_begin; y < box.y_end; ++y) {
    for (int x = box.x_begin; x < box.x_end; ++x) {
      const uint8_t label = image.At(x, y);
      if (label == PartLabelSequence::kUnknown || label >= kCharts) continue;
      const int face = buffer.FaceAt(x, y);
      ++confusion[label][face < 0 ? 0 : body.data().face_part[face]];
    }
  }
  return confusion;
}

}  // namespace

Evaluation EvaluatePartLabels(const Track& track, const PartLabelSequence& labels, const BodyModel& body,
                              const EvaluatePartLabelsOptions& options) {
  const int T = labels.num_frames();
  BODYLOOM_CHECK(T > 0 && track.num_frames() == T, "EvaluatePartLabels: the track has ", track.num_frames(),
                 " frames, the labels have ", T);
  BODYLOOM_CHECK(track.camera.width == labels.image_width && track.camera.height == labels.image_height,
                 "EvaluatePartLabels: the track is for images of ", track.camera.width, "x", track.camera.height,
                 ", the labels are ", labels.image_width, "x", labels.image_height);
  BODYLOOM_CHECK(body.has_parts(), "EvaluatePartLabels: the body '", body.name(), "' has no parts");
  std::array<uint8_t, kCharts> identity;
  std::iota(identity.begin(), identity.end(), uint8_t{0});

  Evaluation evaluation;
  evaluation.protocol = "part-labels";
  evaluation.description = Concatenate(
      "the rendered body's charts against the labels, pixel by pixel, on every frame with labels; a part counts in a "
      "frame when its label has ",
      options.min_pixels, " pixels or more");
  std::vector<double> silhouette, part, joined;
  std::array<std::vector<double>, kCharts> by_chart;
  int64_t right = 0, person = 0;
  VisibilityBuffer buffer;
  for (int t = 0; t < T; ++t) {
    if (labels.frames[t].empty()) continue;
    ++evaluation.frames;
    const bool has_result = track.HasResult(t);
    if (has_result) {
      const BodyPose pose =
          PoseFromAxisAngle(body, track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose());
      buffer.Render(PoseVertices(body, track.motion.betas, pose), body.data().faces, track.CameraAt(t));
    } else {
      buffer = VisibilityBuffer();
      ++evaluation.frames_without_result;
    }
    const Confusion confusion = Compare(labels, t, buffer, body);
    Overlap all;
    for (int a = 0; a < kCharts; ++a) {
      for (int b = 0; b < kCharts; ++b) {
        all.label += a > 0 ? confusion[a][b] : 0;
        all.rendered += b > 0 ? confusion[a][b] : 0;
        all.both += a > 0 && b > 0 ? confusion[a][b] : 0;
      }
      right += a > 0 ? confusion[a][a] : 0;
    }
    person += all.label;
    silhouette.push_back(all.IoU());
    const auto charts = Overlaps(confusion, identity), groups = Overlaps(confusion, kJoined);
    for (int c = 1; c < kCharts; ++c) {
      if (charts[c].label >= options.min_pixels) {
        part.push_back(charts[c].IoU());
        by_chart[c].push_back(charts[c].IoU());
      }
      if (groups[c].label >= options.min_pixels) joined.push_back(groups[c].IoU());
    }
  }
  evaluation.Add("silhouette_iou", Mean(silhouette), "of the whole person, mean over frames");
  evaluation.Add("silhouette_iou_p10", LowestDecile(silhouette), "one frame in ten is below");
  evaluation.Add("part_iou", Mean(part), "mean over parts with enough pixels, all 24 charts apart");
  evaluation.Add("limb_iou", Mean(joined), "the same with the two charts of a bone, of torso and of head joined");
  evaluation.Add("label_accuracy", person > 0 ? double(right) / double(person) : 0,
                 "share of the person's pixels that show the labelled chart");
  AddKneeFlexion(track.motion, nullptr, &evaluation);
  EvaluationBreakdown breakdown;
  breakdown.name = "part_iou_by_chart";
  for (int c = 1; c < kCharts; ++c) {
    if (by_chart[c].empty()) continue;
    breakdown.labels.push_back(std::to_string(c));
    breakdown.values.push_back(Mean(by_chart[c]));
  }
  evaluation.breakdowns.push_back(std::move(breakdown));
  return evaluation;
}

}  // namespace bodyloom
