// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/people/dressed_render.h"

#include <gtest/gtest.h>

#include <cmath>

#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/synthesis/people/make_single_person_dataset.h"
#include "geometry/cloth/cloth_run.h"
#include "geometry/math/rotation.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/data_tools/synthesis/people/turning_motion.h"
#include "tests/support/toy_body.h"

namespace bodyloom::dressed_person_test {
namespace {

using Eigen::Vector3d;

PersonLabel LabelAtLandmark(const Outfit& outfit, const BodyModel& body, const std::string& name) {
  const Landmark& landmark = body.data().landmarks[body.FindLandmark(name)];
  Vector3d p = Vector3d::Zero();
  for (size_t i = 0; i < landmark.vertices.size(); ++i) {
    p += landmark.weights[i] * body.data().v_template.row(landmark.vertices[i]).transpose();
  }
  return outfit.LabelAt(p);
}

TEST(Outfit, LabelsLieWhereTheyBelong) {
  const BodyModel& body = BuiltinBody();
  const MatrixX3d& joints = body.joint_template();
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const Outfit suit(body, GarmentKind::kSuit, seed), skirt(body, GarmentKind::kSkirt, seed);
    for (const Outfit* outfit : {&suit, &skirt}) {
      for (const char* name : {"nose", "left_eye", "right_eye"}) {
        EXPECT_EQ(LabelAtLandmark(*outfit, body, name), PersonLabel::kFace) << name;
      }
      for (const char* name : {"left_big_toe", "right_heel", "left_small_toe"}) {
        EXPECT_EQ(LabelAtLandmark(*outfit, body, name), PersonLabel::kShoes) << name;
      }
      const Vector3d crown = {0, body.data().v_template.col(1).maxCoeff(), joints(15, 2)};
      EXPECT_EQ(outfit->LabelAt(crown), PersonLabel::kHair);
      EXPECT_EQ(outfit->LabelAt(joints.row(22).transpose()), PersonLabel::kSkin) << "hand";
      EXPECT_EQ(outfit->LabelAt(joints.row(9).transpose() + Vector3d(0, 0, 0.15)), PersonLabel::kTop) << "chest";
      EXPECT_EQ(outfit->LabelAt(joints.row(1).transpose()), PersonLabel::kBottom) << "hip";
    }
    EXPECT_EQ(suit.LabelAt(0.5 * (joints.row(1) + joints.row(4)).transpose()), PersonLabel::kBottom) << "thigh";
    EXPECT_EQ(skirt.LabelAt(joints.row(4).transpose()), PersonLabel::kSkin) << "knee";
  }
}

TEST(Outfit, ClothesLieOutsideAndThicknessIsContinuous) {
  const BodyModel& body = BuiltinBody();
  const Outfit outfit(body, GarmentKind::kSuit, 3);
  for (int v = 0; v < body.num_vertices(); ++v) {
    const Vector3d p = body.data().v_template.row(v).transpose();
    const double here = outfit.OffsetAt(p);
    EXPECT_GE(here, 0);
    EXPECT_LT(here, 0.035);
    EXPECT_EQ(here, outfit.offsets_m()[v]);
    for (const Vector3d& d : {Vector3d(1e-5, 0, 0), Vector3d(0, 1e-5, 0), Vector3d(0, 0, 1e-5)}) {
      // Steps may lie only where the neck meets the shoulders' top, at head_y.
      if (std::abs(p.y() - outfit.cut().head_y) <= 1e-4) continue;
      EXPECT_LT(std::abs(outfit.OffsetAt(p + d) - here), 1e-4);
    }
  }
  EXPECT_EQ(int(Outfit(ToyBody(), GarmentKind::kCoat, 1).offsets_m().size()), ToyBody().num_vertices());
}

TEST(Outfit, EverydayTrousersAreSlimStraightOrWideAndMostShirtsHangLoose) {
  const BodyModel& body = BuiltinBody();
  const MatrixX3d& joints = body.joint_template();
  const Vector3d outer_ankle = joints.row(7).transpose() + Vector3d(0.05, 0, 0);
  constexpr int kPeople = 400;
  int wide = 0, hanging = 0;
  for (uint64_t seed = 1; seed <= kPeople; ++seed) {
    const Outfit outfit(body, GarmentKind::kSuit, seed, ClothesStyle::kEveryday);
    const OutfitCut& cut = outfit.cut();
    const Vector3d above_hem = {outer_ankle.x(), cut.hem_y + 0.02 * cut.unit, outer_ankle.z()};
    if (!outfit.has_top()) continue;
    if (cut.hem_y < joints(4, 1) - 0.1) wide += outfit.OffsetAt(above_hem) > 0.04 * cut.unit ? 1 : 0;
    const Outfit patterned(body, GarmentKind::kSuit, seed);
    EXPECT_EQ(cut.nape_y, patterned.cut().nape_y) << "what everyday clothes do not choose stays";
    if (cut.waist_y == patterned.cut().waist_y) continue;
    ++hanging;
    // Over the trousers: further outside just above its hem than they are just below.
    const Vector3d hip(joints(1, 0) + 0.08, cut.waist_y, joints(1, 2));
    EXPECT_GT(outfit.OffsetAt(hip + Vector3d(0, 0.01, 0)), outfit.OffsetAt(hip - Vector3d(0, 0.025, 0))) << seed;
    EXPECT_EQ(outfit.LabelAt(hip + Vector3d(0, 0.01, 0)), PersonLabel::kTop);
    EXPECT_EQ(outfit.LabelAt(hip - Vector3d(0, 0.01, 0)), PersonLabel::kBottom);
  }
  EXPECT_NEAR(hanging, 0.66 * kPeople, 47);  // five standard deviations; one in eight wears no shirt
  // Three in ten have wide trousers, seven in ten of those long ones; nearly all of them are wider than 4 cm at the
  // hem.
  EXPECT_NEAR(wide, 0.2 * kPeople, 41);
  EXPECT_EQ(ClothesStyleFromString(ToString(ClothesStyle::kEveryday)), ClothesStyle::kEveryday);
  EXPECT_THROW(ClothesStyleFromString("fancy"), std::invalid_argument);
}

TEST(Outfit, EverydayPeopleGoBarefootOrWithoutAShirtNowAndThen) {
  const BodyModel& body = BuiltinBody();
  const MatrixX3d& joints = body.joint_template();
  const Vector3d foot(joints(10, 0), body.data().v_template.col(1).minCoeff() + 0.01, joints(10, 2));
  const Vector3d chest = joints.row(9).transpose() + Vector3d(0, 0, 0.1),
                 sleeve(joints(16, 0) + 0.03, joints(16, 1), joints(16, 2));
  constexpr int kPeople = 1000;
  int bare_chest = 0, bare_foot = 0, no_sleeves = 0;
  for (uint64_t seed = 1; seed <= kPeople; ++seed) {
    const Outfit outfit(body, GarmentKind::kSuit, seed, ClothesStyle::kEveryday);
    EXPECT_EQ(outfit.LabelAt(chest), outfit.has_top() ? PersonLabel::kTop : PersonLabel::kSkin);
    EXPECT_EQ(outfit.LabelAt(foot), outfit.has_shoes() ? PersonLabel::kShoes : PersonLabel::kSkin);
    EXPECT_EQ(outfit.OffsetAt(chest) == 0, !outfit.has_top());
    EXPECT_EQ(outfit.OffsetAt(foot) == 0, !outfit.has_shoes());
    bare_chest += outfit.has_top() ? 0 : 1, bare_foot += outfit.has_shoes() ? 0 : 1;
    no_sleeves += outfit.has_top() && outfit.LabelAt(sleeve) == PersonLabel::kSkin ? 1 : 0;
    EXPECT_TRUE(Outfit(body, GarmentKind::kSuit, seed).has_top());
    EXPECT_TRUE(Outfit(body, GarmentKind::kCoat, seed, ClothesStyle::kEveryday).has_top());
  }
  EXPECT_NEAR(bare_chest, 0.12 * kPeople, 51);  // five standard deviations
  EXPECT_NEAR(bare_foot, 0.2 * kPeople, 63);
  EXPECT_NEAR(no_sleeves, 0.07 * kPeople, 40);
}

TEST(Outfit, HairOfThreeInTenHangsDownTheBack) {
  const BodyModel& body = BuiltinBody();
  const MatrixX3d& joints = body.joint_template();
  // Behind the neck, between the shoulder blades, and the chest in front of them.
  const Vector3d nape = joints.row(12).transpose() + Vector3d(0, -0.015, -0.06),
                 back = joints.row(12).transpose() + Vector3d(0, -0.35, -0.09),
                 chest = joints.row(12).transpose() + Vector3d(0, -0.1, 0.1);
  constexpr int kPeople = 1000;
  int hanging = 0;
  for (uint64_t seed = 1; seed <= kPeople; ++seed) {
    const Outfit outfit(body, GarmentKind::kSuit, seed, ClothesStyle::kEveryday);
    const bool is_long = outfit.LabelAt(nape) == PersonLabel::kHair;
    hanging += is_long ? 1 : 0;
    EXPECT_NE(outfit.LabelAt(back), PersonLabel::kHair);
    EXPECT_NE(outfit.LabelAt(chest), PersonLabel::kHair);
    EXPECT_NE(Outfit(body, GarmentKind::kSuit, seed).LabelAt(nape), PersonLabel::kHair);
  }
  EXPECT_NEAR(hanging, 0.3 * kPeople, 73);  // five standard deviations
}

TEST(Outfit, EverydayClothesLieOutsideAndThicknessIsContinuous) {
  const BodyModel& body = BuiltinBody();
  for (const uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    const Outfit outfit(body, GarmentKind::kSuit, seed, ClothesStyle::kEveryday);
    for (int v = 0; v < body.num_vertices(); ++v) {
      const Vector3d p = body.data().v_template.row(v).transpose();
      const double here = outfit.OffsetAt(p);
      EXPECT_GE(here, 0);
      EXPECT_LT(here, 0.1);
      if (std::abs(p.y() - outfit.cut().head_y) <= 1e-4) continue;
      EXPECT_LT(std::abs(outfit.OffsetAt(p + Vector3d(0, 1e-5, 0)) - here), 2e-4) << v;
    }
  }
}

TEST(DressedRender, TruthIsConsistent) {
  MakeSinglePersonDatasetOptions options;
  options.size_px = 128, options.garment = GarmentKind::kSkirt;
  const Motion motion = Turning(1, 30, [](double) { return 0.4; });
  SynthCamera camera;
  const Track track = TrackInView(BuiltinBody(), motion, options, &camera);
  const DressedPerson person(BuiltinBody(), track.motion.betas, options.garment, 1);
  ClothRunOptions run_options;
  run_options.up = camera.up_in_camera;
  ClothRun run(person, track.motion, run_options);
  const DressedScene scene(person, track.camera, 1, 2, LightOfSeed(camera.up_in_camera, LightStyle::kStudio, 1));
  DressedRenderer renderer(scene);
  const BodyPose pose =
      PoseFromAxisAngle(BuiltinBody(), track.motion.poses.row(0), track.motion.trans.row(0).transpose());
  const PersonFrame frame = renderer.Render(pose, run.Next(), 0.5);
  std::array<int, kNumPersonLabels> count{};
  int towards_viewer = 0, person_pixels = 0, bare_outside = 0, changed_background = 0;
  for (int y = 1; y < 127; ++y) {
    for (int x = 1; x < 127; ++x) {
      const int label = frame.labels.pixel(x, y)[0];
      ++count[label];
      const uint8_t* const n = frame.normals.pixel(x, y);
      const Vector3d normal(NormalOfCode(n[2]), NormalOfCode(n[1]), NormalOfCode(n[0]));
      if (label == 0) {
        EXPECT_EQ(int(n[0]) + n[1] + n[2], 0);
        bool alone = true;
        for (int d = 0; d < 9; ++d) alone = alone && frame.labels.pixel(x + d % 3 - 1, y + d / 3 - 1)[0] == 0;
        changed_background += alone && !(frame.rgb.at(x, y) == frame.background.at(x, y));
      } else {
        ++person_pixels;
        EXPECT_NEAR(normal.norm(), 1, 0.012);
        towards_viewer += normal.z() < 0.2;
      }
      bare_outside += label == 0 && frame.iuv.pixel(x, y)[0] > 0;
    }
  }
  for (int label = 0; label < kNumPersonLabels; ++label) EXPECT_GT(count[label], 3) << kPersonLabelNames[label];
  EXPECT_GT(person_pixels, 700);
  EXPECT_GT(towards_viewer, 0.99 * person_pixels);
  EXPECT_LE(bare_outside, 12) << "clothes lie outside the bare body";
  EXPECT_LE(changed_background, 2);
}

TEST(DressedRender, ShadowsDarkenAndNothingElse) {
  const BodyModel& body = BuiltinBody();
  MakeSinglePersonDatasetOptions options;
  options.size_px = 128;
  const Motion motion = Turning(1, 30, [](double) { return 0.4; });
  SynthCamera camera;
  const Track track = TrackInView(body, motion, options, &camera);
  const BodyPose pose = PoseFromAxisAngle(body, track.motion.poses.row(0), track.motion.trans.row(0).transpose());
  double darker = 0;
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    const DressedPerson person(body, track.motion.betas, GarmentKind::kSuit, seed, ClothesStyle::kEveryday);
    PersonLight light = LightOfSeed(camera.up_in_camera, LightStyle::kNatural, seed);
    ASSERT_TRUE(light.shadow_softness_m.has_value());
    const DressedScene shaded(person, track.camera, seed, 2, light);
    light.shadow_softness_m.reset();
    const DressedScene open(person, track.camera, seed, 2, light);
    DressedRenderer first(shaded), second(open);
    const PersonFrame with = first.Render(pose, {}, 0), without = second.Render(pose, {}, 0);
    EXPECT_TRUE(with.labels.bgr == without.labels.bgr);
    EXPECT_TRUE(with.normals.bgr == without.normals.bgr);
    EXPECT_TRUE(with.background.bgr == without.background.bgr);
    double sum = 0, open_sum = 0;
    for (size_t i = 0; i < with.rgb.bgr.size(); ++i) {
      EXPECT_LE(with.rgb.bgr[i], without.rgb.bgr[i] + 1);  // both are rounded
      if (with.labels.bgr[i] > 0) sum += with.rgb.bgr[i], open_sum += without.rgb.bgr[i];
    }
    darker += 1 - sum / open_sum;
    EXPECT_TRUE(first.Render(pose, {}, 0).rgb.bgr == with.rgb.bgr);
  }
  EXPECT_GT(darker / 4, 0.05);
  EXPECT_LT(darker / 4, 0.4);
}

