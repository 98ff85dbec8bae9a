// SPDX-License-Identifier: Apache-2.0
// Heads used by the face loss: those whose face is turned to the camera.
#include <gtest/gtest.h>

#include "data_tools/body/builtin_body.h"
#include "data_tools/descriptors/photo_maps.h"
#include "neural/guided/complete_maps.h"
#include "neural/photo/photo_batch.h"
#include "pipelines/neural/guided/virtual_views.h"
#include "pipelines/neural/photo/photo_input.h"
#include "render/texture/complete/body_part_map.h"
#include "tests/neural/photo/toy_photos.h"

namespace bodyloom::face_box_test {
namespace {

TEST(FaceBox, OfABatchIsThatOfHeadsSeenFromTheFront) {
  const PhotoSource source = ToyPhotos(1, 2);
  const std::vector<PhotoPair> pairs = {{0, 1, 0}, {0, 0, 1}};  // the targets: a front and a back
  const PhotoBatch batch =
      MakePhotoBatch(source, pairs, 2, 16, nullptr, HeadTexelsOf(source.texel_parts, source.texel_places).back);
  ASSERT_EQ(batch.faces.size(), 2U);
  EXPECT_EQ(batch.faces[0].width, kCardWidth);
  EXPECT_EQ(batch.faces[1].width, 0);
  EXPECT_TRUE(MakePhotoBatch(source, pairs, 2, 16).faces.empty()) << "nobody asked for them";
}

TEST(FaceBox, OfAPersonWhoTurns) {
  const BodyModel& body = BuiltinBody();
  const Track track = VirtualViewTrack(body, Eigen::VectorXd::Zero(1));
  PhotoMapsOptions options;
  options.size = options.texture_size = 256;
  for (const int yaw : {0, 20, 45, 80, 100, 135, 160, 180}) {
    for (const int side : {-1, 1}) {
      options.yaw_deg.assign(track.num_frames(), side * yaw);
      const PhotoMaps maps(body, track, options);
      const HeadTexels head = HeadTexelsOf(PartsOfTexels(body, *maps.texels()), PlacesOfTexels(body, *maps.texels()));
      PhotoFrame frame;
      FillMaps(maps.At(kViewFront), options.size, options.texture_size, &frame);
      EXPECT_EQ(FaceBox(frame, head.back).width > 0, yaw <= 45) << side * yaw << " degrees";
      options.texels = maps.texels();
    }
  }
  EXPECT_THROW(FaceBox(PhotoFrame(), {}), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::face_box_test
