// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/score_guided.h"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "apps/interrupt.h"
#include "apps/neural/guided_people.h"
#include "apps/neural/motion_preview.h"
#include "apps/progress.h"
#include "bodyloom/neural/guided/choose_photos.h"
#include "bodyloom/render/contact_sheet.h"

namespace bodyloom {

std::vector<ScoredPhotos> ScoreGuided(const ScoreGuidedRequest& request, const GuidedConfig& config,
                                      GuidedRenderer* renderer, Image* sheet) {
  const GuidedPeople people({request.data, request.body, config.profile.image_size, config.profile.texture_size, true});
  const PhotoSource& source = people.source();
  const int most = *std::max_element(request.photos.begin(), request.photos.end());
  const int count = static_cast<int>(source.num_frames.size());
  const TexelNeighbours neighbours(source.texture_size, source.texel_parts, source.texel_places);
  std::vector<std::unique_ptr<GuidedScorer>> scorers;
  std::vector<ScoredPhotos> scored;
  for (const int photos : request.photos) {
    scorers.push_back(std::make_unique<GuidedScorer>(true));
    scored.push_back({photos, {}, 0});
  }
  std::vector<Image> pictures;
  Progress progress("scores");
  for (int person = 0; person < count; ++person) {
    const std::vector<int> chosen = ChoosePhotos(source, person, most);
    std::vector<int> others;
    for (int f = 0; f < source.num_frames[person]; ++f) {
      if (std::find(chosen.begin(), chosen.end(), f) == chosen.end()) others.push_back(f);
    }
    if (others.empty()) {
      throw std::runtime_error(request.data + ": a person has " + std::to_string(source.num_frames[person]) +
                               " pictures, none is left to compare with");
    }
    std::vector<PhotoFrame> photos(chosen.size());
    for (size_t i = 0; i < chosen.size(); ++i) source.fill(person, chosen[i], &photos[i]);
    std::vector<PhotoFrame> views;
    if (renderer->completion() == MapCompletion::kVirtualViews) views = people.VirtualViewsOf(person);
    for (size_t n = 0; n < scored.size(); ++n) {
      ThrowIfInterrupted();
      const size_t used = std::min(photos.size(), static_cast<size_t>(scored[n].photos));
      renderer->SetSource(std::span(photos).first(used), {source.texel_parts, views, &neighbours});
      const CoherentMaps& maps = renderer->maps();
      double filled = 0, atlas = 0;
      for (size_t i = 0; i < maps.from.size(); ++i) {
        atlas += maps.texel_parts[i] != 0 ? 1 : 0;
        filled += maps.from[i] != 0 && maps.from[i] <= used ? 1 : 0;
      }
      scored[n].texels_seen += filled / std::max(1.0, atlas) / count;
      for (const int k : EvenlySpreadFrames(static_cast<int>(others.size()), request.frames)) {
        PhotoFrame truth;
        source.fill(person, others[k], &truth);
        const GuidedPicture picture = renderer->Render(truth);
        scorers[n]->Add(picture, truth);
        if (sheet == nullptr || n != 0 || k != 0) continue;
        const int size = truth.size;
        pictures.push_back(PictureOf(photos[0].image, size, size));
        pictures.push_back(PictureOf(LookUp(maps, truth).image, size, size));
        pictures.push_back(PictureOf(picture.image, size, size));
        pictures.push_back(PictureOf(truth.image, size, size));
      }
    }
    for (const auto& scorer : scorers) scorer->NextPerson();
    progress.Update("people", (person + 1.0) / count);
  }
  for (size_t n = 0; n < scored.size(); ++n) scored[n].scores = scorers[n]->Scores();
  if (sheet != nullptr) {
    ContactSheetOptions layout;
    layout.columns = 4;
    layout.cell_height_px = std::max(128, config.profile.image_size);
    *sheet = ContactSheet(pictures, layout);
  }
  return scored;
}

}  // namespace bodyloom
