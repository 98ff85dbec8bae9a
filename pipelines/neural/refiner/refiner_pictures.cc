// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/refiner/refiner_pictures.h"

#include <algorithm>
#include <array>
#include <optional>

#include "bodyloom/geometry/base/split_mix.h"
#include "bodyloom/neural/guided/choose_photos.h"
#include "bodyloom/pipelines/neural/people/person_of_frames.h"
#include "bodyloom/pipelines/person/person_layer_painter.h"
#include "bodyloom/render/view_camera.h"

namespace bodyloom {
namespace {

constexpr std::array<int, 4> kPhotos = {1, 1, 2, 4};

PackedPicture PictureFrom(const PersonLayers& layers, const PhotoFrame& truth, double pixels_per_metre) {
  PackedPicture picture = {layers.width, layers.height, pixels_per_metre, PackPlanes(layers, PersonPlane::kCount), {}};
  const size_t pixels = layers.pixels(), window = static_cast<size_t>(truth.size) * truth.size;
  picture.truth.assign(4 * pixels, 0);
  ForEachPixel(layers, truth.size, truth.size, [&](int x, int y, size_t to) {
    const size_t from = static_cast<size_t>(y) * truth.size + x;
    for (size_t c = 0; c < 3; ++c) {
      picture.truth[c * pixels + to] = PackPlane(PersonPlane::kColour, truth.image[c * window + from]);
    }
    picture.truth[3 * pixels + to] = truth.labels[from] != 0 ? 255 : 0;
  });
  return picture;
}

std::vector<PackedPicture> PicturesOfPerson(const RefinerPicturesRequest& request, const PeopleData& people,
                                            int person) {
  const PhotoSource& source = people.source();
  const uint64_t hash = Mix(Mix(request.seed) ^ static_cast<uint64_t>(person));
  const std::vector<int> frames = ChoosePhotos(source, person, kPhotos[hash % kPhotos.size()]);
  std::vector<PhotoFrame> photos(frames.size());
  for (size_t k = 0; k < frames.size(); ++k) photos[k] = people.PhotoOf(person, frames[k]);
  std::vector<PackedPicture> pictures;
  const std::optional<PhotoPerson> made =
      PersonOfFrames(people, person, frames, photos, request.texture_size, FitClothesOptions());
  if (!made) return pictures;
  PersonLayerPainter painter(*made, 1);
  for (int f = 0; f < source.num_frames[person]; ++f) {
    if (std::find(frames.begin(), frames.end(), f) != frames.end()) continue;
    const std::optional<PersonPose> pose = PoseOfFrame(*made, people, person, f);
    if (!pose) continue;
    const PersonLayers layers = painter.Draw(pose->vertices_in_camera, pose->camera);
    if (layers.width == 0) continue;
    PhotoFrame truth;
    source.fill(person, f, &truth);
    pictures.push_back(
        PictureFrom(layers, truth, PixelsPerMetre(pose->camera, pose->vertices_in_camera.col(2).mean())));
  }
  return pictures;
}

}  // namespace

std::vector<PackedPicture> RefinerPicturesOf(const RefinerPicturesRequest& request, const char* stage,
                                             const PipelineCallbacks& callbacks) {
  PeopleDataRequest of_data = AsPhotosShowThem(request);
  of_data.every_other_estimated = true;
  of_data.labels_of_body = false;  // light is taken away by what a photo's parser says, and so it is to be learned
  const PeopleData people(of_data);
  return PicturesByPerson(static_cast<int>(people.source().num_frames.size()), request.threads, stage, callbacks,
                          [&](int person) { return PicturesOfPerson(request, people, person); });
}

}  // namespace bodyloom
