// SPDX-License-Identifier: Apache-2.0
/// Two people with one colour per label, so that each texel shows whose clothes it has.
#include "render/photo_avatar/transfer_clothes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/video/image_file.h"
#include "geometry/body/posed_body.h"
#include "geometry/cloth/body_with_garment.h"
#include "geometry/scene/track_edits.h"
#include "geometry/uv_maps/uv_texels.h"
#include "pipelines/photo_avatar/animate_person.h"
#include "pipelines/photo_avatar/person_folder.h"
#include "render/garment/person_cloth.h"
#include "render/texture/body_regions.h"
#include "render/view/overlay.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/short_track.h"
#include "tests/support/toy_body.h"

namespace bodyloom::transfer_clothes_test {
namespace {

using ::testing::HasSubstr;

constexpr int kSide = 128;
constexpr double kOff = 0.02;  ///< clothes of the other person, metres
/// Of a label: red says which, green whose.
constexpr int kMine = 200, kTheirs = 60;

uint8_t RedOf(PersonLabel label) { return static_cast<uint8_t>(30 * static_cast<int>(label) + 20); }

/// Label of a point of the rest pose.
using Cut = std::function<PersonLabel(const Eigen::Vector3d& rest, BodyRegion region)>;

PersonLabel LongSleeves(const Eigen::Vector3d& rest, BodyRegion region) {
  if (region == BodyRegion::kFace) return PersonLabel::kFace;
  if (region == BodyRegion::kScalp) return PersonLabel::kHair;
  if (region == BodyRegion::kHand) return PersonLabel::kSkin;
  return rest.y() > 0 ? PersonLabel::kTop : PersonLabel::kBottom;
}
PersonLabel NoSleeves(const Eigen::Vector3d& rest, BodyRegion region) {
  const PersonLabel label = LongSleeves(rest, region);
  return label == PersonLabel::kTop && std::abs(rest.x()) > 0.25 ? PersonLabel::kSkin : label;
}

struct Texels {
  UvTexelTable table;
  MatrixX3d rest;
  std::vector<BodyRegion> regions;
};

const Texels& TexelsOfBuiltin() {
  static const Texels texels = [] {
    const BodyModel& body = *BodyOrBuiltin("");
    MatrixX3d rest = ShapeVertices(body, Eigen::VectorXd::Zero(2));
    rest.col(1).array() -= body.joint_template()(0, 1);  // the pelvis at 0
    std::vector<BodyRegion> regions = BodyRegions(body, rest);
    return Texels{BuildUvTexelTable(body, {.width = kSide, .height = kSide, .gutter = 1}), std::move(rest),
                  std::move(regions)};
  }();
  return texels;
}

int CornerOf(size_t texel) {
  const Texels& texels = TexelsOfBuiltin();
  Eigen::Index corner = 0;
  texels.table.barycentric[texel].maxCoeff(&corner);
  return BodyOrBuiltin("")->data().faces(texels.table.face[texel], corner);
}

PhotoPerson PersonOf(const Cut& cut, int green, double off) {
  const Texels& texels = TexelsOfBuiltin();
  PhotoPerson person;
  person.bare = BodyOrBuiltin("");
  person.betas = Eigen::VectorXd::Zero(2);
  const std::vector<double> offsets(static_cast<size_t>(person.bare->num_vertices()), off);
  person.clothed = person.body = std::make_shared<const BodyModel>(BakeShape(*person.bare, person.betas, offsets));
  person.texture = Image(kSide, kSide);
  person.sources = Image(kSide, kSide, Colour{255, 255, 255});
  person.labels.assign(size_t{kSide} * kSide, 0);
  for (size_t i = 0; i < texels.table.size(); ++i) {
    const int v = CornerOf(i), at = texels.table.pixel[i];
    const PersonLabel label = cut(texels.rest.row(v).transpose(), texels.regions[v]);
    person.labels[at] = static_cast<uint8_t>(label);
    uint8_t* bgr = &person.texture.bgr[3 * static_cast<size_t>(at)];
    bgr[0] = 100, bgr[1] = static_cast<uint8_t>(green), bgr[2] = RedOf(label);
  }
  person.tracks = {ShortTrack(1)};
  person.tracks[0].motion.betas = person.betas;
  return person;
}

/// Share of the texels where the other's label is `theirs` and mine `mine` whose colour is as expected; away from seams
/// between labels, where colours are mixed.
double Share(const PhotoPerson& dressed, const Cut& mine, const Cut& theirs, PersonLabel of_mine, PersonLabel of_theirs,
             const std::array<int, 3>& bgr) {
  const Texels& texels = TexelsOfBuiltin();
  int all = 0, right = 0;
  for (size_t i = 0; i < texels.table.size(); ++i) {
    if (texels.table.in_gutter[i] != 0) continue;
    const int v = CornerOf(i);
    const Eigen::Vector3d rest = texels.rest.row(v).transpose();
    if (mine(rest, texels.regions[v]) != of_mine || theirs(rest, texels.regions[v]) != of_theirs) continue;
    ++all;
    const uint8_t* colour = &dressed.texture.bgr[3 * static_cast<size_t>(texels.table.pixel[i])];
    bool same = true;
    for (size_t c = 0; c < 3; ++c) same = same && std::abs(colour[c] - bgr[c]) <= 3;
    right += same ? 1 : 0;
  }
  EXPECT_GT(all, 30);
  return static_cast<double>(right) / all;
}

TEST(TransferClothes, WearsTheOthersClothesAndKeepsHeadAndHands) {
  const PhotoPerson me = PersonOf(NoSleeves, kMine, 0), other = PersonOf(LongSleeves, kTheirs, kOff);
  const PhotoPerson dressed = TransferClothes(me, other);
  const auto share = [&](PersonLabel mine, PersonLabel theirs, int green, PersonLabel red) {
    return Share(dressed, NoSleeves, LongSleeves, mine, theirs, {100, green, RedOf(red)});
  };
  using enum PersonLabel;
  EXPECT_GT(share(kTop, kTop, kTheirs, kTop), 0.9);
  EXPECT_GT(share(kSkin, kTop, kTheirs, kTop), 0.9) << "sleeves over bare arms";
  EXPECT_GT(share(kBottom, kBottom, kTheirs, kBottom), 0.9);
  EXPECT_GT(share(kSkin, kSkin, kMine, kSkin), 0.9) << "hands";
  EXPECT_GT(share(kFace, kFace, kMine, kFace), 0.9);
  EXPECT_GT(share(kHair, kHair, kMine, kHair), 0.9);
  // As far off as there where something is worn, as before on the head.
  const MatrixX3d bare = ShapeVertices(*me.bare, me.betas);
  const Texels& texels = TexelsOfBuiltin();
  int clothed = 0, head = 0;
  for (Eigen::Index v = 0; v < bare.rows(); ++v) {
    const double off = (dressed.body->data().v_template.row(v) - bare.row(v)).norm();
    if (texels.regions[v] == BodyRegion::kFace) {
      ASSERT_LT(off, 1e-6);
      ++head;
    } else if (std::abs(texels.rest(v, 0)) < 0.1 && texels.rest(v, 1) < 0.3 && texels.rest(v, 1) > 0.1) {
      ASSERT_NEAR(off, kOff, 1e-6);
      ++clothed;
    }
  }
  EXPECT_GT(head, 100);
  EXPECT_GT(clothed, 100);
  EXPECT_EQ(dressed.betas, me.betas);
  EXPECT_EQ(dressed.texture.width, kSide);
}

TEST(TransferClothes, ShortSleevesShowArmsInMySkin) {
  const PhotoPerson me = PersonOf(LongSleeves, kMine, kOff), other = PersonOf(NoSleeves, kTheirs, 0);
  const PhotoPerson dressed = TransferClothes(me, other);
  // Their skin where mine was hidden, in my skin's colour.
  EXPECT_GT(Share(dressed, LongSleeves, NoSleeves, PersonLabel::kTop, PersonLabel::kSkin,
                  {100, kMine, RedOf(PersonLabel::kSkin)}),
            0.9);
}

TEST(TransferClothes, ASkirtComesAlong) {
  const PhotoPerson me = PersonOf(LongSleeves, kMine, 0);
  PhotoPerson other = PersonOf(LongSleeves, kTheirs, 0);
  other.cut.waist_y_m = other.bare->joint_template()(0, 1) + 0.08;
  other.cut.length_m = 0.5, other.cut.fullness = 0.4, other.cut.spacing_m = 0.05;
  other.garment = CutGarment(*other.clothed, &other.cut);
  other.body = std::make_shared<const BodyModel>(BodyWithGarment(*other.clothed, other.garment));
  // The strip of the garment is the upper fifth of the atlas, the charts shrink below it: paint anew.
  const UvTexelTable table = BuildUvTexelTable(*other.body, {.width = kSide, .height = kSide, .gutter = 1});
  const Eigen::Index faces = other.bare->data().faces.rows();
  other.texture = Image(kSide, kSide, Colour{RedOf(PersonLabel::kTop), kTheirs, 100});
  other.labels.assign(other.labels.size(), static_cast<uint8_t>(PersonLabel::kTop));
  for (size_t i = 0; i < table.size(); ++i) {
    if (table.face[i] < faces) continue;
    uint8_t* bgr = &other.texture.bgr[3 * static_cast<size_t>(table.pixel[i])];
    bgr[0] = 250, bgr[1] = 10, bgr[2] = 10;
    other.labels[table.pixel[i]] = static_cast<uint8_t>(PersonLabel::kBottom);
  }
  const PhotoPerson dressed = TransferClothes(me, other);
  EXPECT_EQ(dressed.garment.rings, other.garment.rings);
  EXPECT_NEAR(dressed.cut.waist_y_m, other.cut.waist_y_m, 1e-9) << "of two people of the same shape";
  EXPECT_GT(dressed.body->num_vertices(), me.body->num_vertices());
  int blue = 0, strip = 0;
  const UvTexelTable now = BuildUvTexelTable(*dressed.body, {.width = kSide, .height = kSide, .gutter = 0});
  for (size_t i = 0; i < now.size(); ++i) {
    if (now.face[i] < faces) continue;
    ++strip;
    blue += dressed.texture.bgr[3 * static_cast<size_t>(now.pixel[i])] > 200 ? 1 : 0;
  }
  EXPECT_GT(strip, 1000);
  EXPECT_GT(blue, 0.95 * strip);
  // And off again.
  const PhotoPerson again = TransferClothes(dressed, me);
  EXPECT_TRUE(again.garment.empty());
  EXPECT_EQ(dressed.report.garment_length_m, 0.5);
  EXPECT_EQ(again.report.garment_length_m, 0);
  EXPECT_EQ(again.body->num_vertices(), me.body->num_vertices());
}

TEST(TransferClothes, TheReportOfThePhotosStays) {
  PhotoPerson me = PersonOf(LongSleeves, kMine, 0);
  me.report.seen = 0.3, me.report.smooth_fill = 0.7;
  me.report.photos.resize(1);
  const PhotoPerson dressed = TransferClothes(me, PersonOf(NoSleeves, kTheirs, 0));
  EXPECT_EQ(dressed.report.seen, 0.3);
  EXPECT_EQ(dressed.report.smooth_fill, 0.7);
  EXPECT_EQ(dressed.report.photos.size(), 1U);
}

TEST(TransferClothes, RefusesWhatItCannotPutOn) {
  const PhotoPerson me = PersonOf(LongSleeves, kMine, 0);
  PhotoPerson other = PersonOf(NoSleeves, kTheirs, 0);
  other.labels.clear();
  EXPECT_THROW(TransferClothes(me, other), std::invalid_argument);
  EXPECT_THROW(TransferClothes(other, me), std::invalid_argument);
  other = PersonOf(NoSleeves, kTheirs, 0);
  other.bare = std::make_shared<const BodyModel>(ToyBody());
  EXPECT_THROW(TransferClothes(me, other), std::invalid_argument);
}

TEST(TransferClothes, KeptPeopleExchangeClothes) {
  const ScratchFolder folder;
  for (const char* name : {"me", "other"}) std::filesystem::create_directory(folder / name);
  WritePhotoPerson(folder / "me", PersonOf(NoSleeves, kMine, 0));
  WritePhotoPerson(folder / "other", PersonOf(LongSleeves, kTheirs, kOff));
  AnimatePersonRequest request;
  request.person = folder / "me";
  request.garment_from = folder / "other";
  request.keep = folder / "dressed";
  AnimatePerson(request);
  const PhotoPerson expected = TransferClothes(PersonOf(NoSleeves, kMine, 0), PersonOf(LongSleeves, kTheirs, kOff));
  const PhotoPerson kept = ReadPhotoPerson(folder / "dressed", "");
  EXPECT_EQ(kept.labels, expected.labels);
  EXPECT_EQ(kept.texture.bgr, expected.texture.bgr);
  const auto error = [&] {
    try {
      AnimatePerson(request);
    } catch (const std::exception& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  WriteImage(folder / "other/labels.png", Image(4, 4));
  EXPECT_THAT(error(), HasSubstr("labels.png: is 4x4, the texture 128x128"));
  WriteImage(folder / "other/labels.png", Image(kSide, kSide, Colour{9, 9, 9}));
  EXPECT_THAT(error(), HasSubstr("labels.png: label 9, expected 0 to 6"));
  std::filesystem::remove(folder / "other/labels.png");
  EXPECT_THAT(error(), HasSubstr("other: clothes: it is not known what the texels show"));
  PhotoPerson unlabelled = PersonOf(NoSleeves, kMine, 0);
  unlabelled.labels.clear();
  WritePhotoPerson(folder / "me", unlabelled);
  EXPECT_TRUE(ReadPhotoPerson(folder / "me", "").labels.empty()) << "those of who was kept there before are gone";
  request.garment_from = folder / "nobody.jpg";
  EXPECT_THAT(error(), HasSubstr("nobody.jpg"));
}

}  // namespace
}  // namespace bodyloom::transfer_clothes_test
