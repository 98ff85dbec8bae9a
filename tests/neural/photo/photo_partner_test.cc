// SPDX-License-Identifier: Apache-2.0
#include "neural/training/photo_partner.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

namespace bodyloom::photo_partner_test {
namespace {

/// All partners that numbers in [0, 1) choose.
std::set<int> Partners(const PhotoSource& people, int source, PartnerDiffers differs) {
  std::set<int> partners;
  for (int i = 0; i < 200; ++i) partners.insert(PartnerOf(people, 0, source, differs, i / 200.0));
  return partners;
}

PhotoSource People(const std::vector<ImagePlace>& places) {
  PhotoSource people;
  people.num_frames = {static_cast<int>(places.size())};
  people.places = {places};
  return people;
}

TEST(PhotoPartner, IsOfAnotherPoseOrOfAnotherViewToo) {
  // Two poses in three views, and a third pose in the first view alone.
  const PhotoSource people = People({{0, 0}, {1, 0}, {0, 1}, {1, 1}, {0, 2}, {1, 2}, {2, 0}});
  EXPECT_EQ(Partners(people, 0, PartnerDiffers::kPose), (std::set<int>{1, 3, 5, 6}));
  EXPECT_EQ(Partners(people, 0, PartnerDiffers::kPoseAndView), (std::set<int>{3, 5}));
  EXPECT_EQ(Partners(people, 6, PartnerDiffers::kPoseAndView), (std::set<int>{2, 3, 4, 5}));
}

TEST(PhotoPartner, IsTheNextBestWhereThereIsNone) {
  // One camera: another pose. One pose from two sides: the other side. One picture: itself.
  EXPECT_EQ(Partners(People({{0, 0}, {1, 0}, {2, 0}}), 1, PartnerDiffers::kPoseAndView), (std::set<int>{0, 2}));
  EXPECT_EQ(Partners(People({{0, 0}, {0, 1}}), 0, PartnerDiffers::kPose), (std::set<int>{1}));
  EXPECT_EQ(Partners(People({{0, 0}}), 0, PartnerDiffers::kPose), (std::set<int>{0}));
  PhotoSource unknown;
  unknown.num_frames = {4};
  EXPECT_EQ(Partners(unknown, 2, PartnerDiffers::kPoseAndView), (std::set<int>{0, 1, 3}));
}

TEST(PhotoPartner, RefusesWhatIsNotThere) {
  PhotoSource people = People({{0, 0}, {1, 0}});
  EXPECT_THROW(PartnerOf(people, 1, 0, PartnerDiffers::kPose, 0), std::invalid_argument);
  EXPECT_THROW(PartnerOf(people, 0, 2, PartnerDiffers::kPose, 0), std::invalid_argument);
  people.places[0].pop_back();
  EXPECT_THROW(PartnerOf(people, 0, 0, PartnerDiffers::kPose, 0), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::photo_partner_test
