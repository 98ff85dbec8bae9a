// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/worn_garment.h"

#include <memory>
#include <stdexcept>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/scene/track_edits.h"
#include "render/garment/person_cloth.h"
#include "render/gaussian_avatar/cloth_bones.h"

namespace bodyloom {
namespace {

constexpr float kSameNode_m = 1e-4F;  ///< tolerance between a stored position and a recomputed one

BodyModel Clothed(const BodyModel& body, const Eigen::VectorXd& betas, const AvatarGarment& garment) {
  return BodyModel(BakeShape(body, betas, std::vector<double>(garment.offsets_m.begin(), garment.offsets_m.end())));
}

LooseGarment CutFor(const BodyModel& clothed, LooseGarmentOptions cut) { return CutGarment(clothed, &cut); }

}  // namespace

WornGarment::WornGarment(const BodyModel& body, const Eigen::VectorXd& betas, const AvatarGarment& garment)
    : clothed_(Clothed(body, betas, garment)),
      mesh_(CutFor(clothed_, garment.cut)),
      nodes_(mesh_, garment.node_spacing_m) {}

GarmentBones WornGarment::Along(const Track& track, const PipelineCallbacks& callbacks) const {
  return std::move(RunsAlong(track, 1, 1, callbacks)[0]);
}

std::vector<GarmentBones> WornGarment::RunsAlong(const Track& track, int runs, int num_threads,
                                                 const PipelineCallbacks& callbacks) const {
  const Track moved = OfBakedBody(track);
  std::vector<std::unique_ptr<PersonCloth>> cloth;
  std::vector<GarmentBones> bones(runs);
  for (int r = 0; r < runs; ++r) {
    cloth.push_back(std::make_unique<PersonCloth>(clothed_, mesh_, moved, PersonClothOptions{.run = r}));
    bones[r].as_sewn = nodes_.places();
  }
  for (int t = 0; t < track.num_frames(); ++t) {
    callbacks.Update("simulating the garment", 0);
    ParallelFor(runs, num_threads,
                [&](int r) { bones[r].of_frame.push_back(BonesOfCloth(nodes_, nodes_.Move(cloth[r]->At(t)))); });
  }
  return bones;
}

AvatarGarment GarmentOf(const BodyModel& body, const Eigen::VectorXd& betas, const ClipClothes& clothes) {
  AvatarGarment garment;
  garment.cut = clothes.garment;
  garment.offsets_m.assign(clothes.offsets_m.begin(), clothes.offsets_m.end());
  garment.nodes = WornGarment(body, betas, garment).nodes().places().cast<float>();
  return garment;
}

WornGarment CutAnew(const BodyModel& body, const Eigen::VectorXd& betas, const AvatarGarment& garment,
                    const std::string& where) {
  try {
    WornGarment worn(body, betas, garment);
    const bool same = worn.nodes().size() == garment.num_nodes() &&
                      (worn.nodes().places().cast<float>() - garment.nodes).cwiseAbs().maxCoeff() <= kSameNode_m;
    if (same) return worn;
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(where + ": garment_cut: " + error.what());
  }
  throw std::runtime_error(where + ": garment_nodes are not those of its garment_cut on this body (--body)");
}

}  // namespace bodyloom
