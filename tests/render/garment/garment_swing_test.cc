// SPDX-License-Identifier: Apache-2.0
#include "render/garment/fit_clothes.h"

#include <gtest/gtest.h>

#include "tests/render/garment/skirt_scene.h"

namespace bodyloom::garment_swing_test {
namespace {

TEST(GarmentSwing, TurnsUpInTheImageOnly) {
  const Track photo = StandingPhoto(0);
  EXPECT_LT((SwungUp(photo, 0) - Eigen::Vector3d(0, -1, 0)).norm(), 1e-12);
  EXPECT_LT((SwungUp(photo, EIGEN_PI / 2) - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
}

}  // namespace
}  // namespace bodyloom::garment_swing_test
