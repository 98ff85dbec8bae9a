// SPDX-License-Identifier: Apache-2.0
#include "tracking/rig/match_people.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"

namespace bodyloom::match_people_test {
namespace {

using Eigen::Vector3d;

const CameraPose kOther = {RotationFromAxisAngle(Vector3d(0.1, 1.1, -0.05)), Vector3d(-3, 0.2, 2)};
constexpr double kOffset_s = 1.4;

/// Twelve points that swing about somebody's place, seen by the first camera, or by the other one.
ViewMotion Dancer(int steps, const Vector3d& place, bool in_other, double seconds = 8) {
  ViewMotion motion;
  for (double t = 0; t < seconds; t += 1.0 / 30) {
    MatrixX3d points(12, 3);
    for (int k = 0; k < 12; ++k) {
      const double phase = 0.7 * k * steps + steps, speed = 2 + 0.4 * ((k + steps) % 3);
      points.row(k) =
          (place + Vector3d(0.3 * std::sin(speed * t + phase), 0.12 * k, 0.3 * std::cos(speed * t + phase)) +
           Vector3d(0.2 * std::sin(0.7 * t * steps), 0, 0))
              .transpose();
    }
    motion.timestamps.push_back(t + (in_other ? kOffset_s : 0));
    motion.points.push_back(in_other ? MovedPoints(kOther, points) : points);
  }
  return motion;
}

const Vector3d kLeft(-1.5, 0, 4), kRight(1.5, 0, 5);

TEST(MatchPeople, TellsPeopleByTheirMotions) {
  const std::vector<ViewMotion> first = {Dancer(1, kLeft, false), Dancer(2, kRight, false)};
  const std::vector<ViewMotion> other = {Dancer(2, kRight, true), Dancer(3, kLeft, true), Dancer(1, kLeft, true)};
  const MatchedViews matched = MatchPeople(first, other);
  EXPECT_EQ(matched.person_of, (std::vector<int>{2, 0}));
  EXPECT_NEAR(matched.alignment.offset_s, kOffset_s, 0.01);
  EXPECT_LT(
      RotationAngleBetween(matched.alignment.b_from_a.camera_from_world_rotation, kOther.camera_from_world_rotation),
      0.01);
}

/// Two people who dance the same steps: only where they stand tells them apart.
TEST(MatchPeople, TellsPeopleWhoDanceTheSameByTheirPlaces) {
  const std::vector<ViewMotion> first = {Dancer(1, kLeft, false), Dancer(1, kRight, false)};
  const std::vector<ViewMotion> other = {Dancer(1, kRight, true), Dancer(1, kLeft, true)};
  EXPECT_EQ(MatchPeople(first, other).person_of, (std::vector<int>{1, 0}));
}

TEST(MatchPeople, PeopleWhoAreNotThereAreNotMatched) {
  const std::vector<ViewMotion> first = {Dancer(1, kLeft, false), ViewMotion(), Dancer(2, kRight, false)};
  EXPECT_EQ(MatchPeople(first, {Dancer(2, kRight, true)}).person_of, (std::vector<int>{-1, -1, 0}));
  const MatchedViews none = MatchPeople(first, {ViewMotion()});
  EXPECT_EQ(none.person_of, (std::vector<int>{-1, -1, -1}));
  EXPECT_FALSE(none.alignment.found);
}

TEST(AgreementOf, IsZeroForTheSameMotionAndTheDistanceForAnotherPlace) {
  const ViewMotion a = Dancer(1, kLeft, false);
  const MotionAgreement same = AgreementOf(a, Dancer(1, kLeft, true), kOther, kOffset_s);
  EXPECT_LT(same.distance_m, 1e-3);
  EXPECT_LT(same.apart_m, 1e-3);
  EXPECT_NEAR(same.overlap_s, 8, 0.2);
  const MotionAgreement moved = AgreementOf(a, Dancer(1, kRight, true), kOther, kOffset_s);
  EXPECT_LT(moved.distance_m, 1e-3);
  EXPECT_NEAR(moved.apart_m, (kRight - kLeft).norm(), 1e-3);
}

}  // namespace
}  // namespace bodyloom::match_people_test
