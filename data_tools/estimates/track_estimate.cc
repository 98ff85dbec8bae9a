// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/estimates/track_estimate.h"

#include "bodyloom/data_tools/body/mean_pelvis.h"
#include "bodyloom/data_tools/estimates/estimate_arrays.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/refuse.h"

namespace bodyloom {

BodyEstimate EstimateFromTrack(const Track& track, const std::string& where) {
  constexpr Eigen::Index kSmpl = 72, kBody = 66;
  const Motion& motion = track.motion;
  const Eigen::Index columns = motion.poses.cols();
  if (columns != kSmpl && columns != 156 && columns != 162 && columns != 165) {
    Refuse(where, "poses", Concatenate(columns, " columns, expected 72 (SMPL), 156 (SMPL-H), 162 or 165 (SMPL-X)"));
  }
  BodyEstimate estimate;
  estimate.system = "track";
  estimate.body = motion.body;
  estimate.rest_pelvis = MeanPelvis(motion.body == "smplx" ? "smplx" : "smpl");
  estimate.num_frames = motion.num_frames();
  PersonEstimate& person = estimate.people.emplace_back();
  person.name = "0";
  person.betas = motion.betas;
  for (int t = 0; t < motion.num_frames(); ++t) {
    if (track.HasResult(t)) person.frames.push_back(t);
  }
  const auto n = static_cast<Eigen::Index>(person.frames.size());
  person.poses.setZero(n, kSmpl);
  person.trans.resize(n, 3);
  const Eigen::Index kept = columns == kSmpl ? kSmpl : kBody;
  for (Eigen::Index i = 0; i < n; ++i) {
    const int t = person.frames[static_cast<size_t>(i)];
    person.poses.row(i).head(kept) = motion.poses.row(t).head(kept);
    person.trans.row(i) = motion.trans.row(t);
    person.cameras.push_back(track.CameraAt(t));
    const bool has_joints = t < static_cast<int>(track.joints.size()) && track.joints[t].rows() > 0;
    if (i == 0 && has_joints && track.joints[t].row(0).allFinite()) {
      estimate.rest_pelvis = (track.joints[t].row(0) - motion.trans.row(t)).transpose();
    }
  }
  SortEstimate(where, &estimate);
  return estimate;
}

}  // namespace bodyloom
