// SPDX-License-Identifier: Apache-2.0
/// A clip's errors by how much each frame's motion is like what was trained on.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

/// The error of every frame of a clip beside how much its motion is like what was trained on.
class MotionErrors {
 public:
  /// `similarity` by frame of the clip (data_tools/evaluation/motion_similarity.h), or empty.
  explicit MotionErrors(std::vector<float> similarity) : similarity_(std::move(similarity)) {}
  void Add(int frame, double image_l1);

  /// A line a frame: frame, image_l1, similarity. The file appears whole or not at all.
  void WriteCsv(const std::string& path) const;

  struct Quarter {
    double least_similarity = 0, image_l1 = 0;
    int frames = 0;
  };
  /// The frames in four parts of equal size, the least similar first; empty without similarities or with fewer than
  /// four frames.
  [[nodiscard]] std::vector<Quarter> Quarters() const;

 private:
  struct Error {
    int frame;
    double image_l1;
    float similarity;
  };
  std::vector<float> similarity_;
  std::vector<Error> errors_;
};

}  // namespace bodyloom
