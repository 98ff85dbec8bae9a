// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/people/occlusion.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/geometry/rotation.h"
#include "bodyloom/geometry/skinning.h"
#include "bodyloom/tracking/visible_surface.h"

namespace bodyloom {
namespace {

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
  VisibleSurface surface;
  double depth_m = 0;  ///< of the pelvis
};

/// Of one person: its bodies share skinner and shape.
std::shared_ptr<const Skinner> SkinnerOf(const PersonInScene& person) {
  return std::make_shared<const Skinner>(*person.body);
}

bool Pose(const PersonInScene& person, const std::shared_ptr<const Skinner>& skinner, SeenBody* body) {
  const Track& track = *person.track;
  const int t = body->of.frame, J = person.body->num_joints();
  std::vector<Eigen::Matrix3d> rotations;
  for (int j = 0; j < J; ++j)
    rotations.push_back(RotationFromAxisAngle(track.motion.poses.row(t).segment<3>(3 * j).transpose()));
  Eigen::VectorXd betas = Eigen::VectorXd::Zero(person.body->num_betas());
  const Eigen::Index n = std::min(betas.size(), track.motion.betas.size());
  betas.head(n) = track.motion.betas.head(n);
  body->depth_m = track.joints[size_t(t)](0, 2);
  return body->surface.Render(skinner, *person.body, betas, rotations, track.motion.trans.row(t).transpose(),
                              track.camera);
}

/// How far away person `self` is at a pixel.
double OwnDepth(const SeenBody& self, int x, int y) {
  const double depth = self.surface.buffer().DepthAt(x, y);
  return std::isfinite(depth) ? depth : self.depth_m;
}

bool IsHidden(const SeenBody& self, const SeenBody& other, int x, int y) {
  return other.surface.buffer().DepthAt(x, y) < OwnDepth(self, x, y) - kNearerM;
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
  const PixelBox& box = other.surface.buffer().box();
  const double height_px = self.surface.buffer().box().y_end - self.surface.buffer().box().y_begin;
  const int margin = std::max(1, int(std::lround(kMarginOfHeight * height_px)));
  const PixelBox reach{box.x_begin - margin, box.y_begin - margin, box.x_end + margin, box.y_end + margin};
  bool widened = false;
  int hidden = 0;
  for (int y = box.y_begin; y < box.y_end; y += margin) {
    for (int x = box.x_begin; x < box.x_end; x += margin) {
      if (!IsHidden(self, other, x, y)) continue;
      if (!widened) Widen(reach, image_width, image_height, image);
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

/// What `others` hide of `self`.
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
  if (person.part_labels != nullptr) {
    PartLabelSequence& labels = *person.part_labels;
    for (const SeenBody* other : others) {
      counts.pixels += HideLabels(self, *other, labels.image_width, labels.image_height, &labels.frames[size_t(t)]);
    }
  }
  counts.frames = counts.keypoints + counts.dense + counts.pixels > 0;
  return counts;
}

bool Overlap(const PixelBox& a, const PixelBox& b) {
  return a.x_begin < b.x_end && b.x_begin < a.x_end && a.y_begin < b.y_end && b.y_begin < a.y_end;
}

}  // namespace

std::vector<HiddenCounts> TakeWeightFromHidden(const std::vector<PersonInScene>& people, int num_threads) {
  std::map<double, std::vector<Appearance>> by_time;
  std::vector<std::shared_ptr<const Skinner>> skinners(people.size());
  for (size_t i = 0; i < people.size(); ++i) {
    const Track* track = people[i].track;
    if (track == nullptr) continue;
    BODYLOOM_CHECK(track->camera.model == CameraModel::kPinhole, "occlusion: person ", i,
                   " has no place in space, expected a pinhole camera");
    skinners[i] = SkinnerOf(people[i]);
    for (int t = 0; t < track->num_frames(); ++t) {
      if (track->HasResult(t)) by_time[track->motion.timestamps[size_t(t)]].push_back({i, t});
    }
  }
  std::vector<std::vector<Appearance>> moments;
  for (auto& [time, appearances] : by_time) {
    if (appearances.size() > 1) moments.push_back(std::move(appearances));
  }
  std::vector<std::vector<HiddenCounts>> counts(moments.size());
  ParallelFor(int(moments.size()), num_threads, [&](int m) {
    std::vector<SeenBody> bodies(moments[size_t(m)].size());
    for (size_t i = 0; i < bodies.size(); ++i) {
      bodies[i].of = moments[size_t(m)][i];
      if (!Pose(people[bodies[i].of.person], skinners[bodies[i].of.person], &bodies[i])) return;
    }
    counts[size_t(m)].resize(bodies.size());
    for (size_t i = 0; i < bodies.size(); ++i) {
      std::vector<const SeenBody*> others;
      for (const SeenBody& other : bodies) {
        if (&other != &bodies[i] && Overlap(bodies[i].surface.buffer().box(), other.surface.buffer().box())) {
          others.push_back(&other);
        }
      }
      if (!others.empty()) counts[size_t(m)][i] = Hide(bodies[i], others, people[bodies[i].of.person]);
    }
  });
  std::vector<HiddenCounts> sums(people.size());
  for (size_t m = 0; m < moments.size(); ++m) {
    for (size_t i = 0; i < counts[m].size(); ++i) {
      HiddenCounts& sum = sums[moments[m][i].person];
      const HiddenCounts& add = counts[m][i];
      sum.frames += add.frames, sum.keypoints += add.keypoints, sum.dense += add.dense, sum.pixels += add.pixels;
    }
  }
  return sums;
}

}  // namespace bodyloom
