// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/photo/people_data.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "data_tools/body/builtin_body.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/perturbed_motion.h"
#include "data_tools/synthesis/people/make_multi_person_dataset.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::people_data_test {
namespace {

class PeopleWithBodyErrors : public ::testing::Test {
 protected:
  void SetUp() override {
    MakeMultiPersonDatasetOptions options;
    options.people = 1, options.actions = 1, options.views = 3, options.frames = 1, options.size_px = 128;
    options.num_threads = 1;
    MakeMultiPersonDataset(scratch_ / "people", BuiltinBody(), {DemoMotion(BuiltinBody(), 60, 30)}, options);
    request_.data = scratch_ / "people", request_.size = 128, request_.texture_size = 64;
  }
  ScratchFolder scratch_;
  PeopleDataRequest request_;
};

TEST_F(PeopleWithBodyErrors, AreOffByUpToWhatIsRequestedEachByItsOwn) {
  const PeopleData exact(request_);
  request_.body_error_px = 12;
  const PeopleData wrong(request_), again(request_);
  request_.seed = 2;
  const PeopleData otherwise(request_);
  double minimum = 1e9, maximum = 0;
  for (int f = 0; f < 3; ++f) {
    const Track truth = exact.BodyOf(0, f), body = wrong.BodyOf(0, f);
    EXPECT_TRUE(body.motion.poses == again.BodyOf(0, f).motion.poses);
    EXPECT_FALSE(body.motion.poses == otherwise.BodyOf(0, f).motion.poses);
    // The window shows the person larger than the picture does, at most twice as large.
    const double error_px = MeanProjectionError(BuiltinBody(), truth.CameraAt(0), truth.motion, body.motion, 1);
    minimum = std::min(minimum, error_px), maximum = std::max(maximum, error_px);
  }
  EXPECT_GT(minimum, 0.1);
  EXPECT_LT(maximum, 2 * 12);
  EXPECT_GT(maximum, 1.1 * minimum);
}

TEST_F(PeopleWithBodyErrors, ImagesStayAsTheyAre) {
  const PeopleData exact(request_);
  request_.body_error_px = 1e-3;  // below what is made
  const PeopleData same(request_);
  PhotoFrame a, b;
  exact.source().fill(0, 1, &a);
  same.source().fill(0, 1, &b);
  EXPECT_EQ(a.image, b.image);
  EXPECT_EQ(a.labels, b.labels);
  EXPECT_TRUE(exact.BodyOf(0, 1).motion.poses == same.BodyOf(0, 1).motion.poses);
}

}  // namespace
}  // namespace bodyloom::people_data_test
