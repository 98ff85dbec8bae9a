// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/guided/guided_batches.h"

#include <utility>
#include <vector>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/neural/guided/guided_plan.h"
#include "bodyloom/neural/guided/guided_tensors.h"
#include "bodyloom/neural/guided/source_maps.h"

namespace bodyloom {

GuidedBatch MakeGuidedBatch(const PhotoSource& people, const GuidedConfig& config, uint64_t seed, int64_t step,
                            int batch, int reach, const TexelNeighbours* neighbours) {
  std::vector<PhotoFrame> sources(batch), targets(batch);
  std::vector<std::vector<uint8_t>> known;
  for (int b = 0; b < batch; ++b) {
    const GuidedSample sample = GuidedSampleOf(seed, step, b, people);
    people.fill(sample.person, sample.source, &sources[b]);
    people.fill(sample.person, sample.target, &targets[b]);
    known.push_back(KnownPixels(seed, step, b, targets[b].size, targets[b].parts));
  }
  const int multiple = config.Multiple();
  GuidedBatch result;
  result.source = TensorsOf(sources);
  const GuidedTensors target = TensorsOf(targets);
  BODYLOOM_CHECK(result.source.image.defined() && target.image.defined(),
                 "pose-guided training: a frame without image or labels");
  result.boxes = PersonBoxes(targets, multiple, reach);
  result.target = CroppedEach(target, result.boxes, multiple);
  GuidedPseudo pseudo = PseudoOf(target, known);
  if (config.profile.contour_hints) {
    const SourceBody body = {people.texel_parts, {}, neighbours, {}, config.source_labels};
    std::vector<PseudoPicture> warped;
    for (int b = 0; b < batch; ++b) {
      const CoherentMaps maps = MapsOfSource(std::span(&sources[b], 1), body, MapCompletion::kNearest, true, {}).maps;
      warped.push_back(LookUp(maps, targets[b]));
    }
    const GuidedPseudo of_source = PseudoOf(warped);
    pseudo.contour_classes = of_source.classes;
    pseudo.extent = of_source.extent;
  }
  result.pseudo = CroppedEach(pseudo, result.boxes, multiple);
  return result;
}

}  // namespace bodyloom
