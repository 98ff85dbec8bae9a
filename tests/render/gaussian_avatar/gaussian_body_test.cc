// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/gaussian_body.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bodyloom::gaussian_body_test {
namespace {

GaussianBody OfScales(const std::vector<std::array<float, 3>>& log_scales) {
  GaussianBody body;
  body.Resize(static_cast<int>(log_scales.size()));
  for (int i = 0; i < body.size(); ++i) {
    for (int k = 0; k < 3; ++k) body.parameters(i, GaussianBody::kLogScale + k) = log_scales[i][k];
  }
  return body;
}

void ExpectScales(const GaussianBody& body, int i, const std::array<float, 3>& expected) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(body.parameters(i, GaussianBody::kLogScale + k), expected[k], 1e-6) << i;
}

TEST(GaussianBody, ScalesAreBroughtWithinTheirLimits) {
  const float four = std::log(4.0F);
  GaussianBody body = OfScales({{-5, -5, -5}, {-9, -5, -5}, {-2, -3, -7}, {-4, -6.5F, -7}, {-6, -7, -4.9F}});
  EXPECT_EQ(LimitScales({}, &body), 3);
  ExpectScales(body, 0, {-5, -5, -5});
  ExpectScales(body, 1, {-7.5F, -5, -5});
  ExpectScales(body, 2, {-3.5F, -3.5F, -7});  // a disc stays one
  ExpectScales(body, 3, {-6.5F + four, -6.5F, -7});
  ExpectScales(body, 4, {-6, -7, -4.9F});
  EXPECT_EQ(LimitScales({}, &body), 0);
  EXPECT_THROW(LimitScales({.min_log = -3, .max_log = -4}, &body), std::invalid_argument);
  EXPECT_THROW(LimitScales({.max_axis_ratio = 0.5F}, &body), std::invalid_argument);
}

TEST(GaussianBody, SaysWhatIsWrongWithIt) {
  GaussianBody body = OfScales({{-5, -5, -5}, {-5, -5, -5}});
  std::string why;
  EXPECT_TRUE(body.IsValid(3, 10, &why));
  body.joints[5] = 3;
  EXPECT_FALSE(body.IsValid(3, 10, &why));
  EXPECT_EQ(why, "joint 3, expected 0 to 2");
  body.joints[5] = -1;
  EXPECT_FALSE(body.IsValid(3, 10, nullptr));
  body.joints[5] = 0;
  body.anchors[1].face = 10;
  EXPECT_FALSE(body.IsValid(3, 10, &why));
  EXPECT_EQ(why, "anchor on face 10, expected 0 to 9");
  body.anchors.pop_back();
  EXPECT_FALSE(body.IsValid(3, 10, &why));
  EXPECT_NE(why.find("1 anchors"), std::string::npos) << why;
}

}  // namespace
}  // namespace bodyloom::gaussian_body_test
