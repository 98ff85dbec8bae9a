// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/parser/parser_pictures.h"

#include <utility>

#include "bodyloom/geometry/posed_body.h"
#include "bodyloom/neural/parser/train_parser.h"
#include "bodyloom/pipelines/people/planar_picture.h"
#include "bodyloom/pipelines/person/clothes_parser.h"
#include "bodyloom/render/overlay.h"
#include "bodyloom/render/view_camera.h"

namespace bodyloom {
namespace {

std::vector<PackedPicture> PicturesOfPerson(const PeopleData& people, int person) {
  const PhotoSource& source = people.source();
  std::vector<PackedPicture> pictures;
  for (int f = 0; f < source.num_frames[person]; ++f) {
    const Track body = people.BodyOf(person, f);
    if (!body.HasResult(0)) continue;
    const PhotoFrame photo = people.PhotoOf(person, f);
    PhotoFrame truth;
    source.fill(person, f, &truth);
    const Image picture = PictureOf(photo.image, photo.size, photo.size);
    const MatrixX3d rest = ShapeVertices(*people.body(), body.motion.betas);
    const MatrixX3d vertices = TrackVertices(*people.body(), body, 0);
    PersonPhoto parsed;
    parsed.picture = &picture, parsed.mask = photo.labels, parsed.body = people.body().get();
    parsed.rest_vertices = &rest, parsed.vertices_in_camera = &vertices, parsed.camera = body.CameraAt(0);
    const PersonLayers layers = ParserLayers(parsed, 1);
    if (layers.pixels() == 0) continue;
    PackedPicture packed = {
        layers.width, layers.height, PixelsPerMetre(parsed.camera, vertices.col(2).mean()), PackPlanes(layers), {}};
    packed.truth.assign(ParserTruth::kCount * packed.pixels(), 0);
    ForEachPixel(layers, photo.size, photo.size, [&](int x, int y, size_t to) {
      const size_t from = static_cast<size_t>(y) * photo.size + x;
      packed.truth[ParserTruth::kLabel * packed.pixels() + to] = truth.labels[from];
      packed.truth[ParserTruth::kBodyLabel * packed.pixels() + to] = photo.labels[from];
    });
    pictures.push_back(std::move(packed));
  }
  return pictures;
}

}  // namespace

std::vector<PackedPicture> ParserPicturesOf(const PicturesOfPeopleRequest& request, const char* stage,
                                            const PipelineCallbacks& callbacks) {
  const PeopleData people(AsPhotosShowThem(request));
  return PicturesByPerson(static_cast<int>(people.source().num_frames.size()), request.threads, stage, callbacks,
                          [&](int person) { return PicturesOfPerson(people, person); });
}

}  // namespace bodyloom
