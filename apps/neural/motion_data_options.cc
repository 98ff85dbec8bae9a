// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/motion_data_options.h"

#include <CLI/CLI.hpp>

namespace bodyloom {

void AddMotionDataOptions(CLI::App* verb, MotionDataRequest* request) {
  verb->add_option("--data", request->data,
                   "A single-person dataset (bodyloom synth-person), or a video or folder of images")
      ->required();
  verb->add_option("--track", request->track, "The clip's track (default: the single-person dataset's own)");
  verb->add_option("--body", request->body, "The track's body (default: the built-in body)");
  verb->add_option(
      "--iuv", request->iuv,
      "What pixels show of the body by estimates from the pictures, as in the paper's comparisons: a folder "
      "of DensePose's IUV images, or \"own\", the single-person dataset's (default: the tracked body)");
  verb->add_option("--mask", request->mask,
                   "For a video: the person's mask (bodyloom detect --mask, bodyloom run --masks), for silhouette, "
                   "classes and normals of the tracked body within it");
  verb->add_option("--part-labels", request->part_labels,
                   "For a video: DensePose's parts (.npz), for classes and, without --mask, the silhouette");
}

}  // namespace bodyloom
