// SPDX-License-Identifier: Apache-2.0
/// People of a dataset as the pose-guided renderer takes them: their pictures, and virtual views of their bodies.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/neural/people/photo_frame.h"
#include "bodyloom/pipelines/neural/photo/people_data.h"

namespace bodyloom {

class GuidedPeople {
 public:
  /// Throws as PeopleData.
  explicit GuidedPeople(const PeopleDataRequest& request);

  [[nodiscard]] const PeopleData& data() const { return data_; }
  /// Refers to this, which must outlive it.
  [[nodiscard]] const PhotoSource& source() const { return data_.source(); }
  /// The six views of pipelines/neural/guided/virtual_views.h.
  [[nodiscard]] std::vector<PhotoFrame> VirtualViewsOf(int person) const;

 private:
  PeopleDataRequest request_;
  PeopleData data_;
  std::shared_ptr<const BodyModel> body_;
  std::vector<Eigen::VectorXd> betas_;  ///< by person
};

}  // namespace bodyloom