TEST(PersonLight, ComesFromWhereItsStyleSays) {
  const Vector3d up = Vector3d(0.1, -1, 0.2).normalized();
  int from_camera = 0;
  constexpr int kLights = 500;
  for (uint64_t seed = 1; seed <= kLights; ++seed) {
    const PersonLight studio = LightOfSeed(up, LightStyle::kStudio, seed);
    EXPECT_FALSE(studio.shadow_softness_m.has_value());
    const PersonLight natural = LightOfSeed(up, LightStyle::kNatural, seed);
    for (const PersonLight& light : {studio, natural}) {
      EXPECT_NEAR(light.towards[0].norm(), 1, 1e-6);
      EXPECT_NEAR(light.towards[1].norm(), 1, 1e-6);
      EXPECT_GT(light.towards[0].cast<double>().dot(up), 0.1) << "from above";
      EXPECT_GT(light.strength[0] + light.ambient, 0.7);
    }
    EXPECT_GT(studio.towards[0].z(), -0.4F) << "from beside or behind";
    EXPECT_GE(*natural.shadow_softness_m, 0.004F);
    EXPECT_LE(*natural.shadow_softness_m, 0.061F);
    from_camera += natural.towards[0].z() < 0 ? 1 : 0;
  }
  // Azimuths within 2.4 of the camera's: 1.57 of 2.4 and what the height adds.
  EXPECT_NEAR(from_camera, 0.65 * kLights, 55);
  EXPECT_EQ(LightStyleFromString(ToString(LightStyle::kNatural)), LightStyle::kNatural);
  EXPECT_EQ(LightStyleFromString(ToString(LightStyle::kStudio)), LightStyle::kStudio);
  EXPECT_THROW(LightStyleFromString("sun"), std::invalid_argument);
}

