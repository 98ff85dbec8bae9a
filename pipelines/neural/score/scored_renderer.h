// SPDX-License-Identifier: Apache-2.0
/// A renderer of people from photos, as pipelines/neural/score/score_people.h measures it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "neural/guided/coherent_maps.h"
#include "pipelines/neural/photo/people_data.h"
#include "pipelines/neural/score/score_people.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

class ScoredRenderer {
 public:
  ScoredRenderer() = default;
  ScoredRenderer(const ScoredRenderer&) = delete;
  ScoredRenderer& operator=(const ScoredRenderer&) = delete;
  virtual ~ScoredRenderer() = default;

  [[nodiscard]] virtual const PeopleData& people() const = 0;
  /// Of GuidedPicture: whether its labels are those of garments, not only 1 where somebody is.
  [[nodiscard]] virtual bool DrawsLabels() const { return false; }
  /// From now on this is the person: `photos` are its pictures `frames`. Returns the share of the atlas that they fill.
  virtual double SetPhotos(int person, std::span<const int> frames, std::span<const PhotoFrame> photos) = 0;
  /// Whether the photos showed enough for a person; without one, nobody is drawn.
  [[nodiscard]] virtual bool HasPerson() const { return true; }
  /// `pose` is frame `frame` of that person.
  virtual GuidedPicture Render(int frame, const PhotoFrame& pose) = 0;
  /// What the photos show of a pose, 3 planes.
  [[nodiscard]] virtual std::vector<float> ShownOf(const PhotoFrame& pose) const = 0;
};

/// What photos show of the body, and no more.
CoherentMaps MapsOf(std::span<const PhotoFrame> photos, const PhotoSource& people);
/// Share of the atlas that the first `used` photos of the maps filled.
double ShareSeen(const CoherentMaps& maps, size_t used);

/// Labels of a renderer that draws none: 1 where alpha is at least ½, whatever is worn, and 0.
std::vector<uint8_t> SomebodyOf(std::span<const float> alpha);

/// Throw as ScorePeople().
std::unique_ptr<ScoredRenderer> MakeScoredPhoto(const ScorePeopleRequest& request);
std::unique_ptr<ScoredRenderer> MakeScoredGuided(const ScorePeopleRequest& request);
std::unique_ptr<ScoredRenderer> MakeScoredPerson(const ScorePeopleRequest& request);
std::unique_ptr<ScoredRenderer> MakeScoredWarp(const ScorePeopleRequest& request);

}  // namespace bodyloom
