// SPDX-License-Identifier: Apache-2.0
/// People of a dataset as the pose-guided renderer takes them: their pictures, and virtual views of their bodies.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"
#include "pipelines/neural/photo/people_data.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

class GuidedPeople {
 public:
  /// Throws as PeopleData.
  explicit GuidedPeople(const PeopleDataRequest& request);

  [[nodiscard]] const PeopleData& data() const { return data_; }
  /// Refers to this, which must outlive it.
  [[nodiscard]] const PhotoSource& source() const { return data_.source(); }
  /// The six views of pipelines/neural/guided/guided_people.h.
  [[nodiscard]] std::vector<PhotoFrame> VirtualViewsOf(int person) const;

 private:
  PeopleDataRequest request_;
  PeopleData data_;
  std::shared_ptr<const BodyModel> body_;
  std::vector<Eigen::VectorXd> betas_;  ///< by person
};

// The six views of a body in T-pose over which the pose-guided renderer completes its maps.

/// A track of six frames: the body of shape `betas` in T-pose, its root turned so that a camera six metres away sees
/// its front, back, left, right, top and bottom (neural/guided/complete_maps.h, VirtualView).
Track VirtualViewTrack(const BodyModel& body, const Eigen::VectorXd& betas);

/// Its frames, in windows of size × size pixels with maps of texture_size × texture_size texels.
std::vector<PhotoFrame> VirtualViews(const BodyModel& body, const Eigen::VectorXd& betas, int size, int texture_size);

}  // namespace bodyloom