TEST(MakeSinglePersonDataset, SameBytesForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  MakeSinglePersonDatasetOptions options;
  options.size_px = 64, options.garment = GarmentKind::kCoat;
  const Motion motion = Turning(20, 30, [](double t) { return t; });
  const auto bytes = [&](int threads, uint64_t seed) {
    const std::string path = folder.File(std::to_string(threads));
    options.num_threads = threads, options.seed = seed;
    const MakeSinglePersonDatasetSummary summary = MakeSinglePersonDataset(path, BuiltinBody(), motion, options);
    EXPECT_TRUE(summary.finished);
    EXPECT_EQ(summary.frames, 20);
    std::string all = ReadFileBytes(path + "/person.json") + ReadFileBytes(path + "/track.npz");
    for (const char* kind : {"images", "labels", "normals", "iuv", "backgrounds"}) {
      for (const char* frame : {"000000", "000007", "000016", "000019"}) {
        all += ReadFileBytes(path + "/" + kind + "/" + frame + ".png");
      }
    }
    return all;
  };
  const std::string one = bytes(1, 5);
  EXPECT_TRUE(one == bytes(3, 5));
  EXPECT_FALSE(one == bytes(2, 6)) << "another seed is another person";
  const SinglePersonDataset set(folder.File("1"));
  EXPECT_EQ(set.track().num_frames(), 20);
  EXPECT_NEAR(set.info().fps, 30, 1e-9);
  options.progress = [](double done) { return done < 0.5; };
  EXPECT_FALSE(MakeSinglePersonDataset(folder.File("stopped"), BuiltinBody(), motion, options).finished);
  EXPECT_THROW(SinglePersonDataset(folder.File("stopped")), std::runtime_error);
}

}  // namespace
}  // namespace bodyloom::dressed_person_test
