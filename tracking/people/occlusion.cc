// SPDX-License-Identifier: Apache-2.0
#include "tracking/people/occlusion.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/body/posed_body.h"
#include "geometry/body/skinning.h"
#include "geometry/scene/camera_path.h"
#include "tracking/problem/visible_surface.h"

namespace bodyloom {
namespace {

constexpr int kMomentsOfRun = 16;
constexpr float kHiddenShare = 0.2F;      ///< of its confidence that a hidden joint keeps
constexpr double kNearerM = 0.05;         ///< by which another body must be nearer to hide
constexpr double kMarginOfHeight = 0.01;  ///< by which a silhouette is widened over labels

/// One person at one moment.
struct Appearance {
  size_t person = 0;
  int frame = 0;
};

/// One person's body as the camera sees it.
struct SeenBody {
  Appearance of;
  VisibleSurface* surface = nullptr;
  double depth_m = 0;  ///< of the pelvis
  [[nodiscard]] const VisibilityBuffer& buffer() const { return surface->buffer(); }
};

bool Pose(const PersonInScene& person, const std::shared_ptr<const Skinner>& skinner, SeenBody* body) {
  const Track& track = *person.track;
  const int t = body->of.frame;
  BodyPose pose =
      PoseFromAxisAngle(*person.body, track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose());
  body->depth_m = track.joints[size_t(t)](0, 2);
  if (track.HasMovingCamera()) {
    const Eigen::Vector3d pelvis = track.joints[size_t(t)].row(0).transpose();
    const CameraPose& camera = track.camera_from_scene[size_t(t)];
    body->depth_m = MovedPoint(camera, pelvis).z();
    const Eigen::Vector3d rest_pelvis = pelvis - pose.trans;
    pose = MovedPose(camera, rest_pelvis, std::move(pose));
  }
  return body->surface->Render(skinner, *person.body, track.motion.betas, pose.rotations, pose.trans, track.camera);
}

/// Depth of person `self` at a pixel.
double OwnDepth(const SeenBody& self, int x, int y) {
  const double depth = self.buffer().DepthAt(x, y);
  return std::isfinite(depth) ? depth : self.depth_m;
}

bool IsHidden(const SeenBody& self, const SeenBody& other, int x, int y) {
  return other.buffer().DepthAt(x, y) < OwnDepth(self, x, y) - kNearerM;
}

void Widen(const PixelBox& by, int image_width, int image_height, LabelImage* image) {
  const int x0 = std::max(0, std::min(image->x_begin, by.x_begin));
  const int y0 = std::max(0, std::min(image->y_begin, by.y_begin));
  const int x1 = std::min(image_width, std::max(image->x_begin + image->width, by.x_end));
  const int y1 = std::min(image_height, std::max(image->y_begin + image->height, by.y_end));
  LabelImage wide{x0, y0, x1 - x0, y1 - y0, {}};
  wide.labels.assign(size_t(wide.width) * size_t(wide.height), PartLabelSequence::kBackground);
  for (int y = 0; y < image->height; ++y) {
    std::copy_n(image->labels.begin() + ptrdiff_t(y) * image->width, image->width,
                wide.labels.begin() + ptrdiff_t(y + image->y_begin - y0) * wide.width + (image->x_begin - x0));
  }
  *image = std::move(wide);
}

/// Labels hidden by `other`, on a grid of the margin's step, each hidden point with the square around it.
int HideLabels(const SeenBody& self, const SeenBody& other, int image_width, int image_height, LabelImage* image) {
  if (image->labels.empty()) return 0;
  const PixelBox& box = other.buffer().box();
  const int margin = std::max(1, int(std::lround(kMarginOfHeight * self.buffer().box().height())));
  bool widened = false;
  int hidden = 0;
  for (int y = box.y_begin; y < box.y_end; y += margin) {
    for (int x = box.x_begin; x < box.x_end; x += margin) {
      if (!IsHidden(self, other, x, y)) continue;
      if (!widened) Widen(box.GrownBy(margin), image_width, image_height, image);
      widened = true;
      const int x0 = std::max(x - margin, image->x_begin), x1 = std::min(x + margin + 1, image->x_begin + image->width);
      const int y0 = std::max(y - margin, image->y_begin),
                y1 = std::min(y + margin + 1, image->y_begin + image->height);
      for (int v = y0; v < y1; ++v) {
        for (int u = x0; u < x1; ++u) {
          uint8_t& label =
              image->labels[size_t(v - image->y_begin) * size_t(image->width) + size_t(u - image->x_begin)];
          hidden += label != PartLabelSequence::kUnknown;
          label = PartLabelSequence::kUnknown;
        }
      }
    }
  }
  return hidden;
}

/// Down-weights or drops the observations of `self` that `others` hide, and counts them.
HiddenCounts Hide(const SeenBody& self, const std::vector<const SeenBody*>& others, const PersonInScene& person) {
  HiddenCounts counts;
  const auto hidden_at = [&](double x, double y) {
    return std::isfinite(x) && std::isfinite(y) &&
           std::any_of(others.begin(), others.end(), [&](const SeenBody* other) {
             return IsHidden(self, *other, int(std::lround(x)), int(std::lround(y)));
           });
  };
  const int t = self.of.frame;
  if (person.keypoints != nullptr) {
    for (int k = 0; k < person.keypoints->num_points(); ++k) {
      Keypoint& point = person.keypoints->at(t, k);
      if (!(point.confidence > 0) || !hidden_at(point.x, point.y)) continue;
      point.confidence *= kHiddenShare;
      ++counts.keypoints;
    }
  }
  if (person.dense != nullptr) {
    counts.dense = int(std::erase_if(person.dense->frames[size_t(t)], [&](const DenseKeypoint& point) {
      return hidden_at(point.pixel.x(), point.pixel.y());
    }));
  }
  if (person.part_labels != nullptr && !others.empty()) {
    PartLabelSequence& labels = *person.part_labels;
    LabelImage image = labels.frames[size_t(t)].Unpacked();
    for (const SeenBody* other : others) {
      counts.pixels += HideLabels(self, *other, labels.image_width, labels.image_height, &image);
    }
    if (counts.pixels > 0) labels.frames[size_t(t)] = image;
  }
  counts.frames = counts.keypoints + counts.dense + counts.pixels > 0;
  return counts;
}

/// Down-weights or drops the hidden observations of everybody seen at one moment; returns counts by person.
std::vector<std::pair<size_t, HiddenCounts>> HideInMoment(const std::vector<SeenBody>& bodies,
                                                          const std::vector<PersonInScene>& people) {
  std::vector<std::pair<size_t, HiddenCounts>> counts;
  for (const SeenBody& body : bodies) {
    std::vector<const SeenBody*> others;
    for (const SeenBody& other : bodies) {
      if (&other != &body && !body.buffer().box().ClippedTo(other.buffer().box()).empty()) others.push_back(&other);
    }
    if (!others.empty()) counts.emplace_back(body.of.person, Hide(body, others, people[body.of.person]));
  }
  return counts;
}

}  // namespace

std::vector<HiddenCounts> DownweightOccluded(const std::vector<PersonInScene>& people, int num_threads) {
  std::map<double, std::vector<Appearance>> by_time;
  std::vector<std::shared_ptr<const Skinner>> skinners(people.size());
  for (size_t i = 0; i < people.size(); ++i) {
    const Track* track = people[i].track;
    if (track == nullptr) continue;
    BODYLOOM_CHECK(track->camera.model == CameraModel::kPinhole, "occlusion: person ", i,
                   " has no place in space, expected a pinhole camera");
    skinners[i] = std::make_shared<const Skinner>(*people[i].body);
    for (int t = 0; t < track->num_frames(); ++t) {
      if (track->HasResult(t)) by_time[track->motion.timestamps[size_t(t)]].push_back({i, t});
    }
  }
  std::vector<std::vector<Appearance>> moments;
  for (auto& [time, appearances] : by_time) {
    if (appearances.size() > 1) moments.push_back(std::move(appearances));
  }
  std::vector<std::vector<std::pair<size_t, HiddenCounts>>> counts(moments.size());
  // Moments are processed in runs, within which a person's shape and memory are reused.
  const int num_runs = (int(moments.size()) + kMomentsOfRun - 1) / kMomentsOfRun;
  ParallelFor(num_runs, num_threads, [&](int run) {
    std::vector<VisibleSurface> surfaces(people.size());
    const size_t end = std::min(moments.size(), size_t(run + 1) * kMomentsOfRun);
    for (size_t m = size_t(run) * kMomentsOfRun; m < end; ++m) {
      std::vector<SeenBody> bodies;
      for (const Appearance& appearance : moments[m]) {
        SeenBody& body = bodies.emplace_back(SeenBody{appearance, &surfaces[appearance.person]});
        if (!Pose(people[appearance.person], skinners[appearance.person], &body)) bodies.pop_back();
      }
      counts[m] = HideInMoment(bodies, people);
    }
  });
  std::vector<HiddenCounts> sums(people.size());
  for (const auto& of_moment : counts) {
    for (const auto& [person, add] : of_moment) {
      HiddenCounts& sum = sums[person];
      sum.frames += add.frames, sum.keypoints += add.keypoints, sum.dense += add.dense, sum.pixels += add.pixels;
    }
  }
  return sums;
}

}  // namespace bodyloom
